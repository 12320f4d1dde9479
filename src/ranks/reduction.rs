//! Reductions under way: their tickets, finished in the order started, and the agreement on their lengths.

use super::RankError;
use std::cell::Cell;

/// A reduction under way.
#[must_use = "a reduction that is never finished bars those started after it"]
#[derive(Debug)]
pub struct Reduction(u64);

/// One rank's count of reductions.
#[derive(Debug, Default)]
pub(super) struct Tickets {
    started: Cell<u64>,
    finished: Cell<u64>,
}

impl Tickets {
    pub(super) fn start(&self) -> Reduction {
        Reduction(self.started.replace(self.started.get() + 1))
    }

    /// Takes the ticket back, if it is the oldest.
    pub(super) fn finish(&self, reduction: Reduction) -> Result<(), RankError> {
        let next = self.finished.get();
        if reduction.0 != next {
            return Err(RankError::Order { finished: reduction.0, next });
        }
        self.finished.set(next + 1);
        Ok(())
    }
}

/// How many sums and maxima ranks reduce: the most of each and the complement of the fewest, so that an
/// element-wise maximum over the ranks joins them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lengths(pub(super) [u64; Lengths::WORDS]);

impl Lengths {
    pub(super) const WORDS: usize = 4;

    pub(super) fn of(sums: &[u64], maxima: &[u64]) -> Lengths {
        let (sums, maxima) = (sums.len() as u64, maxima.len() as u64);
        Lengths([sums, !sums, maxima, !maxima])
    }

    pub(super) fn join(&mut self, other: Lengths) {
        for (ours, theirs) in self.0.iter_mut().zip(other.0) {
            *ours = theirs.max(*ours);
        }
    }

    /// An error unless all joined are equal.
    pub(super) fn check(self) -> Result<(), RankError> {
        let [longest_sums, shortest_sums, longest_maxima, shortest_maxima] = self.0;
        let (shortest_sums, shortest_maxima) = (!shortest_sums, !shortest_maxima);
        if shortest_sums == longest_sums && shortest_maxima == longest_maxima {
            return Ok(());
        }
        Err(RankError::Lengths { shortest_sums, longest_sums, shortest_maxima, longest_maxima })
    }
}
