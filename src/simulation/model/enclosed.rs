//! Gas that no way leads out of bags: the volume that the plan knows is that of the bags, at the start and as far as known
//! at the end.

use super::fabric::Surfaces;
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
    let inflated =
        fabric.is_elastic().then(|| bags().map(|(index, bag)| inflated(fabric, index, bag)).sum::<f64>().min(room));
    Measured { gas_volume: bags().map(|(_, bag)| bag.volume).sum(), open_to_empty: false, inflated, ..measured }
}

/// m3, what a bag can hold; at least what it does.
fn inflated(fabric: &Surfaces, index: usize, bag: &Bag) -> f64 {
    let Some(membranes) = &fabric.membranes else { return bag.volume };
    let area: f64 = fabric.parts(index).0.map(|triangle| membranes.elements[triangle].area()).sum();
    let sphere = area * area.sqrt() / (6.0 * std::f64::consts::PI.sqrt());
    bag.volume.max(INFLATED * sphere)
}
