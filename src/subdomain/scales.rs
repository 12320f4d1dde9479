//! The reference mass and the fixed-point scales of the tallies, all fixed by the plan.
//!
//! With v0^2 = R T_ref / M_ref a velocity is tallied in units of v0 / 2^20 and a specific energy in
//! units of v0^2 / 2^24: a particle may have 1024 v0 per axis and 256 v0^2 before the tally refuses it
//! (which stops the run), and rounding is 3e-8 of a thermal energy. v0 is that of the heaviest gas at the mean temperature of the end:
//! where a lighter one, or what hot walls and inflow give, may have a fortieth of those 256 as its kT/m, units of energy are as many
//! powers of two larger. What an orifice lets in or a rough wall sends back has more than forty of these with a probability of some 1e-15.

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
        let hottest = molar_mass / lightest * (plan.temperature_max / plan.temperature_reference).max(1.0);
        Scales {
            reference_mass: molar_mass * plan.moles_per_particle,
            velocity: f64::from(1 << 20) / v0_squared.sqrt(),
            energy: f64::from(1 << 24) / coarser(hottest) / v0_squared,
            block_energy: f64::from(1 << 16) / v0_squared,
        }
    }
}

/// A particle's specific energy before the tally refuses it, over v0^2.
const ROOM: f64 = 256.0;
/// The same over the largest kT/m, at least.
const LEAST_ROOM: f64 = 40.0;

/// By how much the units of energy are larger for the sake of the lightest gas at its hottest, whose kT/m is `hottest` times v0^2; a power of two.
fn coarser(hottest: f64) -> f64 {
    let mut coarser = 1.0;
    while hottest * LEAST_ROOM > ROOM * coarser {
        coarser *= 2.0;
    }
    coarser
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hydrogen beside SF6 has room for its fast particles; gases that are no more than six times apart have the units of the heavier
    /// alone, with which the hydrogen has not.
    #[test]
    fn light_gases_have_room() {
        for hottest in [1.0, 6.0, 9.0, 72.5, 800.0] {
            let coarser = coarser(hottest);
            assert!(ROOM * coarser / hottest >= LEAST_ROOM, "{hottest}");
            assert!(coarser == 1.0 || 0.5 * ROOM * coarser / hottest < LEAST_ROOM, "{hottest}");
        }
        assert_eq!((coarser(6.0), coarser(72.5)), (1.0, 16.0));
    }
}
