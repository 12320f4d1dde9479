//! `corpuscle resume`: a run from one of its checkpoints to its end, in the same folder.
//!
//! Rank 0 finds the checkpoint and checks all of it; the others take its word for which it is, and what they read of it
//! is checked as they read.

use std::ffi::OsString;
use std::os::unix::ffi::{OsStrExt, OsStringExt};
use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::output::{Adapter, Checkpoint, CheckpointError, OutputFolder, OutputState, latest, run_folder};
use crate::ranks::Communicator;
use crate::scene::parse;
use crate::simulation::RunState;

use super::CliError;
use super::arguments::ResumeArguments;
use super::run::{among_ranks, launch};
use super::settings::{Execution, RunSettings, model_of};
use super::terminal::say;

pub fn resume(raw: ResumeArguments, quiet: bool) -> Result<(), CliError> {
    let started = Instant::now();
    among_ranks("resume", |comm| {
        let execution = Execution::new(raw.execution)?;
        let Some(checkpoint) = agreed(&raw.from, comm)? else {
            return if comm.rank() == 0 { tell_the_end(&raw.from, quiet) } else { Ok(()) };
        };
        let scene = checkpoint.path().join("scene.toml");
        let model = parse(&checkpoint.scene()?, &scene.display().to_string(), Path::new(""))?;
        let model = model_of(&scene, model)?;
        checkpoint.check_plan(&model.plan.to_toml()?)?;
        let done = checkpoint.manifest().step;
        if let Some(asked) = execution.stop_after_steps.filter(|asked| *asked <= done) {
            return Err(CliError::StepsDone { asked, done });
        }
        let folder = run_folder(&raw.from, checkpoint.path());
        let settings = RunSettings { scene, model, folder, force: false, execution };
        launch(&settings, Some(Beginning::new(checkpoint)?), comm, quiet, started)
    })
}

/// What a run goes on from.
pub struct Beginning {
    pub checkpoint: Checkpoint,
    pub state: RunState,
    pub output: OutputState,
}

impl Beginning {
    fn new(checkpoint: Checkpoint) -> Result<Beginning, CheckpointError> {
        let (output, state) = checkpoint.state()?;
        Ok(Beginning { checkpoint, state, output })
    }

    pub fn step(&self) -> u64 {
        self.checkpoint.manifest().step
    }

    /// s.
    pub fn time(&self) -> f64 {
        self.checkpoint.manifest().time
    }

    /// Says where the run goes on, and what may make its bits differ from there.
    pub fn warn(&self, adapter: &Adapter) {
        let path = self.checkpoint.path().display();
        tracing::info!("goes on from {path}: step {}, {:.4} ms", self.step(), 1e3 * self.time());
        for warning in self.checkpoint.warnings(adapter) {
            tracing::warn!("{warning}");
        }
    }
}

/// The checkpoint that rank 0 has found for `from`; none if the run has ended. Collective.
fn agreed(from: &Path, comm: &dyn Communicator) -> Result<Option<Checkpoint>, CliError> {
    let own = if comm.rank() == 0 { found(from)? } else { None };
    let message = own.as_ref().map(|checkpoint| checkpoint.path().as_os_str().as_bytes().to_vec());
    let path = comm.broadcast(message.unwrap_or_default())?;
    match own {
        Some(checkpoint) => Ok(Some(checkpoint)),
        None if path.is_empty() => Ok(None),
        None => Ok(Some(Checkpoint::open_checked(&PathBuf::from(OsString::from_vec(path)))?)),
    }
}

/// The checkpoint that `from` names, all of it sound; none if `from` names a run that has ended. Of a run that has ended
/// a single checkpoint can still be named: all from there is done anew.
fn found(from: &Path) -> Result<Option<Checkpoint>, CliError> {
    if OutputFolder::open(from).is_ok_and(|folder| folder.has_ended()) {
        return Ok(None);
    }
    let path = latest(from)?;
    let folder = OutputFolder::open(&run_folder(from, &path))?;
    if folder.has_ended() && path != from {
        return Ok(None);
    }
    Ok(Some(Checkpoint::open(&path)?))
}

fn tell_the_end(from: &Path, quiet: bool) -> Result<(), CliError> {
    if !quiet {
        say("the run has reached its end: there is nothing left to do\n")?;
    }
    say(&format!("{}\n", from.display()))
}
