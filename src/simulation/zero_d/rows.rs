//! Who is told of the rows of a run, of particles or of control volumes.

use crate::simulation::accounting::row::Row;
use crate::simulation::accounting::vent_watch::VentWatch;
use crate::simulation::error::SimulationError;

/// Is told of what a history has.
pub trait RowObserver {
    /// A row of the history.
    ///
    /// # Errors
    /// What stops the run.
    fn row(&mut self, _row: &Row) -> Result<(), SimulationError> {
        Ok(())
    }

    /// A vent has opened, by its index.
    fn vent_opened(&mut self, _index: usize, _watch: &VentWatch) {}

    /// At the end: what was seen of all vents.
    fn vents(&mut self, _watches: &[VentWatch]) {}

    /// Totals so far: simulated time (s), steps, particle-steps.
    fn progress(&mut self, _time: f64, _steps: u64, _particle_steps: u64) {}
}
