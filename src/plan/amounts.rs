//! The gas of the whole run in moles and joules, before it is cut into particles.

use super::{Measured, PlanError};
use crate::gas::{FlowIntegral, Species, flow_times_of_temperature, flow_times_temperature, moles_at, thermo};
use crate::scene::{GAS_CONSTANT, Mixture, Orifice, Scene};

pub struct Amounts {
    /// mol by chamber, then gas.
    pub initial: Vec<Vec<f64>>,
    /// mol by gas, from time 0 to the end.
    pub injected: Vec<f64>,
    /// K, that of the energy U of all initial gas, and of all gas at the end of a closed adiabatic run.
    pub initial_temperature: f64,
    pub final_temperature: f64,
}

impl Amounts {
    pub fn of(scene: &Scene, species: &[Species], measured: &Measured) -> Result<Self, PlanError> {
        let (volumes, chambers) = (measured.chamber_volumes.len(), scene.chambers.len());
        if volumes != chambers {
            return Err(PlanError::Volumes { volumes, chambers });
        }
        let mut initial = Vec::with_capacity(chambers);
        let mut heat = Heat::new(species);
        for (chamber, &volume) in scene.chambers.iter().zip(&measured.chamber_volumes) {
            if !(volume > 0.0 && volume.is_finite()) {
                return Err(PlanError::NoVolume { chamber: chamber.name.clone(), volume });
            }
            let moles = moles_at(chamber.pressure, volume, chamber.temperature);
            heat.add(moles, &chamber.mixture, chamber.temperature);
            let mut by_gas = vec![0.0; scene.gases.len()];
            for &(gas, fraction) in &chamber.mixture.0 {
                by_gas[gas] += moles * fraction;
            }
            initial.push(by_gas);
        }
        let initial_temperature = heat.temperature();
        let mut injected = vec![0.0; scene.gases.len()];
        for orifice in &scene.orifices {
            let molar_mass = thermo::molar_mass(&orifice.mixture, species);
            let moles = FlowIntegral::new(&orifice.mass_flow, scene.end_time).total() / molar_mass;
            for &(gas, fraction) in &orifice.mixture.0 {
                injected[gas] += moles * fraction;
            }
            heat.inject(moles, orifice, molar_mass, scene.end_time);
        }
        let amounts = Self { initial, injected, initial_temperature, final_temperature: heat.temperature() };
        if amounts.total() > 0.0 { Ok(amounts) } else { Err(PlanError::NoGas) }
    }

    pub fn initial_total(&self) -> f64 {
        self.initial.iter().flatten().sum()
    }

    pub fn total(&self) -> f64 {
        self.initial_total() + self.injected.iter().sum::<f64>()
    }

