//! The narrowest passage of the gas between walls that face each other, and the thinnest body between gas and gas.
//!
//! From points within each triangle a ray goes along the normal into the gas until it meets the next triangle. Where that
//! one faces back within 45 degrees, and has no corner in common with the first, the ray's length is a passage. Every
//! passage found is there, so the least of them is never below the narrowest; between two flat walls it is exact. A passage
//! that no ray meets is missed: one narrower than the triangles around it are far apart, as at the foot of a wedge. The
//! same ray backwards, through the solid, measures bodies.

use super::sampling::map;
use super::{Triangle, Vessel};
use glam::DVec3;

/// Pairs of a ray and a triangle that are tried at most: of larger meshes fewer triangles send out rays.
const MOST_TRIALS: usize = 100_000_000;
/// The same beside one wall, which is looked at several times where it moves.
const MOST_SIDE_TRIALS: usize = 20_000_000;
/// Barycentric places of the rays in a triangle.
const PLACES: [[f64; 3]; 4] = [[1.0 / 3.0; 3], [0.8, 0.1, 0.1], [0.1, 0.8, 0.1], [0.1, 0.1, 0.8]];
/// Cosine of the largest angle between a ray and the wall that it meets.
const FACING: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Cosine of the least angle between a direction and the normal of a side along it.
const BESIDE: f64 = 0.1;
/// Places along each edge of such a side.
const SIDE_PLACES: usize = 12;
/// Of the vessel's size: what is nearer touches.
const ROUNDING: f64 = 1e-9;

struct Facet {
    wall: u32,
    corners: [DVec3; 3],
    normal: DVec3,
}

impl Facet {
    /// Where along the ray it is met from the side of the gas, or from behind.
    fn met(&self, from: DVec3, along: DVec3) -> Option<f64> {
        let [a, b, c] = self.corners;
        let (u, v) = (b - a, c - a);
        let p = along.cross(v);
        let determinant = u.dot(p);
        if determinant == 0.0 {
            return None;
        }
        let s = from - a;
        let q = s.cross(u);
        let (x, y) = (s.dot(p) / determinant, along.dot(q) / determinant);
        // An edge belongs to both sides: a ray must not slip through.
        (x >= -1e-9 && y >= -1e-9 && x + y <= 1.0 + 1e-9).then(|| v.dot(q) / determinant)
    }
}

/// A way across gas, between two places of walls that face each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// m.
    pub length: f64,
    /// Indices of the walls; twice the same within one.
    pub walls: [u32; 2],
    /// Half-way, m.
    pub middle: [f64; 3],
}

/// What is narrowest; none where nothing of the kind was found.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Narrowest {
    pub gap: Option<Passage>,
    /// m, across a solid, between two walls that face away from each other, with gas before both.
    pub body: Option<f64>,
}

fn shorter(a: Passage, b: Passage) -> Passage {
    if b.length < a.length { b } else { a }
}

/// Barycentric places of a triangle, close enough together to find what is only a part of a side in the gas.
fn side_places() -> impl Iterator<Item = [f64; 3]> {
    let share = |k: usize| (k as f64 + 1.0 / 3.0) / SIDE_PLACES as f64;
    let places = (0..SIDE_PLACES).flat_map(move |i| (0..SIDE_PLACES - i).map(move |j| [share(i), share(j)]));
    places.map(|[u, v]| [1.0 - u - v, u, v])
}

impl Narrowest {
    fn and(self, other: Narrowest) -> Narrowest {
        Narrowest {
            gap: self.gap.into_iter().chain(other.gap).reduce(shorter),
            body: self.body.into_iter().chain(other.body).reduce(f64::min),
        }
    }
}

impl Vessel {
    pub fn narrowest(&self) -> Narrowest {
        let facets = self.facets();
        let size = self.size();
        let every = (facets.len() * facets.len() * PLACES.len()).div_ceil(MOST_TRIALS).max(1);
        let found = map(facets.len().div_ceil(every), |index, _| {
            let own = &facets[index * every];
            let from_places = PLACES.iter().map(|place| self.through_place(&facets, own, place, ROUNDING * size));
            from_places.fold(Narrowest::default(), Narrowest::and)
        });
        found.into_iter().fold(Narrowest::default(), Narrowest::and)
    }

