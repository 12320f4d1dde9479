//! Holes of walls that join no two chambers, or only with a part of their areas.

use glam::DVec3;

use super::contact::later;
use super::facing::parts_of;
use super::moving::Moving;
use super::places::{along, chamber_of};
use crate::geometry::{FoundHole, Vessel};
use crate::plan::{Hindered, Hindrance};
use crate::scene::Scene;

/// Places of a hole that are looked at, about.
const PLACES: f64 = 300.0;
/// Share of the area of a hole that counts as all of it: facets of round walls cut a little off.
const ALL: f64 = 0.95;

/// The gas on both sides of a hole: the chamber of each, none where there is no gas.
pub struct Sides(pub [Option<usize>; 2]);

impl Sides {
    pub fn of(scene: &Scene, vessel: &Vessel, hole: &FoundHole) -> Sides {
        let side = |sign: f64| chamber_of(scene, vessel, along(hole.center, hole.normal, sign * reach(hole)));
        Sides([side(-1.0), side(1.0)])
    }
}

/// From the middle of a hole a little beyond either face of its wall, m.
fn reach(hole: &FoundHole) -> f64 {
    0.5 * hole.thickness + 1e-3 * hole.area.sqrt()
}

/// Holes with gas of one chamber on both sides, and those that other walls cover at all times, wholly or in part.
pub fn hindered(scene: &Scene, vessel: &Vessel, moving: &Moving) -> Vec<Hindered> {
    let walls = vessel.walls.len();
    let mut open: Vec<Open> = vessel.holes.iter().map(|hole| Open::of(vessel, hole)).collect();
    if open.iter().any(|open| open.share < ALL) {
        for later in later(scene, vessel, moving) {
            for (open, hole) in open.iter_mut().zip(&later.holes) {
                let now = Open::of(&later, hole);
                if now.share > open.share {
                    *open = now;
                }
            }
        }
    }
    let found = vessel.holes.iter().zip(open).filter_map(|(hole, open)| {
        let sides = Sides::of(scene, vessel, hole).0;
        let why = match sides {
            [Some(a), Some(b)] if a == b => Hindrance::OneChamber(a),
            _ if open.share < ALL => {
                let by = (0..walls).max_by_key(|&wall| (open.by[wall], std::cmp::Reverse(wall)))?;
                Hindrance::Covered { open: open.share, by, joins: sides.iter().all(Option::is_some) }
            }
            _ => return None,
        };
        Some(Hindered { name: hole.name.clone(), wall: hole.wall as usize, area: hole.area, why })
    });
    found.collect()
}

/// How much of a hole is open, and how often each wall covers one of its places.
struct Open {
    share: f64,
    by: Vec<usize>,
}

impl Open {
    fn of(vessel: &Vessel, hole: &FoundHole) -> Open {
        let mut by = vec![0; vessel.walls.len()];
        let (mut all, mut open) = (0.0, 0.0);
        let middle = DVec3::from(hole.center);
        let corners: Vec<DVec3> = hole.outline.iter().map(|&corner| DVec3::from(corner)).collect();
        // All triangles around the middle are alike.
        let count = (PLACES / corners.len() as f64).sqrt().ceil() as u32;
        for (k, &from) in corners.iter().enumerate() {
            let to = corners[(k + 1) % corners.len()];
            for (u, v) in parts_of(count) {
                let place = (middle + u * (from - middle) + v * (to - middle)).to_array();
                let through = [-1.0, 0.0, 1.0].map(|sign| along(place, hole.normal, sign * reach(hole)));
                all += 1.0;
                let Some(&shut) = through.iter().find(|&&place| !vessel.is_gas(place)) else {
                    open += 1.0;
                    continue;
                };
                let covers = |wall: &usize| *wall != hole.wall as usize && vessel.depth_of(*wall, shut) > 0;
                (0..by.len()).filter(covers).for_each(|wall| by[wall] += 1);
            }
        }
        Open { share: open / f64::max(all, 1.0), by }
    }
}