    /// kg, all gas at the end of a closed run.
    pub fn mass(&self, scene: &Scene) -> f64 {
        scene.gases.iter().enumerate().map(|(index, gas)| self.of_gas(index) * gas.molar_mass).sum()
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

/// Energy and heat capacity of gas that is put together, and so its temperature.
struct Heat<'a> {
    species: &'a [Species],
    /// mol by gas.
    moles: Vec<f64>,
    /// J.
    energy: f64,
    /// sum n cv where no heat capacity depends on the temperature, J/K.
    capacity: f64,
}

impl<'a> Heat<'a> {
    fn new(species: &'a [Species]) -> Heat<'a> {
        Heat { species, moles: vec![0.0; species.len()], energy: 0.0, capacity: 0.0 }
    }

    fn count(&mut self, moles: f64, mixture: &Mixture) {
        for &(gas, fraction) in &mixture.0 {
            self.moles[gas] += moles * fraction;
        }
        if thermo::is_constant(mixture, self.species) {
            self.capacity += moles * thermo::molar_cv(mixture, self.species, 0.0);
        }
    }

    fn add(&mut self, moles: f64, mixture: &Mixture, temperature: f64) {
        self.count(moles, mixture);
        self.energy += if thermo::is_constant(mixture, self.species) {
            moles * thermo::molar_cv(mixture, self.species, temperature) * temperature
        } else {
            moles * mixture.0.iter().map(|&(gas, x)| self.species[gas].energy(x, temperature)).sum::<f64>()
        };
    }

    /// The enthalpy of an orifice's whole flow.
    fn inject(&mut self, moles: f64, orifice: &Orifice, molar_mass: f64, end_time: f64) {
        self.count(moles, &orifice.mixture);
        let (flow, temperature) = (&orifice.mass_flow, &orifice.temperature);
        self.energy += if thermo::is_constant(&orifice.mixture, self.species) {
            let cv = thermo::molar_cv(&orifice.mixture, self.species, 0.0);
            (cv + GAS_CONSTANT) / molar_mass * flow_times_temperature(flow, temperature, end_time)
        } else {
            let enthalpy = |t: f64| thermo::molar_enthalpy(&orifice.mixture, self.species, t) / molar_mass;
            flow_times_of_temperature(flow, temperature, end_time, enthalpy)
        };
    }

    /// K; 0 without gas.
    fn temperature(&self) -> f64 {
        if self.species.iter().all(Species::is_constant) {
            return self.energy / self.capacity.max(f64::MIN_POSITIVE);
        }
        thermo::temperature(&self.moles, self.species, self.energy)
    }
}

/// Gas at rest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Contents {
    /// m3.
    pub volume: f64,
    /// kg.
    pub mass: f64,
    /// Pa.
    pub pressure: f64,
    /// K.
    pub temperature: f64,
}

/// Whether any of its gas enters before the end, s.
pub fn delivers(orifice: &Orifice, end_time: f64) -> bool {
    FlowIntegral::new(&orifice.mass_flow, end_time).total() > 0.0
}

/// The highest temperature the scene can reach, K, and why: a chamber's own, that of a wall, or that of gas which flows
/// into a chamber (an orifice, a neighbour of higher pressure) and is stopped there, gamma T0 at most.
pub fn highest_temperature(scene: &Scene, measured: &Measured) -> (f64, String) {
    // A heat capacity that grows with the temperature makes it less hot than gamma(T0) T0.
    let gamma = |mixture: &Mixture, temperature: f64| {
        let cv = |gas: usize| scene.gases[gas].heat.molar_cv(temperature).max(1.5 * GAS_CONSTANT);
        mixture.0.iter().map(|&(gas, _)| 1.0 + GAS_CONSTANT / cv(gas)).fold(1.0, f64::max)
    };
    let lowest = scene.chambers.iter().map(|chamber| chamber.pressure).fold(f64::INFINITY, f64::min);
    let mut candidates = Vec::new();
    for chamber in &scene.chambers {
        candidates.push((chamber.temperature, format!("chamber `{}`", chamber.name)));
        if chamber.pressure > 1.001 * lowest {
            let filled = gamma(&chamber.mixture, chamber.temperature) * chamber.temperature;
            candidates.push((filled, format!("gamma T of chamber `{}`, which flows into thinner gas", chamber.name)));
        }
    }
    for orifice in scene.orifices.iter().filter(|orifice| delivers(orifice, scene.end_time)) {
        let hottest = orifice.temperature.points.iter().map(|point| point[1]).fold(0.0, f64::max);
        let why = format!("gamma T0 of orifice `{}` (filling reaches gamma T0)", orifice.name);
        candidates.push((gamma(&orifice.mixture, hottest) * hottest, why));
    }
    for (id, heat) in scene.heated_surfaces() {
        candidates.push((heat.temperature, scene.surface_title(id)));
    }
    let (hottest, why) =
        candidates.into_iter().fold((0.0, String::new()), |best, next| if next.0 > best.0 { next } else { best });
    match &measured.motion {
        None => (hottest, why),
        Some(motion) => {
            let times = super::motion::heating(scene, motion, hottest);
            (times * hottest, format!("{why}, {times:.2} times as hot by the walls that move"))
        }
    }
}
