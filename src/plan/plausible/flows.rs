//! Mass flows that are masses, and inflows that are nothing beside the gas that is there.

use super::range::{Kind, most, range_of};
use crate::gas::FlowIntegral;
use crate::plan::amounts::Amounts;
use crate::plan::text::significant;
use crate::scene::{Dimension, Orifice, Scene};

/// Rising values from which on a curve that levels off is one of a mass: who lets a flow rise and stay gives fewer.
const RISING: usize = 4;
/// kg/s: an inflator gives a few. A curve that would be faster as one of a mass is a flow that rises at once, and stays.
const FASTEST: f64 = 20.0;
/// Slope over the steepest: what is less is level.
const LEVEL: f64 = 0.3;
/// Inflow over the gas at the start: no inflator gives so little, and a thousand times as much is one in another unit.
const LITTLE: f64 = 1e-3;

pub fn notes(scene: &Scene, amounts: &Amounts) -> Vec<String> {
    let masses: Vec<String> = scene.orifices.iter().filter_map(|orifice| cumulative(scene, orifice)).collect();
    // A mass is little as a flow.
    if masses.is_empty() { little(scene, amounts).into_iter().collect() } else { masses }
}

/// A flow that starts from nothing, only rises, and levels off or is over when it is largest: that is how the mass that has come in
/// grows.
fn cumulative(scene: &Scene, orifice: &Orifice) -> Option<String> {
    let points = &orifice.mass_flow.points;
    let slopes: Vec<f64> =
        points.windows(2).map(|pair| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0])).collect();
    let steepest = slopes.iter().copied().fold(0.0, f64::max);
    let rising = slopes.iter().filter(|slope| **slope > 0.0).count();
    let falls = slopes.iter().any(|slope| *slope < 0.0);
    let level = slopes.last().is_some_and(|last| *last <= LEVEL * steepest);
    let smooth = rising >= RISING && level;
    let is_over = points.last().is_some_and(|last| last[0] <= scene.end_time * (1.0 + 1e-9));
    let as_mass = steepest / scene.units.factor(Dimension::MassFlow) * scene.units.factor(Dimension::Mass);
    let short = rising > 0 && is_over && as_mass <= FASTEST;
    (points.first().is_some_and(|first| first[1] == 0.0) && !falls && (smooth || short)).then(|| {
        format!(
            "orifice `{}`: its mass_flow never falls, and {} {} {}: is it the mass that has come in so far? A mass flow is its rate",
            orifice.name,
            if level { "levels off at" } else { "ends at" },
            significant(most(&orifice.mass_flow) / scene.units.factor(Dimension::MassFlow)),
            scene.units.symbol(Dimension::MassFlow)
        )
    })
}

/// All of the inflow, also what comes after the end.
fn little(scene: &Scene, amounts: &Amounts) -> Option<String> {
    let until = |orifice: &Orifice| orifice.mass_flow.points.last().map_or(0.0, |last| last[0]).max(scene.end_time);
    let injected: f64 = scene
        .orifices
        .iter()
        .map(|own| FlowIntegral::new(&own.mass_flow, until(own)).total() / own.mixture.molar_mass(&scene.gases))
        .sum();
    let there = amounts.initial_total();
    // What no vessel has is doubted otherwise.
    let is_gas = scene.chambers.iter().all(|chamber| range_of(Kind::Pressure).holds(chamber.pressure));
    (injected > 0.0 && injected < LITTLE * there && is_gas).then(|| {
        let subject = match &scene.orifices[..] {
            [one] => format!("orifice `{}`", one.name),
            _ => "the orifices".to_string(),
        };
        format!(
            "{subject}: all that comes in is {} % of the gas that is there: are `mass_flow` and its times in the units of the scene?",
            significant(100.0 * injected / there)
        )
    })
}
