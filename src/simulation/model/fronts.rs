//! The gas before triangles of walls: of which chamber it is, and of several their shares of the triangle.

use glam::DVec3;

use super::places::chamber_of;
use crate::geometry::Vessel;
use crate::scene::{Disc, Scene};

/// Points of a triangle that are looked at first: a lattice of this many along each side.
const LATTICE: u32 = 8;
/// Splits of all of a triangle, and of what of it lies on the border of two chambers.
pub const EVEN_SPLITS: u32 = 3;
const MOST_SPLITS: u32 = 9;
/// How near to its corners a part is looked at, over the way from its middle.
const CORNER: f64 = 0.94;
/// Share of a triangle that is rounding.
const LEAST: f64 = 1e-4;

pub type Corners = [DVec3; 3];

/// What lies before a triangle.
#[derive(Debug, Clone, PartialEq)]
pub enum Front {
    /// Gas of one chamber, or of none: then the last is taken.
    One(usize),
    /// Of several, with their shares of its area that is free; in order.
    Shared(Vec<(usize, f64)>),
}

impl Front {
    /// `discs`: places on the triangle that count however small they are.
    pub fn of(scene: &Scene, vessel: &Vessel, triangle: Corners, discs: &[&Disc]) -> Front {
        let at = |point: DVec3| before(scene, vessel, triangle, point);
        let mut found = vec![0; scene.chambers.len()];
        for point in lattice(triangle).chain(discs.iter().flat_map(|disc| within(disc, triangle))) {
            if let Some(chamber) = at(point) {
                found[chamber] += 1;
            }
        }
        if found.iter().filter(|&&count| count > 0).count() > 1 {
            let mut shares = shares(triangle, scene.chambers.len(), &at);
            shares.retain(|(_, share)| *share > LEAST);
            let free: f64 = shares.iter().map(|(_, share)| share).sum();
            if shares.len() > 1 {
                return Front::Shared(shares.into_iter().map(|(chamber, share)| (chamber, share / free)).collect());
            }
        }
        let last = found.len() - 1;
        Front::One((0..last).fold(last, |best, chamber| if found[chamber] > found[best] { chamber } else { best }))
    }

    /// The chambers with their shares.
    pub fn shares(&self) -> Vec<(usize, f64)> {
        match self {
            Front::One(chamber) => vec![(*chamber, 1.0)],
            Front::Shared(shares) => shares.clone(),
        }
    }
}

/// The chamber of the gas before a point of a triangle.
pub fn before(scene: &Scene, vessel: &Vessel, [a, b, c]: Corners, point: DVec3) -> Option<usize> {
    let (min, max) = vessel.bounds;
    let off = 1e-6 * (DVec3::from(max) - DVec3::from(min)).max_element();
    chamber_of(scene, vessel, (point + off * (b - a).cross(c - a).normalize()).to_array())
}

fn lattice([a, b, c]: Corners) -> impl Iterator<Item = DVec3> {
    let share = |k: u32| (f64::from(k) + 1.0 / 3.0) / f64::from(LATTICE);
    (0..LATTICE).flat_map(move |i| (0..LATTICE - i).map(move |j| a + (b - a) * share(i) + (c - a) * share(j)))
}

/// Points of a disc that lie in a triangle.
fn within(disc: &Disc, triangle: Corners) -> impl Iterator<Item = DVec3> {
    let [a, b, c] = triangle;
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let center = DVec3::from(disc.center);
    let center = center - (center - a).dot(normal) * normal;
    let (u, v) = normal.try_normalize().unwrap_or(DVec3::Z).any_orthonormal_pair();
    let ring = (0..24).map(move |k| {
        let angle = std::f64::consts::TAU * f64::from(k % 8) / 8.0;
        let radius = 0.5 * disc.diameter * [0.1, 0.6, 0.97][k as usize / 8];
        center + radius * (libm::cos(angle) * u + libm::sin(angle) * v)
    });
    let is_in = move |point: &DVec3| {
        [(a, b), (b, c), (c, a)].iter().all(|(from, to)| (*to - *from).cross(*point - *from).dot(normal) > 0.0)
    };
    ring.filter(is_in)
}

/// The share of a triangle before gas of each chamber that has some; what of it is before no gas is left out.
pub fn shares(triangle: Corners, chambers: usize, at: &dyn Fn(DVec3) -> Option<usize>) -> Vec<(usize, f64)> {
    let mut shares = vec![0.0; chambers];
    add_shares(triangle, 0, at, &mut shares);
    shares.into_iter().enumerate().filter(|(_, share)| *share > 0.0).collect()
}

fn add_shares(triangle: Corners, splits: u32, at: &dyn Fn(DVec3) -> Option<usize>, shares: &mut [f64]) {
    if splits < EVEN_SPLITS || splits < MOST_SPLITS && is_mixed(triangle, at) {
        quarters(triangle).into_iter().for_each(|part| add_shares(part, splits + 1, at, shares));
    } else if let Some(chamber) = at(middle(triangle)) {
        shares[chamber] += 0.25f64.powi(splits as i32);
    }
}

/// Whether a small triangle is not wholly before gas of one chamber, or before none.
pub fn is_mixed(triangle: Corners, at: &dyn Fn(DVec3) -> Option<usize>) -> bool {
    let middle = middle(triangle);
    let own = at(middle);
    triangle.iter().any(|corner| at(middle.lerp(*corner, CORNER)) != own)
}

pub fn middle([a, b, c]: Corners) -> DVec3 {
    (a + b + c) / 3.0
}

pub fn quarters([a, b, c]: Corners) -> [Corners; 4] {
    let [ab, bc, ca] = [(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0];
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A border that cuts a triangle across, and a small corner of it.
    #[test]
    fn shares_are_those_of_the_area() {
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        for border in [0.31, 0.5, 0.97] {
            let at = |point: DVec3| Some(usize::from(point.x > border));
            let found = shares(triangle, 2, &at);
            let expected = (1.0 - border) * (1.0 - border);
            let own = found.iter().find(|(chamber, _)| *chamber == 1).map_or(0.0, |(_, share)| *share);
            assert!((own - expected).abs() < 1e-3, "{border}: {own} {expected}");
            assert!((found.iter().map(|(_, share)| share).sum::<f64>() - 1.0).abs() < 1e-12);
        }
        // A strip before no gas is of none.
        let strip = |point: DVec3| (!(0.4..0.5).contains(&point.y)).then_some(0);
        let [(0, share)] = shares(triangle, 1, &strip)[..] else { panic!("one chamber") };
        assert!((share - (1.0 - (0.6f64.powi(2) - 0.5f64.powi(2)))).abs() < 2e-3, "{share}");
    }
}
