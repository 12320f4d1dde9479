//! What a run is asked for, what it tells while it goes, and what it leaves.

use super::interrupt::Request;
use super::setup::Shuffle;
use crate::output::{Audit, FabricSnapshot, PhaseTable};
use crate::ranks::Communicator;
use crate::simulation::accounting::guards::GuardWarning;
use crate::simulation::error::SimulationError;
use crate::simulation::parallel::balance::{BalanceOptions, BalanceRecord};
use crate::simulation::parallel::exchange::Traffic;
use crate::simulation::parallel::halo_tuner::HaloOptions;
use crate::simulation::run_state::RunState;
use crate::simulation::zero_d::rows::RowObserver;
use crate::subdomain::GpuParticle;

/// What does not change a result (but for `hold_step`).
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
    /// Nobody asks for the particles at the end: the outcome has none.
    pub discard_particles: bool,
    /// The first warning stops the run.
    pub strict: bool,
    /// The step stays the plan's, whatever the state asks for: for studies of steps that are too long.
    pub hold_step: bool,
    /// Neighbour lists begin with room for thin gas, whatever the density, which grows on the way, on a device alone by no more than it must; and
    /// among ranks fabric is listed in few cells: for tests of that.
    pub lists_start_short: bool,
    /// On a GPU, too, kernels over short lists are dispatched by the lengths of these, as those over long ones: for
    /// tests of that.
    pub dispatch_by_lengths: bool,
    /// What is not given of it is tried out.
    pub halo: HaloOptions,
    pub balance: BalanceOptions,
}

/// Is told of the run as it goes, beside its rows.
pub trait Observer: RowObserver {
    /// The particles by id at a time (s), and the rank that owns each.
    ///
    /// # Errors
    /// What stops the run.
    fn snapshot(&mut self, _time: f64, _particles: &[GpuParticle], _owners: &[u32]) -> Result<(), SimulationError> {
        Ok(())
    }

    /// The fabric: at a snapshot, before it.
    fn fabric(&mut self, _fabric: FabricSnapshot) {}

    /// The boxes of the ranks, by rank, as low and high corner (m): at a snapshot, before it.
    fn boxes(&mut self, _boxes: &[[[f64; 3]; 2]]) {}

    /// What the ranks had to do in an interval.
    ///
    /// # Errors
    /// What stops the run.
    fn balance(&mut self, _record: &BalanceRecord) -> Result<(), SimulationError> {
        Ok(())
    }

    /// Something has left its limits; each is told once.
    fn warning(&mut self, _told: &GuardWarning) {}

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
}

impl RowObserver for () {}

impl Observer for () {}

/// All that a run needs to be continued, on one rank.
pub struct Moment<'a> {
    pub step: u64,
    /// s.
    pub time: f64,
    /// Particles that are there.
    pub particles: u64,
    /// Those that entered and the initial ones, whether they are there or have left: ids are below.
    pub ids: u64,
    pub state: &'a RunState,
    /// Of this rank.
    pub own: &'a [GpuParticle],
    pub comm: &'a dyn Communicator,
    /// The run stops here because it was asked to.
    pub stopping: bool,
}

/// How a run went on as a control volume.
#[derive(Debug, Clone, PartialEq)]
pub struct Continued {
    /// s.
    pub until: f64,
    /// Why from the time of the particles on.
    pub why: String,
    /// Of what followed.
    pub audit: Audit,
}

/// What a run leaves.
pub struct Outcome {
    /// By id; on rank 0, and where they are not discarded.
    pub particles: Vec<GpuParticle>,
    /// The rank that owned each of them.
    pub owners: Vec<u32>,
    pub fabric: FabricSnapshot,
    pub audit: Audit,
    /// What a control volume did after the particles.
    pub continued: Option<Continued>,
    /// What has left its limits, and when, since the start of the run.
    pub warnings: Vec<GuardWarning>,
    pub phases: PhaseTable,
    pub steps: u64,
    pub particle_steps: u64,
    pub collisions: u64,
    pub bounces: u64,
    /// s, of the particles; the end time unless the run was stopped earlier, or switched to a control volume.
    pub time: f64,
    /// How often steps were run again with larger buffers.
    pub repeated: u32,
    /// Smallest and largest step taken, s.
    pub step_range: [f64; 2],
    /// What this rank sent and waited for.
    pub traffic: Traffic,
    /// How often the cells were shared out anew.
    pub rebalances: usize,
    /// Wall time of the steps, s: without the set-up, and without the account at the end.
    pub stepping_seconds: f64,
    /// The signal that stopped it, the same on all ranks.
    pub signal: Option<u8>,
}
