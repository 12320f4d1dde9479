//! `corpuscle run`: a scene from its file to the results.
//!
//! The folder is claimed once the scene is planned; an earlier run's results are removed only once the device and the set-up
//! have shown that this run can start. A run that goes on from a checkpoint takes the same way.

mod beginning;
mod chart;
mod checkpoints;
mod devices;
mod ending;
mod environment;
mod job;
mod launch;
mod ranks;
mod recorder;
mod reference;
mod repeat;
mod summary;
pub(super) mod table;
mod timing;
mod uniform;

use std::time::Instant;

use super::CliError;
use super::arguments::RunArguments;
use super::settings::RunSettings;

pub use beginning::Beginning;
pub use checkpoints::CheckpointWish;
pub use ending::Ending;
pub use launch::launch;
pub use ranks::{among_ranks, once};

pub fn run(raw: RunArguments, quiet: bool) -> Result<Ending, CliError> {
    let started = Instant::now();
    let verb = raw.repeat.map_or_else(|| "run".to_owned(), |times| format!("run --repeat {times}"));
    among_ranks(&verb, |comm| {
        let repeat = raw.repeat;
        let settings = once(RunSettings::new(raw), comm)?;
        match repeat {
            Some(times) => repeat::repeat(settings, times, comm, quiet, started),
            None => launch(&settings, None, comm, quiet, started),
        }
    })
}
