//! Exact injection through orifices (docs/explanation/method.md, "Inflow").
//!
//! **When.** Particle n of a gas enters when the moles of it that have flowed through all orifices reach (n + 1/2) nu, so the
//! injected mass is within half a particle of the curves' integral at every time, per gas. **Where.** Of the orifices that have
//! delivered more than their particles it enters that which is the first to have delivered a whole particle more than them.
//! So each orifice is within one particle of its own curve: windows as long as a particle each, and slots of their sum, always
//! leave room by the earliest end (Horn 1974). Orifices alike take turns. Of a gas of one orifice, particle j enters at
//! (j + 1/2) nu of it.
//!
//! **With what.** Without a jet the normal speed has the Maxwell speed distribution, pdf ~ v^2 exp(-m
//! v^2/2kT), i.e. m v^2/2kT is Gamma(3/2); tangential components are normal, spin is Gamma(zeta/2) kT (or as its
//! modes have it, see [`Species`]), all at the stagnation temperature T0 of the moment: the mean energy is exactly the
//! enthalpy h = (5 + zeta)/2 kT0.
//! With a jet a flux Maxwellian drifts at u, which is given, or by the Mach number M sqrt(gamma R Ts / M_mix), with
//! cp Ts + u^2/2 = cp T0, its direction uniform over the solid angle of the cone.
//!
//! **Energy debt.** Each orifice carries the sum of h - e over its particles. A particle pays a fraction of
//! the debt its predecessors left, by its spin (never below zero), or by its speed where zeta = 0 (energy
//! within a factor of 4, so that it still leaves the plane). The fraction of 1/8 leaves the distributions
//! nearly as sampled (it adds a/(2-a) = 7 % of a particle's energy variance) and keeps the debt at about two
//! standard deviations of one particle's energy. The last few particles of an orifice settle what is left, speed
//! included, so that after them the energy injected is the enthalpy injected.
//!
//! Invariants: ids are dense in order of entry over all orifices (ties by the first orifice of the gas, then by its mixture's order);
//! draws are keyed on the id only; the newborns do not depend on how the time is cut by
//! [`Inflow::take_until`].

mod jet;
mod schedule;

use serde::{Deserialize, Serialize};

use super::curve::{FlowIntegral, value_held};
use super::{Draws, Particle, Purpose, Species, thermo};
use crate::scene::{GAS_CONSTANT, Orifice};
use jet::JetFlow;
pub use jet::{jet_mach, jet_state};
use schedule::{Schedule, Stream};

/// Share of the debt that one particle pays.
const DEBT_SHARE: f64 = 0.125;
/// Particles at the end of an orifice's flow that settle the whole debt.
const SETTLING: u64 = 16;
/// Largest change of a particle's translational energy when speed pays.
const SPEED_PAYMENT: f64 = 4.0;

/// A particle that starts on an orifice's disc at a time, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Newborn {
    pub time: f64,
    /// Index of its orifice.
    pub orifice: usize,
    pub particle: Particle,
}

/// All the inflow of a run, in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Inflow {
    sources: Vec<Source>,
    streams: Vec<Stream>,
    /// One for each gas that flows, by its first stream.
    schedules: Vec<Schedule>,
    gases: Vec<Species>,
    moles_per_particle: f64,
    seed: u64,
    first_id: u32,
    entered: u64,
    enthalpy: f64,
}

/// What the gas that flows in is made of.
#[derive(Debug, Clone, Copy)]
pub struct InflowParticles<'a> {
    pub gases: &'a [Species],
    pub moles_per_particle: f64,
    pub seed: u64,
    /// The id of the first to enter.
    pub first_id: u32,
}

/// What has entered so far, beside what the scene says: with it a new inflow of the same scene goes on to the bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct InflowState {
    /// Particles taken of each stream: orifice-major, then the gases of its mixture.
    taken: Vec<u64>,
    /// J, of each orifice.
    debts: Vec<f64>,
    /// J.
    enthalpy: f64,
}

