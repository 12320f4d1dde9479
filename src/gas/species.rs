//! A gas as it is modelled: its mass and its internal (spin) energy.
//!
//! A constant heat capacity is that of zeta = 2 cv/R - 3 internal degrees of freedom. One that depends on the
//! temperature is that of a partition function q = T^nu0 sum_K h_K T^K, h_K >= 0 ([`Modes`]; method.md,
//! "Heat capacities"): a gas whose internal energy e has the density of states g(e) ~ sum_K h_K e^(nu0+K-1) /
//! Gamma(nu0+K), hence e/kT that of Gamma(nu0+K) where K is sampled in proportion to h_K T^K. Energies count from
//! 0 K in either case.
//!
//! Invariant: the arithmetic of a constant heat capacity is in the order in which it always was, so that scenes of
//! such gases keep their bits.

use serde::{Serialize, Serializer};

use super::Draws;
use crate::scene::GAS_CONSTANT;

/// kg/mol and the internal energy.
#[derive(Debug, Clone, PartialEq)]
pub struct Species {
    pub molar_mass: f64,
    heat: Heat,
}

#[derive(Debug, Clone, PartialEq)]
enum Heat {
    /// Molar cv, J/(mol K).
    Constant(f64),
    Modes(Modes),
}

/// One K of the partition function.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Mode {
    pub power: f64,
    /// ln(h_K `scale`^K).
    pub ln_weight: f64,
}

/// q = T^nu0 sum_K h_K T^K.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Modes {
    /// nu0, half the internal degrees of freedom of the mode K = 0.
    pub nu0: f64,
    /// K at which the weights are those given.
    pub scale: f64,
    /// K: over which the heat capacity was fitted.
    pub range: [f64; 2],
    /// Largest difference of cp there, relative.
    pub residual: f64,
    pub modes: Vec<Mode>,
}

impl Modes {
    /// The shares of the modes at a temperature, K; they sum to one.
    fn shares(&self, temperature: f64) -> impl Iterator<Item = (f64, f64)> + '_ {
        // At 0 K the least power has it all.
        let ln = libm::log((temperature / self.scale).max(1e-9));
        let exponent = move |mode: &Mode| mode.ln_weight + mode.power * ln;
        let most = self.modes.iter().map(exponent).fold(f64::NEG_INFINITY, f64::max);
        let weight = move |mode: &Mode| libm::exp(exponent(mode) - most);
        let sum: f64 = self.modes.iter().map(weight).sum();
        self.modes.iter().map(move |mode| (mode.power, weight(mode) / sum))
    }

    /// The share of one mode at a temperature, K.
    pub(super) fn share(&self, index: usize, temperature: f64) -> f64 {
        self.shares(temperature).nth(index).map_or(0.0, |(_, share)| share)
    }

    /// Mean of K and its variance at a temperature (K): u = (nu0 + mean) R T, cv = (nu0 + mean + variance) R.
    pub fn moments(&self, temperature: f64) -> [f64; 2] {
        let sums = self.shares(temperature).fold([0.0; 2], |[a, b], (k, share)| [a + share * k, b + share * k * k]);
        [sums[0], sums[1] - sums[0] * sums[0]]
    }

    /// The power K for a uniform draw.
    fn sampled_mode(&self, temperature: f64, uniform: f64) -> f64 {
        let mut left = uniform;
        for (power, share) in self.shares(temperature) {
            if left < share {
                return power;
            }
            left -= share;
        }
        self.modes.last().map_or(0.0, |mode| mode.power)
    }
}

impl Species {
    pub fn constant(molar_mass: f64, molar_cv: f64) -> Species {
        Species { molar_mass, heat: Heat::Constant(molar_cv) }
    }

    pub fn with_modes(molar_mass: f64, modes: Modes) -> Species {
        Species { molar_mass, heat: Heat::Modes(modes) }
    }

    /// `None` of a constant heat capacity.
    pub fn modes(&self) -> Option<&Modes> {
        match &self.heat {
            Heat::Constant(_) => None,
            Heat::Modes(modes) => Some(modes),
        }
    }

    /// The heat capacity cv where it is constant, J/(mol K).
    pub fn constant_cv(&self) -> Option<f64> {
        match self.heat {
            Heat::Constant(cv) => Some(cv),
            Heat::Modes(_) => None,
        }
    }

    pub fn is_constant(&self) -> bool {
        self.modes().is_none()
    }

    /// Whether it has internal energy.
    pub fn has_spin(&self) -> bool {
        match self.heat {
            Heat::Constant(cv) => constant_dof(cv) > 0.0,
            Heat::Modes(_) => true,
        }
    }

    /// At constant volume, J/(mol K), at a temperature in K.
    pub fn molar_cv(&self, temperature: f64) -> f64 {
        match &self.heat {
            Heat::Constant(cv) => *cv,
            Heat::Modes(modes) => {
                let [mean, variance] = modes.moments(temperature);
                (1.5 + modes.nu0 + mean + variance) * GAS_CONSTANT
            }
        }
    }

    /// At constant pressure, J/(mol K), at a temperature in K.
    pub fn molar_cp(&self, temperature: f64) -> f64 {
        self.molar_cv(temperature) + GAS_CONSTANT
    }

    /// zeta = 2 cv/R - 3 at a temperature, K: the degrees of freedom that take up heat there.
    pub fn spin_dof(&self, temperature: f64) -> f64 {
        constant_dof(self.molar_cv(temperature))
    }

    /// The internal energy at a temperature (K) over kT/2. Where the heat capacity is constant, zeta.
    pub fn spin_energy_dof(&self, temperature: f64) -> f64 {
        match &self.heat {
            Heat::Constant(cv) => constant_dof(*cv),
            Heat::Modes(modes) => 2.0 * (modes.nu0 + modes.moments(temperature)[0]),
        }
    }

