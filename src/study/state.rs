//! States of a run that a study starts from: its start, or checkpoints of it.

use std::path::{Path, PathBuf};

use crate::output::{Checkpoint, latest, run_folder};
use crate::scene::parse;
use crate::simulation::{Clock, Model, ModelError, RunState, particles_of};
use crate::subdomain::GpuParticle;

use super::StudyError;
use super::launched::Start;

/// A moment of a run, read from a checkpoint.
pub struct Moment {
    /// The folder or checkpoint that was named.
    pub from: PathBuf,
    pub start: Start,
    pub model: Model,
    pub run: RunState,
    /// All of them, by id.
    pub particles: Vec<GpuParticle>,
    /// s.
    pub time: f64,
}

impl Moment {
    /// # Errors
    /// If there is no sound checkpoint, or its scene cannot be planned as it was.
    pub fn read(from: &Path) -> Result<Moment, StudyError> {
        let path = latest(from)?;
        let checkpoint = Checkpoint::open(&path)?;
        let folder = run_folder(from, &path);
        let name = checkpoint.path().join("scene.toml").display().to_string();
        let scene = parse(&checkpoint.scene_here()?, &name, Path::new(""))?;
        let unsound = |error: ModelError| StudyError::Model { from: from.to_path_buf(), error: Box::new(error) };
        let mut model = Model::new(scene).map_err(unsound)?;
        checkpoint.restore_names(&mut model.scene);
        checkpoint.check_plan(&model.plan.to_toml().map_err(StudyError::PlanToml)?)?;
        let (_, run) = checkpoint.state()?;
        let particles = particles_of(&checkpoint)?;
        let (step, time) = (checkpoint.manifest().step, checkpoint.manifest().time);
        let start = Start { checkpoint: path, folder, step };
        Ok(Moment { from: from.to_path_buf(), start, model, run, particles, time })
    }

    pub fn name(&self) -> String {
        format!("{:.1} ms", 1e3 * self.time)
    }

    /// The length of the next step, s.
    pub fn step_length(&self) -> f64 {
        Clock::new(&self.model.plan).dt(self.run.ladder.level)
    }
}

/// The steps that each of several moments of one run stands for: each for the time around it, halfway to the next on
/// either side, in steps of its length.
pub fn weights(moments: &[Moment]) -> Vec<f64> {
    let middle = |k: usize| 0.5 * (moments[k - 1].time + moments[k].time);
    let span = |k: usize, moment: &Moment| {
        let from = if k == 0 { 0.0 } else { middle(k) };
        let to = if k + 1 == moments.len() { moment.model.plan.end_time } else { middle(k + 1) };
        (to - from) / moment.step_length()
    };
    moments.iter().enumerate().map(|(k, moment)| span(k, moment)).collect()
}
