//! What a step costs, phase by phase: time, bytes, operations, and their share of what the device can do.
//!
//! Each run is a published scene at its start, at a stated occupancy, step and number of rounds, so that figures of two
//! devices or two versions compare. What the device can do at most is measured in the same run ([`Ceilings`]); bytes are
//! counted from the buffers ([`traffic`]), operations from the kernels ([`operations`]), both by what the run did ([`Work`]).

mod ceilings;
mod collision_cells;
mod host;
pub mod operations;
pub mod report;
pub mod traffic;
mod work;

use std::time::Instant;

use crate::gpu::{Device, Operations};
use crate::output::PhaseTable;
use crate::scene::Method;
use crate::simulation::{Options, Simulation};
use crate::study::StudyError;
use crate::study::pareto::{Setting, model_with};
use crate::study::verify::scene_of;

pub use ceilings::Ceilings;
pub use collision_cells::CollisionCells;
use host::{CpuTime, HostLoad, threads};
use operations::Counted;
pub use work::{BenchedRun, Work};

/// A published scene.
pub struct BenchScene {
    pub name: &'static str,
    text: &'static str,
}

pub const SCENES: [BenchScene; 3] = [
    BenchScene { name: "box", text: include_str!("../../../scenes/box.toml") },
    BenchScene { name: "tank", text: include_str!("../../../scenes/tank.toml") },
    BenchScene { name: "corner", text: include_str!("../../../scenes/corner.toml") },
];

/// Occupancy, step and rounds of all runs: those of the targets.
pub const OCCUPANCY: f64 = 0.12;
pub const STEP: f64 = 0.1;
pub const ROUNDS: u32 = 2;

/// What was run, and what came of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    pub scene: &'static str,
    pub method: Method,
    /// x of the plan's step, without collisions 0.
    pub step: f64,
    /// Those that count, and those before.
    pub steps: u64,
    pub warm_steps: u64,
    pub particle_steps: u64,
    /// Wall time of the steps, s: all that lies between the phases is in it.
    pub seconds: f64,
    /// By phase; empty of a device that does not time them.
    pub costs: Vec<Cost>,
    pub host: HostLoad,
    pub work: Work,
    /// Bytes of the device's buffers that grow with particles and cells, and how many of each there is room for.
    pub buffers: [u64; 2],
    pub cells: u64,
    pub present: u64,
}

/// A phase in all steps.
#[derive(Debug, Clone, PartialEq)]
pub struct Cost {
    pub phase: String,
    /// Of the device.
    pub seconds: f64,
    pub dispatches: u64,
    /// `None` of a phase that is not counted.
    pub bytes: Option<f64>,
    pub operations: Option<Operations>,
}

impl Measured {
    /// Particle-steps per second of wall time.
    pub fn rate(&self) -> f64 {
        self.particle_steps as f64 / self.seconds
    }

    /// Particle-steps per second if each phase took no more than its counted bytes take at the rate of the copy, or its counted
    /// operations at the rate of arithmetic, whichever is longer; `None` where no phase is counted.
    pub fn rate_at_ceilings(&self, ceilings: &Ceilings) -> Option<f64> {
        let at_least = |cost: &Cost| {
            let moved = cost.bytes.unwrap_or(0.0) / ceilings.copy;
            moved.max(cost.operations.map_or(0.0, Operations::all) / ceilings.arithmetic)
        };
        let seconds: f64 = self.costs.iter().map(at_least).sum();
        (seconds > 0.0).then(|| self.particle_steps as f64 / seconds)
    }

    /// Particle-steps per second that this project wants of such a device; `None` of a method without a target.
    pub fn target(&self, device: &Device) -> Option<f64> {
        target(self.method, device.adapter().is_cpu())
    }
}

/// Per second: of a GPU of some 5 TB/s, or of one core of a CPU for each thread of the software device.
fn target(method: Method, cpu: bool) -> Option<f64> {
    let [gpu, core] = match method {
        Method::ClosestApproach => [4e9, 3e6],
        Method::Cell => [1e10, 12e6],
        Method::None => [3e10, 40e6],
        Method::HardSphere | Method::HalfTurn | Method::ControlVolume => return None,
    };
    Some(if cpu { core * threads() } else { gpu })
}

