//! Gas that no way leads out of bags: the volume that the plan knows is that of the bags, at the start and as far as known
//! at the end.

use std::ops::Range;

use super::fabric::Surfaces;
use super::membranes::Membranes;
use crate::fabric::Hold;
use crate::geometry::{Bag, Vessel};
use crate::plan::Measured;
use crate::scene::{Fabric, Scene};

/// What a bag that is flat without stress holds when it is inflated, over a sphere of the area of its fabric: .77 of a square one
/// (Kepert), .82 of two discs (Paulsen, 1994).
const INFLATED: f64 = 0.8;

/// What was measured of the vessel, or of its bags where all gas is in these. `orifices` says which blow into bags.
pub fn in_bags(scene: &Scene, vessel: &Vessel, fabric: &Surfaces, orifices: &[bool], measured: Measured) -> Measured {
    let gets_out = |(index, own): (usize, &Fabric)| {
        own.external_pressure.is_none() && scene.vents.iter().any(|vent| scene.fabric_at(vent.wall) == Some(index))
    };
    let inside = scene.chambers.iter().all(|chamber| chamber.inside.is_some()) && orifices.iter().all(|inside| *inside);
    if scene.fabrics.is_empty() || !inside || scene.fabrics.iter().enumerate().any(gets_out) {
        return measured;
    }
    let bags = || vessel.bags.iter().enumerate().filter_map(|(index, bag)| Some((index, bag.as_ref()?)));
    let room = vessel.gas_volume();
    let gas: f64 = bags().map(|(_, bag)| vessel.gas_volume_inside(bag)).sum();
    let solids = bags().map(|(_, bag)| bag.volume).sum::<f64>() - gas;
    let inflated = || bags().map(|(index, bag)| inflated(fabric, index, bag)).sum::<f64>() - solids;
    let inflated = fabric.is_elastic().then(|| inflated().min(room));
    Measured { gas_volume: gas, open_to_empty: false, inflated, ..measured }
}

/// m3, what a bag can hold; at least what it does.
fn inflated(fabric: &Surfaces, index: usize, bag: &Bag) -> f64 {
    let Some(membranes) = &fabric.membranes else { return bag.volume };
    if !fabric.all[index].elastic {
        return fabric.moments.iter().map(|&time| fabric.measures(time)[index][0]).fold(bag.volume, f64::max);
    }
    let area = area_of(membranes, fabric.parts(index).0);
    bag.volume.max(INFLATED * area * radius_of(area) / 3.0)
}

/// m2, free of stress.
fn area_of(membranes: &Membranes, triangles: Range<usize>) -> f64 {
    triangles.map(|triangle| membranes.elements[triangle].area()).sum()
}

/// m, of a sphere of an area.
fn radius_of(area: f64) -> f64 {
    (area / (4.0 * std::f64::consts::PI)).sqrt()
}

/// 1/m3, the most free nodes of a closed elastic surface over its area times the radius of a sphere of that.
pub fn nodes_over_volume(fabric: &Surfaces) -> Option<f64> {
    let membranes = fabric.membranes.as_ref()?;
    let of_surface = |index: usize| {
        let (triangles, nodes) = fabric.parts(index);
        let free = membranes.holds[nodes].iter().filter(|hold| **hold == Hold::Free).count();
        let area = area_of(membranes, triangles);
        free as f64 / (area * radius_of(area))
    };
    let closed = (0..fabric.all.len()).filter(|&index| fabric.all[index].closed);
    closed.map(of_surface).filter(|&nodes| nodes > 0.0).max_by(f64::total_cmp)
}
