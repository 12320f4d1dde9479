//! What a step costs, phase by phase: time, bytes, and their share of what the device can do.
//!
//! Each run is a published scene at its start, at a stated occupancy, step and number of rounds, so that figures of two
//! devices or two versions compare. What the device can do at most is measured in the same run ([`Ceilings`]); bytes are
//! counted from the buffers ([`traffic`]).

mod ceilings;
pub mod report;
pub mod traffic;

use std::time::Instant;

use crate::gpu::Device;
use crate::output::PhaseTable;
use crate::scene::Method;
use crate::simulation::{Model, Options, Simulation};
use crate::study::StudyError;
use crate::study::pareto::{Setting, model_with};
use crate::study::verify::scene_of;

pub use ceilings::Ceilings;
use traffic::Work;

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
    pub steps: u64,
    pub particle_steps: u64,
    /// Wall time of the steps, s: all that lies between the phases is in it.
    pub seconds: f64,
    /// Of the device, by phase.
    pub phases: PhaseTable,
    pub work: Work,
    /// Bytes of the device's buffers that grow with particles and cells, and how many of each there is room for.
    pub buffers: [u64; 2],
    pub cells: u64,
    pub present: u64,
}

impl Measured {
    /// Particle-steps per second of wall time.
    pub fn rate(&self) -> f64 {
        self.particle_steps as f64 / self.seconds
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
        Method::HardSphere | Method::ControlVolume => return None,
    };
    Some(if cpu { core * threads() } else { gpu })
}

/// Of a software device: as many as it is told to take, or all cores.
pub fn threads() -> f64 {
    let told = std::env::var("LP_NUM_THREADS").ok().and_then(|text| text.parse::<usize>().ok()).filter(|&n| n > 0);
    told.or_else(|| std::thread::available_parallelism().ok().map(usize::from)).unwrap_or(1) as f64
}

/// Runs a scene for some steps; what is compiled for the first time is not timed.
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
    let collides = method != Method::None;
    let setting = Setting {
        method: Some(method),
        particles: Some(particles),
        occupancy: collides.then_some(OCCUPANCY),
        step: collides.then_some(STEP),
        rounds: method.has_rounds().then_some(ROUNDS),
    };
    let model = model_with(scene.name, asked, &setting, None)?;
    run(device, &model, u64::from(model.plan.steps_per_interval))?;
    let (seconds, outcome, candidates, buffers) = run(device, &model, steps)?;
    let plan = &model.plan;
    let cells: u64 = plan.grid.cells.iter().map(|&n| u64::from(n)).product();
    let steps = outcome.steps as f64;
    let work = Work {
        steps,
        particle_steps: outcome.particle_steps as f64,
        cell_steps: if collides { cells as f64 * steps } else { 0.0 },
        candidates: candidates * outcome.particle_steps as f64,
        newborns: outcome.audit.particles_injected as f64,
        collisions: outcome.collisions as f64,
        bounces: outcome.bounces as f64,
        tallies: (steps / f64::from(plan.tally_every)).floor(),
        zones: zones_read(&model) as f64,
        intervals: (steps / f64::from(plan.steps_per_interval)).ceil(),
    };
    Ok(Measured {
        scene: scene.name,
        method,
        step: if collides { STEP } else { 0.0 },
        steps: outcome.steps,
        particle_steps: outcome.particle_steps,
        seconds,
        phases: outcome.phases,
        work,
        buffers,
        cells: if collides { cells } else { 0 },
        present: outcome.particles.len() as u64,
    })
}

/// Zones whose tally reads the particles: of the whole only where the chambers have not all of them.
fn zones_read(model: &Model) -> usize {
    let chambers = &model.scene.chambers;
    let covered = chambers.last().is_some_and(|chamber| chamber.region.is_none());
    usize::from(!covered) + chambers.len() + model.scene.probes.len()
}

type Ran = (f64, crate::simulation::Outcome, f64, [u64; 2]);

fn run(device: &Device, model: &Model, steps: u64) -> Result<Ran, StudyError> {
    let options = Options { stop_after_steps: Some(steps), ..Options::default() };
    let mut simulation = Simulation::new(model, device, options)?;
    simulation.begin(&mut ())?;
    let start = Instant::now();
    while simulation.advance(&mut ())? {}
    simulation.settle(&mut ())?;
    let seconds = start.elapsed().as_secs_f64();
    let candidates = simulation.candidates()?;
    let buffers = simulation.buffer_bytes();
    let outcome = simulation.finish(&mut ())?;
    Ok((seconds, outcome, candidates, buffers))
}

#[cfg(test)]
mod tests {
    use crate::scene::Region;

    use super::*;
    use crate::study::verify::model_from;

    /// The box has one chamber without a region; the tank two, the last without one, and a probe.
    #[test]
    fn the_whole_is_read_only_where_chambers_have_not_all() {
        let zones = SCENES.map(|scene| {
            let asked = scene_of(scene.name, scene.text).expect("a scene");
            let mut model = model_from(scene.name, asked).expect("a plan");
            let covered = zones_read(&model);
            let last = model.scene.chambers.len() - 1;
            model.scene.chambers[last].region = Some(Region::Box { min: [0.0; 3], max: [0.01; 3] });
            [covered, zones_read(&model)]
        });
        assert_eq!(zones, [[1, 2], [3, 4], [2, 3]]);
    }
}
