//! What a run goes on from.

use crate::output::{Adapter, Checkpoint, CheckpointError, OutputFolder, OutputState};
use crate::simulation::RunState;

/// What a run goes on from.
pub struct Beginning {
    pub checkpoint: Checkpoint,
    pub state: RunState,
    pub output: OutputState,
    /// The run's folder; on rank 0.
    pub folder: Option<OutputFolder>,
}

impl Beginning {
    pub fn new(checkpoint: Checkpoint, folder: Option<OutputFolder>) -> Result<Beginning, CheckpointError> {
        let (output, state) = checkpoint.state()?;
        Ok(Beginning { checkpoint, state, output, folder })
    }

    pub fn step(&self) -> u64 {
        self.checkpoint.manifest().step
    }

    /// s.
    pub fn time(&self) -> f64 {
        self.checkpoint.manifest().time
    }

    /// Says where the run goes on, and what may make its bits differ from there.
    pub fn warn(&self, adapter: &Adapter) {
        let path = self.checkpoint.path().display();
        tracing::info!("goes on from {path}: step {}, {:.4} ms", self.step(), 1e3 * self.time());
        for warning in self.checkpoint.warnings(adapter) {
            tracing::warn!("{warning}");
        }
    }
}
