//! `corpuscle refine`: a checkpoint with more particles, in a folder from which `corpuscle resume` goes on.

use std::path::{Path, PathBuf};

use crate::output::{
    Checkpoint, CheckpointWriter, Claim, Content, HistoryWriter, Manifest, Moment, Origin, OutputFolder, OutputState,
    PLAN_FILE, RunContext, SCENE_FILE, SnapshotWriter, grouped, latest,
};
use crate::scene::{parse, to_toml};
use crate::simulation::{Model, RefineReport, Refined, RunState, particles_of, refine as split};
use crate::subdomain::GpuParticle;

use super::CliError;
use super::arguments::RefineArguments;
use super::run::table::columns;
use super::settings::model_of;
use super::terminal::say;

pub fn refine(raw: RefineArguments) -> Result<(), CliError> {
    let path = latest(&raw.from)?;
    let run = run_of(&path);
    let folder = raw.out.unwrap_or_else(|| default_folder(&run, raw.times));
    if same(&folder, &run) {
        return Err(CliError::RefinedOntoItself { path: folder });
    }
    let checkpoint = Checkpoint::open(&path)?;
    let (parent, state, particles) = read(&checkpoint)?;
    let mut refined = split(&parent, &state, &particles, raw.times)?;
    checkpoint.restore_names(&mut refined.model.scene);
    for warning in &refined.model.plan.warnings {
        tracing::warn!("{warning}");
    }
    let scene = to_toml(&refined.model.scene);
    let claim = Claim {
        content: Content::Run,
        scene: Some(&scene),
        meshes: &checkpoint.manifest().mesh,
        inputs: &[std::slice::from_ref(&path), &checkpoint.meshes()?[..]].concat(),
        force: raw.force,
    };
    let written = write(&refined, &checkpoint, &OutputFolder::create(&folder, &claim)?)?;
    say(&summary(&refined.report, raw.times))?;
    say(&format!("{}\n", written.display()))
}

/// The run's folder, of `.../checkpoints/step-0000123456`; of a checkpoint elsewhere its own.
fn run_of(checkpoint: &Path) -> PathBuf {
    let checkpoint = checkpoint.canonicalize().unwrap_or_else(|_| checkpoint.to_path_buf());
    match checkpoint.parent() {
        Some(parent) if parent.file_name().is_some_and(|name| name == crate::output::CHECKPOINT_FOLDER) => {
            parent.parent().unwrap_or(parent).to_path_buf()
        }
        _ => checkpoint,
    }
}

/// `results/tank-x50` beside `results/tank`.
fn default_folder(run: &Path, times: u64) -> PathBuf {
    let mut name = run.file_name().unwrap_or_default().to_os_string();
    name.push(format!("-x{times}"));
    run.with_file_name(name)
}

fn same(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}

fn read(checkpoint: &Checkpoint) -> Result<(Model, RunState, Vec<GpuParticle>), CliError> {
    let name = checkpoint.path().join(SCENE_FILE);
    let scene = parse(&checkpoint.scene_here()?, &name.display().to_string(), Path::new(""))?;
    let model = model_of(&name, scene)?;
    checkpoint.check_plan(&model.plan.to_toml()?)?;
    let (_, state) = checkpoint.state::<RunState>()?;
    Ok((model, state, particles_of(checkpoint)?))
}

/// A run's folder that has got as far as the refined state. Its history and its snapshots begin there.
fn write(refined: &Refined, parent: &Checkpoint, folder: &OutputFolder) -> Result<PathBuf, CliError> {
    let Refined { model, particles, state, report } = refined;
    let plan = model.plan.to_toml()?;
    let Manifest { adapter, mesh, .. } = parent.manifest();
    for (record, source) in mesh.iter().zip(parent.meshes()?) {
        record.keep(&source, folder.path())?;
    }
    let scene = to_toml(&model.scene);
    let units = parent.units();
    let origin = Origin { scene, plan: plan.clone(), meshes: mesh.clone(), adapter: adapter.clone(), units };
    folder.write_text(SCENE_FILE, &origin.scene)?;
    folder.write_text(PLAN_FILE, &plan)?;
    let history = HistoryWriter::create(folder.path(), &columns(&model.scene))?.state()?;
    let snapshots = match model.scene.output.snapshots {
        0 => None,
        _ => Some(SnapshotWriter::create(folder.path())?.state()?),
    };
    // Steps count from the refinement: those before were others.
    let writer = CheckpointWriter::new(&folder.checkpoints(), 0);
    let file = writer.particles(0, bytemuck::cast_slice(particles))?;
    let count = particles.len() as u64;
    let moment = Moment { step: 0, time: report.time, particles: count, ids: count };
    let output = &OutputState { history, snapshots };
    Ok(writer.commit(vec![file], &moment, RunContext { origin: &origin, state, output })?)
}

fn summary(report: &RefineReport, times: u64) -> String {
    let mut text = format!(
        "at {:.4} ms: {} particles of 1/{times} the mass from {}\n",
        1e3 * report.time,
        grouped(report.particles),
        grouped(report.parents),
    );
    text += &format!(
        "{} more and {} fewer than {times} for each, as the refined scene has by now\n",
        grouped(report.added),
        grouped(report.dropped),
    );
    text += &format!(
        "{} groups of neighbours keep momentum within {:.0e} and energy within {:.0e} after rounding\n",
        grouped(report.groups),
        report.momentum_error,
        report.energy_error,
    );
    if report.at_parent > 0 {
        text += &format!("{} found no place around their parent and are at its own\n", grouped(report.at_parent));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_refined_run_is_beside_its_parent() {
        let run = run_of(Path::new("/r/tank/checkpoints/step-0000000040"));
        assert_eq!(run, Path::new("/r/tank"));
        assert_eq!(default_folder(&run, 50), Path::new("/r/tank-x50"));
        assert_eq!(default_folder(&run_of(Path::new("/r/step-0000000040")), 2), Path::new("/r/step-0000000040-x2"));
    }
}
