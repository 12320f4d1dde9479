//! Molar thermodynamics of mixtures (docs/explanation/method.md, "The gas").
//!
//! Energies count from 0 K: U = sum n u(T), H = U + n R T, with the u of [`Species`].

use super::Species;
use crate::scene::{GAS_CONSTANT, Mixture};

/// kg/mol.
pub fn molar_mass(mixture: &Mixture, gases: &[Species]) -> f64 {
    mixture.0.iter().map(|&(gas, fraction)| fraction * gases[gas].molar_mass).sum()
}

/// J/(mol K), at constant volume and a temperature (K).
pub fn molar_cv(mixture: &Mixture, gases: &[Species], temperature: f64) -> f64 {
    mixture.0.iter().map(|&(gas, fraction)| fraction * gases[gas].molar_cv(temperature)).sum()
}

/// cp / cv of the mixture at a temperature, K.
pub fn heat_capacity_ratio(mixture: &Mixture, gases: &[Species], temperature: f64) -> f64 {
    1.0 + GAS_CONSTANT / molar_cv(mixture, gases, temperature)
}

/// Whether no gas of the mixture has a heat capacity that depends on the temperature.
pub fn is_constant(mixture: &Mixture, gases: &[Species]) -> bool {
    mixture.0.iter().all(|&(gas, _)| gases[gas].is_constant())
}

/// J/mol at a temperature, K.
pub fn molar_enthalpy(mixture: &Mixture, gases: &[Species], temperature: f64) -> f64 {
    mixture.0.iter().map(|&(gas, fraction)| gases[gas].enthalpy(fraction, temperature)).sum()
}

/// U of amounts of the gases (mol) at a temperature (K), J.
pub fn energy(moles: &[f64], gases: &[Species], temperature: f64) -> f64 {
    if gases.iter().all(Species::is_constant) {
        return heat_capacity(moles, gases, temperature) * temperature;
    }
    moles.iter().zip(gases).map(|(n, gas)| gas.energy(*n, temperature)).sum()
}

/// sum n cv at a temperature, J/K.
pub fn heat_capacity(moles: &[f64], gases: &[Species], temperature: f64) -> f64 {
    moles.iter().zip(gases).map(|(n, gas)| n * gas.molar_cv(temperature)).sum()
}

/// The temperature (K) at which these amounts (mol) have the energy U (J); 0 without gas or energy.
pub fn temperature(moles: &[f64], gases: &[Species], wanted: f64) -> f64 {
    if gases.iter().all(Species::is_constant) {
        let capacity = heat_capacity(moles, gases, 0.0);
        return if capacity > 0.0 { wanted / capacity } else { 0.0 };
    }
    let total: f64 = moles.iter().sum();
    if !(wanted > 0.0 && total > 0.0) {
        return 0.0;
    }
    // Translation alone takes 3/2 R T.
    let highest = wanted / (1.5 * GAS_CONSTANT * total);
    let excess = |t: f64| energy(moles, gases, t) - wanted;
    root(excess, |t| heat_capacity(moles, gases, t), highest)
}

/// The temperature between 0 and `highest` (K) at which a function that rises with it is zero: Newton's method,
/// with halving where it leaves the bracket.
pub fn root(function: impl Fn(f64) -> f64, slope: impl Fn(f64) -> f64, highest: f64) -> f64 {
    let (mut low, mut high) = (0.0, highest);
    let mut at = 0.6 * highest;
    for _ in 0..100 {
        let value = function(at);
        if value > 0.0 {
            high = at;
        } else {
            low = at;
        }
        let newton = at - value / slope(at);
        if (newton - at).abs() <= 1e-14 * at {
            return newton;
        }
        at = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gas::fit;

    #[test]
    fn mixtures_average_by_moles() {
        let gas = |molar_mass, spin: f64| Species::constant(molar_mass, 0.5 * (3.0 + spin) * GAS_CONSTANT);
        let gases = [gas(0.028, 2.0), gas(0.004, 0.0)];
        let half = Mixture(vec![(0, 0.5), (1, 0.5)]);
        assert_eq!(molar_mass(&half, &gases), 0.016);
        assert!((heat_capacity_ratio(&half, &gases, 300.0) - 1.5).abs() < 1e-14);
        assert!((heat_capacity_ratio(&Mixture(vec![(1, 1.0)]), &gases, 300.0) - 1.5).abs() > 0.1);
    }

    #[test]
    fn the_temperature_of_an_energy_is_found() {
        let curve = Species::with_modes(0.044, fit([23.0, 0.056, -2.2e-5], [235.0, 1080.0]).unwrap());
        for gases in
            [[curve, Species::constant(0.004, 1.5 * GAS_CONSTANT)], [(); 2].map(|()| Species::constant(0.03, 21.0))]
        {
            for kelvin in [3.0, 300.0, 900.0, 5000.0] {
                let wanted = energy(&[2.0, 0.5], &gases, kelvin);
                let found = temperature(&[2.0, 0.5], &gases, wanted);
                assert!((found / kelvin - 1.0).abs() < 1e-12, "{found} {kelvin}");
                assert!((temperature(&[2.0, 0.5], &gases, 1.01 * wanted) / kelvin - 1.0).abs() > 1e-3);
            }
            assert_eq!(temperature(&[0.0, 0.0], &gases, 0.0), 0.0);
        }
    }
}
