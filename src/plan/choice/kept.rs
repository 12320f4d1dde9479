//! Limits that a choice keeps: those on which particles, occupancy and step decide, which are the plan's own.
//!
//! What a passage or thin gas would take (Knudsen numbers, narrow gaps, fronts into near vacuum) follows from the scene and may be any
//! number of particles. The flow through holes is part of the forecast, so the wish itself says how well they are resolved; of the
//! others the plan warns.

use super::{Amounts, Measured, Method, Quantity, Resolution, Scene};
use crate::plan::ChamberPlan;
use crate::plan::warnings::{Decided, warnings};
use crate::scene::GAS_CONSTANT;

/// Counts of particles differ from what was asked by the rounding of chambers and gases.
pub(super) const ROOM: f64 = 0.999;

const KEPT: [Quantity; 7] = [
    Quantity::Particles,
    Quantity::Occupancy,
    Quantity::ProbeParticles,
    Quantity::CellParticles,
    Quantity::WallHits,
    Quantity::Flight,
    Quantity::Step,
];

/// What a plan would be of.
pub struct Choices<'a> {
    pub scene: &'a Scene,
    pub measured: &'a Measured,
    pub amounts: &'a Amounts,
    pub method: Method,
    /// At the end.
    pub particles: f64,
    /// In local mean spacings.
    pub cap: Option<f64>,
}

/// The limits that a plan of these choices would warn of.
pub fn beyond(choices: &Choices<'_>, resolution: &Resolution) -> Vec<Quantity> {
    let Choices { scene, measured, amounts, method, particles, cap } = *choices;
    let per_mole = particles / amounts.total();
    let chambers: Vec<ChamberPlan> = scene
        .chambers
        .iter()
        .zip(amounts.initial.iter().zip(&measured.chamber_volumes))
        .map(|(chamber, (moles, &volume))| ChamberPlan {
            name: chamber.name.clone(),
            volume,
            particles: moles.iter().map(|moles| (moles * per_mole) as u64).collect(),
        })
        .collect();
    let decided = Decided {
        method,
        moles_per_particle: 1.0 / per_mole,
        particles: particles as u64,
        // The plan's own numbers differ a little.
        number_density: ROOM * particles / measured.gas_volume,
        thermal_energy: GAS_CONSTANT * amounts.final_temperature / per_mole,
        resolution,
        diameter_cap: cap,
        chambers: &chambers,
        openings: &[],
    };
    let found = warnings(scene, measured, &decided);
    // Tiles of `half-turn` hold as many whatever the number of all: how few is the scene's, and no other method is less
    // viscous there.
    let own = |kept: &Quantity| method != Method::HalfTurn || *kept != Quantity::CellParticles;
    KEPT.into_iter().filter(own).filter(|kept| found.iter().any(|warning| warning.quantity == *kept)).collect()
}
