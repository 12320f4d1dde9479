//! Where the method `half-turn` may be taken that nobody asked for: it has no mean free path, so the gas itself has to
//! be a continuum at the size of the vessel, and nothing asked for may be what it has not.

use super::{Amounts, COLLISION_CELL, Measured, Scene, kinetics, openings};
use crate::plan::text::significant;
use crate::scene::ModelRequest;

/// Mean free path of the molecules over the smallest hole or chamber, below which rarefaction counts no longer.
const KNUDSEN: f64 = 0.01;

/// Why it may not be.
pub fn unfit(scene: &Scene, measured: &Measured, amounts: &Amounts) -> Option<String> {
    if let Some(key) = asked_of_others(&scene.model) {
        return Some(format!("it has no `{key}`"));
    }
    let knudsen = molecular_knudsen(scene, measured, amounts);
    (knudsen >= KNUDSEN).then(|| {
        format!("the gas itself is rarefied: Kn {} of molecules of 0.37 nm, at most {KNUDSEN}", significant(knudsen))
    })
}

/// The first key that the scene asks for which only other methods heed.
fn asked_of_others(model: &ModelRequest) -> Option<&'static str> {
    let asked = [
        ("diameter", model.diameter.is_some()),
        ("occupancy", model.occupancy.is_some()),
        ("diameter_cap", model.diameter_cap.is_some()),
        ("rounds", model.rounds.is_some()),
        ("collision_number", model.collision_number.is_some()),
    ];
    asked.into_iter().find_map(|(name, asked)| asked.then_some(name))
}

/// The largest of all chambers, by their sizes, and holes, by the denser gas beside them. (Of a chamber without gas
/// that of all gas at the end.)
pub fn molecular_knudsen(scene: &Scene, measured: &Measured, amounts: &Amounts) -> f64 {
    let at_end = kinetics::molecular_mean_free_path(amounts.total() / measured.gas_volume);
    let path = |chamber: usize| {
        let moles: f64 = amounts.initial[chamber].iter().sum();
        let own = kinetics::molecular_mean_free_path(moles / measured.chamber_volumes[chamber]);
        if moles > 0.0 { own } else { at_end }
    };
    let of_chambers =
        (0..scene.chambers.len()).map(|chamber| path(chamber) / libm::cbrt(measured.chamber_volumes[chamber]));
    let of_holes = openings(scene, measured).map(|opening| {
        let [a, b] = opening.between.map(path);
        a.min(b) / opening.length
    });
    of_chambers.chain(of_holes).fold(at_end / libm::cbrt(measured.gas_volume), f64::max)
}

/// Particles of which a collision cell is no longer than the radius of the smallest hole, at the mean density of the
/// end: five spacings across it. That is the guard of the smallest passage, and below it the flow through a hole was
/// not measured.
pub fn fewest(scene: &Scene, measured: &Measured) -> f64 {
    let smallest = openings(scene, measured).map(|opening| opening.length).fold(f64::INFINITY, f64::min);
    let across = COLLISION_CELL / smallest;
    measured.gas_volume * across * across * across
}
