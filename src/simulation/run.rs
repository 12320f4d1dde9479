//! The time loop.

use std::collections::VecDeque;

use crate::gas::Inflow;
use crate::gpu::{Device, PhaseTimer, TimedPass};
use crate::output::{Audit, PhaseTable};
use crate::subdomain::{GpuFlight, GpuParticle, Subdomain, Tallies};

use super::SimulationError;
use super::audit::Account;
use super::averages::{Averages, Row};
use super::clock::Clock;
use super::interval::{InFlight, Interval};
use super::ladder::{Demand, Ladder};
use super::model::Model;
use super::setup::{Setup, Shuffle, set_up};

/// Intervals under way at once. The step size of an interval is that which the state AHEAD intervals before
/// asked for, whether it could have been read sooner or not: so nothing that reads early changes a result.
const AHEAD: usize = 2;

/// What does not change a result.
#[derive(Clone, Copy, Default)]
pub struct Options<'a> {
    /// Steps per submission; `None` for a whole interval.
    pub batch: Option<u32>,
    /// Reorders the initial particles.
    pub shuffle: Option<&'a Shuffle>,
    /// Stop after this many steps (at the end of an interval); the rest of the scene is not simulated.
    pub stop_after_steps: Option<u64>,
}

/// Is told of the run as it goes.
pub trait Observer {
    /// A row of the history.
    ///
    /// # Errors
    /// What stops the run.
    fn row(&mut self, _row: &Row) -> Result<(), SimulationError> {
        Ok(())
    }

    /// The particles by id at a time (s).
    ///
    /// # Errors
    /// What stops the run.
    fn snapshot(&mut self, _time: f64, _particles: &[GpuParticle]) -> Result<(), SimulationError> {
        Ok(())
    }

    /// Totals so far: simulated time (s), steps, particle-steps.
    fn progress(&mut self, _time: f64, _steps: u64, _particle_steps: u64) {}
}

impl Observer for () {}

/// What a run leaves.
pub struct Outcome {
    /// By id.
    pub particles: Vec<GpuParticle>,
    pub audit: Audit,
    pub phases: PhaseTable,
    pub steps: u64,
    pub particle_steps: u64,
    pub collisions: u64,
    pub bounces: u64,
    /// s; the end time unless the run was stopped earlier.
    pub time: f64,
    /// Intervals that were run again with larger buffers.
    pub repeated: u32,
    /// Smallest and largest step taken, s.
    pub step_range: [f64; 2],
}

pub struct Simulation<'a> {
    model: &'a Model,
    device: &'a Device,
    subdomain: Subdomain,
    inflow: Inflow,
    clock: Clock,
    ladder: Ladder,
    averages: Averages,
    account: Account,
    timer: Option<PhaseTimer>,
    flying: VecDeque<InFlight>,
    /// What the states read so far ask of the step and no interval has followed yet, oldest first.
    demands: VecDeque<Demand>,
    submitted: usize,
    spare: Vec<wgpu::Buffer>,
    next_row: f64,
    next_snapshot: u32,
    /// End of the last interval that was read, s.
    read_until: f64,
    repeated: u32,
    options: Options<'a>,
}

