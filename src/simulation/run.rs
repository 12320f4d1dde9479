//! The time loop of a rank.
//!
//! Every rank takes the same decisions, since they follow from tallies summed over all ranks, and runs the same
//! host code on the inflow. Rank 0 tells the observer.

use std::collections::VecDeque;
use std::time::Instant;

use crate::gas::Inflow;
use crate::gpu::{Device, PhaseTimer, Recording};
use crate::output::{Audit, PhaseTable};
use crate::ranks::{Communicator, Solo};
use crate::subdomain::{GpuFlight, GpuParticle, Place, Subdomain, Tallies};

use super::SimulationError;
use super::audit::{Account, count_outside};
use super::averages::{Averages, Row};
use super::balance::{Balance, BalanceOptions, BalanceRecord, Load};
use super::clock::Clock;
use super::decomposition::Decomposition;
use super::exchange::{Exchange, Traffic};
use super::interrupt::Request;
use super::interval::{Deal, InFlight, Interval, Machine, Pending};
use super::ladder::{Demand, Ladder};
use super::model::Model;
use super::run_state::{RunState, StateError as RunStateError};
use super::setup::{Setup, Shuffle};
use super::tuning::Tuner;

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
    /// Where the run stops before the end of the scene because of `stop_after_steps`, it is continuable from there.
    pub checkpoint_at_stop: bool,
    /// Rounds of collisions between two exchanges of ghosts; `None` tries what is fastest. The halo has twice as
    /// many layers of cells.
    pub halo_rounds: Option<u32>,
    pub balance: BalanceOptions,
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

    /// The particles by id at a time (s), and the rank that owns each.
    ///
    /// # Errors
    /// What stops the run.
    fn snapshot(&mut self, _time: f64, _particles: &[GpuParticle], _owners: &[u32]) -> Result<(), SimulationError> {
        Ok(())
    }

    /// The boxes of the ranks, by rank, as low and high corner (m): at a snapshot, before it.
    fn boxes(&mut self, _boxes: &[[[f64; 3]; 2]]) {}

    /// What the ranks had to do in an interval.
    ///
    /// # Errors
    /// What stops the run.
    fn balance(&mut self, _record: &BalanceRecord) -> Result<(), SimulationError> {
        Ok(())
    }

    /// Asked on every rank once per interval: what this rank wants done soon. The most that any wants is done.
    fn request(&mut self, _steps: u64) -> Request {
        Request::None
    }

    /// A moment at which the run can be continued, on every rank. Collective.
    ///
    /// # Errors
    /// What stops the run.
    fn checkpoint(&mut self, _moment: &Moment<'_>) -> Result<(), SimulationError> {
        Ok(())
    }

    /// Totals so far: simulated time (s), steps, particle-steps.
    fn progress(&mut self, _time: f64, _steps: u64, _particle_steps: u64) {}
}

impl Observer for () {}

/// All that a run needs to be continued, on one rank.
pub struct Moment<'a> {
    pub step: u64,
    /// s.
    pub time: f64,
    /// Particles, those that entered and the initial ones.
    pub particles: u64,
    pub state: &'a RunState,
    /// Of this rank.
    pub own: &'a [GpuParticle],
    pub comm: &'a dyn Communicator,
    /// The run stops here because it was asked to.
    pub stopping: bool,
}

/// What a run leaves.
pub struct Outcome {
    /// By id; on rank 0.
    pub particles: Vec<GpuParticle>,
    /// The rank that owned each of them.
    pub owners: Vec<u32>,
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
    /// What this rank sent and waited for.
    pub traffic: Traffic,
    pub balance: Vec<BalanceRecord>,
    /// Wall time of the steps, s: without the set-up, and without the account at the end.
    pub stepping_seconds: f64,
}

/// Particles by id, and the rank that owns each.
type Owned = (Vec<GpuParticle>, Vec<u32>);

/// The ranks of a run.
enum Ranks<'a> {
    Alone(Solo),
    Among(&'a dyn Communicator),
}

impl Ranks<'_> {
    fn comm(&self) -> &dyn Communicator {
        match self {
            Ranks::Alone(solo) => solo,
            Ranks::Among(comm) => *comm,
        }
    }
}

pub struct Simulation<'a> {
    model: &'a Model,
    device: &'a Device,
    ranks: Ranks<'a>,
    subdomain: Subdomain,
    exchange: Exchange<'a>,
    /// `None` on a rank alone, and where particles are dealt out by their ids.
    decomposition: Option<Decomposition>,
    balance: Balance,
    tuner: Tuner,
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
    /// What this rank wants done, and what the ranks want, by the intervals read.
    wish: Request,
    request: Request,
    stopping: bool,
    /// The run goes on from a state; its start has been accounted for.
    resumed: bool,
    options: Options<'a>,
    /// The steps began.
    began: Instant,
}

