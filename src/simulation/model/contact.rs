//! Which walls that move and which surfaces meet gas at any time.

use glam::DVec3;

use super::facing::parts;
use super::moving::Moving;
use crate::geometry::{Triangle, Vessel};
use crate::scene::Scene;

/// Of a run: moments at which walls are looked at.
const MOMENTS: u32 = 8;
/// How far before a triangle gas is looked for, over its longest edge.
const BEFORE: f64 = 1e-4;

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
    !is_so(vessel) && later(scene, vessel, moving).all(|vessel| !is_so(&vessel))
}

/// The walls at some moments of the run after its start, up to its end; none where no wall moves.
pub fn later(scene: &Scene, vessel: &Vessel, moving: &Moving) -> impl Iterator<Item = Vessel> {
    let moments = if moving.is_empty() { 0 } else { MOMENTS };
    (1..=moments).map(|moment| moving.vessel_at(vessel, scene.end_time * f64::from(moment) / f64::from(MOMENTS)))
}

/// Whether gas lies before a place of these triangles, and what is behind it is as it should be.
fn meets_gas(vessel: &Vessel, own: impl Fn(&Triangle) -> bool, behind: impl Fn([f64; 3]) -> bool) -> bool {
    lifted(vessel, own).any(|[before, back]| vessel.is_gas(before) && behind(back))
}

/// Places of the gas just before these triangles, of so many at most that are looked at.
pub fn places_before(vessel: &Vessel, own: impl Fn(&Triangle) -> bool, most: usize) -> impl Iterator<Item = [f64; 3]> {
    let all = parts().count() * vessel.triangles.iter().filter(|triangle| own(triangle)).count();
    let some = lifted(vessel, own).step_by(all.div_ceil(most).max(1));
    some.map(|[before, _]| before).filter(|&before| vessel.is_gas(before))
}

/// Places just before and just behind them.
fn lifted(vessel: &Vessel, own: impl Fn(&Triangle) -> bool) -> impl Iterator<Item = [[f64; 3]; 2]> {
    vessel.triangles.iter().filter(move |triangle| own(triangle)).flat_map(|triangle| {
        let [a, b, c] = triangle.vertices.map(|vertex| DVec3::from(vessel.vertices[vertex as usize]));
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let lift = BEFORE * longest * (b - a).cross(c - a).normalize_or_zero();
        parts().map(move |(u, v)| {
            let place = a + u * (b - a) + v * (c - a);
            [(place + lift).to_array(), (place - lift).to_array()]
        })
    })
}
