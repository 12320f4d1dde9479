//! What a run has on its device, for those who measure it.

use crate::simulation::SimulationError;
use crate::simulation::observer::Observer;

use super::Simulation;

impl Simulation<'_> {
    /// Waits for all that is under way and reads it; the run can go on.
    ///
    /// # Errors
    /// As [`Simulation::run`].
    pub fn settle(&mut self, observer: &mut dyn Observer) -> Result<(), SimulationError> {
        self.read_all(observer)
    }

    /// Entries of a particle's neighbour list in the last step, on average; 0 of a method without.
    ///
    /// # Errors
    /// If the device fails.
    pub fn candidates(&self) -> Result<f64, SimulationError> {
        Ok(self.subdomain.mean_candidates(self.device)?)
    }

    /// Bytes of the device's buffers that grow with the particles (with the copies that are kept to run an interval again)
    /// and of those that grow with the cells.
    pub fn buffer_bytes(&self) -> [u64; 2] {
        let copies: u64 = self.spare.iter().map(wgpu::Buffer::size).sum();
        [self.subdomain.bytes() + copies, self.subdomain.cell_bytes()]
    }
}
