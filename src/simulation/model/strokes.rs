//! How far walls move beside the chambers that they border on.

use glam::DVec3;

use super::contact::places_before;
use super::places::chamber_of;
use crate::gas::way;
use crate::geometry::{Vessel, region_bounds};
use crate::plan::Stroke;
use crate::scene::{Motion, Scene};

/// Places along each edge of the box around a chamber.
const PLACES: u32 = 24;
/// Places before a wall that are looked at for the chambers there.
const MOST_PLACES: usize = 20_000;

/// Of each motion the way in the whole run, to and fro, and the shortest chamber along it; none of walls that border on no chamber.
pub fn strokes(scene: &Scene, vessel: &Vessel) -> Vec<Stroke> {
    let stroke = |(motion, own): (usize, &Motion)| {
        let mut borders: Vec<usize> = Vec::new();
        for place in places_before(vessel, |triangle| triangle.wall as usize == own.wall, MOST_PLACES) {
            borders.extend(chamber_of(scene, vessel, place).filter(|chamber| !borders.contains(chamber)));
        }
        let length = |chamber: usize| (chamber, length_of(scene, vessel, chamber, DVec3::from(own.direction)));
        let (chamber, length) = borders.into_iter().map(length).min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Stroke { motion, way: way(&own.course, scene.end_time), chamber, length })
    };
    scene.motions.iter().enumerate().filter_map(stroke).collect()
}

/// How far the gas of a chamber reaches along a direction, m, to a part of its box.
fn length_of(scene: &Scene, vessel: &Vessel, chamber: usize, along: DVec3) -> f64 {
    let whole = vessel.bounds;
    let region = scene.chambers[chamber].region.as_ref().map_or(whole, region_bounds);
    let low = DVec3::from(region.0).max(DVec3::from(whole.0));
    let size = DVec3::from(region.1).min(DVec3::from(whole.1)) - low;
    let share = |k: u32| (f64::from(k) + 0.5) / f64::from(PLACES);
    let mut reach = (f64::INFINITY, f64::NEG_INFINITY);
    for k in 0..PLACES.pow(3) {
        let [x, y, z] = [k % PLACES, k / PLACES % PLACES, k / PLACES / PLACES].map(share);
        let place = low + size * DVec3::new(x, y, z);
        if chamber_of(scene, vessel, place.to_array()) == Some(chamber) {
            reach = (reach.0.min(place.dot(along)), reach.1.max(place.dot(along)));
        }
    }
    // A place stands for the part of the box around it.
    (reach.1 - reach.0 + (size / f64::from(PLACES)).dot(along.abs())).max(0.0)
}
