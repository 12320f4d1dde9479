//! The reference mass and the fixed-point scales of the tallies, all fixed by the plan.
//!
//! With v0^2 = R T_ref / M_ref a velocity is tallied in units of v0 / 2^20 and a specific energy in
//! units of v0^2 / 2^24: a particle may have 1024 v0 per axis and 256 v0^2 before the tally refuses it
//! (which stops the run), and rounding is 3e-8 of a thermal energy. v0 is that of the heaviest gas: beside one more than
//! eight times lighter, whose particles are so much faster, units of energy are as many powers of two larger.

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
        let lightest = plan.gases.iter().map(|gas| gas.molar_mass).fold(f64::INFINITY, f64::min);
        let v0_squared = GAS_CONSTANT * plan.temperature_reference / molar_mass;
        Scales {
            reference_mass: molar_mass * plan.moles_per_particle,
            velocity: f64::from(1 << 20) / v0_squared.sqrt(),
            energy: f64::from(1 << 24) / coarser(molar_mass, lightest) / v0_squared,
            block_energy: f64::from(1 << 16) / v0_squared,
        }
    }
}

/// By how much the units of energy are larger, for the sake of the lightest gas (molar masses); a power of two.
fn coarser(heaviest: f64, lightest: f64) -> f64 {
    let mut coarser = 1.0;
    while heaviest / lightest > 8.0 * coarser {
        coarser *= 2.0;
    }
    coarser
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hydrogen beside SF6 has room for its fast particles, 20 mean energies; gases up to eight times apart have the units of
    /// the heavier alone, with which the hydrogen has not.
    #[test]
    fn light_gases_have_room() {
        let room = |ratio: f64, coarser: f64| 256.0 * coarser / (1.5 * ratio);
        for ratio in [1.0, 8.0, 9.0, 72.5] {
            assert!(room(ratio, coarser(ratio, 1.0)) > 20.0, "{ratio}");
        }
        assert_eq!(coarser(8.0, 1.0), 1.0);
        assert_eq!(coarser(0.146, 0.002), 16.0);
        assert!(room(72.5, 1.0) < 3.0);
    }
}
