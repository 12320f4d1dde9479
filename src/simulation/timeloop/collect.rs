//! What a rank reads of the intervals that it submitted, one or two of them late: their tallies, summed over the
//! ranks, go into the account, the averages, the step size and the balance.

use super::elastic_fabric::SavedFabric;
use super::simulation::Simulation;
use super::submit::{FabricInFlight, InFlight, Pending};
use crate::simulation::SimulationError;
use crate::simulation::accounting::averages::Sampled;
use crate::simulation::accounting::guards::{GuardWarning, Shown};
use crate::simulation::accounting::phases::{PAIR_PHASES, once_an_interval};
use crate::simulation::accounting::row::Row;
use crate::simulation::control::interval::Interval;
use crate::simulation::control::surface_states::SeenGas;
use crate::simulation::control::window::Window;
use crate::simulation::model::fabric::Surfaces;
use crate::simulation::parallel::exchange::Traffic;
use crate::simulation::parallel::load::Load;
use crate::simulation::run_state::Feedback;
use crate::simulation::timeloop::interrupt::Request;
use crate::simulation::timeloop::observer::Observer;
use crate::subdomain::{Remembered, Tallies};

impl Simulation<'_> {
    /// Takes an interval's tallies from the device and starts to sum them over the ranks.
    pub fn reduce(&mut self, mut flight: InFlight) -> Result<InFlight, SimulationError> {
        if let Pending::OnDevice(readback) = flight.tallies {
            let (own, stamps) = self.subdomain.finish_readback(self.device, readback)?;
            let (mut sums, mut maxima) = own.to_words();
            maxima.push(self.requests.wish.weight());
            let seconds = self.step_seconds(&flight.phases, &stamps, &flight.traffic);
            let load = Load::new(seconds, flight.present, flight.cells, &own, &flight.traffic);
            sums.extend(load.to_words(self.ranks.comm()));
            let reduction = self.ranks.comm().start_reduction(sums, maxima)?;
            flight.tallies = Pending::Reducing(Box::new(own), stamps, reduction);
        }
        Ok(flight)
    }

    /// Device time of the timed step, s, and that of its phases with pairs; on a device that does not time, from submissions to their ends, of the
    /// mean step of the interval.
    fn step_seconds(&self, phases: &[&'static str], stamps: &[u8], traffic: &Traffic) -> (f64, Option<f64>) {
        let Some(timer) = &self.submissions.timer else {
            return (traffic.device_seconds / traffic.steps.max(1) as f64, None);
        };
        let mut timed = timer.seconds(phases, stamps);
        timed.retain(|(phase, _)| !once_an_interval(phase));
        let all = timed.iter().map(|(_, seconds)| seconds).sum();
        timed.retain(|(phase, _)| PAIR_PHASES.contains(phase));
        let pairs = timed.iter().map(|(_, seconds)| seconds).sum();
        (all, (!timed.is_empty()).then_some(pairs))
    }

    /// The tallies of all ranks, the stamps of this one, and every rank's load.
    fn collect(&mut self, tallies: Pending) -> Result<(Tallies, Vec<u8>, Vec<Load>), SimulationError> {
        match tallies {
            Pending::OnDevice(readback) => {
                let (own, stamps) = self.subdomain.finish_readback(self.device, readback)?;
                self.requests.agreed = self.requests.agreed.max(self.requests.wish);
                Ok((own, stamps, Vec::new()))
            }
            Pending::Reducing(own, stamps, reduction) => {
                let (mut sums, maxima) = self.ranks.comm().finish_reduction(reduction)?;
                let loads = Load::from_words(&mut sums, self.ranks.comm().size());
                self.requests.agreed =
                    self.requests.agreed.max(Request::of_weight(maxima.get(2).copied().unwrap_or(0)));
                Ok((all_tallies(&own, &sums, &maxima)?, stamps, loads))
            }
        }
    }

    pub fn read_all(&mut self, observer: &mut dyn Observer) -> Result<(), SimulationError> {
        while !self.submissions.flying.is_empty() {
            self.read_oldest(observer)?;
        }
        Ok(())
    }

    pub fn read_oldest(&mut self, observer: &mut dyn Observer) -> Result<(), SimulationError> {
        let Some(mut flight) = self.submissions.flying.pop_front() else {
            return Ok(());
        };
        if self.ranks.comm().size() > 1 {
            flight = self.reduce(flight)?;
        }
        let InFlight { mut interval, before, tallies, phases, fabric, .. } = flight;
        let (mut tallies, stamps, loads) = self.collect(tallies)?;
        if tallies.counters.tails_wanted > 0 || tallies.counters.strays > 0 || self.is_short_of_fabric(&tallies) {
            return self.run_again(
                interval,
                Before { gas: before, fabric: fabric.map(|fabric| fabric.before) },
                tallies,
            );
        }
        if let Some((_, earlier)) = interval.done.take() {
            tallies = tallies.and_before(&earlier).ok_or_else(misshapen)?;
        }
        self.submissions.spare.extend(before.spare());
        if let (Some(elastic), Some(FabricInFlight { after, .. })) = (&mut self.fabric, fabric) {
            let grown = elastic.read(self.device, after, &interval)?;
            let gained = Surfaces::gained(&self.model.scene, &grown);
            // (Walls that move have been counted.)
            let moved = std::mem::take(&mut interval.volumes);
            let beside = if moved.is_empty() { self.books.averages.initial_volumes() } else { &moved };
            interval.volumes = beside.iter().zip(gained).map(|(beside, gained)| beside + gained).collect();
        }
        self.progress.read_until += interval.dt * f64::from(interval.steps);
        let timed = self.submissions.timer.as_ref().map(|timer| timer.seconds(&phases, &stamps)).unwrap_or_default();
        let drift = self.enter_into_account(&interval, &tallies, &timed)?;
        self.guard(&interval, &tallies, drift, observer)?;
        let seen = self.average(&interval, &tallies, observer);
        self.weigh_ranks(&interval, loads, observer)?;
        self.ask_for_next(&tallies, seen, observer)?;
        observer.progress(
            self.progress.read_until,
            interval.first_step + u64::from(interval.steps),
            self.books.account.state().particle_steps,
        );
        Ok(())
    }

    /// Checks that nothing is lost and adds the interval to the totals; returns the drift of the energy.
    fn enter_into_account(
        &mut self,
        interval: &Interval,
        tallies: &Tallies,
        timed: &[(&'static str, f64)],
    ) -> Result<f64, SimulationError> {
        let lost = |what: String| SimulationError::Lost { time: self.progress.read_until, what };
        let drift = self.books.account.check(tallies, interval).map_err(lost)?;
        self.books.account.add(&self.model.plan, tallies, interval, timed);
        self.lists.add(&tallies.counters);
        Ok(drift)
    }

    /// Tells what left its limits in the interval.
    fn guard(
        &mut self,
        interval: &Interval,
        tallies: &Tallies,
        drift: f64,
        observer: &mut dyn Observer,
    ) -> Result<(), SimulationError> {
        let shown = Shown {
            time: self.progress.read_until,
            step: interval.dt,
            tallies,
            shares: &interval.tables.cross_section_shares,
            particle_steps: interval.particles * u64::from(interval.steps),
            drift,
            clipped: self.books.account.state().clipped(),
        };
        let told = self.books.guards.interval(&shown);
        self.tell(&told, observer)
    }

    /// Adds the interval to the averages; returns what the surfaces have seen in it.
    fn average(&mut self, interval: &Interval, tallies: &Tallies, observer: &mut dyn Observer) -> SeenGas {
        let samples = interval.samples();
        let end = self.progress.read_until;
        let span = [end - interval.dt * f64::from(interval.steps), end];
        let nodes = match &self.fabric {
            _ if !self.model.surface_models.has_vents_on_fabric() => Vec::new(),
            Some(elastic) => elastic.nodes().to_vec(),
            None => self.model.fabric.places(end),
        };
        let (volumes, vents) = (&interval.volumes[..], &interval.tables.vents[..]);
        let window = Window { span, samples, volumes, vents, nodes: &nodes };
        let (seen, targets) = self.control.surfaces.see(tallies, window);
        self.watch_vents(end, observer);
        let sampled = Sampled { dt: interval.dt, steps: interval.steps, samples };
        self.books.averages.add(tallies, sampled, &targets);
        self.books.averages.add_room(sampled, &interval.volumes);
        seen
    }

    /// Takes in what each rank had to do.
    fn weigh_ranks(
        &mut self,
        interval: &Interval,
        loads: Vec<Load>,
        observer: &mut dyn Observer,
    ) -> Result<(), SimulationError> {
        if self.parallel.decomposition.is_some() {
            let slowest = loads.iter().map(|load| load.wall).fold(0.0, f64::max);
            self.parallel.halo_tuner.measured(slowest, interval.steps, interval.particles);
        }
        if !loads.is_empty() {
            self.parallel.balance.take(interval.first_step, interval.steps, self.progress.read_until, loads);
            if let Some(record) = self.parallel.balance.latest() {
                observer.balance(record)?;
            }
        }
        Ok(())
    }

    /// What the state at the end of the interval asks of a later one; emits a row if one is due.
    fn ask_for_next(
        &mut self,
        tallies: &Tallies,
        seen: SeenGas,
        observer: &mut dyn Observer,
    ) -> Result<(), SimulationError> {
        let met = [tallies.counters.collisions, tallies.counters.fast_pairs.into()];
        let demand = self.control.ladder.demand(&tallies.blocks, &tallies.fast, met);
        let left = self.books.account.state().left();
        let mut switches = false;
        if self.progress.read_until >= self.progress.next_row * (1.0 - 1e-9) && self.books.averages.ready() {
            let row = self.emit_row(observer)?;
            switches = self.switching.row(&row);
        }
        self.control.feedback.push_back(Feedback { demand, seen, left, switches });
        Ok(())
    }

    pub fn emit_row(&mut self, observer: &mut dyn Observer) -> Result<Row, SimulationError> {
        let mut row = self.books.averages.row(self.progress.read_until, self.books.account.state().particles);
        for (state, [moved, velocity]) in row.motions.iter_mut().zip(self.model.moving.courses(row.time)) {
            (state.displacement, state.velocity) = (moved, velocity);
        }
        let measures = match &mut self.fabric {
            Some(elastic) => elastic.mean_measures(),
            None if row.fabrics.is_empty() => Vec::new(),
            None => self.model.fabric.measures(row.time),
        };
        for ((state, surface), [volume, area]) in row.fabrics.iter_mut().zip(&self.model.fabric.all).zip(measures) {
            state.pressure = state.pressure.map(|force| force / area);
            (state.volume, state.area) = (if surface.closed { volume } else { 0.0 }, area);
        }
        for (state, energies) in row.fabrics.iter_mut().zip(self.fabric.iter().flat_map(|elastic| elastic.energies())) {
            state.energies = Some(energies);
        }
        let told = self.books.guards.row(&row);
        let spacing = self.model.plan.end_time / f64::from(self.model.scene.output.rows.max(1));
        while self.progress.next_row <= self.progress.read_until * (1.0 + 1e-9) {
            self.progress.next_row += spacing;
        }
        observer.row(&row)?;
        self.tell(&told, observer)?;
        Ok(row)
    }

    /// By the pressures that the vents follow, at a time, s.
    pub fn watch_vents(&mut self, time: f64, observer: &mut dyn Observer) {
        for (index, (watch, vent)) in self.books.vents.iter_mut().zip(&self.model.scene.vents).enumerate() {
            if watch.see(vent, [time, self.control.surfaces.pressure_before(index)], false) {
                observer.vent_opened(index, watch);
            }
        }
    }

    /// Tells what has left its limits; a strict run ends there, on all ranks alike.
    fn tell(&mut self, told: &[GuardWarning], observer: &mut dyn Observer) -> Result<(), SimulationError> {
        for told in told {
            observer.warning(told);
        }
        match told.first() {
            Some(first) if self.options.strict => {
                self.abandon()?;
                // Nobody leaves before rank 0 has written what it had to.
                self.ranks.comm().sum(vec![0])?;
                Err(SimulationError::Guard { told: Box::new(first.clone()) })
            }
            _ => Ok(()),
        }
    }

    /// Waits for what is under way, and drops it.
    fn abandon(&mut self) -> Result<Vec<(Interval, Remembered)>, SimulationError> {
        let mut dropped = Vec::new();
        for flight in std::mem::take(&mut self.submissions.flying) {
            match flight.tallies {
                Pending::OnDevice(readback) => drop(self.subdomain.finish_readback(self.device, readback)?),
                Pending::Reducing(_, _, reduction) => drop(self.ranks.comm().finish_reduction(reduction)?),
            }
            dropped.push((flight.interval, flight.before));
        }
        Ok(dropped)
    }

    /// Triangles found no place in lists of fabric that can have more.
    fn is_short_of_fabric(&self, tallies: &Tallies) -> bool {
        tallies.counters.misplaced > 0 && self.subdomain.is_short_of_fabric()
    }

    /// Runs an interval, and those submitted since, again with as much room for the tails of neighbour lists as its tallies say was wanted and a
    /// quarter more, with everyone as a peer if particles strayed, and with twice the room for lists of fabric if that was short. All ranks do, since they see the sums. A device alone goes on from
    /// the step that had too little room.
    fn run_again(
        &mut self,
        mut first: Interval,
        Before { gas: before, fabric }: Before,
        mut tallies: Tallies,
    ) -> Result<(), SimulationError> {
        self.progress.repeated += 1;
        self.parallel.halo_tuner.disturbed();
        let (wanted, strayed) = (tallies.counters.tails_wanted, tallies.counters.strays > 0);
        let short_of_fabric = self.is_short_of_fabric(&tallies);
        let later = self.abandon()?;
        let Some(step) = self.subdomain.restore(self.device, &before, &first.entering())? else {
            let what = "an interval has to run again, and its start was not kept".to_owned();
            return Err(SimulationError::Lost { time: self.progress.read_until, what });
        };
        tracing::debug!(
            "tails of neighbour lists grow to {wanted}, strays: {strayed}, short of lists of fabric: {short_of_fabric}; an interval of {} steps \
             is run again from step {step}",
            first.steps
        );
        if let (Some(elastic), Some(before)) = (&self.fabric, &fabric) {
            elastic.restore(self.device, before);
        }
        if step > 0 {
            if let Some((_, earlier)) = &first.done {
                tallies = tallies.and_before(earlier).ok_or_else(misshapen)?;
            }
            first.done = Some((step, Box::new(tallies)));
        }
        // (A device alone can be asked to grow no more than it must.)
        let more = if self.options.lists_start_short && self.parallel.decomposition.is_none() { 0.0 } else { 0.25 };
        self.subdomain.make_room_for_tails(self.device, wanted.into(), more)?;
        if short_of_fabric {
            self.subdomain.make_room_for_fabric(self.device)?;
        }
        if let Some(decomposition) = &mut self.parallel.decomposition {
            // The cuts may have changed since; the first exchange brings the particles home.
            decomposition.scatter();
            if strayed {
                decomposition.widen();
            }
        }
        self.submissions.spare.extend(before.spare());
        self.submit(first)?;
        for (interval, before) in later {
            self.submissions.spare.extend(before.spare());
            self.submit(interval)?;
        }
        Ok(())
    }
}

/// What there was before an interval.
struct Before {
    gas: Remembered,
    fabric: Option<SavedFabric>,
}

/// Tallies of two ranks, or of two parts of an interval, that cannot be added.
fn misshapen() -> SimulationError {
    SimulationError::Lost { time: 0.0, what: "tallies that are to be added do not have the same shape".into() }
}

pub fn all_tallies(own: &Tallies, sums: &[u64], maxima: &[u64]) -> Result<Tallies, SimulationError> {
    own.from_words(sums, maxima).ok_or_else(misshapen)
}
