//! What a rank of a run has, from its start or from a state.

use std::collections::VecDeque;
use std::time::Instant;

use super::elastic_fabric::ElasticFabric;
use super::interrupt::Request;
use super::observer::Options;
use super::setup::Setup;
use super::submit::InFlight;
use crate::gas::Inflow;
use crate::gpu::{Device, PhaseTimer};
use crate::ranks::{Communicator, Solo};
use crate::simulation::accounting::audit::Account;
use crate::simulation::accounting::averages::Averages;
use crate::simulation::accounting::guards::Guards;
use crate::simulation::accounting::lists::Lists;
use crate::simulation::accounting::vent_watch::VentWatch;
use crate::simulation::control::clock::Clock;
use crate::simulation::control::ladder::Ladder;
use crate::simulation::control::state_error::RunStateError;
use crate::simulation::control::surface_states::SurfaceStates;
use crate::simulation::error::SimulationError;
use crate::simulation::model::build::Model;
use crate::simulation::parallel::balance::Balance;
use crate::simulation::parallel::decomposition::Decomposition;
use crate::simulation::parallel::exchange::Exchange;
use crate::simulation::parallel::halo_tuner::Tuner;
use crate::simulation::run_state::{Feedback, RunState};
use crate::simulation::zero_d::switch::Switching;
use crate::subdomain::{GpuParticle, Subdomain, SubdomainBox};

/// The ranks of a run.
pub enum Ranks<'a> {
    Alone(Solo),
    Among(&'a dyn Communicator),
}

impl Ranks<'_> {
    pub fn comm(&self) -> &dyn Communicator {
        match self {
            Ranks::Alone(solo) => solo,
            Ranks::Among(comm) => *comm,
        }
    }
}

pub struct Simulation<'a> {
    pub(super) model: &'a Model,
    pub(super) device: &'a Device,
    pub(super) options: Options<'a>,
    pub(super) ranks: Ranks<'a>,
    pub(super) subdomain: Subdomain,
    /// Elastic fabric.
    pub(super) fabric: Option<ElasticFabric<'a>>,
    pub(super) inflow: Inflow,
    pub(super) parallel: Parallel<'a>,
    pub(super) control: Control<'a>,
    pub(super) books: Books<'a>,
    pub(super) submissions: Submissions,
    pub(super) progress: Progress,
    pub(super) requests: Requests,
    pub(super) switching: Switching<'a>,
    /// No particles from here on.
    pub(super) switched: bool,
    /// The run goes on from a state; its start has been accounted for.
    pub(super) resumed: bool,
    /// The steps began.
    pub(super) began: Instant,
    pub(super) lists: Lists,
}

/// How the ranks share the gas.
pub struct Parallel<'a> {
    pub exchange: Exchange<'a>,
    /// `None` on a rank alone, and where particles are dealt out by their ids.
    pub decomposition: Option<Decomposition>,
    pub balance: Balance,
    pub halo_tuner: Tuner,
}

/// What decides of the next intervals.
pub struct Control<'a> {
    pub clock: Clock,
    pub ladder: Ladder,
    pub surfaces: SurfaceStates<'a>,
    /// What the states read so far ask and no interval has followed yet, oldest first.
    pub feedback: VecDeque<Feedback>,
}

/// What is known of the intervals that were read.
pub struct Books<'a> {
    pub averages: Averages,
    pub account: Account,
    pub guards: Guards<'a>,
    pub vents: Vec<VentWatch>,
}

/// What the device has been given to do.
pub struct Submissions {
    pub timer: Option<PhaseTimer>,
    pub flying: VecDeque<InFlight>,
    /// Intervals so far.
    pub submitted: usize,
    /// Nothing has been submitted to this device yet.
    pub fresh: bool,
    pub spare: Vec<wgpu::Buffer>,
}

/// How far the run has been read.
pub struct Progress {
    /// s.
    pub next_row: f64,
    pub next_snapshot: u32,
    /// End of the last interval that was read, s.
    pub read_until: f64,
    pub repeated: u32,
}

