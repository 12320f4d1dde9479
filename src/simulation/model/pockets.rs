//! Spaces that open behind walls that move, and that no gas reaches: behind a piston that is shorter than its way.
//!
//! Such a space lies before faces of the wall that had no gas before them at the start, holds no place that has been gas all the time, and
//! no face that had gas before it lies in it, too.

use glam::DVec3;

use super::contact::before_and_behind;
use super::moving::{Moving, extent};
use crate::gas::{displacement, way};
use crate::geometry::{Spaces, Vessel};
use crate::plan::Pocket;
use crate::scene::{Motion, Scene};

/// Moments of a run: at least, and at most where a thin body goes far.
const MOMENTS: std::ops::RangeInclusive<f64> = 8.0..=32.0;
/// Places of a wall that are looked at, about.
const MOST_PLACES: usize = 2000;
/// How far before a face lines are looked for, in distances between them.
const AHEAD: [f64; 4] = [0.0, 0.5, 1.0, 1.5];
/// Halvings of the time in which a space opens.
const HALVINGS: u32 = 12;

pub fn pockets(scene: &Scene, vessel: &Vessel, moving: &Moving) -> Vec<Pocket> {
    scene.motions.iter().filter_map(|motion| pocket(scene, vessel, moving, motion)).collect()
}

fn pocket(scene: &Scene, vessel: &Vessel, moving: &Moving, motion: &Motion) -> Option<Pocket> {
    let is_wet = |index: usize| places(vessel, &[index]).any(|[before, _]| vessel.is_gas(before));
    let own = |index: &usize| vessel.triangles[*index].wall as usize == motion.wall;
    let (wet, dry): (Vec<usize>, Vec<usize>) =
        (0..vessel.triangles.len()).filter(own).partition(|&index| is_wet(index));
    if dry.is_empty() {
        return None;
    }
    let opened = |vessel: &Vessel| places(vessel, &dry).any(|[before, _]| vessel.is_gas(before));
    let (low, high) = extent(vessel, |wall, _| wall == motion.wall);
    let along = DVec3::from(motion.direction);
    let thickness = (DVec3::from(high) - DVec3::from(low)).dot(along.abs());
    let count = (2.0 * way(&motion.course, scene.end_time) / thickness).ceil();
    let count = count.clamp(*MOMENTS.start(), *MOMENTS.end()) as u32;
    let time = |moment: u32| scene.end_time * f64::from(moment) / f64::from(count);
    // Spaces cost more than places.
    let first = (1..=count).find(|&moment| opened(&moving.vessel_at(vessel, time(moment))))?;
    let bounds = moving.bounds(vessel);
    let thinnest = vessel.narrowest().body.unwrap_or(f64::INFINITY).min(thickness);
    let mut always = vessel.spaces(bounds, thinnest);
    let found = (1..=count).find(|&moment| {
        let now = moving.vessel_at(vessel, time(moment));
        let spaces = now.spaces(bounds, thinnest);
        always.keep_common(&spaces);
        moment >= first && is_shut(&now, &spaces, &always, [&wet, &dry]) && now.gap_beside(motion.wall, along).is_none()
    })?;
    let (mut shut, mut open) = (time(found.min(first) - 1), time(found.min(first)));
    for _ in 0..HALVINGS {
        let middle = 0.5 * (shut + open);
        if opened(&moving.vessel_at(vessel, middle)) { open = middle } else { shut = middle }
    }
    let farthest = (0..=count).map(|moment| displacement(&motion.course, time(moment)).abs()).fold(0.0, f64::max);
    let further = (farthest - displacement(&motion.course, open).abs()).max(0.0);
    Some(Pocket { wall: motion.wall, time: open, further })
}

/// Places just before and just behind some triangles, of so many at most that are looked at.
fn places(vessel: &Vessel, triangles: &[usize]) -> impl Iterator<Item = [[f64; 3]; 2]> {
    let of = |&index: &usize| before_and_behind(vessel, &vessel.triangles[index]);
    let all: Vec<[[f64; 3]; 2]> = triangles.iter().flat_map(of).collect();
    let step = all.len().div_ceil(MOST_PLACES).max(1);
    all.into_iter().step_by(step)
}

/// Whether a space before the dry faces has no gas, and no face that was wet.
fn is_shut(vessel: &Vessel, spaces: &Spaces, always: &Spaces, [wet, dry]: [&[usize]; 2]) -> bool {
    let fed: std::collections::HashSet<usize> = always.middles().filter_map(|(place, ..)| spaces.at(place)).collect();
    let of = |faces: &[usize]| {
        let found = places(vessel, faces).flat_map(|[before, back]| {
            let ahead = (DVec3::from(before) - DVec3::from(back)).normalize_or_zero() * spaces.spacing();
            let tries = AHEAD.map(|by| (DVec3::from(before) + by * ahead).to_array());
            tries.into_iter().take_while(|&place| vessel.is_gas(place)).find_map(|place| spaces.at(place))
        });
        found.collect::<std::collections::HashSet<usize>>()
    };
    let wet = of(wet);
    of(dry).into_iter().any(|space| !fed.contains(&space) && !wet.contains(&space))
}
