//! A run by the method `control-volume`: the files of any run but snapshots and checkpoints, in a moment and on no device.

use std::time::Instant;

use super::chart;
use super::environment::command;
use super::recorder::Recorder;
use super::reference::Reference;
use crate::cli::CliError;
use crate::cli::report::report_of_run;
use crate::cli::settings::RunSettings;
use crate::cli::terminal::{self, tell};
use crate::output::{
    AdapterRecord, Environment, LOG_FILE, OutputFolder, PLAN_FILE, PRESSURE_CHART_FILE, SCENE_FILE, Timing,
    audit_verdict, meshes_of,
};
use crate::scene::to_toml;
use crate::simulation::{audit_limits, run_uniform};

pub fn run(settings: &RunSettings, folder: &OutputFolder, quiet: bool, started: Instant) -> Result<(), CliError> {
    let RunSettings { model, execution, .. } = settings;
    let checkpoints = execution.checkpoints;
    if execution.stop_after_steps.is_some() || checkpoints.every.is_some() || checkpoints.stop_after.is_some() {
        tracing::warn!("a control volume takes no steps: it is not stopped after some, and writes no checkpoints");
    }
    if execution.gpu.is_some() || execution.batch.is_some() || execution.sharing.subdomains > 1 {
        tracing::warn!(
            "a control volume runs on no device and is not shared out: it needs no --gpu, --batch or --subdomains"
        );
    }
    folder.clear()?;
    terminal::log_to(&folder.path().join(LOG_FILE));
    for mesh in meshes_of(&model.scene)? {
        mesh.keep(&mesh.path, folder.path())?;
    }
    folder.write_text(SCENE_FILE, &to_toml(&model.scene))?;
    folder.write_text(PLAN_FILE, &model.explained().to_toml()?)?;
    let none = AdapterRecord { name: "none: a control volume".to_owned(), ..AdapterRecord::default() };
    Environment::of_this_host(command(), none).in_units(model.scene.units).write(folder.path())?;
    let mut recorder = Recorder::without_particles(model, Reference::new(model), folder.path())?;
    let set_up = started.elapsed();
    let begun = Instant::now();
    let audit = run_uniform(model, &mut recorder)?;
    chart::draw(&folder.path().join(PRESSURE_CHART_FILE), &model.scene, recorder.history())?;
    let timing = Timing {
        stepping_seconds: begun.elapsed().as_secs_f64(),
        set_up_seconds: set_up.as_secs_f64(),
        ..Timing::default()
    };
    timing.write(folder.path())?;
    let vents = recorder.of_vents();
    let limits = audit_limits(&model.plan);
    let failures = audit.verdict(&limits);
    let verdict = audit_verdict(&failures, &audit.warnings(&limits));
    let end = 1e3 * model.plan.end_time;
    folder.end(&format!("{}\n{end:.4} ms as a control volume\n{vents}{verdict}", audit.render()))?;
    if !quiet {
        tell(&format!("{}: control volume\n\n{}\n{vents}", model.scene.title, audit.render()));
        tell(&format!("wall time {:.3} s\n", started.elapsed().as_secs_f64()));
    }
    report_of_run(settings, folder, quiet);
    tell(&format!("{}\n", folder.path().display()));
    if failures.is_empty() { Ok(()) } else { Err(CliError::Audit { failures }) }
}
