//! Runs from a state in the middle of a run: each process comes to it alone, and goes on from it among the others.

use std::path::Path;

use corpuscle::gpu::Device;
use corpuscle::output::{
    Adapter, AppendedState, Checkpoint, CheckpointWriter, HistoryState, Moment as Written, Origin, OutputState,
    RunContext,
};
use corpuscle::ranks::{Communicator, Solo};
use corpuscle::simulation::{
    Model, Moment, Observer, Options, Request, RowObserver, RunState, Setup, Simulation, SimulationError,
};
use corpuscle::subdomain::GpuParticle;

use crate::whole_run::{Run, Witness};

/// Cuts a run after so many steps, at the end of an interval.
struct Cutter {
    after: u64,
    state: Option<(RunState, Vec<GpuParticle>)>,
}

impl RowObserver for Cutter {}

impl Observer for Cutter {
    fn request(&mut self, steps: u64) -> Request {
        if steps >= self.after { Request::CheckpointAndStop(None) } else { Request::None }
    }

    fn checkpoint(&mut self, moment: &Moment<'_>) -> Result<(), SimulationError> {
        self.state = Some((moment.state.clone(), moment.own.to_vec()));
        Ok(())
    }
}

/// As two ranks would have written it.
fn saved(parent: &Path, model: &Model, state: &RunState, particles: &[GpuParticle]) -> Checkpoint {
    let writer = CheckpointWriter::new(parent, 1);
    let parts = [&particles[..particles.len() / 3], &particles[particles.len() / 3..]];
    let write = |(rank, part)| writer.particles(rank, bytemuck::cast_slice(part));
    let files = parts.into_iter().enumerate().map(write).collect::<Result<_, _>>().expect("files");
    let moment = Written { step: 1, time: 0.0, particles: particles.len() as u64, ids: u64::from(u32::MAX) };
    let plan = model.plan.to_toml().expect("a plan");
    let origin = Origin::new(&model.scene, plan, Adapter::default()).expect("an origin");
    let file = AppendedState { bytes: 0, crc32: 0 };
    let output = OutputState { history: HistoryState { rows: 0, file }, snapshots: None };
    let path =
        writer.commit(files, &moment, RunContext { origin: &origin, state, output: &output }).expect("a checkpoint");
    Checkpoint::open(&path).expect("a checkpoint")
}

/// What is left of a run after so many steps, on these ranks.
pub fn go_on(
    model: &Model,
    after: u64,
    device: &Device,
    comm: &dyn Communicator,
    options: Options<'_>,
) -> Result<Run, SimulationError> {
    let mut cutter = Cutter { after, state: None };
    Simulation::new(model, device, Options::default())?.run(&mut cutter)?;
    let (state, particles) = cutter.state.expect("a state");
    let folder = tempfile::tempdir().expect("a folder");
    let setup = match comm.size() {
        1 => Setup::with_particles(model, device, 1, particles)?,
        // Each reads its share of files that are the same for all.
        ranks => Setup::from_checkpoint(model, device, ranks, saved(folder.path(), model, &state, &particles))?,
    };
    let mut witness = Witness::default();
    let outcome = Simulation::among(model, device, &setup, comm, options)?.resume(&state)?.run(&mut witness)?;
    Ok(Run { rows: witness.rows, snapshots: witness.snapshots, outcome })
}

/// The same on one process.
pub fn go_on_alone(model: &Model, after: u64, device: &Device) -> Run {
    go_on(model, after, device, &Solo::new(), Options::default()).expect("a run")
}
