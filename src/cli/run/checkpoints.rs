//! Checkpoints of a run: when they are due, and how its ranks write one together.
//!
//! Every rank writes its particles and tells rank 0. Rank 0 flushes the files of the run, adds the state and gives the
//! checkpoint its name; then it tells all how that went, so that an error of any rank ends all with its message, and no
//! rank computes on before the checkpoint stands.

use std::fmt;
use std::path::{Path, PathBuf};
use std::time::Instant;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::output::{self, CheckpointError, CheckpointWriter, FileRecord, Origin, OutputError, OutputState};
use crate::ranks::RankError;
use crate::simulation::{
    CheckpointEvery, Interrupt, Moment, Observer, Request, RowObserver, Schedule, SimulationError, WallTime,
};
use crate::subdomain::GpuParticle;

/// What the user asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct CheckpointWish {
    pub every: Option<CheckpointEvery>,
    pub stop_after: Option<WallTime>,
}

/// How far the files of the run have got.
pub type Outputs<'a> = &'a mut dyn FnMut() -> Result<OutputState, OutputError>;

/// One rank's part.
pub struct Checkpoints<'a> {
    folder: PathBuf,
    /// One for all ranks of the process.
    interrupt: &'a Interrupt,
    /// Of the process.
    started: Instant,
    /// On rank 0.
    lead: Option<Lead>,
    stopped_at: Option<PathBuf>,
}

/// What only rank 0 knows.
struct Lead {
    schedule: Schedule,
    origin: Origin,
}

impl<'a> Checkpoints<'a> {
    /// Into `folder`, which need not be there yet; `started`: the process did.
    pub fn new(folder: PathBuf, interrupt: &'a Interrupt, started: Instant) -> Checkpoints<'a> {
        Checkpoints { folder, interrupt, started, lead: None, stopped_at: None }
    }

    /// The part of rank 0, of a run whose time loop starts, or goes on, at `step`.
    pub fn leading(self, wanted: CheckpointWish, step: u64, origin: Origin) -> Checkpoints<'a> {
        let schedule = Schedule::new(wanted.every, wanted.stop_after, self.started.elapsed(), step);
        Checkpoints { lead: Some(Lead { schedule, origin }), ..self }
    }

    /// What this rank wants done soon; signals may reach any of them.
    pub fn request(&mut self, step: u64) -> Request {
        let elapsed = self.started.elapsed();
        let due = self.lead.as_mut().map_or(Request::None, |lead| lead.schedule.due(elapsed, step));
        self.interrupt.take().max(due)
    }

    /// The checkpoint at which the run was stopped, if it was asked to.
    pub fn stopped_at(&self) -> Option<&Path> {
        self.stopped_at.as_deref()
    }

    /// Writes a checkpoint. Collective. `output`, on rank 0, tells how far the files of the run have got, all of it on
    /// the disc. Returns what was written, on rank 0.
    ///
    /// # Errors
    /// On every rank the same, if one of them could not write.
    pub fn write(
        &mut self,
        moment: &Moment<'_>,
        output: Option<Outputs<'_>>,
    ) -> Result<Option<Written>, SimulationError> {
        let begun = Instant::now();
        let (comm, rank) = (moment.comm, moment.comm.rank());
        let writer = CheckpointWriter::new(&self.folder, moment.step);
        // By id: on a device particles may lie in the order of its threads.
        let mut particles = moment.own.to_vec();
        particles.sort_unstable_by_key(GpuParticle::id);
        let own = writer.particles(rank, bytemuck::cast_slice(&particles)).map_err(|error| error.to_string());
        drop(particles);
        let written = match comm.gather(encoded(&own, rank)?)? {
            None => Ok(None),
            Some(all) => {
                let files: Result<Vec<FileAnswer>, RankError> =
                    all.iter().enumerate().map(|(rank, bytes)| decoded(bytes, rank)).collect();
                self.commit(writer, moment, files?, output).map(Some)
            }
        };
        let trouble: Option<String> = decoded(&comm.broadcast(encoded(&written.as_ref().err(), rank)?)?, 0)?;
        if let Some(trouble) = trouble {
            return Err(SimulationError::Observer(trouble));
        }
        let written = written.ok().flatten();
        if moment.stopping {
            self.stopped_at = written.as_ref().map(|written| written.path.clone());
        }
        if let Some(lead) = &mut self.lead {
            lead.schedule.written(self.started.elapsed(), moment.step, begun.elapsed());
        }
        Ok(written)
    }

    /// On rank 0.
    fn commit(
        &self,
        writer: CheckpointWriter,
        moment: &Moment<'_>,
        files: Vec<FileAnswer>,
        output: Option<Outputs<'_>>,
    ) -> Result<Written, String> {
        let several = files.len() > 1;
        let of_rank = |(rank, file): (usize, FileAnswer)| {
            file.map_err(|error| if several { format!("rank {rank}: {error}") } else { error })
        };
        let files = files.into_iter().enumerate().map(of_rank).collect::<Result<Vec<FileRecord>, String>>()?;
        let (Some(Lead { origin, .. }), Some(output)) = (&self.lead, output) else {
            return Err("rank 0 does not know what the checkpoint is of".to_owned());
        };
        let Moment { step, time, particles, ids, state, .. } = *moment;
        let at = output::Moment { step, time, particles, ids };
        let output = output().map_err(|error| error.to_string())?;
        let commit = || -> Result<Written, CheckpointError> {
            let path = writer.commit(files, &at, output::RunContext { origin, state, output: &output })?;
            let bytes = output::Checkpoint::open_checked(&path)?.manifest().file.iter().map(|file| file.bytes).sum();
            Ok(Written { path, step, time, bytes })
        };
        commit().map_err(|error| error.to_string())
    }
}

/// The observer of every rank but rank 0.
impl RowObserver for Checkpoints<'_> {}

impl Observer for Checkpoints<'_> {
    fn request(&mut self, steps: u64) -> Request {
        Checkpoints::request(self, steps)
    }

    fn checkpoint(&mut self, moment: &Moment<'_>) -> Result<(), SimulationError> {
        self.write(moment, None).map(|_| ())
    }
}

/// A rank's file of particles, or why there is none.
type FileAnswer = Result<FileRecord, String>;

/// A checkpoint that stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Written {
    path: PathBuf,
    step: u64,
    /// s.
    time: f64,
    /// Of all its files but the manifest.
    bytes: u64,
}

impl fmt::Display for Written {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Written { path, step, time, bytes } = self;
        let megabytes = 1e-6 * *bytes as f64;
        write!(out, "checkpoint {}: step {step}, {:.4} ms, {megabytes:.2} MB", path.display(), 1e3 * time)
    }
}

fn encoded<T: Serialize>(value: &T, rank: usize) -> Result<Vec<u8>, RankError> {
    postcard::to_stdvec(value).map_err(|_| RankError::Garbled { rank })
}

fn decoded<T: DeserializeOwned>(bytes: &[u8], rank: usize) -> Result<T, RankError> {
    postcard::from_bytes(bytes).map_err(|_| RankError::Garbled { rank })
}
