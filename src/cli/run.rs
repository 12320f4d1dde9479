//! `corpuscle run`: a scene from its file to the results.
//!
//! An earlier run's results are removed only once the scene, the device and the set-up have shown that this
//! run can start.

mod chart;
mod devices;
mod recorder;
mod reference;
mod table;

use std::fmt::Write;
use std::time::{Duration, Instant};

use crate::gpu::{AdapterDescription, Device};
use crate::output::{AdapterRecord, Environment, OutputFolder, PLAN_FILE, PRESSURE_CHART_FILE, SCENE_FILE, grouped};
use crate::ranks::{Communicator, Pace, from_environment, in_process};
use crate::scene::to_toml;
use crate::simulation::{Model, Options, Outcome, Setup, Simulation, SimulationError, audit_limits};

use super::CliError;
use super::arguments::RunArguments;
use super::settings::RunSettings;
use super::terminal::say;

use recorder::Recorder;
use reference::Reference;

pub fn run(raw: RunArguments, quiet: bool) -> Result<(), CliError> {
    let comm = from_environment()?;
    let done = with_ranks(raw, quiet, &*comm);
    if let Err(error) = &done {
        // Under a launcher this ends all ranks; alone it changes nothing.
        comm.fail(&error.to_string(), error.exit_code().into());
    }
    done
}

fn with_ranks(raw: RunArguments, quiet: bool, comm: &dyn Communicator) -> Result<(), CliError> {
    let started = Instant::now();
    let settings = RunSettings::new(raw)?;
    let quiet = quiet || comm.rank() > 0;
    let subdomains = settings.sharing.subdomains;
    if subdomains > 1 && comm.size() > 1 {
        return Err(CliError::SubdomainsOfRanks { asked: subdomains, ranks: comm.size() });
    }
    let model = &settings.model;
    if comm.rank() == 0 {
        for warning in &model.plan.warnings {
            tracing::warn!("{warning}");
        }
    }
    let device = devices::open(settings.gpu.as_deref(), comm)?;
    devices::agree(&device, model, comm)?;
    if !quiet {
        say(&heading(device.adapter(), model))?;
        say(&devices::map(&device, comm)?)?;
    } else {
        devices::map(&device, comm)?;
    }
    let ranks = comm.size().max(subdomains);
    let setup = Setup::new(model, &device, ranks, None)?;
    let job = Job { settings: &settings, device: &device, setup: &setup, quiet, started };
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
    let (heard, mut causes): (Vec<_>, Vec<_>) = results.into_iter().partition(|result| {
        matches!(result, Ok(()) | Err(CliError::Rank(_)) | Err(CliError::Simulation(SimulationError::Rank(_))))
    });
    causes.extend(heard.into_iter().filter(Result::is_err));
    causes.into_iter().next().unwrap_or(Ok(()))
}

/// What all ranks of this process share.
struct Job<'a> {
    settings: &'a RunSettings,
    device: &'a Device,
    setup: &'a Setup,
    quiet: bool,
    started: Instant,
}

impl Job<'_> {
    fn run(&self, comm: &dyn Communicator) -> Result<(), CliError> {
        let Job { settings, device, setup, .. } = self;
        let model = &settings.model;
        let options = Options {
            batch: settings.batch,
            stop_after_steps: settings.stop_after_steps,
            halo_rounds: settings.sharing.halo_rounds,
            balance: settings.sharing.balance,
            ..Options::default()
        };
        let simulation = Simulation::among(model, device, setup, comm, options)?;
        if comm.rank() > 0 {
            simulation.run(&mut ())?;
            return Ok(());
        }
        let folder = OutputFolder::create(&settings.folder, settings.force)?;
        folder.write_text(SCENE_FILE, &to_toml(&model.scene))?;
        folder.write_text(PLAN_FILE, &model.plan.to_toml()?)?;
        Environment::of_this_host(command(), record(device)).write(folder.path())?;
        let mut recorder = Recorder::new(model, Reference::new(model), folder.path(), !self.quiet)?;
        let set_up = self.started.elapsed();
        let result = simulation.run(&mut recorder);
        // What a run that stopped early has measured is of use, above all to find out why it stopped.
        let drawn = chart::draw(&folder.path().join(PRESSURE_CHART_FILE), &model.scene, recorder.history());
        let outcome = result?;
        drawn?;
        recorder.finish(&outcome)?;
        self.tell(&outcome, set_up, &folder)
    }

    fn tell(&self, outcome: &Outcome, set_up: Duration, folder: &OutputFolder) -> Result<(), CliError> {
        let limits = audit_limits(&self.settings.model.plan);
        for warning in outcome.audit.warnings(&limits) {
            tracing::warn!("{warning}");
        }
        if !self.quiet {
            say(&summary(outcome))?;
            let seconds = self.started.elapsed().as_secs_f64();
            say(&format!("wall time {seconds:.1} s, of which set-up {:.1} s\n", set_up.as_secs_f64()))?;
        }
        say(&format!("{}\n", folder.path().display()))?;
        let failures = outcome.audit.verdict(&limits);
        if failures.is_empty() { Ok(()) } else { Err(CliError::Audit { failures }) }
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
        limits: limits.into_iter().map(|(name, value)| (name.to_owned(), value)).collect(),
        features: features.iter_names().map(|(name, _)| name.to_owned()).collect(),
    }
}

/// The audit, the phase table and the totals.
fn summary(outcome: &Outcome) -> String {
    let mut text = format!("\n{}\n", outcome.audit.render());
    if outcome.phases.rows.is_empty() {
        text += "This device does not time its phases.\n";
    } else {
        text += &outcome.phases.render();
    }
    let [shortest, longest] = outcome.step_range.map(|step| 1e6 * step);
    // Writing to a string cannot fail.
    let _ = write!(
        text,
        "\n{:.4} ms in {} steps of {shortest:.3} to {longest:.3} us, {} collisions, {} bounces off walls\n",
        1e3 * outcome.time,
        grouped(outcome.steps),
        grouped(outcome.collisions),
        grouped(outcome.bounces),
    );
    if outcome.repeated > 0 {
        let _ = writeln!(text, "{} intervals were run again with longer neighbour lists", outcome.repeated);
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
        let rebalances = outcome.balance.iter().filter(|record| record.rebalanced.is_some()).count();
        let _ = writeln!(text, "{rebalances} rebalances");
    }
    text
}
