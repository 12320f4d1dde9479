//! The ranks of this process: alone, or those of the launcher that started it.

use super::launcher::Launcher;
use super::{Communicator, RankError, Solo};

/// The ranks that this process belongs to: MPI's if a launcher started it, else itself alone.
pub fn from_environment() -> Result<Box<dyn Communicator>, RankError> {
    match Launcher::find(|name| std::env::var(name).ok()) {
        Some(launcher) => launched(launcher),
        None => Ok(Box::new(Solo::new())),
    }
}

#[cfg(feature = "mpi")]
fn launched(launcher: Launcher) -> Result<Box<dyn Communicator>, RankError> {
    Ok(Box::new(super::mpi::Mpi::start(&launcher)?))
}

#[cfg(not(feature = "mpi"))]
fn launched(launcher: Launcher) -> Result<Box<dyn Communicator>, RankError> {
    if !launcher.started(1) {
        return Err(RankError::WithoutMpi { variable: launcher.variable.to_owned(), value: launcher.value });
    }
    Ok(Box::new(Solo::new()))
}
