//! The time loop of a rank. What it reads of the intervals it submitted is in `collect`.
//!
//! Every rank takes the same decisions, since they follow from tallies summed over all ranks, and runs the same
//! host code on the inflow. Rank 0 tells the observer.

use std::time::Instant;

use super::collect::all_tallies;
use super::interrupt::Request;
use super::observer::{Moment, Observer, Outcome};
use super::simulation::Simulation;
use super::submit::Machine;
use crate::gpu::Recording;
use crate::simulation::accounting::audit::{AtEnd, count_outside, count_passed};
use crate::simulation::control::interval::{Deal, Interval, Span};
use crate::simulation::error::SimulationError;
use crate::simulation::parallel::decomposition::Histogram;
use crate::subdomain::{GpuParticle, Tallies};

/// Intervals under way at once. The step size of an interval is that which the state AHEAD intervals before
/// asked for, whether it could have been read sooner or not: so nothing that reads early changes a result.
pub const AHEAD: usize = 2;

impl Simulation<'_> {
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
        self.books.account.start(&at_start);
        self.control.surfaces.start(&at_start);
        self.watch_vents(0.0, observer);
        let demand = self.control.ladder.demand(&at_start.blocks, &at_start.fast, [0; 2]);
        if self.options.hold_step {
            self.control.ladder.hold(demand);
        } else {
            self.control.ladder.start(demand).map_err(|source| SimulationError::Ladder { time: 0.0, source })?;
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
        if self.control.clock.done() || self.stopped() || self.switched {
            return Ok(false);
        }
        while self.submissions.flying.len() >= AHEAD {
            self.read_oldest(observer)?;
        }
        self.requests.wish = self.requests.wish.max(observer.request(self.control.clock.steps));
        if self.requests.agreed != Request::None {
            self.checkpoint(observer)?;
            if self.requests.stopping {
                return Ok(false);
            }
        }
        // By what was read until here: as many intervals before the end of the particles as for the step size.
        self.switched = self.control.clock.time() >= self.switching.time()
            || (self.follows() && self.control.feedback.front().is_some_and(|asked| asked.switches));
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
        if self.options.checkpoint_at_stop && self.stopped() && !self.requests.stopping && !self.control.clock.done() {
            self.checkpoint(observer)?;
        }
        let last = if self.books.averages.ready() {
            Some(self.emit_row(observer)?)
        } else {
            // Its totals go on in a control volume.
            self.switched
                .then(|| self.books.averages.row(self.progress.read_until, self.books.account.state().particles))
        };
        let at_end = self.measure()?;
        let own = self.subdomain.particles(self.device)?;
        let vessel = self.model.vessel_at(self.control.clock.time());
        let outside = count_outside(&vessel, &self.model.plan, &own);
        let outside = self.ranks.comm().sum(vec![outside])?[0];
        self.count_passed(&own)?;
        let fabric = match &self.fabric {
            Some(elastic) => Some(elastic.account(self.device, self.ranks.comm())?),
            None => None,
        };
        let closing = AtEnd {
            fabric,
            tallies: &at_end,
            inflow: &self.inflow,
            outside,
            averages: &self.books.averages,
            surface_states: &self.control.surfaces,
        };
        let audit = self.books.account.close(self.model, &closing);
        let continued = self.go_on_without_particles(&at_end, &audit, last.as_ref(), observer)?;
        if continued.is_none() {
            observer.vents(&self.books.vents);
        }
        let left = if self.options.discard_particles { None } else { self.gather(own)? };
        let (particles, owners) = left.unwrap_or_default();
        Ok(Outcome {
            particles,
            owners,
            traffic: self.parallel.exchange.traffic(),
            rebalances: self.parallel.balance.rebalances(),
            audit,
            continued,
            warnings: self.books.guards.told().to_vec(),
            phases: self.books.account.phases(),
            fabric: self.fabric_snapshot(),
            steps: self.control.clock.steps,
            particle_steps: self.books.account.state().particle_steps,
            collisions: self.books.account.state().collisions,
            bounces: self.books.account.state().bounces,
            time: self.control.clock.time(),
            repeated: self.progress.repeated,
            step_range: self.books.account.state().step_range,
            stepping_seconds,
            signal: self.requests.signal,
        })
    }

    /// A checkpoint, with nothing under way.
    fn checkpoint(&mut self, observer: &mut dyn Observer) -> Result<(), SimulationError> {
        self.read_all(observer)?;
        if let Request::CheckpointAndStop(signal) = self.requests.agreed {
            (self.requests.stopping, self.requests.signal) = (true, signal);
        }
        (self.requests.wish, self.requests.agreed) = (Request::None, Request::None);
        let own = self.subdomain.particles(self.device)?;
        // (Sheets that cross let a few particles of elastic bags out: the audit tells of these.)
        if let Some(passed) = self.count_passed(&own)?.filter(|&passed| passed > 0 && !self.model.fabric.is_elastic()) {
            let what = format!("{passed} particles are on the wrong side of closed fabric");
            return Err(SimulationError::Lost { time: self.control.clock.time(), what });
        }
        let entered = self.inflow.entered_by_gas().iter().sum::<u64>();
        observer.checkpoint(&Moment {
            step: self.control.clock.steps,
            time: self.control.clock.time(),
            particles: self.books.account.state().particles,
            ids: self.model.plan.initial_particles + entered,
            state: &self.state()?,
            own: &own,
            comm: self.ranks.comm(),
            stopping: self.requests.stopping,
        })
    }

    fn stopped(&self) -> bool {
        self.options.stop_after_steps.is_some_and(|most| self.control.clock.steps >= most)
    }

    /// Whether the next interval follows what was read.
    fn follows(&self) -> bool {
        self.submissions.submitted >= AHEAD
    }

    /// Where the nodes of fabric are at the time of the clock, with nothing under way, m.
    pub(super) fn fabric_nodes(&self) -> Vec<[f64; 3]> {
        match &self.fabric {
            Some(elastic) => elastic.nodes().to_vec(),
            None => self.model.fabric.places(self.control.clock.time()),
        }
    }

    /// Counts the particles of all ranks on the wrong side of closed fabric, if there is any. Collective.
    pub(super) fn count_passed(&mut self, own: &[GpuParticle]) -> Result<Option<u64>, SimulationError> {
        let fabric = &self.model.fabric;
        if !fabric.all.iter().any(|surface| surface.closed) {
            return Ok(None);
        }
        let bags = fabric.bags_of(&self.fabric_nodes())?;
        let passed = self.ranks.comm().sum(vec![count_passed(&bags, &self.model.plan, own), own.len() as u64])?;
        self.books.account.passed([passed[0], passed[1]]);
        Ok(Some(passed[0]))
    }

    /// Tallies of the particles as they are, of all ranks.
    fn measure(&mut self) -> Result<Tallies, SimulationError> {
        self.subdomain
            .place_walls(self.device, &self.model.moving.at(&self.model.plan.grid, self.control.clock.time()));
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
            && let Some(asked) = self.control.feedback.pop_front()
        {
            let time = self.control.clock.time();
            if self.options.hold_step {
                self.control.ladder.hold(asked.demand);
            } else {
                self.control.ladder.follow(asked.demand).map_err(|source| SimulationError::Ladder { time, source })?;
            }
            self.control.surfaces.follow(asked.seen);
            let entered = self.inflow.entered_by_gas().iter().sum::<u64>();
            self.subdomain.shrink(plan.initial_particles + entered - asked.left);
        }
        if let Some(decomposition) = &mut self.parallel.decomposition {
            let mut histogram =
                Histogram { device: self.device, subdomain: &mut self.subdomain, comm: self.ranks.comm() };
            let seconds = self.parallel.balance.act(self.control.clock.steps, &mut histogram, decomposition)?;
            self.parallel.exchange.rebalanced(seconds);
            if decomposition.set_halo(self.parallel.halo_tuner.next()) {
                decomposition.apply(self.device, &mut self.subdomain, &mut self.parallel.exchange)?;
            }
        }
        self.submissions.submitted += 1;
        let (level, steps) = self.control.clock.interval(self.control.ladder.level(), plan.steps_per_interval);
        let (start, first_step) = (self.control.clock.time(), self.control.clock.steps);
        self.control.clock.advance(level, steps);
        let end = self.control.clock.time();
        let deal = match self.parallel.decomposition {
            None => Deal::ById { rank: self.ranks.comm().rank() as u32, ranks: self.ranks.comm().size() as u32 },
            Some(_) => Deal::All,
        };
        let mut interval = Interval::new(
            plan,
            &mut self.inflow,
            &Span { start, end, first_step, steps },
            deal,
            &self.model.orifices_inside,
        )?;
        interval.tables = self.control.surfaces.tables(start, end);
        interval.tables.cross_section_shares = self.control.ladder.shares().to_vec();
        interval.tables.halvings = self.control.ladder.halvings(level);
        let moving = &self.model.moving;
        if !moving.is_empty() {
            interval.tables.motions = moving.steps(&plan.grid, start, interval.dt, steps);
        }
        if moving.changes_volumes() {
            interval.volumes = moving.mean_volumes(self.books.averages.initial_volumes(), interval.tallied_at(start));
        }
        interval.tables.nodes = self.model.fabric.steps(&plan.grid, start, interval.dt, steps);
        self.submit(interval)
    }

    pub(in crate::simulation) fn submit(&mut self, interval: Interval) -> Result<(), SimulationError> {
        let batch = self.options.batch.unwrap_or(self.model.plan.steps_per_interval);
        let spare = self.submissions.spare.pop();
        let fit_lists = std::mem::take(&mut self.submissions.fresh) && !self.options.lists_start_short;
        let mut machine = Machine {
            device: self.device,
            subdomain: &mut self.subdomain,
            exchange: &mut self.parallel.exchange,
            decomposition: self.parallel.decomposition.as_mut(),
            fabric: self.fabric.as_ref(),
            timer: self.submissions.timer.as_ref(),
            batch,
            fit_lists,
        };
        let flying = machine.submit(interval, spare)?;
        // The one before is done, or nearly: its sums are formed while this one runs.
        if self.ranks.comm().size() > 1
            && let Some(before) = self.submissions.flying.pop_back()
        {
            let reducing = self.reduce(before)?;
            self.submissions.flying.push_back(reducing);
        }
        self.submissions.flying.push_back(flying);
        Ok(())
    }
}
