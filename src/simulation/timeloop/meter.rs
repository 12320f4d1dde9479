//! What a run has on its device and has done there, for those who measure it.

use super::simulation::Simulation;
use crate::gpu::Constants;
use crate::output::PhaseTable;
use crate::simulation::SimulationError;
use crate::simulation::timeloop::observer::Observer;
use crate::subdomain::Counters;
use crate::subdomain::registry::RECHOOSE_LISTS;

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

/// Lengths of lists in the last steps of the intervals, summed over these.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Lists {
    pub intervals: u64,
    /// Flights that were tested against walls.
    pub near_walls: u64,
    /// Particles that chose, by round; behind the last those that would have again.
    pub choosers: [u64; RECHOOSE_LISTS as usize],
}

impl Lists {
    pub fn add(&mut self, counters: &Counters) {
        self.intervals += 1;
        self.near_walls += u64::from(counters.near_walls);
        for (sum, own) in self.choosers.iter_mut().zip(counters.choosers) {
            *sum += u64::from(own);
        }
    }
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
