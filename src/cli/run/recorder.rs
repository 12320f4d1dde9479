//! What a run leaves behind while it goes on: rows, snapshots, and the display of its progress.

use std::path::{Path, PathBuf};

use super::checkpoints::Checkpoints;
use super::reference::Reference;
use super::table::{Owners, columns, time_column, values, volume_column};
use crate::output::{
    BalanceRow, BalanceWriter, Column, FabricSnapshot, Frame, History, HistoryWriter, OutputError, OutputState,
    ParticleRow, Progress, SUBDOMAIN_CHART_FILE, Shown, SnapshotWriter, TriangleSet, over_mean, subdomain_chart,
};
use crate::simulation::{
    BalanceRecord, GuardWarning, Model, Moment, Observer, Outcome, Request, Row, RowObserver, SimulationError,
    VentWatch, imbalance,
};
use crate::subdomain::{GpuParticle, Scales};

pub struct Recorder<'a> {
    model: &'a Model,
    reference: Reference,
    history: HistoryWriter,
    /// `None` in a scene that wants no snapshots.
    snapshots: Option<SnapshotWriter>,
    progress: Option<Progress>,
    checkpoints: Option<Checkpoints<'a>>,
    /// `None` on a rank alone.
    among: Option<Among>,
    /// The fabric of the next snapshot.
    fabric: FabricSnapshot,
    /// A line for each vent; empty until the end.
    vents: Vec<VentWatch>,
}

/// What there is to tell of several ranks.
struct Among {
    dir: PathBuf,
    balance: BalanceWriter,
    /// Of the next snapshot.
    boxes: Vec<[[f64; 3]; 2]>,
    frames: Vec<Frame>,
}

/// What is written as the run goes on.
struct Files {
    history: HistoryWriter,
    snapshots: Option<SnapshotWriter>,
    progress: Option<Progress>,
}

/// Particles of a frame that are drawn, about.
const DRAWN: usize = 4000;

