//! What a control volume knows of probes and surfaces: the chambers that they lie in, or face.

use glam::DVec3;

use super::error::NoChamber;
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
        for (u, v) in parts() {
            let point = (a + u * (b - a) + v * (c - a) + lift).to_array();
            // Where walls meet, a part may lie within another's solid: it is not pressed.
            let Some(chamber) = chamber_of(scene, vessel, point) else { continue };
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
