//! What the ranks of a verb agree on.

use super::devices;
use super::ending::Ending;
use crate::cli::{CliError, terminal};
use crate::ranks::{Communicator, from_environment};

/// What every rank has made of the same input: if it is bad, the first to find that so says it, and the others wait for the end
/// that this puts to all.
///
/// # Errors
/// The error of this rank.
pub fn once<T>(prepared: Result<T, CliError>, comm: &dyn Communicator) -> Result<T, CliError> {
    let failed = comm.all_gather(vec![u8::from(prepared.is_err())])?;
    if failed.iter().position(|failed| *failed != [0]).is_some_and(|first| first != comm.rank()) {
        comm.barrier()?;
    }
    prepared
}

/// What this process does as a rank of those that a launcher may have started.
pub fn among_ranks(
    verb: &str,
    work: impl FnOnce(&dyn Communicator) -> Result<Ending, CliError>,
) -> Result<Ending, CliError> {
    let comm = from_environment()?;
    let done = devices::agree_on_verb(verb, &*comm).and_then(|()| work(&*comm));
    if let Err(error) = &done {
        if comm.size() > 1 {
            terminal::keep(error);
        }
        // Under a launcher this ends all ranks, and nobody tells of the error later; alone it changes nothing.
        comm.fail(&terminal::report(error), error.exit_code().into());
    }
    done
}