    /// The narrowest gap between the sides of a wall that lie along a direction and face away from its middle, and another wall.
    pub fn gap_beside(&self, wall: usize, along: DVec3) -> Option<Passage> {
        let facets = self.facets();
        let is_own = |facet: &&Facet| facet.wall as usize == wall;
        let corners = || facets.iter().filter(is_own).flat_map(|facet| facet.corners);
        let middle = corners().sum::<DVec3>() / corners().count().max(1) as f64;
        let is_side = |facet: &&Facet| {
            facet.normal.dot(along).abs() < BESIDE && facet.normal.dot(facet.corners[0] - middle) > 0.0
        };
        let sides: Vec<&Facet> = facets.iter().filter(is_own).filter(is_side).collect();
        let trials = sides.len() * facets.len() * (SIDE_PLACES * SIDE_PLACES);
        let every = trials.div_ceil(MOST_SIDE_TRIALS).max(1);
        let least = ROUNDING * self.size();
        let found = map(sides.len().div_ceil(every), |index, _| {
            let gaps =
                side_places().filter_map(|place| self.through_place(&facets, sides[index * every], &place, least).gap);
            gaps.filter(|gap| gap.walls[0] != gap.walls[1]).reduce(shorter)
        });
        found.into_iter().flatten().reduce(shorter)
    }

    fn facets(&self) -> Vec<Facet> {
        let place = |index: u32| DVec3::from(self.vertices[index as usize]);
        let facet = |triangle: &Triangle| {
            let corners = triangle.vertices.map(place);
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
            Facet { wall: triangle.wall, corners, normal }
        };
        self.triangles.iter().map(facet).collect()
    }

    fn size(&self) -> f64 {
        DVec3::from(self.bounds.1).distance(DVec3::from(self.bounds.0))
    }