impl<'a> Simulation<'a> {
    /// A run on one device.
    ///
    /// # Errors
    /// If the scene does not fit the device, or its gas does not fit its walls.
    pub fn new(model: &'a Model, device: &'a Device, options: Options<'a>) -> Result<Simulation<'a>, SimulationError> {
        let setup = Setup::new(model, device, 1, options.shuffle)?;
        Simulation::on(model, device, &setup, Ranks::Alone(Solo::new()), options)
    }

    /// One rank of a run. Collective: all ranks make theirs, with the same model and options, from a set-up for
    /// their number.
    ///
    /// # Errors
    /// As [`Simulation::new`], or if there are more ranks than cells.
    pub fn among(
        model: &'a Model,
        device: &'a Device,
        setup: &Setup,
        comm: &'a dyn Communicator,
        options: Options<'a>,
    ) -> Result<Simulation<'a>, SimulationError> {
        Simulation::on(model, device, setup, Ranks::Among(comm), options)
    }

    fn on(
        model: &'a Model,
        device: &'a Device,
        setup: &Setup,
        ranks: Ranks<'a>,
        options: Options<'a>,
    ) -> Result<Simulation<'a>, SimulationError> {
        let comm = ranks.comm();
        let plan = &model.plan;
        let initial = setup.particles.iter().copied();
        let (size, rank) = (comm.size() as u32, comm.rank() as u32);
        let mut decomposition = None;
        let own: Vec<GpuParticle> = if setup.domain.features().halo {
            let rounds = Tuner::new(plan.rounds, options.halo_rounds).first();
            let cut_by = setup.cut_by.as_ref().unwrap_or(&setup.particles);
            let weighed = options.balance.at_start().then(|| cut_by.as_slice());
            let cut = Decomposition::new(plan, comm, rounds, weighed)?;
            decomposition.insert(cut).own(plan, initial).collect()
        } else {
            initial.filter(|particle| particle.id() % size == rank).collect()
        };
        let place = decomposition.as_ref().map_or_else(|| Place::alone(plan), |cut| cut.place().1);
        let subdomain = Subdomain::new(device, setup.domain.clone(), place, &own)?;
        let first_id = plan.initial_particles as u32;
        let scene = &model.scene;
        let inflow =
            Inflow::new(&scene.orifices, &scene.gases, plan.moles_per_particle, plan.seed, first_id, plan.end_time);
        Ok(Simulation {
            subdomain,
            exchange: match ranks {
                Ranks::Alone(_) => Exchange::none(),
                Ranks::Among(comm) => Exchange::new(comm),
            },
            decomposition,
            balance: Balance::new(options.balance, comm.size()),
            tuner: Tuner::new(plan.rounds, options.halo_rounds),
            inflow,
            clock: Clock::new(plan),
            ladder: Ladder::new(plan, setup.volumes.to_vec()),
            averages: Averages::new(plan, setup.layout.clone(), setup.patches),
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
            began: Instant::now(),
            wish: Request::None,
            request: Request::None,
            stopping: false,
            resumed: false,
            options,
            model,
            device,
            ranks,
        })
    }

    /// One rank of a run that goes on from a state: `setup` has the particles of that moment.
    ///
    /// # Errors
    /// As [`Simulation::among`], or if the state is of another run.
    pub fn resume(
        model: &'a Model,
        device: &'a Device,
        setup: &Setup,
        comm: &'a dyn Communicator,
        options: Options<'a>,
        state: &RunState,
    ) -> Result<Simulation<'a>, SimulationError> {
        let mut simulation = Simulation::among(model, device, setup, comm, options)?;
        simulation.clock.restore(&state.clock)?;
        simulation.ladder.restore(&state.ladder)?;
        simulation.averages.restore(&state.averages)?;
        simulation.account.restore(&model.plan, &state.account)?;
        simulation.inflow.restore(&state.inflow).map_err(RunStateError::from)?;
        simulation.demands = state.demands.iter().copied().collect();
        simulation.submitted = state.submitted as usize;
        simulation.next_row = state.next_row;
        simulation.next_snapshot = state.next_snapshot;
        simulation.read_until = state.read_until;
        simulation.repeated = state.repeated;
        simulation.resumed = true;
        Ok(simulation)
    }

    fn state(&self) -> RunState {
        RunState {
            clock: self.clock.state(),
            ladder: self.ladder.state(),
            averages: self.averages.state(),
            account: self.account.state().clone(),
            inflow: self.inflow.state(),
            demands: self.demands.iter().copied().collect(),
            submitted: self.submitted as u64,
            next_row: self.next_row,
            next_snapshot: self.next_snapshot,
            read_until: self.read_until,
            repeated: self.repeated,
        }
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
        self.began = Instant::now();
        if self.resumed {
            return Ok(());
        }
        let at_start = self.measure()?;
        self.account.start(&at_start);
        let demand = self.ladder.demand(&at_start.blocks, &at_start.fast);
        self.ladder.start(demand).map_err(|source| SimulationError::Ladder { time: 0.0, source })?;
        self.snapshot(observer)?;
        self.began = Instant::now();
        Ok(())
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
        self.wish = self.wish.max(observer.request(self.clock.steps));
        if self.request != Request::None {
            self.checkpoint(observer)?;
            if self.stopping {
                return Ok(false);
            }
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
        if self.options.checkpoint_at_stop && self.stopped() && !self.stopping && !self.clock.done() {
            self.checkpoint(observer)?;
        }
        let stepping_seconds = self.began.elapsed().as_secs_f64();
        if self.averages.ready() {
            self.emit_row(observer)?;
        }
        let at_end = self.measure()?;
        let own = self.subdomain.particles(self.device)?;
        let outside = count_outside(&self.model.vessel, &self.model.plan, &own);
        let outside = self.ranks.comm().sum(vec![outside])?[0];
        let audit = self.account.close(self.model, &self.inflow, &at_end, outside, &self.averages);
        let (particles, owners) = self.gather(own)?.unwrap_or_default();
        Ok(Outcome {
            particles,
            owners,
            traffic: self.exchange.traffic(),
            balance: self.balance.into_records(),
            audit,
            phases: self.account.phases(),
            steps: self.clock.steps,
            particle_steps: self.account.state().particle_steps,
            collisions: self.account.state().collisions,
            bounces: self.account.state().bounces,
            time: self.clock.time(),
            repeated: self.repeated,
            step_range: self.account.state().step_range,
            stepping_seconds,
        })
    }

    /// A checkpoint, with nothing under way.
    fn checkpoint(&mut self, observer: &mut dyn Observer) -> Result<(), SimulationError> {
        self.read_all(observer)?;
        self.stopping = self.request == Request::CheckpointAndStop;
        (self.wish, self.request) = (Request::None, Request::None);
        let own = self.subdomain.particles(self.device)?;
        let entered = self.inflow.entered_by_gas().iter().sum::<u64>();
        observer.checkpoint(&Moment {
            step: self.clock.steps,
            time: self.clock.time(),
            particles: self.model.plan.initial_particles + entered,
            state: &self.state(),
            own: &own,
            comm: self.ranks.comm(),
            stopping: self.stopping,
        })
    }

    fn stopped(&self) -> bool {
        self.options.stop_after_steps.is_some_and(|most| self.clock.steps >= most)
    }

    /// Tallies of the particles as they are, of all ranks.
    fn measure(&mut self) -> Result<Tallies, SimulationError> {
        let slot = self.subdomain.at_rest(self.device);
        let mut rec = Recording::new(self.device);
        self.subdomain.tally(&mut rec, &slot);
        self.subdomain.tally_blocks(&mut rec, &slot);
        let staging = self.subdomain.encode_readback(&mut rec, None)?;
        let submission = rec.submit();
        let readback = self.device.read_later(staging, submission);
        let own = self.subdomain.finish_readback(self.device, readback)?.0;
        let (sums, maxima) = own.to_words();
        let reduction = self.ranks.comm().start_reduction(sums, maxima)?;
        let (sums, maxima) = self.ranks.comm().finish_reduction(reduction)?;
        all_tallies(&own, &sums, &maxima)
    }

    fn submit_next(&mut self) -> Result<(), SimulationError> {
        let plan = &self.model.plan;
        if self.submitted >= AHEAD
            && let Some(demand) = self.demands.pop_front()
        {
            let time = self.clock.time();
            self.ladder.follow(demand).map_err(|source| SimulationError::Ladder { time, source })?;
        }
        if let Some(decomposition) = &mut self.decomposition {
            let (subdomain, comm) = (&mut self.subdomain, self.ranks.comm());
            let seconds = self.balance.act(self.clock.steps, self.device, subdomain, comm, decomposition)?;
            self.exchange.rebalanced(seconds);
            if decomposition.set_rounds(self.tuner.next()) {
                decomposition.apply(self.device, &mut self.subdomain, &mut self.exchange)?;
            }
        }
        self.submitted += 1;
        let (level, steps) = self.clock.interval(self.ladder.level(), plan.steps_per_interval);
        let (start, first_step) = (self.clock.time(), self.clock.steps);
        self.clock.advance(level, steps);
        let end = self.clock.time();
        let deal = match self.decomposition {
            None => Deal::ById { rank: self.ranks.comm().rank() as u32, ranks: self.ranks.comm().size() as u32 },
            Some(_) => Deal::All,
        };
        let interval = Interval::new(plan, &mut self.inflow, start, end, first_step, steps, deal)?;
        self.submit(interval)
    }

    fn submit(&mut self, interval: Interval) -> Result<(), SimulationError> {
        let batch = self.options.batch.unwrap_or(self.model.plan.steps_per_interval);
        let spare = self.spare.pop();
        let mut machine = Machine {
            plan: &self.model.plan,
            device: self.device,
            subdomain: &mut self.subdomain,
            exchange: &mut self.exchange,
            decomposition: self.decomposition.as_mut(),
            timer: self.timer.as_ref(),
            batch,
        };
        let flying = machine.submit(interval, spare)?;
        // The one before is done, or nearly: its sums are formed while this one runs.
        if self.ranks.comm().size() > 1
            && let Some(before) = self.flying.pop_back()
        {
            let reducing = self.reduce(before)?;
            self.flying.push_back(reducing);
        }
        self.flying.push_back(flying);
        Ok(())
    }

    /// Takes an interval's tallies from the device and starts to sum them over the ranks.
    fn reduce(&mut self, mut flight: InFlight) -> Result<InFlight, SimulationError> {
        if let Pending::OnDevice(readback) = flight.tallies {
            let (own, stamps) = self.subdomain.finish_readback(self.device, readback)?;
            let (mut sums, mut maxima) = own.to_words();
            maxima.push(self.wish.weight());
            let seconds = self.step_seconds(&flight.phases, &stamps, &flight.traffic);
            sums.extend(Load::new(seconds, flight.present, &own, &flight.traffic).to_words(self.ranks.comm()));
            let reduction = self.ranks.comm().start_reduction(sums, maxima)?;
            flight.tallies = Pending::Reducing(Box::new(own), stamps, reduction);
        }
        Ok(flight)
    }

    /// Device time of the timed step, s; on a device that does not time, from submissions to their ends, of the
    /// mean step of the interval.
    fn step_seconds(&self, phases: &[&'static str], stamps: &[u8], traffic: &Traffic) -> f64 {
        match &self.timer {
            Some(timer) => timer.seconds(phases, stamps).iter().map(|(_, seconds)| seconds).sum(),
            None => traffic.device_seconds / traffic.steps.max(1) as f64,
        }
    }

    /// The tallies of all ranks, the stamps of this one, and every rank's load.
    fn collect(&mut self, tallies: Pending) -> Result<(Tallies, Vec<u8>, Vec<Load>), SimulationError> {
        match tallies {
            Pending::OnDevice(readback) => {
                let (own, stamps) = self.subdomain.finish_readback(self.device, readback)?;
                self.request = self.request.max(self.wish);
                Ok((own, stamps, Vec::new()))
            }
            Pending::Reducing(own, stamps, reduction) => {
                let (mut sums, maxima) = self.ranks.comm().finish_reduction(reduction)?;
                let loads = Load::from_words(&mut sums, self.ranks.comm().size());
                self.request = self.request.max(Request::of_weight(maxima.get(2).copied().unwrap_or(0)));
                Ok((all_tallies(&own, &sums, &maxima)?, stamps, loads))
            }
        }
    }

    fn read_all(&mut self, observer: &mut dyn Observer) -> Result<(), SimulationError> {
        while !self.flying.is_empty() {
            self.read_oldest(observer)?;
        }
        Ok(())
    }

    fn read_oldest(&mut self, observer: &mut dyn Observer) -> Result<(), SimulationError> {
        let Some(mut flight) = self.flying.pop_front() else {
            return Ok(());
        };
        if self.ranks.comm().size() > 1 {
            flight = self.reduce(flight)?;
        }
        let InFlight { interval, before, tallies, phases, .. } = flight;
        let (tallies, stamps, loads) = self.collect(tallies)?;
        let counters = &tallies.counters;
        if counters.most_neighbours > 0 || counters.strays > 0 {
            return self.run_again(interval, before, counters.most_neighbours, counters.strays > 0);
        }
        self.spare.push(before.particles);
        let duration = interval.dt * f64::from(interval.steps);
        self.read_until += duration;
        let plan = &self.model.plan;
        let lost = |what: String| SimulationError::Lost { time: self.read_until, what };
        self.account.check(plan, &tallies, &interval).map_err(lost)?;
        let timed = self.timer.as_ref().map(|timer| timer.seconds(&phases, &stamps)).unwrap_or_default();
        let samples = interval.samples(plan);
        self.account.add(plan, &tallies, &interval, samples, &timed);
        self.averages.add(&tallies, interval.dt, interval.steps, samples);
        if self.decomposition.is_some() {
            let slowest = loads.iter().map(|load| load.wall).fold(0.0, f64::max);
            self.tuner.measured(slowest, interval.steps, interval.particles);
        }
        if !loads.is_empty() {
            self.balance.take(interval.first_step, interval.steps, self.read_until, loads);
            if let Some(record) = self.balance.latest() {
                observer.balance(record)?;
            }
        }
        self.demands.push_back(self.ladder.demand(&tallies.blocks, &tallies.fast));
        if self.read_until >= self.next_row * (1.0 - 1e-9) && self.averages.ready() {
            self.emit_row(observer)?;
        }
        observer.progress(
            self.read_until,
            interval.first_step + u64::from(interval.steps),
            self.account.state().particle_steps,
        );
        Ok(())
    }

    fn emit_row(&mut self, observer: &mut dyn Observer) -> Result<(), SimulationError> {
        let row = self.averages.row(self.read_until, self.account.state().particles);
        let spacing = self.model.plan.end_time / f64::from(self.model.scene.output.rows.max(1));
        while self.next_row <= self.read_until * (1.0 + 1e-9) {
            self.next_row += spacing;
        }
        observer.row(&row)
    }

    /// Runs an interval, and those submitted since, again with neighbour lists of at least `wanted`, and with
    /// everyone as a peer if particles strayed. All ranks do, since they see the sums.
    fn run_again(
        &mut self,
        first: Interval,
        before: crate::subdomain::Remembered,
        wanted: u32,
        strayed: bool,
    ) -> Result<(), SimulationError> {
        self.repeated += 1;
        self.tuner.disturbed();
        tracing::debug!("neighbour lists grow to {wanted}, strays: {strayed}; an interval is run again");
        let mut later = Vec::new();
        for flight in std::mem::take(&mut self.flying) {
            match flight.tallies {
                Pending::OnDevice(readback) => drop(self.subdomain.finish_readback(self.device, readback)?),
                Pending::Reducing(_, _, reduction) => drop(self.ranks.comm().finish_reduction(reduction)?),
            }
            later.push((flight.interval, flight.before));
        }
        self.subdomain.restore(self.device, &before);
        self.subdomain.make_room(self.device, 0, 0, wanted)?;
        if let Some(decomposition) = &mut self.decomposition {
            // The cuts may have changed since; the first exchange brings the particles home.
            decomposition.scatter();
            if strayed {
                decomposition.widen();
            }
        }
        self.spare.push(before.particles);
        self.submit(first)?;
        for (interval, before) in later {
            self.spare.push(before.particles);
            self.submit(interval)?;
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
        let own = self.subdomain.particles(self.device)?;
        if let Some((particles, owners)) = self.gather(own)? {
            if let Some(decomposition) = &self.decomposition {
                observer.boxes(&decomposition.boxes(&self.model.plan.grid));
            }
            observer.snapshot(self.clock.time(), &particles, &owners)?;
        }
        while self.snapshot_due() && self.next_snapshot <= asked {
            self.next_snapshot += 1;
        }
        Ok(())
    }

    /// All particles by id, and the rank that owns each, at rank 0. Collective.
    fn gather(&self, own: Vec<GpuParticle>) -> Result<Option<Owned>, SimulationError> {
        let Some(messages) = self.ranks.comm().gather(bytemuck::cast_slice(&own).to_vec())? else {
            return Ok(None);
        };
        let mut all = Vec::new();
        for (rank, message) in (0..).zip(messages) {
            let particles: Vec<GpuParticle> = bytemuck::pod_collect_to_vec(&message);
            all.extend(particles.into_iter().map(|particle| (particle, rank)));
        }
        all.sort_unstable_by_key(|(particle, _)| particle.id());
        Ok(Some(all.into_iter().unzip()))
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

fn all_tallies(own: &Tallies, sums: &[u64], maxima: &[u64]) -> Result<Tallies, SimulationError> {
    own.from_words(sums, maxima).ok_or_else(|| SimulationError::Lost {
        time: 0.0,
        what: "the ranks' tallies do not have the same shape".into(),
    })
}
