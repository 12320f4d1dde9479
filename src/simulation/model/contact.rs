//! Which walls that move and which surfaces meet gas at any time, and which holes join no two chambers.

use glam::DVec3;

use super::facing::parts;
use super::moving::Moving;
use super::places::{along, chamber_of};
use crate::geometry::{FoundHole, Triangle, Vessel};
use crate::plan::NoOpening;
use crate::scene::Scene;

/// Of a run: moments at which walls are looked at.
const MOMENTS: u32 = 8;
/// How far before a triangle gas is looked for, over its longest edge.
const BEFORE: f64 = 1e-4;

/// The gas on both sides of a hole: the chamber of each, none where there is no gas.
pub struct Sides(pub [Option<usize>; 2]);

impl Sides {
    pub fn of(scene: &Scene, vessel: &Vessel, hole: &FoundHole) -> Sides {
        // A little beyond either face of the wall.
        let reach = 0.5 * hole.thickness + 1e-3 * hole.area.sqrt();
        let side = |sign: f64| chamber_of(scene, vessel, along(hole.center, hole.normal, sign * reach));
        Sides([side(-1.0), side(1.0)])
    }
}

/// Holes with gas of one chamber on both sides, or, where no wall moves, without gas on one.
pub fn no_openings(scene: &Scene, vessel: &Vessel) -> Vec<NoOpening> {
    let found = vessel.holes.iter().filter_map(|hole| {
        let chamber = match Sides::of(scene, vessel, hole).0 {
            [Some(a), Some(b)] if a == b => Some(a),
            // A wall that moves may uncover it. Gas space in no chamber is told as such.
            [None, _] | [_, None] if scene.motions.is_empty() && is_covered(vessel, hole) => None,
            _ => return None,
        };
        Some(NoOpening { name: hole.name.clone(), wall: hole.wall as usize, chamber })
    });
    found.collect()
}

fn is_covered(vessel: &Vessel, hole: &FoundHole) -> bool {
    let reach = 0.5 * hole.thickness + 1e-3 * hole.area.sqrt();
    [-1.0, 1.0].iter().any(|sign| !vessel.is_gas(along(hole.center, hole.normal, sign * reach)))
}

/// The walls that move and have no gas before them at any time.
pub fn dry_motions(scene: &Scene, vessel: &Vessel, moving: &Moving) -> Vec<usize> {
    let is_dry = |&wall: &usize| {
        never(scene, vessel, moving, |vessel| {
            // A face that lies in that of the vessel has gas before it, but none that it moves: behind it are both solids.
            meets_gas(vessel, |triangle| triangle.wall as usize == wall, |behind| vessel.solid_depth(behind) <= 1)
        })
    };
    scene.motions.iter().map(|motion| motion.wall).filter(is_dry).collect()
}

/// The surfaces of the scene that have no gas before them at any time.
pub fn dry_surfaces(scene: &Scene, vessel: &Vessel, moving: &Moving) -> Vec<usize> {
    let is_dry = |&index: &usize| {
        let surface = &scene.surfaces[index];
        let own = |triangle: &Triangle| {
            triangle.wall as usize == surface.wall && (surface.face.is_none() || triangle.face == surface.face)
        };
        never(scene, vessel, moving, |vessel| meets_gas(vessel, own, |_| true))
    };
    (0..scene.surfaces.len()).filter(is_dry).collect()
}

/// Whether it is so of the walls at none of some moments of the run.
fn never(scene: &Scene, vessel: &Vessel, moving: &Moving, is_so: impl Fn(&Vessel) -> bool) -> bool {
    let later = |moment: u32| scene.end_time * f64::from(moment) / f64::from(MOMENTS);
    let moments = if moving.is_empty() { 0 } else { MOMENTS };
    !is_so(vessel) && (1..=moments).all(|moment| !is_so(&moving.vessel_at(vessel, later(moment))))
}

/// Whether gas lies before a place of these triangles, and what is behind it is as it should be.
fn meets_gas(vessel: &Vessel, own: impl Fn(&Triangle) -> bool, behind: impl Fn([f64; 3]) -> bool) -> bool {
    vessel.triangles.iter().filter(|triangle| own(triangle)).any(|triangle| {
        let [a, b, c] = triangle.vertices.map(|vertex| DVec3::from(vessel.vertices[vertex as usize]));
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let lift = BEFORE * longest * (b - a).cross(c - a).normalize_or_zero();
        parts().any(|(u, v)| {
            let place = a + u * (b - a) + v * (c - a);
            vessel.is_gas((place + lift).to_array()) && behind((place - lift).to_array())
        })
    })
}