    /// What the line along the normal through a place of a facet measures, before it and behind.
    fn through_place(&self, facets: &[Facet], own: &Facet, place: &[f64; 3], least: f64) -> Narrowest {
        let from: DVec3 = own.corners.iter().zip(place).map(|(corner, weight)| *weight * *corner).sum();
        let [mut ahead, mut behind]: [Option<(f64, &Facet)>; 2] = [None; 2];
        for facet in facets {
            let Some(distance) = facet.met(from, own.normal) else { continue };
            let nearest = if distance > 0.0 { &mut ahead } else { &mut behind };
            if distance.abs() > least && nearest.is_none_or(|(other, _)| distance.abs() < other.abs()) {
                *nearest = Some((distance, facet));
            }
        }
        let faces_back = |(distance, other): (f64, &Facet)| {
            let apart = own.corners.iter().all(|a| other.corners.iter().all(|b| a.distance(*b) > least));
            (apart && other.normal.dot(own.normal) < -FACING).then_some((distance, other.wall))
        };
        let gas = |along: f64| self.is_gas((from + along * own.normal).to_array());
        // Of walls that overlap, what is hidden in another faces no gas.
        let gap = ahead.and_then(faces_back).filter(|&(d, _)| gas(0.01 * d) && gas(0.5 * d));
        let body = behind.and_then(faces_back).filter(|&(d, _)| gas(-0.01 * d) && !gas(0.5 * d) && gas(1.01 * d));
        let passage = |(length, other): (f64, u32)| Passage {
            length,
            walls: [own.wall.min(other), own.wall.max(other)],
            middle: (from + 0.5 * length * own.normal).to_array(),
        };
        Narrowest { gap: gap.map(passage), body: body.map(|(d, _)| d.abs()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn gap(walls: &str) -> Option<f64> {
        narrowest(walls).gap.map(|passage| passage.length)
    }

    fn narrowest(walls: &str) -> Narrowest {
        let text = format!(
            "end_time = 1.0\n[[gas]]\nname = \"n2\"\nmolar_mass = 0.028\ngamma = 1.4\n{walls}\n\
             [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\ngas = \"n2\"\n"
        );
        let scene = crate::scene::parse(&text, "test.toml", Path::new("")).unwrap();
        Vessel::build(&scene.walls).unwrap().narrowest()
    }

    const TANK: &str =
        "[[wall]]\nname = \"tank\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [1.0, 0.5, 0.5]\ngas = \"inside\"\n";

    fn near(found: Option<f64>, expected: f64) -> bool {
        found.is_some_and(|found| (found / expected - 1.0).abs() < 1e-6)
    }

    /// Of an empty box its shorter side; a block before a wall leaves its distance; a hole its width; of a round vessel
    /// about the diameter.
    #[test]
    fn the_narrowest_passage_is_found() {
        assert!(near(gap(TANK), 0.5), "{:?}", gap(TANK));
        let block = |low: f64| {
            gap(&format!(
                "{TANK}[[wall]]\nname = \"block\"\nshape = \"box\"\nmin = [0.2, 0.1, {low}]\nmax = [0.6, 0.3, 0.3]\ngas = \"outside\"\n"
            ))
        };
        for low in [0.003, 0.05] {
            assert!(near(block(low), low), "{:?}", block(low));
        }
        let shell = "[[wall]]\nname = \"shell\"\nshape = \"box\"\nmin = [0.2, 0.15, 0.15]\nmax = [0.4, 0.35, 0.35]\n\
             thickness = 0.01\nhole = [{ name = \"slit\", face = \"+x\", center = [0.25, 0.25], size = [0.1, 0.004] }]\n";
        assert!(near(gap(&format!("{TANK}{shell}")), 0.004));
        let ball = gap(
            "[[wall]]\nname = \"ball\"\nshape = \"sphere\"\ncenter = [0.0, 0.0, 0.0]\nradius = 0.1\ngas = \"inside\"\n",
        );
        assert!(ball.is_some_and(|gap| (0.17..0.21).contains(&gap)), "{ball:?}");
    }

    /// A passage has its walls, the vessel before what stands in it, and lies between them.
    #[test]
    fn a_passage_has_its_walls_and_its_place() {
        let block = "[[wall]]\nname = \"block\"\nshape = \"box\"\nmin = [0.2, 0.1, 0.003]\nmax = [0.6, 0.3, 0.3]\ngas = \"outside\"\n";
        let found = narrowest(&format!("{TANK}{block}")).gap.unwrap();
        assert_eq!(found.walls, [0, 1]);
        let [x, y, z] = found.middle;
        assert!((0.2..0.6).contains(&x) && (0.1..0.3).contains(&y) && near(Some(z), 0.0015), "{found:?}");
        assert_eq!(narrowest(TANK).gap.unwrap().walls, [0, 0]);
    }

    /// The thickness of a plate is no passage, nor what a plate let into a wall hides.
    #[test]
    fn a_solid_is_no_passage() {
        let plate = |z: f64| {
            gap(&format!(
                "{TANK}[[wall]]\nname = \"plate\"\nshape = \"plane\"\ncenter = [0.5, 0.25, {z}]\nnormal = [0.0, 0.0, 1.0]\n\
                 u = [1.0, 0.0, 0.0]\nsize = [0.4, 0.2]\nthickness = 0.001\n"
            ))
        };
        let free = plate(0.2);
        assert!(free.is_some_and(|gap| gap > 0.14), "{free:?}");
        // Half a thickness within the floor.
        let hidden = plate(0.0);
        assert!(hidden.is_some_and(|gap| gap > 0.14), "{hidden:?}");
    }

    /// A foil is as thin as its thickness; what is hidden in a wall, and a vessel with nothing behind its walls, is no body.
    #[test]
    fn the_thinnest_body_is_found() {
        let foil = |low: f64, high: f64| {
            narrowest(&format!(
                "{TANK}[[wall]]\nname = \"foil\"\nshape = \"box\"\nmin = [0.2, 0.1, {low}]\nmax = [0.6, 0.3, {high}]\ngas = \"outside\"\n"
            ))
            .body
        };
        assert!(near(foil(0.2, 0.2 + 1e-7), 1e-7), "{:?}", foil(0.2, 0.2 + 1e-7));
        assert!(near(foil(0.2, 0.25), 0.05));
        assert_eq!(narrowest(TANK).body, None);
        // Half within the floor: across its other sides.
        assert!(near(foil(-0.01, 0.01), 0.2), "{:?}", foil(-0.01, 0.01));
    }
}
