//! What a run has on its device and has done there, for those who measure it.

use super::simulation::Simulation;
use crate::gpu::Constants;
use crate::output::PhaseTable;
use crate::simulation::SimulationError;
use crate::simulation::accounting::lists::Lists;
use crate::simulation::timeloop::observer::Observer;

/// What was read of a run so far, since its start.
#[derive(Debug, Clone, PartialEq)]
pub struct Done {
    pub phases: PhaseTable,
    pub collisions: u64,
    pub bounces: u64,
    /// Particles that entered.
    pub entered: u64,
    pub lists: Lists,
}

impl Simulation<'_> {
    /// Waits for all that is under way and reads it; the run can go on.
    ///
    /// # Errors
    /// As [`Simulation::run`].
    pub fn settle(&mut self, observer: &mut dyn Observer) -> Result<(), SimulationError> {
        self.read_all(observer)
    }

    /// What the intervals that were read have done.
    pub fn done(&self) -> Done {
        let state = self.books.account.state();
        Done {
            phases: self.books.account.phases(),
            collisions: state.collisions,
            bounces: state.bounces,
            entered: self.inflow.entered_by_gas().iter().sum(),
            lists: self.lists,
        }
    }

    /// Of the neighbour lists of the last step: entries for each particle, and the share of the particles that have any; 0 of a
    /// method without.
    ///
    /// # Errors
    /// If the device fails.
    pub fn mean_lists(&self) -> Result<[f64; 2], SimulationError> {
        Ok(self.subdomain.mean_lists(self.device)?)
    }

    /// What the kernels are specialised by.
    pub fn constants(&self) -> &Constants {
        self.subdomain.constants()
    }

    /// Bytes of the device's buffers that grow with the particles (among ranks with the copies that are kept to run an interval
    /// again) and of those that grow with the cells.
    pub fn buffer_bytes(&self) -> [u64; 2] {
        let copies: u64 = self.submissions.spare.iter().map(wgpu::Buffer::size).sum();
        [self.subdomain.bytes() + copies, self.subdomain.cell_bytes()]
    }
}
