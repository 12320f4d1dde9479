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
mod communicator;
mod devices;
mod environment;
mod error;
mod in_process;
mod launcher;
#[cfg(feature = "mpi")]
mod mpi;
mod reduction;
mod schedule;
mod solo;
#[cfg(test)]
mod tests;

pub use agreement::agree;
pub use communicator::Communicator;
pub use devices::choose_device;
pub use environment::from_environment;
pub use error::{LONGEST_MESSAGE, RankError};
pub use in_process::in_process;
pub use launcher::one_of_several;
pub use reduction::Reduction;
pub use schedule::Pace;
pub use solo::Solo;
