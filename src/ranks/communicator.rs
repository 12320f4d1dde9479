//! What joins the ranks of one run.

use super::error::{LONGEST_MESSAGE, RankError};
use super::reduction::Reduction;

/// *Collective* calls are made by every rank, all in the same sequence, whether they start or finish something.
/// Whoever gets an error of any call, or
/// stops for a reason of its own while others go on, calls [`Communicator::fail`].
pub trait Communicator {
    fn rank(&self) -> usize;

    fn size(&self) -> usize;

    /// The rank's number among those of its machine, which chooses the device.
    fn node_rank(&self) -> usize;

    /// How many ranks are on its machine.
    fn node_size(&self) -> usize;

    /// Whether the ranks are threads of one process, and so share one device.
    fn in_process(&self) -> bool;

    /// Starts to send `message` and returns at once. `dest` is another rank.
    fn send(&self, dest: usize, message: Vec<u8>) -> Result<(), RankError>;

    /// The next message from `source`, another rank, waiting for it.
    fn receive(&self, source: usize) -> Result<Vec<u8>, RankError>;

    /// Collective: starts to form the wrapping sums and the maxima, element by element, over all ranks. Several
    /// may be under way.
    fn start_reduction(&self, sums: Vec<u64>, maxima: Vec<u64>) -> Result<Reduction, RankError>;

    /// Collective: the sums and maxima, waiting for them. Reductions are finished in the order started.
    fn finish_reduction(&self, reduction: Reduction) -> Result<(Vec<u64>, Vec<u64>), RankError>;

    /// Collective: every rank's bytes, by rank, at rank 0; nothing elsewhere.
    fn gather(&self, message: Vec<u8>) -> Result<Option<Vec<Vec<u8>>>, RankError>;

    /// Collective: every rank's bytes, by rank, everywhere.
    fn all_gather(&self, message: Vec<u8>) -> Result<Vec<Vec<u8>>, RankError>;

    /// Collective: rank 0's bytes everywhere; what others give is not looked at.
    fn broadcast(&self, message: Vec<u8>) -> Result<Vec<u8>, RankError>;

    /// Collective: returns when all ranks have called it.
    fn barrier(&self) -> Result<(), RankError>;

    /// Ends all ranks promptly. In one process the pending and later calls of every rank give
    /// [`RankError::Failed`] with the first failure, and this returns. Under MPI the message goes to standard
    /// error with the rank, every process is ended, and this does not return.
    fn fail(&self, message: &str, exit_code: i32);

    /// Collective: the wrapping sums, element by element, over all ranks.
    fn sum(&self, values: Vec<u64>) -> Result<Vec<u64>, RankError> {
        let started = self.start_reduction(values, Vec::new())?;
        Ok(self.finish_reduction(started)?.0)
    }

    /// Collective: the maxima, element by element, over all ranks.
    fn maximum(&self, values: Vec<u64>) -> Result<Vec<u64>, RankError> {
        let started = self.start_reduction(Vec::new(), values)?;
        Ok(self.finish_reduction(started)?.1)
    }
}

/// The message, if it is short enough.
pub(super) fn within_limit(message: Vec<u8>) -> Result<Vec<u8>, RankError> {
    if message.len() <= LONGEST_MESSAGE { Ok(message) } else { Err(RankError::TooLong { bytes: message.len() }) }
}

/// Whether rank `own` of `size` may exchange messages with rank `other`.
pub(super) fn check_other(own: usize, other: usize, size: usize) -> Result<(), RankError> {
    match other {
        other if other >= size => Err(RankError::NoSuchRank { rank: other, size }),
        other if other == own => Err(RankError::Oneself { rank: own }),
        _ => Ok(()),
    }
}

/// What a panic says.
pub(super) fn panic_message(panic: &(dyn std::any::Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("without a message")
}
