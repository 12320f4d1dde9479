//! `corpuscle run`: a scene from its file to the results.
//!
//! An earlier run's results are removed only once the scene, the device and the set-up have shown that this
//! run can start.

mod chart;
mod recorder;
mod reference;
mod table;

use std::fmt::Write;
use std::time::Instant;

use crate::gpu::{AdapterDescription, Device};
use crate::output::{AdapterRecord, Environment, OutputFolder, PLAN_FILE, PRESSURE_CHART_FILE, SCENE_FILE, grouped};
use crate::scene::to_toml;
use crate::simulation::{Model, Options, Outcome, Simulation, audit_limits};

use super::CliError;
use super::arguments::RunArguments;
use super::settings::RunSettings;
use super::terminal::say;

use recorder::Recorder;
use reference::Reference;

pub fn run(raw: RunArguments, quiet: bool) -> Result<(), CliError> {
    let started = Instant::now();
    let settings = RunSettings::new(raw)?;
    let model = &settings.model;
    for warning in &model.plan.warnings {
        tracing::warn!("{warning}");
    }
    let device = Device::open(settings.gpu.as_deref())?;
    if !quiet {
        say(&heading(device.adapter(), model))?;
    }
    let options = Options {
        batch: settings.batch,
        stop_after_steps: settings.stop_after_steps,
        ..Options::default()
    };
    let simulation = Simulation::new(model, &device, options)?;
    let folder = OutputFolder::create(&settings.folder, settings.force)?;
    folder.write_text(SCENE_FILE, &to_toml(&model.scene))?;
    folder.write_text(PLAN_FILE, &model.plan.to_toml()?)?;
    Environment::of_this_host(command(), record(&device)).write(folder.path())?;

    let mut recorder = Recorder::new(model, Reference::new(model), folder.path(), !quiet)?;
    let set_up = started.elapsed();
    let result = simulation.run(&mut recorder);
    // What a run that stopped early has measured is of use, above all to find out why it stopped.
    let drawn = chart::draw(&folder.path().join(PRESSURE_CHART_FILE), &model.scene, recorder.history());
    let outcome = result?;
    drawn?;
    recorder.finish(&outcome)?;

    let limits = audit_limits(&model.plan);
    for warning in outcome.audit.warnings(&limits) {
        tracing::warn!("{warning}");
    }
    if !quiet {
        say(&summary(&outcome))?;
        let seconds = started.elapsed().as_secs_f64();
        say(&format!("wall time {seconds:.1} s, of which set-up {:.1} s\n", set_up.as_secs_f64()))?;
    }
    say(&format!("{}\n", folder.path().display()))?;
    let failures = outcome.audit.verdict(&limits);
    if failures.is_empty() { Ok(()) } else { Err(CliError::Audit { failures }) }
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
    text
}
