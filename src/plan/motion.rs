//! Walls that move, before the run: how hot they make the gas.

use super::limits::{Quantity, Warning};
use super::text::significant;
use super::{Measured, MeasuredMotion, Reason};
use crate::gas::Species;
use crate::scene::{GAS_CONSTANT, Method, Scene};

/// How many times as hot gas of temperature `hottest`, K, can get: compressed isentropically to the least volume, then by
/// the shock that the fastest wall drives into it (Rankine and Hugoniot), by the gas in which each does most.
pub fn heating(scene: &Scene, motion: &MeasuredMotion, hottest: f64) -> f64 {
    let by = |gas: &crate::scene::Gas| {
        let cv = gas.heat.molar_cv(hottest).max(1.5 * GAS_CONSTANT);
        let gamma = 1.0 + GAS_CONSTANT / cv;
        let compressed = libm::pow(motion.least_share.min(1.0), 1.0 - gamma);
        let sound = (gamma * GAS_CONSTANT * hottest / gas.molar_mass).sqrt();
        // The Mach number of a shock behind which the gas has the velocity of the wall.
        let half = 0.25 * (gamma + 1.0) * motion.fastest / sound;
        let mach2 = (half + (1.0 + half * half).sqrt()).powi(2);
        let shocked = (2.0 * gamma * mach2 - (gamma - 1.0)) * ((gamma - 1.0) * mach2 + 2.0)
            / ((gamma + 1.0) * (gamma + 1.0) * mach2);
        compressed * shocked
    };
    scene.gases.iter().map(by).fold(1.0, f64::max)
}

pub fn reasons(scene: &Scene, measured: &Measured, reasons: &mut Vec<Reason>) {
    let Some(motion) = &measured.motion else { return };
    let walls = scene.motions.iter().map(|motion| &scene.walls[motion.wall].name);
    let led = scene.fabrics.iter().filter(|fabric| fabric.motion.is_some() || fabric.turn.is_some());
    let quantity = match (scene.motions.is_empty(), led.clone().next().is_none()) {
        (true, _) => "fabric",
        (false, true) => "moving walls",
        (false, false) => "moving walls and fabric",
    };
    let names: Vec<String> = walls.chain(led.map(|fabric| &fabric.name)).map(|name| format!("`{name}`")).collect();
    let volumes = if scene.fabrics.iter().any(|fabric| fabric.membrane.is_some()) {
        "the volume beside elastic fabric a run finds".into()
    } else {
        format!(
            "all gas has {} of its volume at the end, a chamber {} at least",
            significant(motion.final_gas_volume / measured.gas_volume),
            significant(motion.least_share)
        )
    };
    reasons.push(Reason {
        quantity: quantity.into(),
        value: names.join(", "),
        why: format!("up to {} m/s; {volumes}", significant(motion.fastest)),
    });
}

/// Heat through walls beside moving ones, by all methods.
pub fn covered(scene: &Scene, measured: &Measured) -> Option<String> {
    let heated = measured.motion.is_some() && scene.has_heat();
    heated.then(|| {
        "walls that exchange heat count with their areas as drawn, in the control volume and in heat fluxes, whatever \
         part of them a moving wall covers"
            .into()
    })
}

pub fn warnings(scene: &Scene, species: &[Species], method: Method, measured: &Measured) -> Vec<String> {
    let Some(motion) = &measured.motion else { return Vec::new() };
    let mut warnings: Vec<String> = covered(scene, measured).into_iter().collect();
    let coldest = scene.chambers.iter().map(|chamber| chamber.temperature).fold(f64::INFINITY, f64::min);
    let heaviest = species.iter().map(|gas| gas.molar_mass).fold(0.0, f64::max);
    let thermal = (GAS_CONSTANT * coldest / heaviest).sqrt();
    let subject = format!("a wall that moves with {} m/s", significant(motion.fastest));
    let times = motion.fastest / thermal;
    let remedy = "a slower wall";
    warnings
        .extend(Warning::by_table(Quantity::WallSpeed, method, &subject, times, remedy).map(|warning| warning.text));
    warnings
}
