//! What a control volume knows of probes and surfaces: the chambers that they lie in, or face.

use glam::DVec3;

use super::error::NoChamber;
use super::fronts::shares;
use super::places::chamber_of;
use crate::geometry::{Vessel, region_bounds};
use crate::scene::{Scene, Surface};

/// Parts along each edge into which a triangle is cut to find what chambers it faces.
pub const PARTS: u32 = 8;

/// Where a scene's probes and surfaces are: what a control volume must know of them.
pub struct Known {
    /// The chamber of each probe.
    pub probes: Vec<usize>,
    /// The faces of each surface.
    pub surfaces: Vec<Vec<Face>>,
}

impl Known {
    /// # Errors
    /// If a probe or a surface lies in no chamber.
    pub fn of(scene: &Scene, vessel: &Vessel) -> Result<Known, NoChamber> {
        let surfaces = scene.surfaces.iter().map(|surface| facing(scene, vessel, surface)).collect::<Result<_, _>>()?;
        Ok(Known { probes: probes(scene, vessel)?, surfaces })
    }
}

/// The chamber of each.
pub fn probes(scene: &Scene, vessel: &Vessel) -> Result<Vec<usize>, NoChamber> {
    let chamber = |probe: &crate::scene::Probe| {
        let (low, high) = region_bounds(&probe.region);
        let middle = std::array::from_fn(|axis| 0.5 * (low[axis] + high[axis]));
        let what = || format!("the middle of probe \"{}\"", probe.name);
        chamber_of(scene, vessel, middle).ok_or_else(|| NoChamber { what: what(), point: middle })
    };
    scene.probes.iter().map(chamber).collect()
}

/// A part of a surface and the chamber whose gas presses it.
pub struct Face {
    pub chamber: usize,
    /// m2.
    pub area: f64,
    /// Area times the unit normal away from the gas.
    pub(in crate::simulation) outward: DVec3,
}

/// # Errors
/// If no gas lies before the surface.
pub fn facing(scene: &Scene, vessel: &Vessel, surface: &Surface) -> Result<Vec<Face>, NoChamber> {
    let mut faces: Vec<Face> = Vec::new();
    let vertex = |index: u32| DVec3::from(vessel.vertices[index as usize]);
    let own = vessel.triangles.iter().filter(|triangle| {
        triangle.wall as usize == surface.wall && (surface.face.is_none() || triangle.face == surface.face)
    });
    for triangle in own {
        let [a, b, c] = triangle.vertices.map(vertex);
        // Twice the area, towards the gas.
        let cross = (b - a).cross(c - a);
        let share = 1.0 / f64::from(PARTS * PARTS);
        let lift = 1e-4 * cross.length().sqrt() * cross.normalize();
        let at = |point: DVec3| chamber_of(scene, vessel, (point + lift).to_array());
        // Where walls meet, a part may lie within another's solid: it is not pressed.
        let mut found: Vec<(usize, f64)> =
            parts().filter_map(|(u, v)| Some((at(a + u * (b - a) + v * (c - a))?, share))).collect();
        if found.windows(2).any(|pair| pair[0].0 != pair[1].0) {
            found = shares([a, b, c], scene.chambers.len(), &at);
        }
        for (chamber, share) in found {
            let (area, outward) = (0.5 * share * cross.length(), -0.5 * share * cross);
            match faces.iter_mut().find(|face| face.chamber == chamber) {
                Some(face) => {
                    face.area += area;
                    face.outward += outward;
                }
                None => faces.push(Face { chamber, area, outward }),
            }
        }
    }
    if faces.is_empty() {
        let point = vessel.bounds.0;
        return Err(NoChamber { what: format!("the gas before surface \"{}\"", surface.name), point });
    }
    Ok(faces)
}

/// The middles of the equal parts of a triangle, along two of its edges.
pub fn parts() -> impl Iterator<Item = (f64, f64)> {
    parts_of(PARTS)
}

/// The same of so many parts along an edge.
pub fn parts_of(count: u32) -> impl Iterator<Item = (f64, f64)> {
    let place = move |k: u32, third: f64| (f64::from(k) + third) / f64::from(count);
    (0..count).flat_map(move |i| {
        (0..count - i).flat_map(move |j| {
            let upright = Some((place(i, 1.0 / 3.0), place(j, 1.0 / 3.0)));
            let turned = (i + j + 2 <= count).then(|| (place(i, 2.0 / 3.0), place(j, 2.0 / 3.0)));
            upright.into_iter().chain(turned)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A side of a box that two chambers share is pressed by each on its part, whatever its two triangles are.
    #[test]
    fn a_shared_face_has_its_areas() {
        let text = "end_time = 1e-3\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
            [[wall]]\nname = \"bag\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [0.25, 0.12, 0.4]\ngas = \"inside\"\n\
            [[wall]]\nname = \"divider\"\nshape = \"plane\"\ncenter = [0.125, 0.06, 0.16]\nnormal = [0, 0, 1]\nu = [1, 0, 0]\n\
            size = [0.254, 0.124]\nthickness = 0.003\n\
            [[chamber]]\nname = \"low\"\nregion = { box = { min = [0, 0, 0], max = [0.25, 0.12, 0.16] } }\n\
            pressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
            [[chamber]]\nname = \"high\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
            [[surface]]\nname = \"side\"\nwall = \"bag\"\nface = \"+x\"\n";
        let scene = crate::scene::parse(text, "test.toml", std::path::Path::new("")).unwrap();
        let vessel = Vessel::build(&scene.walls).unwrap();
        let faces = facing(&scene, &vessel, &scene.surfaces[0]).unwrap();
        let share = |chamber: usize| {
            faces.iter().filter(|face| face.chamber == chamber).map(|face| face.area).sum::<f64>() / 0.048
        };
        // The plate covers 3 of the 400 mm.
        for (chamber, expected) in [(0, 158.5 / 400.0), (1, 238.5 / 400.0)] {
            assert!((share(chamber) - expected).abs() < 1e-3, "{chamber}: {} {expected}", share(chamber));
        }
        let pressed: DVec3 = faces.iter().map(|face| face.outward).sum();
        assert!((pressed - DVec3::new(0.048 * 397.0 / 400.0, 0.0, 0.0)).length() < 5e-5, "{pressed}");
    }
}
