//! One interval of steps: what it needs to run, and to run again. Its step size is fixed, its newborns are
//! known, and its tallies are read one interval late.

use crate::gas::{Inflow, Newborn};
use crate::gpu::{Device, PhaseTimer, Readback, TimedPass};
use crate::plan::Plan;
use crate::subdomain::{GpuNewborn, Remembered, Scales, Subdomain};

use super::SimulationError;
use super::step::{Sampling, step};

/// An interval as it was decided.
pub struct Interval {
    pub dt: f64,
    pub first_step: u64,
    pub steps: u32,
    /// Newborns of each step.
    pub newborns_of: Vec<u32>,
    pub newborns: Vec<GpuNewborn>,
    pub first_id: u32,
    /// Momentum that the newborns bring, kg m/s.
    pub momentum: [f64; 3],
}

/// An interval on its way through the device.
pub struct InFlight {
    pub interval: Interval,
    pub before: Remembered,
    pub readback: Readback,
    /// Phases of the timed step.
    pub phases: Vec<&'static str>,
    /// Particles at its end.
    pub particles: u32,
}

impl Interval {
    /// Takes the newborns of the interval from the inflow.
    pub fn new(
        plan: &Plan,
        inflow: &mut Inflow,
        start: f64,
        end: f64,
        first_step: u64,
        steps: u32,
    ) -> Result<Interval, SimulationError> {
        let dt = (end - start) / f64::from(steps);
        let scales = Scales::new(plan);
        let born: Vec<Newborn> = inflow.take_until(end);
        let first_id = born.first().map_or(0, |newborn| newborn.particle.id);
        let mut newborns_of = vec![0; steps as usize];
        let mut newborns = Vec::with_capacity(born.len());
        let mut momentum = [0.0; 3];
        for newborn in &born {
            let k = (((newborn.time - start) / dt) as usize).min(steps as usize - 1);
            let late = (newborn.time - start - k as f64 * dt).clamp(0.0, dt);
            newborns_of[k] += 1;
            let on_device = GpuNewborn::from_host(&newborn.particle, late, &plan.grid, &scales)?;
            let mass = plan.gases[usize::from(newborn.particle.gas)].molar_mass * plan.moles_per_particle;
            for (total, v) in momentum.iter_mut().zip(on_device.particle.velocity) {
                *total += mass * f64::from(v);
            }
            newborns.push(on_device);
        }
        Ok(Interval { dt, first_step, steps, newborns_of, newborns, first_id, momentum })
    }

    /// How many of its steps add to the zones.
    pub fn samples(&self, plan: &Plan) -> u32 {
        (0..self.steps).filter(|&k| tallied(plan, self.first_step + u64::from(k))).count() as u32
    }

    /// Encodes and submits the interval, `batch` steps a submission. Neither the batches nor the timed step
    /// change a bit of the result.
    pub fn submit(
        self,
        plan: &Plan,
        subdomain: &mut Subdomain,
        device: &Device,
        timer: Option<&PhaseTimer>,
        batch: u32,
        spare: Option<wgpu::Buffer>,
    ) -> Result<InFlight, SimulationError> {
        let before = subdomain.remember(device, spare)?;
        let slots = subdomain.begin_interval(
            device,
            self.first_step,
            self.dt,
            &self.newborns_of,
            &self.newborns,
            self.first_id,
        )?;
        let mut phases = Vec::new();
        let last = slots.len() - 1;
        let mut encoder = device.encoder();
        for (k, slot) in slots.iter().enumerate() {
            let sampling = Sampling { lost: k == 0, tally: tallied(plan, self.first_step + k as u64) };
            let timed = timer.filter(|_| k == last);
            let mut pass = TimedPass::new(&mut encoder, timed);
            step(subdomain, device, &mut pass, *slot, plan.rounds, sampling);
            if k == last {
                subdomain.tally_blocks(device, &mut pass, *slot);
            }
            let names = pass.end();
            if timed.is_some() {
                phases = names;
            }
            if k != last && (k as u32 + 1).is_multiple_of(batch.max(1)) {
                device.submit(std::mem::replace(&mut encoder, device.encoder()));
            }
        }
        let timed = timer.map(|timer| (timer, phases.len()));
        let staging = subdomain.encode_readback(device, &mut encoder, timed)?;
        let submission = device.submit(encoder);
        let readback = device.read_later(staging, submission);
        Ok(InFlight { before, readback, phases, particles: subdomain.count(), interval: self })
    }
}

/// Steps that add to the zones: a function of the step's number alone.
fn tallied(plan: &Plan, step: u64) -> bool {
    (step + 1).is_multiple_of(u64::from(plan.tally_every))
}