impl<'a> Simulation<'a> {
    /// # Errors
    /// If the scene does not fit the device, or its gas does not fit its walls.
    pub fn new(model: &'a Model, device: &'a Device, options: Options<'a>) -> Result<Simulation<'a>, SimulationError> {
        let plan = &model.plan;
        let Setup { subdomain, layout, patches } = set_up(model, device, options.shuffle)?;
        let volumes = crate::geometry::block_volumes(&model.vessel, &plan.grid, plan.block_cells_log2);
        let first_id = plan.initial_particles as u32;
        let scene = &model.scene;
        let inflow =
            Inflow::new(&scene.orifices, &scene.gases, plan.moles_per_particle, plan.seed, first_id, plan.end_time);
        Ok(Simulation {
            subdomain,
            inflow,
            clock: Clock::new(plan),
            ladder: Ladder::new(plan, volumes),
            averages: Averages::new(plan, layout, patches),
            account: Account::new(plan),
            timer: PhaseTimer::new(device)?,
            flying: VecDeque::new(),
            demands: VecDeque::new(),
            submitted: 0,
            spare: Vec::new(),
            next_row: plan.end_time / f64::from(scene.output.rows.max(1)),
            next_snapshot: 0,
            read_until: 0.0,
            repeated: 0,
            options,
            model,
            device,
        })
    }

    /// Runs to the end of the scene.
    ///
    /// # Errors
    /// If the device fails, a particle, mass or energy is lost, or the observer stops the run.
    pub fn run(mut self, observer: &mut dyn Observer) -> Result<Outcome, SimulationError> {
        self.begin(observer)?;
        while self.advance(observer)? {}
        self.finish(observer)
    }

    /// Takes the account of the initial state; comes before the first [`Simulation::advance`].
    ///
    /// # Errors
    /// As [`Simulation::run`].
    pub fn begin(&mut self, observer: &mut dyn Observer) -> Result<(), SimulationError> {
        let at_start = self.measure()?;
        self.account.start(&at_start);
        let demand = self.ladder.demand(&at_start.blocks, &at_start.fast);
        self.ladder.start(demand).map_err(|source| SimulationError::Ladder { time: 0.0, source })?;
        self.snapshot(observer)
    }

    /// Reads an interval that is done and submits one; false, and nothing is done, where the run has
    /// reached its end.
    ///
    /// # Errors
    /// As [`Simulation::run`].
    pub fn advance(&mut self, observer: &mut dyn Observer) -> Result<bool, SimulationError> {
        if self.clock.done() || self.stopped() {
            return Ok(false);
        }
        while self.flying.len() >= AHEAD {
            self.read_oldest(observer)?;
        }
        self.submit_next()?;
        if self.snapshot_due() {
            self.read_all(observer)?;
            self.snapshot(observer)?;
        }
        Ok(true)
    }

    /// Reads what is under way and closes the account.
    ///
    /// # Errors
    /// As [`Simulation::run`].
    pub fn finish(mut self, observer: &mut dyn Observer) -> Result<Outcome, SimulationError> {
        self.read_all(observer)?;
        if self.averages.ready() {
            self.emit_row(observer)?;
        }
        let at_end = self.measure()?;
        let mut particles = self.subdomain.particles(self.device)?;
        particles.sort_unstable_by_key(GpuParticle::id);
        let audit = self.account.close(self.model, &self.inflow, &at_end, &particles, &self.averages);
        Ok(Outcome {
            particles,
            audit,
            phases: self.account.phases(),
            steps: self.clock.steps,
            particle_steps: self.account.particle_steps,
            collisions: self.account.collisions,
            bounces: self.account.bounces,
            time: self.clock.time(),
            repeated: self.repeated,
            step_range: self.account.step_range,
        })
    }

    fn stopped(&self) -> bool {
        self.options.stop_after_steps.is_some_and(|most| self.clock.steps >= most)
    }

    /// Tallies of the particles as they are.
    fn measure(&mut self) -> Result<Tallies, SimulationError> {
        let slot = self.subdomain.at_rest(self.device);
        let mut encoder = self.device.encoder();
        let mut pass = TimedPass::new(&mut encoder, None);
        self.subdomain.tally(self.device, &mut pass, slot);
        self.subdomain.tally_blocks(self.device, &mut pass, slot);
        pass.end();
        let staging = self.subdomain.encode_readback(self.device, &mut encoder, None)?;
        let submission = self.device.submit(encoder);
        let readback = self.device.read_later(staging, submission);
        Ok(self.subdomain.finish_readback(self.device, readback)?.0)
    }

    fn submit_next(&mut self) -> Result<(), SimulationError> {
        let plan = &self.model.plan;
        if self.submitted >= AHEAD
            && let Some(demand) = self.demands.pop_front()
        {
            let time = self.clock.time();
            self.ladder.follow(demand).map_err(|source| SimulationError::Ladder { time, source })?;
        }
        self.submitted += 1;
        let (level, steps) = self.clock.interval(self.ladder.level(), plan.steps_per_interval);
        let (start, first_step) = (self.clock.time(), self.clock.steps);
        self.clock.advance(level, steps);
        let end = self.clock.time();
        let interval = Interval::new(plan, &mut self.inflow, start, end, first_step, steps)?;
        self.submit(interval)
    }

    fn submit(&mut self, interval: Interval) -> Result<(), SimulationError> {
        let batch = self.options.batch.unwrap_or(self.model.plan.steps_per_interval);
        let (plan, spare) = (&self.model.plan, self.spare.pop());
        let flying = interval.submit(plan, &mut self.subdomain, self.device, self.timer.as_ref(), batch, spare)?;
        self.flying.push_back(flying);
        Ok(())
    }

    fn read_all(&mut self, observer: &mut dyn Observer) -> Result<(), SimulationError> {
        while !self.flying.is_empty() {
            self.read_oldest(observer)?;
        }
        Ok(())
    }

    fn read_oldest(&mut self, observer: &mut dyn Observer) -> Result<(), SimulationError> {
        let Some(InFlight { interval, before, readback, phases, particles }) = self.flying.pop_front() else {
            return Ok(());
        };
        let (tallies, stamps) = self.subdomain.finish_readback(self.device, readback)?;
        if tallies.counters.most_neighbours > 0 {
            return self.run_again(interval, before, tallies.counters.most_neighbours);
        }
        self.spare.push(before.particles);
        let duration = interval.dt * f64::from(interval.steps);
        self.read_until += duration;
        let lost = |what: String| SimulationError::Lost { time: self.read_until, what };
        self.account.check(&tallies, particles).map_err(lost)?;
        let timed = self.timer.as_ref().map(|timer| timer.seconds(&phases, &stamps)).unwrap_or_default();
        let plan = &self.model.plan;
        let samples = interval.samples(plan);
        self.account.add(plan, &tallies, &interval, samples, particles, &timed);
        self.averages.add(&tallies, interval.dt, interval.steps, samples);
        self.demands.push_back(self.ladder.demand(&tallies.blocks, &tallies.fast));
        if self.read_until >= self.next_row * (1.0 - 1e-9) && self.averages.ready() {
            self.emit_row(observer)?;
        }
        observer.progress(
            self.read_until,
            interval.first_step + u64::from(interval.steps),
            self.account.particle_steps,
        );
        Ok(())
    }

    fn emit_row(&mut self, observer: &mut dyn Observer) -> Result<(), SimulationError> {
        let row = self.averages.row(self.read_until, self.account.particles);
        let spacing = self.model.plan.end_time / f64::from(self.model.scene.output.rows.max(1));
        while self.next_row <= self.read_until * (1.0 + 1e-9) {
            self.next_row += spacing;
        }
        observer.row(&row)
    }

    /// Runs an interval, and those submitted since, again with neighbour lists of at least `wanted`.
    fn run_again(
        &mut self,
        first: Interval,
        before: crate::subdomain::Remembered,
        wanted: u32,
    ) -> Result<(), SimulationError> {
        self.repeated += 1;
        tracing::debug!("neighbour lists grow to {wanted}; an interval is run again");
        let later: Vec<InFlight> = self.flying.drain(..).collect();
        for flight in &later {
            self.device.wait(flight.readback.submission())?;
        }
        self.subdomain.restore(self.device, &before);
        self.subdomain.make_room(self.device, 0, wanted)?;
        self.spare.push(before.particles);
        self.submit(first)?;
        for flight in later {
            self.spare.push(flight.before.particles);
            self.submit(flight.interval)?;
        }
        Ok(())
    }

    fn snapshot_due(&self) -> bool {
        let asked = self.model.scene.output.snapshots;
        let due = f64::from(self.next_snapshot) / f64::from(asked.max(1));
        asked > 0 && (self.clock.progress() >= due * (1.0 - 1e-12) || self.clock.done())
    }

    fn snapshot(&mut self, observer: &mut dyn Observer) -> Result<(), SimulationError> {
        let asked = self.model.scene.output.snapshots;
        if asked == 0 {
            return Ok(());
        }
        let mut particles = self.subdomain.particles(self.device)?;
        particles.sort_unstable_by_key(GpuParticle::id);
        observer.snapshot(self.clock.time(), &particles)?;
        while self.snapshot_due() && self.next_snapshot <= asked {
            self.next_snapshot += 1;
        }
        Ok(())
    }

    /// The flights of the last step of the run so far, with ids, in the order of [`Simulation::particles`]: for tests and studies of single steps.
    ///
    /// # Errors
    /// If the device fails.
    pub fn flights(&self) -> Result<Vec<(u32, GpuFlight)>, SimulationError> {
        let particles = self.subdomain.particles(self.device)?;
        let flights = self.subdomain.flights(self.device)?;
        Ok(particles.iter().map(GpuParticle::id).zip(flights).collect())
    }

    /// The particles, in the order of the device.
    ///
    /// # Errors
    /// If the device fails.
    pub fn particles(&self) -> Result<Vec<GpuParticle>, SimulationError> {
        Ok(self.subdomain.particles(self.device)?)
    }
}
