//! A run of which everything is kept.

use crate::simulation::RowObserver;
use std::path::Path;

use crate::gpu::Device;
use crate::scene::{self, Scene};
use crate::simulation::{Model, ModelError, Observer, Options, Outcome, Row, Simulation, SimulationError};
use crate::study::StudyError;
use crate::subdomain::GpuParticle;

/// What a run told, and what it left.
pub struct Run {
    pub rows: Vec<Row>,
    /// Time, s, and the particles by id.
    pub snapshots: Vec<(f64, Vec<GpuParticle>)>,
    pub outcome: Outcome,
}

/// Keeps all it is told.
#[derive(Default)]
pub struct Witness {
    pub rows: Vec<Row>,
    pub snapshots: Vec<(f64, Vec<GpuParticle>)>,
}

impl RowObserver for Witness {
    fn row(&mut self, row: &Row) -> Result<(), SimulationError> {
        self.rows.push(row.clone());
        Ok(())
    }
}

impl Observer for Witness {
    fn snapshot(&mut self, time: f64, particles: &[GpuParticle], _owners: &[u32]) -> Result<(), SimulationError> {
        self.snapshots.push((time, particles.to_vec()));
        Ok(())
    }
}

/// The scene of a case's own text.
///
/// # Errors
/// If the text is no scene.
pub fn scene_of(case: &str, text: &str) -> Result<Scene, StudyError> {
    Ok(scene::parse(text, &format!("{case}.toml"), Path::new(""))?)
}

pub(super) fn model_of(case: &str, text: &str) -> Result<Model, StudyError> {
    model_from(case, scene_of(case, text)?)
}

/// `case` stands in the message if its walls or its plan are not sound.
pub(crate) fn model_from(case: &str, scene: Scene) -> Result<Model, StudyError> {
    Model::new(scene).map_err(|error| unsound(case, error))
}

pub(super) fn unsound(case: &str, error: ModelError) -> StudyError {
    StudyError::Model { from: case.into(), error: Box::new(error) }
}

/// # Errors
/// If the run fails.
pub fn run(device: &Device, model: &Model, options: Options<'_>) -> Result<Run, StudyError> {
    let mut witness = Witness::default();
    let outcome = Simulation::new(model, device, options)?.run(&mut witness)?;
    Ok(Run { rows: witness.rows, snapshots: witness.snapshots, outcome })
}
