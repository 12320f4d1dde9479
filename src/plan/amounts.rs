//! The gas of the whole run in moles and joules, before it is cut into particles.

use super::{Measured, PlanError};
use crate::gas::{FlowIntegral, flow_times_temperature, moles_at, thermo};
use crate::scene::{GAS_CONSTANT, Scene};

pub struct Amounts {
    /// mol by chamber, then gas.
    pub initial: Vec<Vec<f64>>,
    /// mol by gas, from time 0 to the end.
    pub injected: Vec<f64>,
    /// K, U / (n cv) of all initial gas, and of all gas at the end of a closed adiabatic run.
    pub initial_temperature: f64,
    pub final_temperature: f64,
}

impl Amounts {
    pub fn of(scene: &Scene, measured: &Measured) -> Result<Self, PlanError> {
        let (volumes, chambers) = (measured.chamber_volumes.len(), scene.chambers.len());
        if volumes != chambers {
            return Err(PlanError::Volumes { volumes, chambers });
        }
        let mut initial = Vec::with_capacity(chambers);
        let mut energy = 0.0;
        let mut capacity = 0.0;
        for (chamber, &volume) in scene.chambers.iter().zip(&measured.chamber_volumes) {
            if !(volume > 0.0 && volume.is_finite()) {
                return Err(PlanError::NoVolume { chamber: chamber.name.clone(), volume });
            }
            let moles = moles_at(chamber.pressure, volume, chamber.temperature);
            let own_capacity = moles * thermo::molar_cv(&chamber.mixture, &scene.gases);
            capacity += own_capacity;
            energy += own_capacity * chamber.temperature;
            let mut by_gas = vec![0.0; scene.gases.len()];
            for &(gas, fraction) in &chamber.mixture.0 {
                by_gas[gas] += moles * fraction;
            }
            initial.push(by_gas);
        }
        let initial_temperature = if capacity > 0.0 { energy / capacity } else { 0.0 };
        let mut injected = vec![0.0; scene.gases.len()];
        for orifice in &scene.orifices {
            let molar_mass = thermo::molar_mass(&orifice.mixture, &scene.gases);
            let moles = FlowIntegral::new(&orifice.mass_flow, scene.end_time).total() / molar_mass;
            for &(gas, fraction) in &orifice.mixture.0 {
                injected[gas] += moles * fraction;
            }
            let cv = thermo::molar_cv(&orifice.mixture, &scene.gases);
            capacity += moles * cv;
            energy += (cv + GAS_CONSTANT) / molar_mass
                * flow_times_temperature(&orifice.mass_flow, &orifice.temperature, scene.end_time);
        }
        let amounts = Self {
            initial,
            injected,
            initial_temperature,
            final_temperature: energy / capacity.max(f64::MIN_POSITIVE),
        };
        if amounts.total() > 0.0 { Ok(amounts) } else { Err(PlanError::NoGas) }
    }

    pub fn initial_total(&self) -> f64 {
        self.initial.iter().flatten().sum()
    }

    pub fn total(&self) -> f64 {
        self.initial_total() + self.injected.iter().sum::<f64>()
    }

    /// Moles of one gas in all.
    fn of_gas(&self, gas: usize) -> f64 {
        self.injected[gas] + self.initial.iter().map(|chamber| chamber[gas]).sum::<f64>()
    }

    /// kg/mol, the mean of all gas, and of the initial gas.
    pub fn mean_molar_masses(&self, scene: &Scene) -> (f64, f64) {
        let mean = |moles: &dyn Fn(usize) -> f64| {
            let sums = scene.gases.iter().enumerate().fold((0.0, 0.0), |(mass, total), (index, gas)| {
                (mass + moles(index) * gas.molar_mass, total + moles(index))
            });
            sums.0 / sums.1
        };
        let initial = |gas| self.initial.iter().map(|chamber| chamber[gas]).sum();
        (mean(&|gas| self.of_gas(gas)), mean(&initial))
    }

    /// kg/mol, of the lightest gas that is there at all.
    pub fn lightest(&self, scene: &Scene) -> f64 {
        let present = scene.gases.iter().enumerate().filter(|(index, _)| self.of_gas(*index) > 0.0);
        present.map(|(_, gas)| gas.molar_mass).fold(f64::INFINITY, f64::min)
    }
}

/// The highest temperature the scene can reach, K, and why: a chamber's own, that of a wall, or that of gas which flows
/// into a chamber (an orifice, a neighbour of higher pressure) and is stopped there, gamma T0 at most.
pub fn highest_temperature(scene: &Scene) -> (f64, String) {
    let gamma = |mixture: &crate::scene::Mixture| {
        let gammas = mixture.0.iter().map(|&(gas, _)| 1.0 + GAS_CONSTANT / scene.gases[gas].molar_cv);
        gammas.fold(1.0, f64::max)
    };
    let lowest = scene.chambers.iter().map(|chamber| chamber.pressure).fold(f64::INFINITY, f64::min);
    let mut candidates = Vec::new();
    for chamber in &scene.chambers {
        candidates.push((chamber.temperature, format!("chamber `{}`", chamber.name)));
        if chamber.pressure > 1.001 * lowest {
            let filled = gamma(&chamber.mixture) * chamber.temperature;
            candidates.push((filled, format!("gamma T of chamber `{}`, which flows into thinner gas", chamber.name)));
        }
    }
    for orifice in &scene.orifices {
        let hottest = orifice.temperature.points.iter().map(|point| point[1]).fold(0.0, f64::max);
        let why = format!("gamma T0 of orifice `{}` (filling reaches gamma T0)", orifice.name);
        candidates.push((gamma(&orifice.mixture) * hottest, why));
    }
    for wall in &scene.walls {
        if let Some(heat) = &wall.heat {
            candidates.push((heat.temperature, format!("wall `{}`", wall.name)));
        }
    }
    candidates.into_iter().fold((0.0, String::new()), |best, next| if next.0 > best.0 { next } else { best })
}
