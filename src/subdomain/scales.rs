//! The reference mass and the fixed-point scales of the tallies, all fixed by the plan.
//!
//! With v0^2 = R T_ref / M_ref a velocity is tallied in units of v0 / 2^20 and a specific energy in
//! units of v0^2 / 2^24: a particle may have 1024 v0 per axis and 256 v0^2 before the tally refuses it
//! (which stops the run), and rounding is 3e-8 of a thermal energy.

use crate::plan::Plan;
use crate::scene::GAS_CONSTANT;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// Mass of a particle of the reference gas (the heaviest), kg.
    pub reference_mass: f64,
    /// Tally units per m/s.
    pub velocity: f64,
    /// Tally units per (m/s)^2.
    pub energy: f64,
    /// Tally units per (m/s)^2, in the blocks.
    pub block_energy: f64,
}

impl Scales {
    pub fn new(plan: &Plan) -> Scales {
        let molar_mass = plan.gases.iter().map(|gas| gas.molar_mass).fold(0.0, f64::max);
        let v0_squared = GAS_CONSTANT * plan.temperature_reference / molar_mass;
        Scales {
            reference_mass: molar_mass * plan.moles_per_particle,
            velocity: f64::from(1 << 20) / v0_squared.sqrt(),
            energy: f64::from(1 << 24) / v0_squared,
            block_energy: f64::from(1 << 16) / v0_squared,
        }
    }
}