impl<'a> Recorder<'a> {
    /// Starts the files in the existing folder `dir`; the walls are written at once.
    pub fn new(model: &'a Model, reference: Reference, dir: &Path, shown: Shown) -> Result<Recorder<'a>, OutputError> {
        let history = HistoryWriter::create(dir, &columns(&model.scene))?;
        let snapshots = match model.scene.output.snapshots {
            0 => None,
            _ => {
                let writer = SnapshotWriter::create(dir)?.naming(gas_names(model));
                write_walls(&writer, model)?;
                Some(writer)
            }
        };
        let progress = Some(Progress::new(model.plan.end_time, shown));
        let files = Files { history, snapshots, progress };
        Ok(Recorder::of(model, reference, files))
    }

    /// Of a run that has no particles, and so no snapshots.
    pub fn without_particles(model: &'a Model, reference: Reference, dir: &Path) -> Result<Recorder<'a>, OutputError> {
        let history = HistoryWriter::create(dir, &columns(&model.scene))?;
        Ok(Recorder::of(model, reference, Files { history, snapshots: None, progress: None }))
    }

    /// Goes on with the files in `dir` from where a checkpoint found them: what was written after it is dropped, so that
    /// they end as those of a run without interruption.
    ///
    /// # Errors
    /// If a file is not the one that the checkpoint knows.
    pub fn resume(
        model: &'a Model,
        reference: Reference,
        dir: &Path,
        shown: Shown,
        from: Reached<'_>,
    ) -> Result<Recorder<'a>, OutputError> {
        let Reached { output, totals } = from;
        let history = HistoryWriter::resume(dir, &columns(&model.scene), &output.history)?;
        let mut reference = reference;
        seen_volumes(model, history.history()).into_iter().for_each(|(time, volumes)| reference.see(time, volumes));
        let snapshots = match &output.snapshots {
            None => None,
            Some(snapshots) => {
                let writer = SnapshotWriter::resume(dir, snapshots)?.naming(gas_names(model));
                write_walls(&writer, model)?;
                Some(writer)
            }
        };
        let Totals { time, steps, particle_steps } = totals;
        let progress = Some(Progress::new(model.plan.end_time, shown).resume(time, steps, particle_steps));
        let files = Files { history, snapshots, progress };
        Ok(Recorder::of(model, reference, files))
    }

    fn of(model: &'a Model, reference: Reference, files: Files) -> Recorder<'a> {
        let Files { history, snapshots, progress } = files;
        Recorder {
            model,
            reference,
            history,
            snapshots,
            progress,
            checkpoints: None,
            among: None,
            fabric: FabricSnapshot::default(),
            vents: Vec::new(),
        }
    }

    /// Also writes checkpoints.
    pub fn checkpointing(self, checkpoints: Checkpoints<'a>) -> Recorder<'a> {
        Recorder { checkpoints: Some(checkpoints), ..self }
    }

    /// The checkpoint at which the run was stopped, if it was asked to.
    pub fn stopped_at(&self) -> Option<&Path> {
        self.checkpoints.as_ref().and_then(Checkpoints::stopped_at)
    }

    /// Also tells how the work is shared out among several ranks. `step`: the run goes on from there.
    ///
    /// # Errors
    /// If the system cannot write the files.
    pub fn among(mut self, dir: &Path, step: u64) -> Result<Recorder<'a>, OutputError> {
        let balance = if step > 0 { BalanceWriter::resume(dir, step)? } else { BalanceWriter::create(dir)? };
        self.among = Some(Among { dir: dir.to_path_buf(), balance, boxes: Vec::new(), frames: Vec::new() });
        Ok(self)
    }

    /// How far the files have got, all of them on the disc: for a checkpoint of this moment.
    ///
    /// # Errors
    /// If the system cannot write them.
    pub fn state(&mut self) -> Result<OutputState, OutputError> {
        let snapshots = self.snapshots.as_mut().map(SnapshotWriter::state).transpose()?;
        Ok(OutputState { history: self.history.state()?, snapshots })
    }

    /// When each vent opened, or that it did not, and for how long it would have let gas in: a line each, at the end of a run.
    pub fn of_vents(&self) -> String {
        let scene = &self.model.scene;
        let of_vent = |(index, watch): (usize, &VentWatch)| [watch.told(scene, index), watch.drew(scene, index)];
        self.vents.iter().enumerate().flat_map(of_vent).flatten().map(|text| text + "\n").collect()
    }

    pub fn history(&self) -> &History {
        self.history.history()
    }

    /// The state at the end, if the run ended between two snapshots, and the rates of the whole run. What stopped at a
    /// checkpoint has its state there.
    pub fn finish(&mut self, outcome: &Outcome) -> Result<(), OutputError> {
        if let Some(progress) = &mut self.progress {
            progress.finish(
                outcome.continued.as_ref().map_or(outcome.time, |continued| continued.until),
                outcome.steps,
                outcome.particle_steps,
            );
        }
        if self.stopped_at().is_some() {
            return Ok(());
        }
        if self.snapshots.as_ref().and_then(SnapshotWriter::last_time) != Some(outcome.time) {
            if let Some(among) = &mut self.among {
                // Those of the snapshot before may no longer be right.
                among.boxes.clear();
            }
            self.fabric.clone_from(&outcome.fabric);
            self.write_snapshot(outcome.time, &outcome.particles, &outcome.owners)?;
        }
        match &self.among {
            Some(Among { dir, frames, .. }) if !frames.is_empty() => {
                let title = format!("{}: particles by the rank that owns them", self.model.scene.title);
                subdomain_chart(&dir.join(SUBDOMAIN_CHART_FILE), &title, frames)
            }
            _ => Ok(()),
        }
    }

    fn write_snapshot(&mut self, time: f64, particles: &[GpuParticle], owners: &[u32]) -> Result<(), OutputError> {
        let Some(writer) = &mut self.snapshots else {
            return Ok(());
        };
        let plan = &self.model.plan;
        let scales = Scales::new(plan);
        if let Some(among) = &mut self.among {
            let every = particles.len().div_ceil(DRAWN).max(1);
            let sample = particles.iter().zip(owners).step_by(every);
            among.frames.push(Frame {
                time,
                particles: particles.len(),
                points: sample.map(|(particle, &owner)| (plan.grid.to_metres(particle.position), owner)).collect(),
                boxes: among.boxes.clone(),
            });
        }
        let rows: Vec<ParticleRow> = particles
            .iter()
            .map(|particle| ParticleRow {
                id: particle.id(),
                gas: particle.gas(),
                position: plan.grid.to_metres(particle.position),
                velocity: particle.velocity,
                spin_energy: (f64::from(particle.spin) * scales.reference_mass) as f32,
            })
            .collect();
        writer.write_among(time, &rows, self.among.is_some().then_some(owners))?;
        let fabric = &self.model.fabric;
        if fabric.is_empty() {
            return Ok(());
        }
        let owners: Vec<u32> =
            (0..).zip(&fabric.all).flat_map(|(k, own)| own.triangles.clone().map(move |_| k)).collect();
        let names: Vec<String> = fabric.all.iter().map(|own| own.name.clone()).collect();
        let triangles =
            TriangleSet { vertices: &self.fabric.nodes, triangles: &fabric.triangles, owners: &owners, names: &names };
        writer.write_fabric(triangles, self.fabric.fields.as_ref())
    }
}

/// How far a run had got at a checkpoint.
#[derive(Debug, Clone, Copy)]
pub struct Reached<'a> {
    pub output: &'a OutputState,
    pub totals: Totals,
}

/// What a run has done so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Totals {
    /// s.
    pub time: f64,
    pub steps: u64,
    pub particle_steps: u64,
}

