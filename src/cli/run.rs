//! `corpuscle run`: a scene from its file to the results.
//!
//! The folder is claimed once the scene is planned; an earlier run's results are removed only once the device and the set-up
//! have shown that this run can start. A run that goes on from a checkpoint takes the same way.

mod chart;
mod checkpoints;
mod devices;
mod recorder;
mod reference;
mod repeat;
pub(super) mod table;
mod timing;
mod uniform;

use std::fmt::Write;
use std::time::{Duration, Instant};

use crate::gpu::{AdapterDescription, Device};
use crate::output::{
    Adapter, AdapterRecord, CHECKPOINT_FOLDER, Claim, Content, Environment, LOG_FILE, Origin, OutputFolder, PLAN_FILE,
    PRESSURE_CHART_FILE, SCENE_FILE, Shown, forget_after, grouped, meshes_of,
};
use crate::ranks::{Communicator, Pace, from_environment, in_process};
use crate::scene::{Method, to_toml};
use crate::simulation::{
    Continued, Interrupt, Model, Options, Outcome, Setup, Simulation, SimulationError, audit_limits, signal_name,
};

use super::CliError;
use super::arguments::RunArguments;
use super::resume::Beginning;
use super::settings::RunSettings;
use super::terminal::{self, LOG_ONLY, tell};

use checkpoints::Checkpoints;
pub use checkpoints::Wanted;
use recorder::{Recorder, Totals};
use reference::Reference;

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
fn claim(settings: &RunSettings, content: Content) -> Result<OutputFolder, CliError> {
    let scene = to_toml(&settings.model.scene);
    let meshes = meshes_of(&settings.model.scene)?;
    let mut inputs = vec![settings.scene.clone()];
    inputs.extend(meshes.iter().map(|mesh| mesh.path.clone()));
    let claim = Claim { content, scene: Some(&scene), meshes: &meshes, inputs: &inputs, force: settings.force };
    Ok(OutputFolder::claim(&settings.folder, &claim)?)
}

/// What all ranks of this process share.
struct Job<'a> {
    settings: &'a RunSettings,
    /// Rank 0 has it.
    folder: Option<OutputFolder>,
    from: Option<Beginning>,
    device: &'a Device,
    setup: &'a Setup,
    interrupt: &'a Interrupt,
    quiet: bool,
    started: Instant,
}

/// How a run ended.
struct Ended<'a> {
    outcome: &'a Outcome,
    set_up: Duration,
    /// A line for each that has a pressure to open at.
    vents: String,
    /// At a checkpoint, as asked.
    stopped: bool,
}

impl Job<'_> {
    fn run(&self, comm: &dyn Communicator) -> Result<Ending, CliError> {
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
        let simulation = match &self.from {
            None => Simulation::among(model, device, setup, comm, options)?,
            Some(from) => Simulation::resume(model, device, setup, comm, options, &from.state)?,
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
            folder.end(&format!("{account}\n{}{vents}{}", totals(&outcome), warned(&outcome)))?;
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
                Origin { scene: checkpoint.scene()?, plan, meshes: checkpoint.manifest().mesh.clone(), adapter }
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
                mesh.keep(&mesh.path, folder)?;
            }
            Environment::of_this_host(command(), adapter).write(folder.path())?;
            return Ok(Recorder::new(model, reference, folder.path(), shown)?);
        };
        folder.go_on()?;
        terminal::log_to(&folder.path().join(LOG_FILE));
        // First, since they count on what is cut off then.
        forget_after(&folder.checkpoints(), from.step())?;
        let totals =
            Totals { time: from.time(), steps: from.step(), particle_steps: from.state.account.particle_steps };
        Ok(Recorder::resume(model, reference, folder.path(), shown, &from.output, totals)?)
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
        tell(&format!("{}\n", folder.path().display()));
        let mut failures = outcome.audit.verdict(&limits);
        failures.extend(outcome.continued.iter().flat_map(|continued| continued.audit.verdict(&limits)));
        if !failures.is_empty() {
            return Err(CliError::Audit { failures });
        }
        if self.settings.execution.strict && !warnings.is_empty() {
            return Err(CliError::RunWarnings { warnings });
        }
        Ok(())
    }
}

/// Rank 0 may still be writing when others are done: a launcher ends all when the first ends for a signal.
fn ending(outcome: &Outcome, comm: &dyn Communicator) -> Result<Ending, CliError> {
    let Some(signal) = outcome.signal else { return Ok(Ending::Done) };
    comm.barrier()?;
    Ok(Ending::Stopped { signal })
}

