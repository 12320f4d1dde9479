//! `corpuscle run`: a scene from its file to the results.
//!
//! An earlier run's results are removed only once the scene, the device and the set-up have shown that this
//! run can start. A run that goes on from a checkpoint takes the same way.

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
    Adapter, AdapterRecord, CHECKPOINT_FOLDER, Environment, Origin, OutputFolder, PLAN_FILE, PRESSURE_CHART_FILE,
    SCENE_FILE, forget_after, grouped,
};
use crate::ranks::{Communicator, Pace, from_environment, in_process};
use crate::scene::{Method, to_toml};
use crate::simulation::{
    Continued, Interrupt, Model, Options, Outcome, Setup, Simulation, SimulationError, audit_limits,
};

use super::CliError;
use super::arguments::RunArguments;
use super::resume::Beginning;
use super::settings::RunSettings;
use super::terminal::{self, say};

use checkpoints::Checkpoints;
pub use checkpoints::Wanted;
use recorder::{Recorder, Totals};
use reference::Reference;

pub fn run(raw: RunArguments, quiet: bool) -> Result<(), CliError> {
    let started = Instant::now();
    let verb = raw.repeat.map_or_else(|| "run".to_owned(), |times| format!("run --repeat {times}"));
    among_ranks(&verb, |comm| match raw.repeat {
        Some(times) => repeat::repeat(RunSettings::new(raw)?, times, comm, quiet, started),
        None => launch(&RunSettings::new(raw)?, None, comm, quiet, started),
    })
}

/// What this process does as a rank of those that a launcher may have started.
pub fn among_ranks(verb: &str, work: impl FnOnce(&dyn Communicator) -> Result<(), CliError>) -> Result<(), CliError> {
    let comm = from_environment()?;
    let done = devices::agree_on_verb(verb, &*comm).and_then(|()| work(&*comm));
    if let Err(error) = &done {
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
) -> Result<(), CliError> {
    let quiet = quiet || comm.rank() > 0;
    let execution = &settings.execution;
    let subdomains = execution.sharing.subdomains;
    if subdomains > 1 && comm.size() > 1 {
        return Err(CliError::SubdomainsOfRanks { asked: subdomains, ranks: comm.size() });
    }
    let model = &settings.model;
    let told = model.plan.told();
    if execution.strict && !told.is_empty() {
        let (scene, warnings) = (settings.scene.clone(), told);
        return Err(CliError::PlanWarnings { scene, warnings });
    }
    if comm.rank() == 0 {
        for warning in &told {
            tracing::warn!("{warning}");
        }
        if let Some(choice) = &model.choice {
            tracing::info!("{}", choice.summary());
        }
    }
    devices::agree_on_run(model, execution, comm)?;
    if model.plan.method == Method::ControlVolume {
        // Nothing to share out: the first rank does it.
        return if comm.rank() == 0 { uniform::run(settings, quiet, started) } else { Ok(()) };
    }
    let device = devices::open(execution.gpu.as_deref(), comm)?;
    devices::agree_on_device(&device, comm)?;
    if !quiet {
        say(&heading(device.adapter(), model))?;
        say(&devices::map(&device, comm)?)?;
    } else {
        devices::map(&device, comm)?;
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
    let job = Job { settings, from, device: &device, setup: &setup, interrupt: &interrupt, quiet, started };
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
    // The cause rather than what the others heard of it.
    let heard = |error: &CliError| matches!(error, CliError::Rank(_) | CliError::Simulation(SimulationError::Rank(_)));
    let failed = results.into_iter().enumerate().filter_map(|(rank, result)| Some((rank, result.err()?)));
    match failed.min_by_key(|(rank, error)| (heard(error), *rank)) {
        None => Ok(()),
        Some((rank, error)) => {
            tracing::error!("subdomain {rank} of {subdomains} ended the run");
            Err(error)
        }
    }
}

/// What all ranks of this process share.
struct Job<'a> {
    settings: &'a RunSettings,
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
    fn run(&self, comm: &dyn Communicator) -> Result<(), CliError> {
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
        if comm.rank() > 0 {
            match simulation.run(&mut checkpoints) {
                // All ranks stop there alike; rank 0 says it.
                Err(SimulationError::Guard { .. }) => {}
                done => drop(timing::of_ranks(comm, &done?)?),
            }
            return Ok(());
        }
        let adapter = record(device);
        let origin = Origin::new(&model.scene, model.plan.to_toml()?, Adapter::from(&adapter))?;
        let (folder, recorder) = self.files(adapter)?;
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
        self.tell(&Ended { outcome: &outcome, set_up, vents, stopped: recorder.stopped_at().is_some() }, &folder)
    }

    /// The folder of the results, and who writes into it, on rank 0.
    fn files(&self, adapter: AdapterRecord) -> Result<(OutputFolder, Recorder<'_>), CliError> {
        let RunSettings { model, folder, force, .. } = self.settings;
        let (reference, shown) = (Reference::new(model), !self.quiet);
        let Some(from) = &self.from else {
            let folder = OutputFolder::create(folder, *force)?;
            folder.write_text(SCENE_FILE, &to_toml(&model.scene))?;
            folder.write_text(PLAN_FILE, &model.explained().to_toml()?)?;
            Environment::of_this_host(command(), adapter).write(folder.path())?;
            let recorder = Recorder::new(model, reference, folder.path(), shown)?;
            return Ok((folder, recorder));
        };
        let folder = OutputFolder::open(folder)?;
        folder.go_on()?;
        // First, since they count on what is cut off then.
        forget_after(&folder.checkpoints(), from.step())?;
        let totals =
            Totals { time: from.time(), steps: from.step(), particle_steps: from.state.account.particle_steps };
        let recorder = Recorder::resume(model, reference, folder.path(), shown, &from.output, totals)?;
        Ok((folder, recorder))
    }

    fn tell(&self, ended: &Ended<'_>, folder: &OutputFolder) -> Result<(), CliError> {
        let Ended { outcome, set_up, vents, stopped } = ended;
        let limits = audit_limits(&self.settings.model.plan);
        let warnings = outcome.audit.warnings(&limits);
        for warning in &warnings {
            tracing::warn!("{warning}");
        }
        if !self.quiet {
            say(&summary(&self.settings.model, outcome, vents))?;
            let seconds = self.started.elapsed().as_secs_f64();
            say(&format!("wall time {seconds:.1} s, of which set-up {:.1} s\n", set_up.as_secs_f64()))?;
        }
        if *stopped && !self.quiet {
            say(&format!(
                "stopped as asked at {:.4} ms of {:.4} ms; to go on: corpuscle resume {}\n",
                1e3 * outcome.time,
                1e3 * self.settings.model.plan.end_time,
                folder.path().display()
            ))?;
        }
        say(&format!("{}\n", folder.path().display()))?;
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
        form: device.form().name().to_owned(),
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
        text += &outcome.phases.render();
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
