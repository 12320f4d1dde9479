//! What a run leaves behind while it goes on: rows, snapshots, and the display of its progress.

use std::path::Path;

use crate::output::{History, HistoryWriter, OutputError, ParticleRow, Progress, SnapshotWriter};
use crate::simulation::{Model, Observer, Outcome, Row, SimulationError};
use crate::subdomain::{GpuParticle, Scales};

use super::reference::Reference;
use super::table::{columns, values};

pub struct Recorder<'a> {
    model: &'a Model,
    reference: Reference,
    history: HistoryWriter,
    /// `None` in a scene that wants no snapshots.
    snapshots: Option<SnapshotWriter>,
    /// s, of the last snapshot.
    last_snapshot: Option<f64>,
    progress: Option<Progress>,
}

impl<'a> Recorder<'a> {
    /// Starts the files in the existing folder `dir`; the walls are written at once.
    pub fn new(model: &'a Model, reference: Reference, dir: &Path, shown: bool) -> Result<Recorder<'a>, OutputError> {
        let history = HistoryWriter::create(dir, &columns(&model.scene))?;
        let snapshots = match model.scene.output.snapshots {
            0 => None,
            _ => {
                let writer = SnapshotWriter::create(dir)?;
                let triangles = &model.vessel.triangles;
                let corners: Vec<[u32; 3]> = triangles.iter().map(|triangle| triangle.vertices).collect();
                let walls: Vec<u32> = triangles.iter().map(|triangle| triangle.wall).collect();
                writer.write_walls(&model.vessel.vertices, &corners, &walls)?;
                Some(writer)
            }
        };
        let progress = shown.then(|| Progress::new(model.plan.end_time));
        Ok(Recorder { model, reference, history, snapshots, last_snapshot: None, progress })
    }

    pub fn history(&self) -> &History {
        self.history.history()
    }

    /// The state at the end, if the run was stopped between two snapshots, and the rates of the whole run.
    pub fn finish(&mut self, outcome: &Outcome) -> Result<(), OutputError> {
        if let Some(progress) = &mut self.progress {
            progress.finish(outcome.time, outcome.steps, outcome.particle_steps);
        }
        if self.last_snapshot == Some(outcome.time) {
            return Ok(());
        }
        self.write_snapshot(outcome.time, &outcome.particles)
    }

    fn write_snapshot(&mut self, time: f64, particles: &[GpuParticle]) -> Result<(), OutputError> {
        let Some(writer) = &mut self.snapshots else {
            return Ok(());
        };
        let plan = &self.model.plan;
        let scales = Scales::new(plan);
        let rows: Vec<ParticleRow> = particles
            .iter()
            .map(|particle| ParticleRow {
                id: particle.id(),
                gas: particle.gas(),
                position: plan.grid.to_metres(particle.position),
                velocity: particle.velocity,
                spin_energy: (f64::from(particle.spin) * scales.reference_mass) as f32,
            })
            .collect();
        writer.write(time, &rows)?;
        self.last_snapshot = Some(time);
        Ok(())
    }
}

/// The error's text names the file.
fn stop(error: OutputError) -> SimulationError {
    SimulationError::Observer(error.to_string())
}

impl Observer for Recorder<'_> {
    fn row(&mut self, row: &Row) -> Result<(), SimulationError> {
        self.history.row(&values(row, &self.reference)).map_err(stop)
    }

    fn snapshot(&mut self, time: f64, particles: &[GpuParticle], _owners: &[u32]) -> Result<(), SimulationError> {
        self.write_snapshot(time, particles).map_err(stop)
    }

    fn progress(&mut self, time: f64, steps: u64, particle_steps: u64) {
        if let Some(progress) = &mut self.progress {
            progress.update(time, steps, particle_steps);
        }
    }
}
