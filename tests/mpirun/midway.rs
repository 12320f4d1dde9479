//! Runs from a state in the middle of a run: each process comes to it alone, and goes on from it among the others.

use corpuscle::gpu::Device;
use corpuscle::ranks::{Communicator, Solo};
use corpuscle::simulation::{Model, Moment, Observer, Options, Request, RunState, Setup, Simulation, SimulationError};
use corpuscle::subdomain::GpuParticle;

use crate::whole_run::{Run, Witness};

/// Cuts a run after so many steps, at the end of an interval.
struct Cutter {
    after: u64,
    state: Option<(RunState, Vec<GpuParticle>)>,
}

impl Observer for Cutter {
    fn request(&mut self, steps: u64) -> Request {
        if steps >= self.after { Request::CheckpointAndStop } else { Request::None }
    }

    fn checkpoint(&mut self, moment: &Moment<'_>) -> Result<(), SimulationError> {
        self.state = Some((moment.state.clone(), moment.own.to_vec()));
        Ok(())
    }
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
    let setup = Setup::with_particles(model, device, comm.size(), particles)?;
    let mut witness = Witness::default();
    let outcome = Simulation::resume(model, device, &setup, comm, options, &state)?.run(&mut witness)?;
    Ok(Run { rows: witness.rows, snapshots: witness.snapshots, outcome })
}

/// The same on one process.
pub fn go_on_alone(model: &Model, after: u64, device: &Device) -> Run {
    go_on(model, after, device, &Solo::new(), Options::default()).expect("a run")
}
