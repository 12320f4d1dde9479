//! The time loop of a rank. What it reads of the intervals it submitted is in `reading`.
//!
//! Every rank takes the same decisions, since they follow from tallies summed over all ranks, and runs the same
//! host code on the inflow. Rank 0 tells the observer.

mod handover;
mod looks;
pub mod meter;
mod reading;
mod snapshots;

use std::collections::VecDeque;
use std::time::Instant;

use crate::gas::Inflow;
use crate::gpu::{Device, PhaseTimer, Recording};
use crate::ranks::{Communicator, Solo};
use crate::subdomain::{GpuParticle, Place, Subdomain, Tallies};

use super::SimulationError;
use super::audit::{Account, count_outside};
use super::averages::Averages;
use super::balance::Balance;
use super::clock::Clock;
use super::conditions::Conditions;
use super::decomposition::Decomposition;
use super::exchange::Exchange;
use super::guards::Guards;
use super::interrupt::Request;
use super::interval::{Deal, InFlight, Interval, Machine};
use super::ladder::Ladder;
use super::model::Model;
use super::observer::{Moment, Observer, Options, Outcome};
use super::run_state::{Asked, RunState, StateError as RunStateError};
use super::setup::Setup;
use super::switch::Switching;
use super::tuning::Tuner;
use super::vent_watch::VentWatch;

use meter::Lists;
use reading::all_tallies;

