//! Which walls that move and which surfaces meet gas at any time.

use glam::DVec3;

use super::facing::parts;
use super::moving::Moving;
use crate::geometry::{Triangle, Vessel};
use crate::plan::DryMotion;
use crate::scene::{Motion, Scene};

/// Of a run: moments at which walls are looked at.
const MOMENTS: u32 = 8;
/// How far before a triangle gas is looked for, over its longest edge.
const BEFORE: f64 = 1e-4;

/// The walls that move and have no gas before them at any time, or none from the first half of the run on.
pub fn dry_motions(scene: &Scene, vessel: &Vessel, moving: &Moving) -> Vec<DryMotion> {
    let time = |moment: u32| scene.end_time * f64::from(moment) / f64::from(MOMENTS);
    let dry = |motion: &Motion| {
        let met = (0..=MOMENTS).rev().find(|&moment| is_met(&moving.vessel_at(vessel, time(moment)), motion.wall));
        let from = met.map_or(0, |last| last + 1);
        (2 * from <= MOMENTS).then(|| DryMotion {
            wall: motion.wall,
            since: time(from),
            other_way: meets_the_other_way(scene, vessel, moving, motion.wall),
        })
    };
    scene.motions.iter().filter_map(dry).collect()
}

/// A face that lies in that of the vessel has gas before it, but none that it moves: behind it are both solids.
fn is_met(vessel: &Vessel, wall: usize) -> bool {
    meets_gas(vessel, |triangle| triangle.wall as usize == wall, |behind| vessel.solid_depth(behind) <= 1)
}

/// Whether a wall would have gas before it at some moment if all moved in the opposite directions.
fn meets_the_other_way(scene: &Scene, vessel: &Vessel, moving: &Moving, wall: usize) -> bool {
    (1..=MOMENTS).any(|moment| {
        let courses = moving.courses(scene.end_time * f64::from(moment) / f64::from(MOMENTS));
        let turned: Vec<f64> = courses.into_iter().map(|[moved, _]| -moved).collect();
        is_met(&moving.vessel_moved(vessel, &turned), wall)
    })
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
    vessel
        .triangles
        .iter()
        .filter(move |triangle| own(triangle))
        .flat_map(|triangle| before_and_behind(vessel, triangle))
}

/// Places just before and just behind a triangle.
pub fn before_and_behind(vessel: &Vessel, triangle: &Triangle) -> impl Iterator<Item = [[f64; 3]; 2]> + use<> {
    let [a, b, c] = triangle.vertices.map(|vertex| DVec3::from(vessel.vertices[vertex as usize]));
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let lift = BEFORE * longest * (b - a).cross(c - a).normalize_or_zero();
    parts().map(move |(u, v)| {
        let place = a + u * (b - a) + v * (c - a);
        [(place + lift).to_array(), (place - lift).to_array()]
    })
}