fn write_walls(writer: &SnapshotWriter, model: &Model) -> Result<(), OutputError> {
    let triangles = &model.vessel.triangles;
    let corners: Vec<[u32; 3]> = triangles.iter().map(|triangle| triangle.vertices).collect();
    let walls: Vec<u32> = triangles.iter().map(|triangle| triangle.wall).collect();
    let names: Vec<String> = model.scene.walls.iter().map(|wall| wall.name.clone()).collect();
    let walls = TriangleSet { vertices: &model.vessel.vertices, triangles: &corners, owners: &walls, names: &names };
    writer.write_walls(walls).map(|_| ())
}

/// The times of rows, s, and the volumes of chambers then, m3.
fn seen_volumes(model: &Model, history: &History) -> Vec<(f64, Vec<f64>)> {
    let column = |column: Column| history.column(&column.header()).unwrap_or_default();
    let owners = Owners::of(&model.scene).chambers;
    let volumes: Vec<Vec<f64>> = owners.iter().map(|owner| column(volume_column(owner))).collect();
    let at = |row: usize| volumes.iter().filter_map(|own| own.get(row).copied()).collect();
    column(time_column()).into_iter().enumerate().map(|(row, time)| (time, at(row))).collect()
}

fn gas_names(model: &Model) -> Vec<String> {
    model.scene.gases.iter().map(|gas| gas.name.clone()).collect()
}

fn balance_row(record: &BalanceRecord) -> BalanceRow {
    let loads = &record.loads;
    let seconds: Vec<f64> = loads.iter().map(|load| load.seconds).collect();
    BalanceRow {
        step: record.step,
        time: record.time,
        owned: loads.iter().map(|load| load.owned).collect(),
        ghosts: loads.iter().map(|load| load.particles.saturating_sub(load.owned)).collect(),
        imbalance_work: imbalance(record.predicted.iter().copied()),
        imbalance_seconds: seconds.iter().any(|&s| s > 0.0).then(|| over_mean(&seconds)),
        rebalanced: record.rebalanced,
        moved: loads.iter().map(|load| load.moved).sum(),
        bytes: loads.iter().map(|load| load.bytes).sum(),
        rebalance_seconds: loads.iter().map(|load| load.rebalancing).fold(0.0, f64::max),
    }
}

/// The error's text names the file.
fn stop(error: OutputError) -> SimulationError {
    SimulationError::Observer(error.to_string())
}

impl RowObserver for Recorder<'_> {
    fn row(&mut self, row: &Row) -> Result<(), SimulationError> {
        if self.stopped_at().is_some() {
            // The window that the checkpoint cuts in two: the run that goes on has the whole of it.
            return Ok(());
        }
        self.reference.follow(self.model, row);
        self.history.row(&values(row, &self.reference)).map_err(stop)
    }

    fn vent_opened(&mut self, index: usize, watch: &VentWatch) {
        let Some(text) = watch.told(&self.model.scene, index) else { return };
        match &self.progress {
            Some(progress) => progress.note(&text),
            None => tracing::info!("{text}"),
        }
    }

    fn vents(&mut self, watches: &[VentWatch]) {
        self.vents = watches.to_vec();
    }

    fn progress(&mut self, time: f64, steps: u64, particle_steps: u64) {
        if let Some(progress) = &mut self.progress {
            progress.update(time, steps, particle_steps);
        }
    }
}

impl Observer for Recorder<'_> {
    fn snapshot(&mut self, time: f64, particles: &[GpuParticle], owners: &[u32]) -> Result<(), SimulationError> {
        self.write_snapshot(time, particles, owners).map_err(stop)
    }

    fn fabric(&mut self, fabric: FabricSnapshot) {
        self.fabric = fabric;
    }

    fn boxes(&mut self, boxes: &[[[f64; 3]; 2]]) {
        if let Some(among) = &mut self.among {
            among.boxes = boxes.to_vec();
        }
    }

    fn balance(&mut self, record: &BalanceRecord) -> Result<(), SimulationError> {
        match &mut self.among {
            Some(among) => among.balance.row(&balance_row(record)).map_err(stop),
            None => Ok(()),
        }
    }

    fn warning(&mut self, told: &GuardWarning) {
        match &self.progress {
            Some(progress) => progress.warn(&told.to_string()),
            None => tracing::warn!("{told}"),
        }
    }

    fn request(&mut self, steps: u64) -> Request {
        self.checkpoints.as_mut().map_or(Request::None, |checkpoints| checkpoints.request(steps))
    }

    fn checkpoint(&mut self, moment: &Moment<'_>) -> Result<(), SimulationError> {
        let Some(mut checkpoints) = self.checkpoints.take() else { return Ok(()) };
        let written = checkpoints.write(moment, Some(&mut || self.state()));
        self.checkpoints = Some(checkpoints);
        if let (Some(written), Some(progress)) = (written?, &self.progress) {
            progress.note(&written.to_string());
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
