//! How a run ends.

use crate::cli::CliError;
use crate::ranks::Communicator;
use crate::simulation::Outcome;

/// How a run has ended that nothing went wrong with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// At its end, or where it was asked to stop by an option.
    Done,
    /// For a signal, with a checkpoint. The same on all ranks.
    Stopped { signal: u8 },
}

impl Ending {
    /// As of a shell for a process that a signal has ended.
    pub fn exit_code(self) -> u8 {
        match self {
            Ending::Done => 0,
            Ending::Stopped { signal } => 128 + signal.min(127),
        }
    }
}

/// Rank 0 may still be writing when others are done: a launcher ends all when the first ends for a signal.
pub(super) fn ending(outcome: &Outcome, comm: &dyn Communicator) -> Result<Ending, CliError> {
    let Some(signal) = outcome.signal else { return Ok(Ending::Done) };
    comm.barrier()?;
    Ok(Ending::Stopped { signal })
}