    /// J, of an amount (mol) at a temperature (K).
    pub fn energy(&self, moles: f64, temperature: f64) -> f64 {
        match &self.heat {
            Heat::Constant(cv) => moles * cv * temperature,
            Heat::Modes(_) if temperature <= 0.0 => 0.0,
            Heat::Modes(_) => moles * (1.5 + 0.5 * self.spin_energy_dof(temperature)) * GAS_CONSTANT * temperature,
        }
    }

    /// J, of an amount (mol) at a temperature (K).
    pub fn enthalpy(&self, moles: f64, temperature: f64) -> f64 {
        match &self.heat {
            Heat::Constant(cv) => moles * (cv + GAS_CONSTANT) * temperature,
            Heat::Modes(_) => self.energy(moles, temperature) + moles * GAS_CONSTANT * temperature,
        }
    }

    /// The internal energy of a particle in equilibrium at a temperature (K), in the unit of `thermal_energy` = kT.
    pub fn draw_spin(&self, thermal_energy: f64, temperature: f64, draws: &mut Draws) -> f64 {
        let shape = match &self.heat {
            Heat::Constant(cv) => 0.5 * constant_dof(*cv),
            Heat::Modes(modes) => modes.nu0 + modes.sampled_mode(temperature, draws.uniform()),
        };
        thermal_energy * draws.gamma(shape)
    }
}

fn constant_dof(molar_cv: f64) -> f64 {
    (2.0 * molar_cv / GAS_CONSTANT - 3.0).max(0.0)
}

/// The modes, where there are any.
impl Serialize for Species {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.modes().serialize(serializer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gas::Purpose;

    /// cv of modes alpha^K / K! is linear: nu0 + 2 alpha T.
    fn linear() -> Species {
        let mut ln_factorial = 0.0;
        let modes = (0..24).map(|k| {
            let power = f64::from(k);
            ln_factorial += if k > 0 { libm::log(power) } else { 0.0 };
            Mode { power, ln_weight: power * libm::log(0.8) - ln_factorial }
        });
        let modes = Modes { nu0: 1.0, scale: 500.0, range: [0.0, 1000.0], residual: 0.0, modes: modes.collect() };
        Species::with_modes(0.028, modes)
    }

    #[test]
    fn a_poisson_series_has_a_linear_heat_capacity() {
        for temperature in [50.0, 300.0, 500.0, 900.0] {
            let expected = 1.5 + 1.0 + 2.0 * 0.8 * temperature / 500.0;
            assert!((linear().molar_cv(temperature) / GAS_CONSTANT - expected).abs() < 1e-9);
            let energy = 2.5 * temperature + 0.8 * temperature * temperature / 500.0;
            assert!((linear().energy(2.0, temperature) / (2.0 * GAS_CONSTANT) - energy).abs() < 1e-9 * energy);
            let enthalpy = linear().enthalpy(1.0, temperature) - linear().energy(1.0, temperature);
            assert!((enthalpy / (GAS_CONSTANT * temperature) - 1.0).abs() < 1e-12);
        }
        assert!((linear().molar_cv(300.0) / GAS_CONSTANT - 2.5).abs() > 0.5);
    }

    /// The mean of the draws is the internal energy at each temperature, their variance T^2 cv: within 4.5 standard
    /// errors.
    #[test]
    fn drawn_energies_have_the_mean_and_the_variance_of_the_curve() {
        let count = 100_000;
        for temperature in [100.0, 400.0, 900.0] {
            let mut sums = [0.0; 4];
            for id in 0..count {
                let energy = linear().draw_spin(1.0, temperature, &mut Draws::new(3, Purpose::InitialState, id));
                for (power, sum) in (1..).zip(&mut sums) {
                    *sum += energy.powi(power) / f64::from(count);
                }
            }
            let mean = 0.5 * linear().spin_energy_dof(temperature);
            let variance = linear().molar_cv(temperature) / GAS_CONSTANT - 1.5;
            let error = ((sums[1] - sums[0] * sums[0]) / f64::from(count)).sqrt();
            assert!((sums[0] - mean).abs() < 4.5 * error, "{temperature} K: {} {mean}", sums[0]);
            // Var of x^2 about the mean from the raw moments.
            let square = sums[1] - 2.0 * mean * sums[0] + mean * mean;
            let fourth = sums[3] - 4.0 * mean * sums[2] + 6.0 * mean * mean * sums[1] - 4.0 * mean.powi(3) * sums[0]
                + mean.powi(4);
            let error = ((fourth - square * square) / f64::from(count)).sqrt();
            assert!((square - variance).abs() < 4.5 * error, "{temperature} K: {square} {variance}");
            // The check can fail: the degrees of freedom of the heat capacity give another mean.
            let other = 0.5 * linear().spin_dof(temperature);
            assert!((sums[0] - other).abs() > 4.5 * (variance / f64::from(count)).sqrt());
        }
    }

    #[test]
    fn a_constant_heat_capacity_is_as_before() {
        let nitrogen = Species::constant(0.028, 2.5 * GAS_CONSTANT);
        assert_eq!((nitrogen.spin_dof(1.0), nitrogen.spin_energy_dof(900.0)), (2.0, 2.0));
        assert_eq!(nitrogen.energy(3.0, 300.0), 3.0 * (2.5 * GAS_CONSTANT) * 300.0);
        assert!(nitrogen.has_spin() && !Species::constant(0.004, 1.5 * GAS_CONSTANT).has_spin());
        let draws = || Draws::new(1, Purpose::Inflow, 7);
        assert_eq!(nitrogen.draw_spin(2.0, 300.0, &mut draws()), 2.0 * draws().gamma(1.0));
    }
}