/// What is wished of the run from outside.
#[derive(Default)]
pub struct Requests {
    /// What this rank wants done.
    pub wish: Request,
    /// What the ranks want, by the intervals read.
    pub agreed: Request,
    pub stopping: bool,
    /// The signal for which it stops.
    pub signal: Option<u8>,
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
            let cut = Decomposition::new(plan, comm, halo, weighed)?;
            let cut = decomposition.insert(if options.lists_start_short { cut.with_fabric_nearby() } else { cut });
            setup.particles.own(model, comm, share, |particle| cut.owner(plan, particle))?
        } else {
            let ranks = comm.size();
            setup.particles.own(model, comm, share, |particle| particle.id() as usize % ranks)?
        };
        let place = decomposition.as_ref().map_or_else(|| SubdomainBox::alone(plan), |cut| cut.place().1);
        let mut subdomain = Subdomain::new(device, setup.domain.clone(), place, &own)?;
        if options.dispatch_by_lengths {
            subdomain.dispatch_by_lengths();
        }
        let fabric = ElasticFabric::new(model, device, &mut subdomain)?;
        let scene = &model.scene;
        let inflow = model.inflow();
        let parallel = Parallel {
            exchange: match ranks {
                Ranks::Alone(_) => Exchange::none(),
                Ranks::Among(comm) => Exchange::new(comm),
            },
            decomposition,
            balance: Balance::new(options.balance, comm.size()),
            halo_tuner: Tuner::new(plan.rounds, options.halo),
        };
        let control = Control {
            clock: Clock::new(plan),
            ladder: Ladder::new(plan, setup.volumes.to_vec()),
            surfaces: SurfaceStates::new(model),
            feedback: VecDeque::new(),
        };
        let books = Books {
            averages: Averages::new(plan, setup.layout.clone(), setup.patches),
            account: Account::new(plan),
            guards: Guards::new(&model.scene, plan, setup.volumes.to_vec()),
            vents: vec![VentWatch::default(); scene.vents.len()],
        };
        let submissions = Submissions {
            timer: PhaseTimer::new(device)?,
            flying: VecDeque::new(),
            submitted: 0,
            fresh: true,
            spare: Vec::new(),
        };
        let next_row = plan.end_time / f64::from(scene.output.rows.max(1));
        Ok(Simulation {
            subdomain,
            fabric,
            inflow,
            parallel,
            control,
            books,
            submissions,
            progress: Progress { next_row, next_snapshot: 0, read_until: 0.0, repeated: 0 },
            requests: Requests::default(),
            switching: Switching::new(model)?,
            switched: false,
            resumed: false,
            began: Instant::now(),
            lists: Lists::default(),
            options,
            model,
            device,
            ranks,
        })
    }

    /// The same run from a state on: its set-up has the particles of that moment.
    ///
    /// # Errors
    /// If the state is of another run.
    pub fn resume(mut self, state: &RunState) -> Result<Simulation<'a>, SimulationError> {
        self.control.clock.restore(&state.clock)?;
        self.control.ladder.restore(&state.ladder)?;
        self.books.averages.restore(&state.averages)?;
        self.books.account.restore(&self.model.plan, &state.account)?;
        self.inflow.restore(&state.inflow).map_err(RunStateError::from)?;
        for wanted in &state.feedback {
            self.control.ladder.check(&wanted.demand.shares)?;
        }
        self.control.feedback = state.feedback.iter().cloned().collect();
        self.control.surfaces.restore(&state.surfaces)?;
        self.books.guards.restore(&state.guards);
        self.switching.restore(&state.switch)?;
        if state.vents.len() != self.model.scene.vents.len() {
            let [found, expected] = [state.vents.len(), self.model.scene.vents.len()].map(|n| n as u64);
            return Err(RunStateError::differs("vents", found, expected).into());
        }
        self.books.vents.clone_from(&state.vents);
        if let (Some(fabric), Some(known)) = (&mut self.fabric, &state.fabric) {
            fabric.put(self.device, known, (self.ranks.comm().rank() == 0, self.control.clock.time()))?;
        }
        self.submissions.submitted = state.submitted as usize;
        self.progress.next_row = state.next_row;
        self.progress.next_snapshot = state.next_snapshot;
        self.progress.read_until = state.read_until;
        self.progress.repeated = state.repeated;
        self.resumed = true;
        Ok(self)
    }

    /// With nothing under way. Collective.
    pub(super) fn state(&self) -> Result<RunState, SimulationError> {
        let fabric = self.fabric.as_ref().map(|fabric| fabric.state(self.device, self.ranks.comm())).transpose()?;
        Ok(RunState {
            fabric,
            clock: self.control.clock.state(),
            ladder: self.control.ladder.state(),
            averages: self.books.averages.state(),
            account: self.books.account.state().clone(),
            inflow: self.inflow.state(),
            feedback: self.control.feedback.iter().cloned().collect(),
            surfaces: self.control.surfaces.state().clone(),
            guards: self.books.guards.state().clone(),
            switch: self.switching.state().clone(),
            vents: self.books.vents.clone(),
            submitted: self.submissions.submitted as u64,
            next_row: self.progress.next_row,
            next_snapshot: self.progress.next_snapshot,
            read_until: self.progress.read_until,
            repeated: self.progress.repeated,
        })
    }
}
