//! Molar thermodynamics of mixtures of gases with constant heat capacities (specification, section 1).
//!
//! Energies count from 0 K: U = sum n cv T, H = sum n cp T.

use crate::scene::{GAS_CONSTANT, Gas, Mixture};

/// kg/mol.
pub fn molar_mass(mixture: &Mixture, gases: &[Gas]) -> f64 {
    mixture.0.iter().map(|&(gas, fraction)| fraction * gases[gas].molar_mass).sum()
}

/// J/(mol K), at constant volume.
pub fn molar_cv(mixture: &Mixture, gases: &[Gas]) -> f64 {
    mixture.0.iter().map(|&(gas, fraction)| fraction * gases[gas].molar_cv).sum()
}

/// cp / cv of the mixture.
pub fn heat_capacity_ratio(mixture: &Mixture, gases: &[Gas]) -> f64 {
    1.0 + GAS_CONSTANT / molar_cv(mixture, gases)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mixtures_average_by_moles() {
        let gas = |molar_mass, spin: f64| Gas {
            name: String::new(),
            molar_mass,
            molar_cv: 0.5 * (3.0 + spin) * GAS_CONSTANT,
        };
        let gases = [gas(0.028, 2.0), gas(0.004, 0.0)];
        let half = Mixture(vec![(0, 0.5), (1, 0.5)]);
        assert_eq!(molar_mass(&half, &gases), 0.016);
        assert!((heat_capacity_ratio(&half, &gases) - 1.5).abs() < 1e-14);
        assert!((heat_capacity_ratio(&Mixture(vec![(1, 1.0)]), &gases) - 1.5).abs() > 0.1);
    }
}
