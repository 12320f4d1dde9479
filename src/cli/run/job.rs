//! One rank's part of a run: the time loop and, on rank 0, the files.

use std::time::{Duration, Instant};

use super::beginning::Beginning;
use super::checkpoints::Checkpoints;
use super::ending::{Ending, ending};
use super::environment::{command, record};
use super::recorder::{Reached, Recorder, Totals};
use super::reference::Reference;
use super::summary::{continued, summary, totals, warned};
use super::{chart, timing};
use crate::cli::CliError;
use crate::cli::report::report_of_run;
use crate::cli::settings::RunSettings;
use crate::cli::terminal::{self, LOG_ONLY, tell};
use crate::gpu::Device;
use crate::output::{
    Adapter, AdapterRecord, AuditLimits, CHECKPOINT_FOLDER, Environment, LOG_FILE, Origin, OutputFolder, PLAN_FILE,
    PRESSURE_CHART_FILE, SCENE_FILE, Shown, audit_verdict, forget_after,
};
use crate::ranks::Communicator;
use crate::simulation::{Interrupt, Options, Outcome, Setup, Simulation, SimulationError, audit_limits, signal_name};

/// What all ranks of this process share.
pub(super) struct Job<'a> {
    pub(super) settings: &'a RunSettings,
    /// Rank 0 has it.
    pub(super) folder: Option<OutputFolder>,
    pub(super) from: Option<Beginning>,
    pub(super) device: &'a Device,
    pub(super) setup: &'a Setup,
    pub(super) interrupt: &'a Interrupt,
    pub(super) quiet: bool,
    pub(super) started: Instant,
}