/// Intervals under way at once. The step size of an interval is that which the state AHEAD intervals before
/// asked for, whether it could have been read sooner or not: so nothing that reads early changes a result.
pub(super) const AHEAD: usize = 2;

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
    guards: Guards<'a>,
    timer: Option<PhaseTimer>,
    flying: VecDeque<InFlight>,
    /// What the states read so far ask and no interval has followed yet, oldest first.
    asked: VecDeque<Asked>,
    conditions: Conditions<'a>,
    switching: Switching<'a>,
    vents: Vec<VentWatch>,
    /// No particles from here on.
    switched: bool,
    submitted: usize,
    /// Nothing has been submitted to this device yet.
    fresh: bool,
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
    /// The signal for which it stops.
    signal: Option<u8>,
    /// The run goes on from a state; its start has been accounted for.
    resumed: bool,
    options: Options<'a>,
    /// The steps began.
    began: Instant,
    lists: Lists,
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
    /// As [`Simulation::new`], or if there are more ranks than cells, or a file of particles is not as it was written.
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
        let share = setup.particles.share(model, comm)?;
        let mut decomposition = None;
        let own: Vec<GpuParticle> = if setup.domain.features().halo {
            let halo = Tuner::new(plan.rounds, options.halo).first();
            let cut_by = setup.cut_by.as_ref().filter(|_| options.balance.at_start());
            let cut_by = cut_by.map(|stock| stock.share(model, comm)).transpose()?;
            let weighed = options.balance.at_start().then_some(cut_by.as_deref().unwrap_or(&share));
            let cut = decomposition.insert(Decomposition::new(plan, comm, halo, weighed)?);
            setup.particles.own(model, comm, share, |particle| cut.owner(plan, particle))?
        } else {
            let ranks = comm.size();
            setup.particles.own(model, comm, share, |particle| particle.id() as usize % ranks)?
        };
        let place = decomposition.as_ref().map_or_else(|| Place::alone(plan), |cut| cut.place().1);
        let mut subdomain = Subdomain::new(device, setup.domain.clone(), place, &own)?;
        if options.dispatch_by_lengths {
            subdomain.dispatch_by_lengths();
        }
        let first_id = plan.initial_particles as u32;
        let scene = &model.scene;
        let inflow =
            Inflow::new(&scene.orifices, &plan.species(), plan.moles_per_particle, plan.seed, first_id, plan.end_time);
        Ok(Simulation {
            subdomain,
            exchange: match ranks {
                Ranks::Alone(_) => Exchange::none(),
                Ranks::Among(comm) => Exchange::new(comm),
            },
            decomposition,
            balance: Balance::new(options.balance, comm.size()),
            tuner: Tuner::new(plan.rounds, options.halo),
            inflow,
            clock: Clock::new(plan),
            ladder: Ladder::new(plan, setup.volumes.to_vec()),
            averages: Averages::new(plan, setup.layout.clone(), setup.patches),
            account: Account::new(plan),
            guards: Guards::new(&model.scene, plan, setup.volumes.to_vec()),
            timer: PhaseTimer::new(device)?,
            flying: VecDeque::new(),
            asked: VecDeque::new(),
            conditions: Conditions::new(model),
            switching: Switching::new(model)?,
            vents: vec![VentWatch::default(); scene.vents.len()],
            switched: false,
            submitted: 0,
            fresh: true,
            spare: Vec::new(),
            next_row: plan.end_time / f64::from(scene.output.rows.max(1)),
            next_snapshot: 0,
            read_until: 0.0,
            repeated: 0,
            began: Instant::now(),
            lists: Lists::default(),
            wish: Request::None,
            request: Request::None,
            stopping: false,
            signal: None,
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
        for asked in &state.asked {
            simulation.ladder.check(&asked.demand.shares)?;
        }
        simulation.asked = state.asked.iter().cloned().collect();
        simulation.conditions.restore(&state.conditions)?;
        simulation.guards.restore(&state.guards);
        simulation.switching.restore(&state.switch)?;
        if state.vents.len() != model.scene.vents.len() {
            let [found, expected] = [state.vents.len(), model.scene.vents.len()].map(|n| n as u64);
            return Err(RunStateError::differs("vents", found, expected).into());
        }
        simulation.vents.clone_from(&state.vents);
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
            asked: self.asked.iter().cloned().collect(),
            conditions: self.conditions.state().clone(),
            guards: self.guards.state().clone(),
            switch: self.switching.state().clone(),
            vents: self.vents.clone(),
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
        self.conditions.start(&at_start);
        self.watch_vents(0.0, observer);
        let demand = self.ladder.demand(&at_start.blocks, &at_start.fast, [0; 2]);
        if self.options.hold_step {
            self.ladder.hold(demand);
        } else {
            self.ladder.start(demand).map_err(|source| SimulationError::Ladder { time: 0.0, source })?;
        }
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
        if self.clock.done() || self.stopped() || self.switched {
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
        // By what was read until here: as many intervals before the end of the particles as for the step size.
        self.switched = self.clock.time() >= self.switching.time()
            || (self.follows() && self.asked.front().is_some_and(|asked| asked.switches));
        if self.switched {
            return Ok(false);
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
        let stepping_seconds = self.began.elapsed().as_secs_f64();
        if self.options.checkpoint_at_stop && self.stopped() && !self.stopping && !self.clock.done() {
            self.checkpoint(observer)?;
        }
        let last = if self.averages.ready() {
            Some(self.emit_row(observer)?)
        } else {
            // Its totals go on in a control volume.
            self.switched.then(|| self.averages.row(self.read_until, self.account.state().particles))
        };
        let at_end = self.measure()?;
        let own = self.subdomain.particles(self.device)?;
        let vessel = self.model.vessel_at(self.clock.time());
        let outside = count_outside(&vessel, &self.model.plan, &own);
        let outside = self.ranks.comm().sum(vec![outside])?[0];
        let audit = self.account.close(self.model, &self.inflow, &at_end, outside, &self.averages, &self.conditions);
        let continued = self.go_on_without_particles(&at_end, &audit, last.as_ref(), observer)?;
        if continued.is_none() {
            observer.vents(&self.vents);
        }
        let left = if self.options.discard_particles { None } else { self.gather(own)? };
        let (particles, owners) = left.unwrap_or_default();
        Ok(Outcome {
            particles,
            owners,
            traffic: self.exchange.traffic(),
            rebalances: self.balance.rebalances(),
            audit,
            continued,
            warnings: self.guards.told().to_vec(),
            phases: self.account.phases(),
            steps: self.clock.steps,
            particle_steps: self.account.state().particle_steps,
            collisions: self.account.state().collisions,
            bounces: self.account.state().bounces,
            time: self.clock.time(),
            repeated: self.repeated,
            step_range: self.account.state().step_range,
            stepping_seconds,
            signal: self.signal,
        })
    }

    /// A checkpoint, with nothing under way.
    fn checkpoint(&mut self, observer: &mut dyn Observer) -> Result<(), SimulationError> {
        self.read_all(observer)?;
        if let Request::CheckpointAndStop(signal) = self.request {
            (self.stopping, self.signal) = (true, signal);
        }
        (self.wish, self.request) = (Request::None, Request::None);
        let own = self.subdomain.particles(self.device)?;
        let entered = self.inflow.entered_by_gas().iter().sum::<u64>();
        observer.checkpoint(&Moment {
            step: self.clock.steps,
            time: self.clock.time(),
            particles: self.account.state().particles,
            ids: self.model.plan.initial_particles + entered,
            state: &self.state(),
            own: &own,
            comm: self.ranks.comm(),
            stopping: self.stopping,
        })
    }

    fn stopped(&self) -> bool {
        self.options.stop_after_steps.is_some_and(|most| self.clock.steps >= most)
    }

    /// Whether the next interval follows what was read.
    fn follows(&self) -> bool {
        self.submitted >= AHEAD
    }

    /// Tallies of the particles as they are, of all ranks.
    fn measure(&mut self) -> Result<Tallies, SimulationError> {
        self.subdomain.place_walls(self.device, &self.model.moving.at(&self.model.plan.grid, self.clock.time()));
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
        if self.follows()
            && let Some(asked) = self.asked.pop_front()
        {
            let time = self.clock.time();
            if self.options.hold_step {
                self.ladder.hold(asked.demand);
            } else {
                self.ladder.follow(asked.demand).map_err(|source| SimulationError::Ladder { time, source })?;
            }
            self.conditions.follow(asked.seen);
            let entered = self.inflow.entered_by_gas().iter().sum::<u64>();
            self.subdomain.shrink(plan.initial_particles + entered - asked.left);
        }
        if let Some(decomposition) = &mut self.decomposition {
            let (subdomain, comm) = (&mut self.subdomain, self.ranks.comm());
            let seconds = self.balance.act(self.clock.steps, self.device, subdomain, comm, decomposition)?;
            self.exchange.rebalanced(seconds);
            if decomposition.set_halo(self.tuner.next()) {
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
        let mut interval = Interval::new(plan, &mut self.inflow, start, end, first_step, steps, deal)?;
        interval.tables = self.conditions.tables(start, end);
        interval.tables.cross_section_shares = self.ladder.shares().to_vec();
        interval.tables.halvings = self.ladder.halvings(level);
        let moving = &self.model.moving;
        if !moving.is_empty() {
            interval.tables.motions = moving.steps(&plan.grid, start, interval.dt, steps);
            interval.volumes = moving.mean_volumes(self.averages.drawn(), interval.tallied_at(start));
        }
        self.submit(interval)
    }

    fn submit(&mut self, interval: Interval) -> Result<(), SimulationError> {
        let batch = self.options.batch.unwrap_or(self.model.plan.steps_per_interval);
        let spare = self.spare.pop();
        let fit_lists = std::mem::take(&mut self.fresh) && !self.options.lists_start_short;
        let mut machine = Machine {
            plan: &self.model.plan,
            device: self.device,
            subdomain: &mut self.subdomain,
            exchange: &mut self.exchange,
            decomposition: self.decomposition.as_mut(),
            timer: self.timer.as_ref(),
            batch,
            fit_lists,
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
}
