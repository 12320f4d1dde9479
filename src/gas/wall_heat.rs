//! Heat between a gas and a wall that keeps its temperature (docs/explanation/method.md, "Walls").
//!
//! Per gas c cbar/4 moles of concentration c hit a square metre in a second and bring (2 + zeta/2) R T each; a share
//! alpha of them leaves with (2 + zeta/2) R T_w. So alpha = 1 is the coefficient
//! h1 = sum c cbar R (2 + zeta/2) / 4, and any coefficient h is the share alpha = h / h1. Where zeta depends on the
//! temperature, zeta/2 R (T - T_w) stands for the difference of the internal energies, e(T) - e(T_w).

use super::{Species, kinetics};
use crate::scene::{GAS_CONSTANT, HeatTransfer, WallHeat};

/// Differences of temperature less than this part are none.
const NO_DIFFERENCE: f64 = 1e-6;

/// (e(T) - e(T_w)) / (R/2 (T - T_w)): zeta where that is constant.
fn spin_dof_between(gas: &Species, temperature: f64, wall: f64) -> f64 {
    let difference = temperature - wall;
    if gas.is_constant() || temperature <= 0.0 {
        gas.spin_energy_dof(temperature)
    } else if difference.abs() < NO_DIFFERENCE * temperature {
        gas.spin_dof(temperature)
    } else {
        (gas.spin_energy_dof(temperature) * temperature - gas.spin_energy_dof(wall) * wall) / difference
    }
}

/// h1, W/(m2 K), of gas with `moles` mol/m3 of each gas at `temperature`, at a wall of the temperature `wall`, K.
pub fn kinetic_coefficient(gases: &[Species], moles: &[f64], temperature: f64, wall: f64) -> f64 {
    let of_gas = |(gas, moles): (&Species, &f64)| {
        let speed = kinetics::mean_speed(kinetics::thermal_square(temperature, gas.molar_mass));
        0.25 * moles * speed * GAS_CONSTANT * (2.0 + 0.5 * spin_dof_between(gas, temperature, wall))
    };
    gases.iter().zip(moles).map(of_gas).sum()
}

/// Heat from the gas to the wall, W/m2.
pub fn heat_flux(heat: &WallHeat, gases: &[Species], moles: &[f64], temperature: f64) -> f64 {
    let most = kinetic_coefficient(gases, moles, temperature, heat.temperature);
    let coefficient = match heat.transfer {
        HeatTransfer::Accommodation(share) => share * most,
        HeatTransfer::Coefficient(coefficient) => coefficient.min(most),
    };
    coefficient * (temperature - heat.temperature)
}

/// The share of the hits that leave with the wall's temperature; a coefficient may ask for more than 1.
pub fn accommodation(heat: &WallHeat, gases: &[Species], moles: &[f64], temperature: f64) -> f64 {
    match heat.transfer {
        HeatTransfer::Accommodation(share) => share,
        HeatTransfer::Coefficient(0.0) => 0.0,
        HeatTransfer::Coefficient(coefficient) => {
            coefficient / kinetic_coefficient(gases, moles, temperature, heat.temperature)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gas::fit;

    fn nitrogen() -> Vec<Species> {
        vec![Species::constant(0.0280134, 2.5 * GAS_CONSTANT)]
    }

    /// Nitrogen at 1 bar and 300 K: c = 40.09 mol/m3, cbar = 476.2 m/s, so h1 = 40.09 x 476.2 x 8.314 x 3 / 4
    /// = 1.190e5 W/(m2 K).
    #[test]
    fn the_coefficient_of_full_accommodation() {
        let moles = [1e5 / (GAS_CONSTANT * 300.0)];
        let found = kinetic_coefficient(&nitrogen(), &moles, 300.0, 350.0);
        assert!((found / 1.190e5 - 1.0).abs() < 1e-3, "{found}");
        // Without the factor (2 + zeta/2) it would be a third.
        assert!((found / 3.97e4 - 1.0).abs() > 1.0);
    }

    /// Of a gas whose heat capacity grows, what the hits bring above what they take is the difference of the energies; near
    /// the wall's temperature it is the heat capacity.
    #[test]
    fn a_growing_heat_capacity_carries_the_difference_of_the_energies() {
        let gas = Species::with_modes(0.044, fit([23.0, 5.6e-2, -2.2e-5], [250.0, 900.0]).unwrap());
        let (hot, cold) = (800.0, 300.0);
        let gases = [gas];
        let internal = |t: f64| gases[0].energy(1.0, t) - 1.5 * GAS_CONSTANT * t;
        let hits = 0.25 * 40.0 * kinetics::mean_speed(kinetics::thermal_square(hot, 0.044));
        let expected = hits * (2.0 * GAS_CONSTANT * (hot - cold) + internal(hot) - internal(cold));
        let wall = |temperature| WallHeat { temperature, transfer: HeatTransfer::Accommodation(1.0) };
        assert!((heat_flux(&wall(cold), &gases, &[40.0], hot) / expected - 1.0).abs() < 1e-12);
        let near = |wall: f64| kinetic_coefficient(&gases, &[40.0], hot, wall);
        assert!((near(hot) / near(hot * (1.0 + 1e-4)) - 1.0).abs() < 1e-4);
        // The check can fail: by the energy at the gas's own temperature it would be a tenth more.
        let own = hits * (2.0 * GAS_CONSTANT + internal(hot) / hot) * (hot - cold);
        assert!((own / expected - 1.0).abs() > 0.05, "{}", own / expected);
    }

    /// A coefficient and the share that it asks for carry the same heat, up to all hits.
    #[test]
    fn coefficient_and_share_are_two_words_for_one_flux() {
        let (gases, moles) = (nitrogen(), [40.0]);
        let wall = |transfer| WallHeat { temperature: 300.0, transfer };
        let by_coefficient = wall(HeatTransfer::Coefficient(500.0));
        let share = accommodation(&by_coefficient, &gases, &moles, 400.0);
        let by_share = wall(HeatTransfer::Accommodation(share));
        let flux = |heat: &WallHeat| heat_flux(heat, &gases, &moles, 400.0);
        assert!((flux(&by_share) / 5e4 - 1.0).abs() < 1e-12 && (flux(&by_coefficient) / 5e4 - 1.0).abs() < 1e-12);
        let beyond = wall(HeatTransfer::Coefficient(1e9));
        assert!(accommodation(&beyond, &gases, &moles, 400.0) > 1.0);
        assert_eq!(flux(&beyond), flux(&wall(HeatTransfer::Accommodation(1.0))));
    }
}
