//! Gaps beside walls that part two chambers, and beside walls that move: gas flows through them round the wall.

use glam::DVec3;

use super::contact::later;
use super::moving::Moving;
use super::outlook::surface_of;
use super::places::chamber_of;
use crate::geometry::{Passage, Vessel, region_volume};
use crate::plan::GapBeside;
use crate::scene::Scene;

/// Share of the border of two chambers from which on a wall in it parts them.
const PARTS: f64 = 0.25;
/// A gap that was to be closed is at most this share of the wall's least side across: of one that parts chambers, of one that moves.
const BESIDE_PARTING: f64 = 0.2;
const BESIDE_MOVING: f64 = 0.05;
/// Steps through a wall to the gas behind it.
const STEPS: u32 = 64;
/// Cosine of the largest angle between normals of one side of a region.
const ONE_SIDE: f64 = 0.99;

pub fn gaps_beside(scene: &Scene, vessel: &Vessel, moving: &Moving) -> Vec<GapBeside> {
    let mut found: Vec<GapBeside> = Vec::new();
    for parting in partings(scene, vessel) {
        let gap = vessel.gap_beside(parting.wall, parting.along);
        let limit = BESIDE_PARTING * across(vessel, parting.wall, parting.along);
        found.extend(gap.filter(|gap| gap.length <= limit).map(|gap| GapBeside {
            gap,
            wall: parting.wall,
            chambers: Some(parting.chambers),
        }));
    }
    for motion in &scene.motions {
        let along = DVec3::from(motion.direction);
        let limit = BESIDE_MOVING * across(vessel, motion.wall, along);
        let later = later(scene, vessel, moving).filter_map(|vessel| vessel.gap_beside(motion.wall, along));
        let shorter = |a: Passage, b: Passage| if b.length < a.length { b } else { a };
        let gap = vessel.gap_beside(motion.wall, along).into_iter().chain(later).reduce(shorter);
        found.extend(gap.filter(|gap| gap.length <= limit).map(|gap| GapBeside {
            gap,
            wall: motion.wall,
            chambers: None,
        }));
    }
    // One of each two walls: that of the chambers stands first.
    let mut told: Vec<[u32; 2]> = Vec::new();
    found.retain(|beside| {
        let known = told.contains(&beside.gap.walls);
        told.push(beside.gap.walls);
        !known
    });
    found
}

/// The least side of a wall across a direction, m.
fn across(vessel: &Vessel, wall: usize, along: DVec3) -> f64 {
    let (u, v) = along.normalize_or(DVec3::X).any_orthonormal_pair();
    let own = vessel.triangles.iter().filter(|triangle| triangle.wall as usize == wall);
    let corners: Vec<DVec3> =
        own.flat_map(|triangle| triangle.vertices).map(|v| DVec3::from(vessel.vertices[v as usize])).collect();
    let side = |axis: DVec3| {
        let places = corners.iter().map(|corner| corner.dot(axis));
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        high - low
    };
    side(u).min(side(v))
}

/// A body on one side of the region of a chamber, with other gas behind it.
struct Parting {
    chambers: [usize; 2],
    wall: usize,
    along: DVec3,
    /// m2 of the border.
    area: f64,
}

/// The bodies that part two chambers.
fn partings(scene: &Scene, vessel: &Vessel) -> Vec<Parting> {
    let mut found: Vec<Parting> = Vec::new();
    let boxes = boxes(vessel);
    // All of the border, open or not.
    let mut whole = vec![0.0; scene.chambers.len() * scene.chambers.len()];
    let pair_index = |[a, b]: [usize; 2]| a * scene.chambers.len() + b;
    for (index, chamber) in scene.chambers.iter().enumerate() {
        let Some(region) = &chamber.region else { continue };
        let lift = 1e-4 * libm::cbrt(region_volume(region));
        for (point, outward, area) in surface_of(region) {
            let at = |distance: f64| (point + distance * outward).to_array();
            let body = [-lift, lift].into_iter().find_map(|distance| solid_at(vessel, at(distance)));
            let [inside, outside] = match body {
                None => [-lift, lift].map(|distance| chamber_of(scene, vessel, at(distance))),
                Some(wall) => {
                    let [low, high] = boxes[wall];
                    let step = (high - low).dot(outward.abs()) / f64::from(STEPS);
                    [-1.0, 1.0].map(|sign| {
                        let ways = (0..=STEPS + 1).map(|k| sign * (lift + step * f64::from(k)));
                        ways.map(at).find(|&place| vessel.is_gas(place)).and_then(|p| chamber_of(scene, vessel, p))
                    })
                }
            };
            let (Some(inside), Some(outside)) = (inside, outside) else { continue };
            if inside != index || outside == index {
                continue;
            }
            let chambers = [index.min(outside), index.max(outside)];
            whole[pair_index(chambers)] += area;
            let Some(wall) = body else { continue };
            let same = |known: &&mut Parting| {
                known.chambers == chambers && known.wall == wall && known.along.dot(outward).abs() > ONE_SIDE
            };
            match found.iter_mut().find(same) {
                Some(known) => known.area += area,
                None => found.push(Parting { chambers, wall, along: outward, area }),
            }
        }
    }
    found.retain(|parting| parting.area >= PARTS * whole[pair_index(parting.chambers)]);
    found
}

/// The body that holds a place within all that encloses the gas.
fn solid_at(vessel: &Vessel, place: [f64; 3]) -> Option<usize> {
    if vessel.is_gas(place) {
        return None;
    }
    let holds = |wall: &usize| vessel.depth_of(*wall, place) > 0;
    let mut holding = (0..vessel.walls.len()).filter(holds);
    let first = holding.next()?;
    let all_bodies = !vessel.walls[first].cavity && holding.all(|wall| !vessel.walls[wall].cavity);
    all_bodies.then_some(first)
}

/// Low and high corner of the box around each wall, m.
fn boxes(vessel: &Vessel) -> Vec<[DVec3; 2]> {
    let mut boxes = vec![[DVec3::INFINITY, DVec3::NEG_INFINITY]; vessel.walls.len()];
    for triangle in &vessel.triangles {
        let own = &mut boxes[triangle.wall as usize];
        for corner in triangle.vertices.map(|v| DVec3::from(vessel.vertices[v as usize])) {
            *own = [own[0].min(corner), own[1].max(corner)];
        }
    }
    boxes
}
