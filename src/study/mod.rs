//! Studies: many runs of a scene, and what they say together.
//!
//! A sweep over counts of devices is made of real runs ([`launched`]), or of subdomains that are measured one at a time
//! on one device ([`emulation`]) and put together by a model ([`modelled`]). What is measured and what is modelled
//! never stand in one column.

pub mod bench;
pub mod emulation;
pub mod launched;
pub mod modelled;
pub mod pareto;
pub mod report;
pub mod stability;
pub mod state;
pub mod stopwatch;
pub mod verify;

use crate::output::OutputError;
use crate::ranks::RankError;
use crate::simulation::SimulationError;

/// Who owns which part of the space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Strategy {
    /// Boxes of equal size.
    Off,
    /// Boxes with equal numbers of the initial particles.
    Initial,
    /// Boxes that follow the load.
    Dynamic,
}

impl Strategy {
    /// As `run --balance` takes it.
    pub fn name(self) -> &'static str {
        match self {
            Strategy::Off => "off",
            Strategy::Initial => "initial",
            Strategy::Dynamic => "dynamic",
        }
    }

    /// In tables.
    pub fn title(self) -> &'static str {
        match self {
            Strategy::Off => "static, equal boxes",
            Strategy::Initial => "static, balanced at the start",
            Strategy::Dynamic => "dynamic RCB",
        }
    }
}

#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum StudyError {
    #[error("cannot start `{program}`: {source}")]
    #[diagnostic(help("--launcher takes a program and its arguments, such as \"mpirun --bind-to none\""))]
    Start { program: String, source: std::io::Error },
    #[error("the run {case} ended with {status}:\n{said}")]
    Run { case: String, status: String, code: Option<i32>, said: String },
    #[error("the histories of the runs {one} and {other} differ from line {line} on")]
    #[diagnostic(help(
        "runs of one scene leave the same bytes on any number of devices; please report it with the scene. \
         Both folders are kept"
    ))]
    Bits { one: String, other: String, line: usize },
    #[error("{state}: no interval of the measurement ran as it should; it may be too near to the end of the scene")]
    TooShort { state: String },
    #[error("{}: {error}", from.display())]
    Model { from: std::path::PathBuf, error: Box<crate::simulation::ModelError> },
    #[error("cannot write the table: {0}")]
    Table(#[from] csv::Error),
    #[error("cannot write the plan as TOML: {0}")]
    PlanToml(toml::ser::Error),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] crate::scene::SceneError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Checkpoint(#[from] crate::output::CheckpointError),
    #[error(transparent)]
    Device(#[from] crate::gpu::GpuError),
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Simulation(#[from] SimulationError),
    #[error(transparent)]
    Rank(#[from] RankError),
}