fn command() -> Vec<String> {
    std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect()
}

fn heading(adapter: &AdapterDescription, model: &Model) -> String {
    let plan = &model.plan;
    let AdapterDescription { index, info, .. } = adapter;
    let driver = format!("{} {}", info.driver, info.driver_info);
    format!(
        "{}: {} particles, {} cells\nadapter {index}: {} ({}, {})\n",
        model.scene.title,
        grouped(plan.particles),
        grouped(plan.grid.cell_count() as u64),
        info.name,
        info.backend,
        driver.trim(),
    )
}

fn record(device: &Device) -> AdapterRecord {
    let AdapterDescription { info, limits, features, .. } = device.adapter();
    let limits = [
        ("max_storage_buffer_binding_size", limits.max_storage_buffer_binding_size),
        ("max_buffer_size", limits.max_buffer_size),
        ("max_storage_buffers_per_shader_stage", limits.max_storage_buffers_per_shader_stage.into()),
        ("max_compute_workgroups_per_dimension", limits.max_compute_workgroups_per_dimension.into()),
        ("max_compute_workgroup_size_x", limits.max_compute_workgroup_size_x.into()),
        ("max_compute_workgroup_storage_size", limits.max_compute_workgroup_storage_size.into()),
        ("min_uniform_buffer_offset_alignment", limits.min_uniform_buffer_offset_alignment.into()),
    ];
    AdapterRecord {
        name: info.name.clone(),
        backend: info.backend.to_string(),
        driver: info.driver.clone(),
        driver_info: info.driver_info.clone(),
        device_type: format!("{:?}", info.device_type),
        form: device.variant().name().to_owned(),
        limits: limits.into_iter().map(|(name, value)| (name.to_owned(), value)).collect(),
        features: features.iter_names().map(|(name, _)| name.to_owned()).collect(),
    }
}

/// The account of what a control volume did after the particles; nothing of a run that stayed one of particles.
fn continued(model: &Model, outcome: &Outcome) -> String {
    let of = |continued: &Continued| {
        let [from, until] = [outcome.time, continued.until].map(|time| 1e3 * time);
        format!(
            "\nfrom {from:.4} ms to {until:.4} ms as a control volume: {}\n{}",
            continued.why,
            continued.audit.render()
        )
    };
    match &outcome.continued {
        Some(continued) => of(continued),
        None if model.scene.model.switch.is_some() && outcome.time >= model.plan.end_time => {
            "\nno control volume took over: the pressures were not uniform for so long before the end\n".to_owned()
        }
        None => String::new(),
    }
}

/// What the whole run has done, without wall times.
fn totals(outcome: &Outcome) -> String {
    let [shortest, longest] = outcome.step_range.map(|step| 1e6 * step);
    format!(
        "{:.4} ms in {} steps of {shortest:.3} to {longest:.3} us, {} collisions, {} bounces off walls\n",
        1e3 * outcome.time,
        grouped(outcome.steps),
        grouped(outcome.collisions),
        grouped(outcome.bounces),
    )
}

/// What has left its limits, a line each.
fn warned(outcome: &Outcome) -> String {
    outcome.warnings.iter().map(|told| format!("warning {told}\n")).collect()
}

/// The audit, the phase table and the totals.
fn summary(model: &Model, outcome: &Outcome, vents: &str) -> String {
    let mut text = format!("\n{}{}\n", outcome.audit.render(), continued(model, outcome));
    if outcome.phases.rows.is_empty() {
        text += "This device does not time its phases.\n";
    } else {
        text += &outcome.phases.render(outcome.stepping_seconds);
    }
    text += "\n";
    text += &totals(outcome);
    text += vents;
    text += &warned(outcome);
    if outcome.repeated > 0 {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "steps were run again {} times, with more room for neighbour lists", outcome.repeated);
    }
    let traffic = &outcome.traffic;
    if traffic.steps > 0 {
        let per_step = |count: f64| count / traffic.steps as f64;
        let _ = writeln!(
            text,
            "rank 0 per step: {:.1} messages, {:.1} kB sent, {:.0} of {:.0} particles from other ranks, {:.2} ms until \
             packed, {:.2} ms for the others' messages",
            per_step(traffic.messages as f64),
            per_step(1e-3 * traffic.bytes as f64),
            per_step(traffic.arrived as f64),
            per_step(traffic.present as f64),
            per_step(1e3 * traffic.device_seconds),
            per_step(1e3 * traffic.waiting_seconds),
        );
        let _ = writeln!(text, "{} rebalances", outcome.rebalances);
    }
    text
}
