//! `corpuscle resume`: a run from one of its checkpoints to its end, in the same folder.
//!
//! Rank 0 finds the checkpoint and checks all of it; the others take its word for which it is, and what they read of it
//! is checked as they read.

use std::ffi::OsString;
use std::os::unix::ffi::{OsStrExt, OsStringExt};
use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::output::{Checkpoint, OutputFolder, check_marker, has_ended, latest, run_folder};
use crate::ranks::Communicator;
use crate::scene::parse;

use super::CliError;
use super::arguments::ResumeArguments;
use super::run::{Beginning, Ending, among_ranks, launch, once};
use super::settings::{Execution, RunSettings, model_of};
use super::terminal::tell;

pub fn resume(raw: ResumeArguments, quiet: bool) -> Result<Ending, CliError> {
    let started = Instant::now();
    among_ranks("resume", |comm| {
        let execution = once(Execution::new(raw.execution), comm)?;
        let Some((folder, checkpoint)) = agreed(&raw.from, comm)? else {
            if comm.rank() == 0 {
                tell_the_end(&raw.from, quiet);
            }
            return Ok(Ending::Done);
        };
        let settings = once(settings_of(&raw.from, &checkpoint, execution), comm)?;
        let beginning = once(Beginning::new(checkpoint, folder).map_err(CliError::from), comm)?;
        launch(&settings, Some(beginning), comm, quiet, started)
    })
}

/// The run as its checkpoint has it.
fn settings_of(from: &Path, checkpoint: &Checkpoint, execution: Execution) -> Result<RunSettings, CliError> {
    let scene = checkpoint.path().join("scene.toml");
    let model = parse(&checkpoint.scene_here()?, &scene.display().to_string(), Path::new(""))?;
    let mut model = model_of(&scene, model)?;
    checkpoint.restore_names(&mut model.scene);
    checkpoint.check_plan(&model.plan.to_toml()?)?;
    let done = checkpoint.manifest().step;
    if let Some(asked) = execution.stop_after_steps.filter(|asked| *asked <= done) {
        return Err(CliError::StepsDone { asked, done });
    }
    let folder = run_folder(from, checkpoint.path());
    Ok(RunSettings { scene, model, folder, force: false, execution })
}

/// A run's folder, on rank 0, and one of its checkpoints.
type Found = (Option<OutputFolder>, Checkpoint);

/// The checkpoint that rank 0 has found for `from`; none if the run has ended. Collective.
fn agreed(from: &Path, comm: &dyn Communicator) -> Result<Option<Found>, CliError> {
    let own = if comm.rank() == 0 { found(from)? } else { None };
    let message = own.as_ref().map(|(_, checkpoint)| checkpoint.path().as_os_str().as_bytes().to_vec());
    let path = comm.broadcast(message.unwrap_or_default())?;
    match own {
        Some(found) => Ok(Some(found)),
        None if path.is_empty() => Ok(None),
        None => Ok(Some((None, Checkpoint::open_checked(&PathBuf::from(OsString::from_vec(path)))?))),
    }
}

/// The checkpoint that `from` names, all of it sound; none if `from` names a run that has ended. Of a run that has ended
/// a single checkpoint can still be named: all from there is done anew.
fn found(from: &Path) -> Result<Option<Found>, CliError> {
    if check_marker(from).is_ok() && has_ended(from) {
        return Ok(None);
    }
    let folder = OutputFolder::open(&run_folder(from, &latest(from)?))?;
    // The one that has just ended may have written others.
    let path = latest(from)?;
    if has_ended(folder.path()) && path != from {
        return Ok(None);
    }
    Ok(Some((Some(folder), Checkpoint::open(&path)?)))
}

fn tell_the_end(from: &Path, quiet: bool) {
    if !quiet {
        tell("the run has reached its end: there is nothing left to do\n");
    }
    tell(&format!("{}\n", from.display()));
}
