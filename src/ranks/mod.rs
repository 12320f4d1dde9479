//! Ranks: the parts of one run, each with its own subdomain, and how they talk.
//!
//! A [`Communicator`] has three forms that one conformance suite holds to the same behaviour: one process
//! ([`Solo`]), several threads of one process ([`in_process`]), and MPI (feature `mpi`). Nothing above knows
//! which. It moves bytes and adds integers; it knows no physics.
//!
//! Invariants: messages between two ranks arrive in the order sent. Sums wrap and maxima are exact, so that no
//! result depends on the order in which ranks contribute. A rank that stops early says so with
//! [`Communicator::fail`], and nobody waits for it any more.

#[doc(hidden)]
pub mod conformance;

mod agreement;
mod collectives;
mod devices;
mod environment;
mod error;
mod in_process;
#[cfg(feature = "mpi")]
mod mpi;
mod reduction;
mod schedule;
mod solo;
#[cfg(test)]
mod tests;

pub use agreement::agree;
pub use devices::choose_device;
pub use environment::{from_environment, one_of_several};
pub use error::RankError;
pub use in_process::in_process;
pub use reduction::Reduction;
pub use schedule::Pace;
pub use solo::Solo;

/// The longest message, and the longest sum of an [`Communicator::all_gather`]: what MPI can count.
pub const LONGEST_MESSAGE: usize = i32::MAX as usize;

/// What joins the ranks of one run.
///
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
fn within_limit(message: Vec<u8>) -> Result<Vec<u8>, RankError> {
    if message.len() <= LONGEST_MESSAGE { Ok(message) } else { Err(RankError::TooLong { bytes: message.len() }) }
}

/// Whether rank `own` of `size` may exchange messages with rank `other`.
fn check_other(own: usize, other: usize, size: usize) -> Result<(), RankError> {
    match other {
        other if other >= size => Err(RankError::NoSuchRank { rank: other, size }),
        other if other == own => Err(RankError::Oneself { rank: own }),
        _ => Ok(()),
    }
}

/// What a panic says.
fn panic_message(panic: &(dyn std::any::Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("without a message")
}