/// A state that is not one of this inflow.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum InflowStateError {
    #[error(
        "the state has {found_streams} flows of {found_orifices} orifices, \
         the scene has {expected_streams} of {expected_orifices}"
    )]
    Length { found_streams: usize, found_orifices: usize, expected_streams: usize, expected_orifices: usize },
    #[error("flow {stream} of the state has let {taken} particles in, the scene has {count} for it in all")]
    Taken { stream: usize, taken: u64, count: u64 },
    #[error("the energies of the state are not numbers")]
    Energy,
}

/// One orifice and its debt.
#[derive(Debug, Clone, PartialEq)]
struct Source {
    orifice: Orifice,
    /// Two unit vectors in the disc.
    tangents: [[f64; 3]; 2],
    /// Particles to come, at most.
    left: u64,
    debt: f64,
}

/// A flow that brings no particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unrepresented {
    pub orifice: usize,
    pub gas: usize,
    /// What of a particle flows.
    pub part: f64,
    /// And what of one brings one for certain.
    pub enough: f64,
}

impl Inflow {
    /// The inflow of a run from time 0 to `end_time` (s). Flows must not be negative; `first_id` +
    /// [`total`](Self::total) must fit 32 bits (held by `scene::load` and by the plan).
    pub fn new(orifices: &[Orifice], end_time: f64, particles: InflowParticles<'_>) -> Self {
        let InflowParticles { gases, moles_per_particle, seed, first_id } = particles;
        let mut streams = Vec::new();
        let mut sources = Vec::new();
        for (source, orifice) in orifices.iter().enumerate() {
            let flow = FlowIntegral::new(&orifice.mass_flow, end_time);
            let molar_mass = thermo::molar_mass(&orifice.mixture, gases);
            streams.extend(orifice.mixture.0.iter().map(|&(gas, fraction)| {
                let mass_per_particle = moles_per_particle * molar_mass / fraction;
                let most = (flow.total() / mass_per_particle).ceil() as u64;
                Stream { source, gas, flow: flow.clone(), mass_per_particle, most, taken: 0 }
            }));
            let tangents = tangents(orifice.direction);
            sources.push(Source { orifice: orifice.clone(), tangents, left: 0, debt: 0.0 });
        }
        let mut flowing: Vec<usize> = Vec::new();
        for stream in &streams {
            if !flowing.contains(&stream.gas) {
                flowing.push(stream.gas);
            }
        }
        let of_gas = |gas: &usize| Schedule::new(&streams, *gas, moles_per_particle, end_time);
        let schedules: Vec<Schedule> = flowing.iter().filter_map(of_gas).collect();
        for schedule in &schedules {
            if let [only] = schedule.streams[..] {
                streams[only].most = schedule.count;
            }
        }
        for stream in &streams {
            sources[stream.source].left += stream.most;
        }
        let gases = gases.to_vec();
        Self { sources, streams, schedules, gases, moles_per_particle, seed, first_id, entered: 0, enthalpy: 0.0 }
    }

    /// Particles of the whole run, taken and to come.
    pub fn total(&self) -> u64 {
        self.schedules.iter().map(|schedule| schedule.count).sum()
    }

    /// The same by gas.
    pub fn total_by_gas(&self) -> Vec<u64> {
        self.by_gas(|schedule| schedule.count)
    }

    /// Flows too small for a particle.
    pub fn without_particle(&self) -> Vec<Unrepresented> {
        let part = |stream: &Stream| stream.flow.total() / stream.mass_per_particle;
        let mut at_end = self.streams.clone();
        for schedule in &self.schedules {
            match schedule.streams[..] {
                [only] => at_end[only].taken = schedule.count,
                // Who brings a whole particle gets one.
                _ if schedule.streams.iter().all(|&stream| part(&self.streams[stream]) >= 1.0) => {
                    schedule.streams.iter().for_each(|&stream| at_end[stream].taken = 1);
                }
                _ => {
                    let mut schedule = schedule.clone();
                    while let Some(time) = schedule.next {
                        let stream = schedule.stream_at(time, &at_end);
                        at_end[stream].taken += 1;
                        schedule.take(schedule.taken + 1);
                    }
                }
            }
        }
        let is_alone = |gas| self.streams.iter().filter(|stream| stream.gas == gas).count() == 1;
        let none = at_end.iter().filter(|stream| stream.taken == 0);
        let found = none.map(|stream| Unrepresented {
            orifice: stream.source,
            gas: stream.gas,
            part: part(stream),
            enough: if is_alone(stream.gas) { 0.5 } else { 1.0 },
        });
        found.collect()
    }

