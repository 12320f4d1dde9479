//! What can go wrong in a run.

use super::accounting::guards::GuardWarning;
use super::control::ladder::LadderError;
use super::model::error::NoChamber;
use crate::fabric::MembraneError;
use crate::gas::FillError;
use crate::geometry::GeometryError;
use crate::gpu::GpuError;
use crate::output::CheckpointError;
use crate::partition::PartitionError;
use crate::ranks::RankError;
use crate::simulation::control::state_error::RunStateError;
use crate::subdomain::{StateError, TooManyParts};

#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum SimulationError {
    #[error(transparent)]
    #[diagnostic(transparent)]
    Geometry(#[from] GeometryError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Fill(#[from] FillError),
    #[error(transparent)]
    State(#[from] StateError),
    #[error(transparent)]
    Cells(#[from] TooManyParts),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error("elastic fabric is none that can be computed: {0}")]
    Membrane(#[from] MembraneError),
    #[error("nodes of elastic fabric would have left the grid of the walls, or were nowhere, {times} times")]
    #[diagnostic(help(
        "give the bag room within its walls; where it has, its steps are too long or its gas too coarse"
    ))]
    LostNodes { times: u32 },
    #[error("fabric \"{fabric}\" came, by {time:e} s, over a plane between it and another closed fabric")]
    #[diagnostic(help(
        "closed fabrics are told apart by planes between them at the start: put them farther apart, or hold them there"
    ))]
    OverPlane { fabric: String, time: f64 },
    #[error("fabric \"{fabric}\" has no inside left, by {time:e} s: its sheets have passed through each other")]
    #[diagnostic(help("sheets do not stop each other: more gas in it, or less pressure on it, hold them apart"))]
    InsideOut { fabric: String, time: f64 },
    #[error(transparent)]
    Partition(#[from] PartitionError),
    #[error(transparent)]
    Rank(#[from] RankError),
    #[error("a message of rank {rank} is {found}; {expected} was due")]
    Message { rank: usize, found: String, expected: String },
    #[error("{found} of the {expected} particles of the start came to the ranks that own them")]
    Dealt { found: u64, expected: u64 },
    #[error(transparent)]
    #[diagnostic(transparent)]
    Checkpoint(#[from] CheckpointError),
    #[error(transparent)]
    Resume(#[from] RunStateError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    NoChamber(#[from] NoChamber),
    #[error("the method `control-volume` has no particles to share out or to send to a device")]
    #[diagnostic(help("`corpuscle run` does the run; for particles ask for another `method` in [model]"))]
    NoParticles,
    #[error("at {time:.6} s: {source}")]
    Ladder { time: f64, source: LadderError },
    /// Of a run for which warnings are errors.
    #[error("--strict, and the run warns {told}")]
    #[diagnostic(help("what was written until then stays; without --strict the run would have gone on"))]
    Guard { told: Box<GuardWarning> },
    #[error("at {time:.6} s: {what}")]
    #[diagnostic(help("the run cannot be trusted beyond this point; please report it with the scene"))]
    Lost { time: f64, what: String },
    /// What an observer could not do, such as write a file.
    #[error("{0}")]
    Observer(String),
}