/// Runs a scene for some steps, after an interval that does not count: in it kernels are compiled and buffers touched for the first
/// time, and lists get their room.
///
/// # Errors
/// If the scene cannot be planned so, or a run fails.
pub fn measure(
    device: &Device,
    scene: &BenchScene,
    method: Method,
    particles: u64,
    steps: u64,
) -> Result<Measured, StudyError> {
    let mut asked = scene_of(scene.name, scene.text)?;
    asked.output.snapshots = 0;
    // Where particles have no diameter the step is the plan's.
    let collides = !matches!(method, Method::None | Method::HalfTurn);
    let setting = Setting {
        method: Some(method),
        particles: Some(particles),
        occupancy: collides.then_some(OCCUPANCY),
        step: collides.then_some(STEP),
        rounds: method.has_rounds().then_some(ROUNDS),
    };
    let model = model_with(scene.name, asked, &setting, None)?;
    let warm = u64::from(model.plan.steps_per_interval);
    let options = Options { stop_after_steps: Some(warm + steps), ..Options::default() };
    let mut simulation = Simulation::new(&model, device, options)?;
    simulation.begin(&mut ())?;
    simulation.advance(&mut ())?;
    simulation.settle(&mut ())?;
    ceilings::wake(device)?;
    let before = simulation.done();
    let (start, cpu_start) = (Instant::now(), CpuTime::now());
    while simulation.advance(&mut ())? {}
    simulation.settle(&mut ())?;
    let (seconds, cpu) = (start.elapsed().as_secs_f64(), CpuTime::now().since(cpu_start));
    let after = simulation.done();
    let lists = simulation.mean_lists()?;
    let buffers = simulation.buffer_bytes();
    let counted = Counted::new(simulation.constants())?;
    let outcome = simulation.finish(&mut ())?;
    let run = BenchedRun { before: &before, after: &after, outcome: &outcome, lists };
    let work = Work::new(&model, &run, device.variant());
    let phases = since(&before.phases, &after.phases);
    let costs = phases.rows.iter().map(|(name, seconds, dispatches)| Cost {
        phase: name.clone(),
        seconds: *seconds,
        dispatches: *dispatches,
        bytes: traffic::bytes(name, method, &work),
        operations: operations::operations(name, method, &work, &counted),
    });
    Ok(Measured {
        scene: scene.name,
        method,
        step: if collides { STEP } else { 0.0 },
        steps: phases.steps,
        warm_steps: before.phases.steps,
        particle_steps: phases.particle_steps,
        seconds,
        costs: costs.collect(),
        host: HostLoad::new(cpu, seconds, device.adapter().is_cpu()),
        work,
        buffers,
        cells: if method == Method::None { 0 } else { model.plan.grid.cell_count() as u64 },
        present: outcome.particles.len() as u64,
    })
}

/// What a table has that it did not have before.
fn since(before: &PhaseTable, after: &PhaseTable) -> PhaseTable {
    let rows = after.rows.iter().map(|(name, seconds, dispatches)| {
        let (_, then, done) = before.rows.iter().find(|(known, ..)| known == name).cloned().unwrap_or_default();
        (name.clone(), seconds - then, dispatches - done)
    });
    PhaseTable {
        rows: rows.collect(),
        steps: after.steps - before.steps,
        particle_steps: after.particle_steps - before.particle_steps,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_before_does_not_count() {
        let row = |name: &str, seconds, dispatches| (name.to_owned(), seconds, dispatches);
        let before = PhaseTable { rows: vec![row("bin", 0.5, 32)], steps: 32, particle_steps: 3200 };
        let after =
            PhaseTable { rows: vec![row("bin", 0.75, 96), row("tally", 0.1, 8)], steps: 96, particle_steps: 9600 };
        let expected =
            PhaseTable { rows: vec![row("bin", 0.25, 64), row("tally", 0.1, 8)], steps: 64, particle_steps: 6400 };
        assert_eq!(since(&before, &after), expected);
    }
}
