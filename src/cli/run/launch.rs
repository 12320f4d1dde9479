//! A run on the devices that it asks for: one rank, several of a launcher, or several in this process.

use std::time::Instant;

use super::beginning::Beginning;
use super::ending::Ending;
use super::environment::record;
use super::job::Job;
use super::ranks::once;
use super::summary::heading;
use super::{devices, uniform};
use crate::cli::CliError;
use crate::cli::settings::RunSettings;
use crate::cli::terminal::{LOG_ONLY, tell};
use crate::output::{Adapter, Claim, Content, OutputFolder, meshes_of};
use crate::ranks::{Communicator, Pace, in_process};
use crate::scene::{Method, to_toml};
use crate::simulation::{Interrupt, Setup, SimulationError};

/// A run, from its start or from a checkpoint; `started`: this process did.
pub fn launch(
    settings: &RunSettings,
    from: Option<Beginning>,
    comm: &dyn Communicator,
    quiet: bool,
    started: Instant,
) -> Result<Ending, CliError> {
    let quiet = quiet || comm.rank() > 0;
    let execution = &settings.execution;
    let subdomains = execution.sharing.subdomains;
    if subdomains > 1 && comm.size() > 1 {
        return Err(CliError::SubdomainsOfRanks { asked: subdomains, ranks: comm.size() });
    }
    let model = &settings.model;
    let told = model.plan.told();
    let strict = if execution.strict && !told.is_empty() {
        Err(CliError::PlanWarnings { scene: settings.scene.clone(), warnings: told.clone() })
    } else {
        Ok(())
    };
    once(strict, comm)?;
    if comm.rank() == 0 {
        for warning in &told {
            tracing::warn!("{warning}");
        }
        for note in &model.plan.inventory.notes {
            tracing::info!("note: {note}");
        }
        if let Some(choice) = &model.choice {
            tracing::info!("{}", choice.summary());
        }
    }
    devices::agree_on_run(model, execution, comm)?;
    let mut from = from;
    let folder = match &mut from {
        Some(beginning) => beginning.folder.take(),
        None if comm.rank() == 0 => Some(claim(settings, Content::Run)?),
        None => None,
    };
    if model.plan.method == Method::ControlVolume {
        // Nothing to share out: the first rank does it.
        return match folder {
            Some(folder) => uniform::run(settings, &folder, quiet, started).map(|()| Ending::Done),
            None => Ok(Ending::Done),
        };
    }
    let device = devices::open(execution.gpu.as_deref(), comm)?;
    devices::agree_on_device(&device, comm)?;
    let map = devices::map(&device, comm)?;
    if comm.rank() == 0 {
        let heading = heading(device.adapter(), model) + &map;
        tracing::info!(target: LOG_ONLY, "{}", heading.trim_end());
        if !quiet {
            tell(&heading);
        }
    }
    let ranks = comm.size().max(subdomains);
    let setup = match &from {
        None => Setup::new(model, &device, ranks, None)?,
        Some(from) => {
            if comm.rank() == 0 {
                from.warn(&Adapter::from(&record(&device)));
            }
            Setup::from_checkpoint(model, &device, ranks, from.checkpoint.clone())?
        }
    };
    if ranks > 1 && !setup.domain.features().halo && comm.rank() == 0 {
        tracing::info!("no collisions: particles are dealt out by id, nothing is exchanged or balanced");
    }
    let interrupt = Interrupt::catch().map_err(CliError::Signals)?;
    let (device, setup, interrupt) = (&device, &setup, &interrupt);
    let job = Job { settings, folder, from, device, setup, interrupt, quiet, started };
    if subdomains == 1 {
        return job.run(comm);
    }
    let results = in_process(subdomains, Pace::Together, |comm: &dyn Communicator| {
        let done = job.run(comm);
        if let Err(error) = &done {
            comm.fail(&error.to_string(), error.exit_code().into());
        }
        done
    })?;
    let ending = results.first().and_then(|result| result.as_ref().ok().copied()).unwrap_or(Ending::Done);
    // The cause rather than what the others heard of it.
    let heard = |error: &CliError| matches!(error, CliError::Rank(_) | CliError::Simulation(SimulationError::Rank(_)));
    let failed = results.into_iter().enumerate().filter_map(|(rank, result)| Some((rank, result.err()?)));
    match failed.min_by_key(|(rank, error)| (heard(error), *rank)) {
        None => Ok(ending),
        Some((rank, error)) => {
            tracing::error!("subdomain {rank} of {subdomains} ended the run");
            Err(error)
        }
    }
}

/// The folder of the results, which nothing has been changed in yet.
pub(super) fn claim(settings: &RunSettings, content: Content) -> Result<OutputFolder, CliError> {
    let scene = to_toml(&settings.model.scene);
    let meshes = meshes_of(&settings.model.scene)?;
    let mut inputs = vec![settings.scene.clone()];
    inputs.extend(meshes.iter().map(|mesh| mesh.path.clone()));
    let claim = Claim { content, scene: Some(&scene), meshes: &meshes, inputs: &inputs, force: settings.force };
    Ok(OutputFolder::claim(&settings.folder, &claim)?)
}