impl Job<'_> {
    pub(super) fn run(&self, comm: &dyn Communicator) -> Result<Ending, CliError> {
        let Job { settings, device, setup, .. } = self;
        let model = &settings.model;
        let execution = &settings.execution;
        let options = Options {
            batch: execution.batch,
            stop_after_steps: execution.stop_after_steps,
            strict: execution.strict,
            // Only the last snapshot has them.
            discard_particles: model.scene.output.snapshots == 0,
            checkpoint_at_stop: execution.checkpoints.every.is_some() || self.from.is_some(),
            halo: execution.sharing.halo,
            balance: execution.sharing.balance,
            ..Options::default()
        };
        let simulation = Simulation::among(model, device, setup, comm, options)?;
        let simulation = match &self.from {
            None => simulation,
            Some(from) => simulation.resume(&from.state)?,
        };
        let mut checkpoints = Checkpoints::new(settings.folder.join(CHECKPOINT_FOLDER), self.interrupt, self.started);
        let Some(folder) = self.folder.as_ref().filter(|_| comm.rank() == 0) else {
            return match simulation.run(&mut checkpoints) {
                // All ranks stop there alike; rank 0 says it.
                Err(SimulationError::Guard { .. }) => Ok(Ending::Done),
                done => {
                    let outcome = done?;
                    timing::of_ranks(comm, &outcome)?;
                    ending(&outcome, comm)
                }
            };
        };
        let adapter = record(device);
        let origin = self.origin(Adapter::from(&adapter))?;
        let recorder = self.files(folder, &origin, adapter)?;
        let step = self.from.as_ref().map_or(0, Beginning::step);
        let mut recorder = recorder.checkpointing(checkpoints.leading(execution.checkpoints, step, origin));
        if comm.size() > 1 {
            recorder = recorder.among(folder.path(), step)?;
        }
        let set_up = self.started.elapsed();
        let result = simulation.run(&mut recorder);
        // What a run that stopped early has measured is of use, above all to find out why it stopped.
        let drawn = chart::draw(&folder.path().join(PRESSURE_CHART_FILE), &model.scene, recorder.history());
        let outcome = result?;
        drawn?;
        recorder.finish(&outcome)?;
        timing::of(comm, &outcome, set_up)?.write(folder.path())?;
        if outcome.continued.is_some() || outcome.time >= model.plan.end_time {
            let account = [outcome.audit.render(), continued(model, &outcome)].concat();
            let vents = recorder.of_vents();
            let limits = audit_limits(&model.plan);
            let verdict = audit_verdict(&failures(&outcome, &limits), &outcome.audit.warnings(&limits));
            folder.end(&format!("{account}\n{}{vents}{}{verdict}", totals(&outcome), warned(&outcome)))?;
        }
        let vents = recorder.of_vents();
        let stopped = recorder.stopped_at().is_some();
        self.tell(&Ended { outcome: &outcome, set_up, vents, stopped }, folder)?;
        ending(&outcome, comm)
    }

    /// What all checkpoints of the run come from, the earlier ones included.
    fn origin(&self, adapter: Adapter) -> Result<Origin, CliError> {
        let model = &self.settings.model;
        let plan = model.plan.to_toml()?;
        Ok(match &self.from {
            None => Origin::new(&model.scene, plan, adapter)?,
            Some(Beginning { checkpoint, .. }) => {
                let (scene, meshes) = (checkpoint.scene()?, checkpoint.manifest().mesh.clone());
                Origin { scene, plan, meshes, adapter, units: checkpoint.units() }
            }
        })
    }

    /// The files of the results, and who writes them, on rank 0.
    fn files(&self, folder: &OutputFolder, origin: &Origin, adapter: AdapterRecord) -> Result<Recorder<'_>, CliError> {
        let RunSettings { model, .. } = self.settings;
        let reference = Reference::new(model);
        let shown = if self.quiet { Shown::No } else { Shown::Yes { colour: terminal::colour() } };
        let Some(from) = &self.from else {
            folder.clear()?;
            terminal::log_to(&folder.path().join(LOG_FILE));
            folder.write_text(SCENE_FILE, &origin.scene)?;
            folder.write_text(PLAN_FILE, &model.explained().to_toml()?)?;
            for mesh in &origin.meshes {
                mesh.keep(&mesh.path, folder.path())?;
            }
            Environment::of_this_host(command(), adapter).in_units(model.scene.units).write(folder.path())?;
            return Ok(Recorder::new(model, reference, folder.path(), shown)?);
        };
        folder.go_on()?;
        terminal::log_to(&folder.path().join(LOG_FILE));
        // First, since they count on what is cut off then.
        forget_after(&folder.checkpoints(), from.step())?;
        let totals =
            Totals { time: from.time(), steps: from.step(), particle_steps: from.state.account.particle_steps };
        Ok(Recorder::resume(model, reference, folder.path(), shown, Reached { output: &from.output, totals })?)
    }

    fn tell(&self, ended: &Ended<'_>, folder: &OutputFolder) -> Result<(), CliError> {
        let Ended { outcome, set_up, vents, stopped } = ended;
        let limits = audit_limits(&self.settings.model.plan);
        let warnings = outcome.audit.warnings(&limits);
        for warning in &warnings {
            tracing::warn!("{warning}");
        }
        if !self.quiet {
            tell(&summary(&self.settings.model, outcome, vents));
            let seconds = self.started.elapsed().as_secs_f64();
            tell(&format!("wall time {seconds:.1} s, of which set-up {:.1} s\n", set_up.as_secs_f64()));
        }
        if *stopped {
            let signal = outcome.signal.map(|signal| format!(" ({})", signal_name(signal))).unwrap_or_default();
            let text = format!(
                "stopped as asked{signal} at {:.4} ms of {:.4} ms; to go on: corpuscle resume {}",
                1e3 * outcome.time,
                1e3 * self.settings.model.plan.end_time,
                folder.path().display()
            );
            tracing::info!(target: LOG_ONLY, "{text}");
            if !self.quiet {
                tell(&(text + "\n"));
            }
        }
        report_of_run(self.settings, folder, self.quiet);
        tell(&format!("{}\n", folder.path().display()));
        let failures = failures(outcome, &limits);
        if !failures.is_empty() {
            return Err(CliError::Audit { failures });
        }
        if self.settings.execution.strict && !warnings.is_empty() {
            return Err(CliError::RunWarnings { warnings });
        }
        Ok(())
    }
}

/// Why the run cannot be trusted.
fn failures(outcome: &Outcome, limits: &AuditLimits) -> Vec<String> {
    let continued = outcome.continued.iter().flat_map(|continued| continued.audit.verdict(limits));
    outcome.audit.verdict(limits).into_iter().chain(continued).collect()
}

/// How a run ended.
pub(super) struct Ended<'a> {
    outcome: &'a Outcome,
    set_up: Duration,
    /// A line for each that has a pressure to open at.
    vents: String,
    /// At a checkpoint, as asked.
    stopped: bool,
}
