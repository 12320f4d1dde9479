//! Spaces of gas that no gas flows between, and the chambers that several of them are of.

use super::places::{along, chamber_of};
use crate::geometry::{Passage, Spaces, Vessel};
use crate::plan::SplitChamber;
use crate::scene::Scene;

/// Of all gas: what is smaller is a sliver between facets.
const LEAST: f64 = 0.01;
/// Of the distance between lines: where a passage is narrower it may be missed, and nothing is said.
const NARROW: f64 = 2.0;

/// How many there are and which chambers are in several; none where all gas may be one space.
pub fn separate(
    scene: &Scene,
    vessel: &Vessel,
    thinnest: Option<f64>,
    gap: Option<&Passage>,
) -> (Option<usize>, Vec<SplitChamber>) {
    let known = vessel.gas_spaces();
    if known == Some(1) {
        return (None, Vec::new());
    }
    let mut spaces = vessel.spaces(vessel.bounds, thinnest.unwrap_or(f64::INFINITY));
    if known.is_none() && gap.is_some_and(|gap| gap.length < NARROW * spaces.spacing()) {
        return (None, Vec::new());
    }
    join_by_holes(vessel, &mut spaces);
    let whole: f64 = spaces.volumes.iter().sum();
    let is_large = |volume: f64| volume > LEAST * whole;
    let count = spaces.volumes.iter().filter(|&&volume| is_large(volume)).count();
    if count < 2 {
        return (None, Vec::new());
    }
    let mut parts = vec![vec![0.0; spaces.volumes.len()]; scene.chambers.len()];
    for (place, volume, space) in spaces.middles() {
        if let Some(chamber) = chamber_of(scene, vessel, place) {
            parts[chamber][space] += volume;
        }
    }
    let split = parts.into_iter().enumerate().filter_map(|(chamber, parts)| {
        let mut volumes: Vec<f64> = parts.into_iter().filter(|&volume| is_large(volume)).collect();
        volumes.sort_by(|a, b| b.total_cmp(a));
        (volumes.len() > 1).then_some(SplitChamber { chamber, volumes })
    });
    (known.is_none().then_some(count), split.collect())
}

/// Holes of walls join what is on both their sides, however small they are.
fn join_by_holes(vessel: &Vessel, spaces: &mut Spaces) {
    for hole in &vessel.holes {
        let reach = [0.5 * hole.thickness + 1e-3 * hole.area.sqrt(), 0.5 * hole.thickness + spaces.spacing()];
        let side = |sign: f64| {
            let places = reach.map(|reach| along(hole.center, hole.normal, sign * reach));
            places.into_iter().filter(|&place| vessel.is_gas(place)).find_map(|place| spaces.at(place))
        };
        if let [Some(a), Some(b)] = [side(-1.0), side(1.0)] {
            spaces.join(a, b);
        }
    }
}
