//! Groups of neighbouring parents, in one chamber each: what is local is measured and kept over a group.
//!
//! The parents of a chamber are halved at the median along the longest side of the box around them until no half would
//! have [`LEAST`]. So groups are small where the gas is dense, and of one size in number.

use super::places::Places;
use crate::subdomain::GpuParticle;

/// Parents of a group, at least, in a chamber that has so many: enough for a temperature within a fifth.
pub const LEAST: usize = 16;

/// Indices of the parents of each group; every parent is in one.
pub fn groups(parents: &[GpuParticle], places: &Places<'_>) -> Vec<Vec<u32>> {
    let mut by_chamber: Vec<Vec<u32>> = Vec::new();
    for (index, parent) in (0..).zip(parents) {
        let chamber = places.chamber(places.metres(parent));
        if by_chamber.len() <= chamber {
            by_chamber.resize(chamber + 1, Vec::new());
        }
        by_chamber[chamber].push(index);
    }
    let mut found = Vec::new();
    let mut open: Vec<Vec<u32>> = by_chamber.into_iter().filter(|chamber| !chamber.is_empty()).collect();
    while let Some(mut own) = open.pop() {
        if own.len() < 2 * LEAST {
            own.sort_unstable();
            found.push(own);
            continue;
        }
        let axis = longest_axis(parents, &own);
        let place = |&index: &u32| (parents[index as usize].position[axis], index);
        let middle = own.len() / 2;
        own.select_nth_unstable_by_key(middle, place);
        let upper = own.split_off(middle);
        open.extend([own, upper]);
    }
    found
}

fn longest_axis(parents: &[GpuParticle], own: &[u32]) -> usize {
    let extent = |axis: usize| {
        let along = || own.iter().map(|&index| parents[index as usize].position[axis]);
        along().max().unwrap_or(0) - along().min().unwrap_or(0)
    };
    (0..3).max_by_key(|&axis| extent(axis)).unwrap_or(0)
}