    /// Particles taken so far, by gas.
    pub fn entered_by_gas(&self) -> Vec<u64> {
        self.by_gas(|schedule| schedule.taken)
    }

    /// Enthalpy of the particles taken so far at their temperatures of entry, J.
    pub fn enthalpy(&self) -> f64 {
        self.enthalpy
    }

    /// Enthalpy of the particles taken so far less their energy, J.
    pub fn debt(&self) -> f64 {
        self.sources.iter().map(|source| source.debt).sum()
    }

    /// The particles not yet taken that enter before `end` (s), in order of time.
    pub fn take_until(&mut self, end: f64) -> Vec<Newborn> {
        let mut newborns = Vec::new();
        while let Some((schedule, time)) = self.earliest().filter(|&(_, time)| time < end) {
            let schedule = &mut self.schedules[schedule];
            let stream = schedule.stream_at(time, &self.streams);
            schedule.take(schedule.taken + 1);
            self.streams[stream].taken += 1;
            newborns.push(self.emit(stream, time));
        }
        newborns
    }

    pub fn state(&self) -> InflowState {
        InflowState {
            taken: self.streams.iter().map(|stream| stream.taken).collect(),
            debts: self.sources.iter().map(|source| source.debt).collect(),
            enthalpy: self.enthalpy,
        }
    }

    /// Puts an inflow of the same scene where [`state`](Self::state) found one; on an error nothing is changed.
    ///
    /// # Errors
    /// If the state is that of another scene.
    pub fn restore(&mut self, state: &InflowState) -> Result<(), InflowStateError> {
        if (state.taken.len(), state.debts.len()) != (self.streams.len(), self.sources.len()) {
            return Err(InflowStateError::Length {
                found_streams: state.taken.len(),
                found_orifices: state.debts.len(),
                expected_streams: self.streams.len(),
                expected_orifices: self.sources.len(),
            });
        }
        for (stream, (&taken, &Stream { most, .. })) in state.taken.iter().zip(&self.streams).enumerate() {
            if taken > most {
                return Err(InflowStateError::Taken { stream, taken, count: most });
            }
        }
        let of_schedule = |schedule: &Schedule| schedule.streams.iter().map(|&stream| state.taken[stream]).sum::<u64>();
        if let Some(schedule) = self.schedules.iter().find(|schedule| of_schedule(schedule) > schedule.count) {
            let (taken, count) = (of_schedule(schedule), schedule.count);
            return Err(InflowStateError::Taken { stream: schedule.streams[0], taken, count });
        }
        if !state.debts.iter().chain([&state.enthalpy]).all(|energy| energy.is_finite()) {
            return Err(InflowStateError::Energy);
        }
        for (source, &debt) in self.sources.iter_mut().zip(&state.debts) {
            (source.debt, source.left) = (debt, 0);
        }
        for (stream, &taken) in self.streams.iter_mut().zip(&state.taken) {
            stream.taken = taken;
            self.sources[stream.source].left += stream.most - taken;
        }
        for schedule in &mut self.schedules {
            schedule.take(of_schedule(schedule));
        }
        self.entered = state.taken.iter().sum();
        self.enthalpy = state.enthalpy;
        Ok(())
    }

    fn by_gas(&self, number: impl Fn(&Schedule) -> u64) -> Vec<u64> {
        let mut sums = vec![0; self.gases.len()];
        for schedule in &self.schedules {
            sums[self.streams[schedule.streams[0]].gas] += number(schedule);
        }
        sums
    }

