//! Lengths of the lists that kernels go through.

use crate::subdomain::Counters;
use crate::subdomain::registry::RECHOOSE_LISTS;

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