    /// Schedules lie in order of their first stream: the first of equals is the one of the lower index.
    fn earliest(&self) -> Option<(usize, f64)> {
        let next = self.schedules.iter().enumerate().filter_map(|(index, schedule)| Some((index, schedule.next?)));
        next.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    fn emit(&mut self, stream: usize, time: f64) -> Newborn {
        let Stream { source: orifice, gas, .. } = self.streams[stream];
        let id = self.first_id.wrapping_add(self.entered as u32);
        self.entered += 1;
        let source = &mut self.sources[orifice];
        source.left = source.left.saturating_sub(1);
        let species = &self.gases[gas];
        let temperature = value_held(&source.orifice.temperature, time);
        let enthalpy = species.enthalpy(self.moles_per_particle, temperature);
        self.enthalpy += enthalpy;
        let mass = species.molar_mass * self.moles_per_particle;

        let mut draws = Draws::new(self.seed, Purpose::Inflow, id);
        let position = source.point_on_disc(&mut draws);
        let (local, static_temperature) = match source.orifice.jet {
            None => (effusing_velocity(temperature, species, &mut draws), temperature),
            Some(jet) => {
                let flow = JetFlow::of(jet, temperature, &source.orifice.mixture, &self.gases);
                (flow.velocity(species, &mut draws), flow.temperature)
            }
        };
        let thermal_energy = self.moles_per_particle * GAS_CONSTANT * static_temperature;
        let mut spin_energy = species.draw_spin(thermal_energy, static_temperature, &mut draws);
        let translational = 0.5 * mass * local.iter().map(|v| v * v).sum::<f64>();

        let settling = source.left < SETTLING;
        let sampled = translational + spin_energy;
        let mut due = if settling { source.debt + enthalpy - sampled } else { DEBT_SHARE * source.debt };
        if species.has_spin() {
            let paid = due.max(-spin_energy);
            spin_energy += paid;
            due -= paid;
        }
        let mut factor = 1.0;
        if settling || !species.has_spin() {
            factor = (1.0 + due / translational).clamp(1.0 / SPEED_PAYMENT, SPEED_PAYMENT);
        }
        source.debt += enthalpy - (factor * translational + spin_energy);
        let velocity = source.to_global(local.map(|v| v * factor.sqrt()));
        Newborn { time, orifice, particle: Particle { id, gas: gas as u8, position, velocity, spin_energy } }
    }
}

/// Normal, then two tangential components, m/s: mean energy (5 + zeta)/2 kT with the spin.
fn effusing_velocity(temperature: f64, gas: &Species, draws: &mut Draws) -> [f64; 3] {
    let c0 = (GAS_CONSTANT * temperature / gas.molar_mass).sqrt();
    [c0 * (2.0 * draws.gamma(1.5)).sqrt(), c0 * draws.normal(), c0 * draws.normal()]
}

impl Source {
    fn point_on_disc(&self, draws: &mut Draws) -> [f64; 3] {
        let radius = (self.orifice.area / std::f64::consts::PI * draws.uniform()).sqrt();
        let angle = 2.0 * std::f64::consts::PI * draws.uniform();
        let offset = self.to_global([0.0, radius * libm::cos(angle), radius * libm::sin(angle)]);
        std::array::from_fn(|axis| self.orifice.position[axis] + offset[axis])
    }

    fn to_global(&self, local: [f64; 3]) -> [f64; 3] {
        let axes = [self.orifice.direction, self.tangents[0], self.tangents[1]];
        std::array::from_fn(|i| axes[0][i] * local[0] + axes[1][i] * local[1] + axes[2][i] * local[2])
    }
}

/// Two unit vectors perpendicular to a unit vector and to each other.
fn tangents(normal: [f64; 3]) -> [[f64; 3]; 2] {
    let normal = glam::DVec3::from_array(normal);
    // The axis the normal leans on least gives the best-conditioned cross product.
    let least = [glam::DVec3::X, glam::DVec3::Y, glam::DVec3::Z]
        .into_iter()
        .min_by(|a, b| normal.dot(*a).abs().total_cmp(&normal.dot(*b).abs()))
        .unwrap_or(glam::DVec3::X);
    let first = normal.cross(least).normalize();
    [first.to_array(), normal.cross(first).to_array()]
}

#[cfg(test)]
mod tests;
