//! A rank's time loop and the step: owns the subdomain, the inflow and the clock; audits.
//!
//! `Simulation::run` submits intervals of steps, one ahead of what it reads: the tallies of an interval
//! set the step size of the interval after next, so the device never waits for the host. If neighbour
//! lists had too little room, the intervals since are run again with more, from a remembered state or where the device was held.

mod audit;
mod averages;
mod balance;
mod block_gas;
mod clock;
mod coats;
mod conditions;
mod decomposition;
mod exchange;
mod flow_only;
mod guards;
mod interrupt;
mod interval;
mod ladder;
mod model;
mod moving;
mod observer;
mod outlook;
mod reference;
mod refine;
mod run;
mod run_state;
mod schedule;
mod setup;
mod step;
mod stock;
mod switch;
mod tuning;
mod uniform;
mod vent_watch;

pub use crate::subdomain::Ghosts;
pub use audit::{AccountState, audit_limits};
pub use averages::{AveragesState, Layout, Row, SurfaceState, ZoneState};
pub use balance::{BalanceMode, BalanceOptions, BalanceRecord, Load, imbalance};
pub use clock::{Clock, ClockState};
pub use coats::{Coat, Coats, VentPlace};
pub use conditions::{Conditions, ConditionsState, Seen, Wanted};
pub use exchange::Traffic;
pub use guards::{GuardState, Told};
pub use interrupt::{Interrupt, Request, signal_name};
pub use ladder::{Demand, Ladder, LadderError, LadderState};
pub use model::{Model, ModelError, chamber_of};
pub use observer::{Continued, Moment, Observer, Options, Outcome};
pub use reference::reference;
pub use refine::{RefineError, RefineReport, Refined, refine};
pub use run::Simulation;
pub use run::meter::{Done, Lists};
pub use run_state::{Asked, RunState, StateError as RunStateError, particles_of};
pub use schedule::{CheckpointEvery, Schedule, WallTime, WallTimeError, whole_number};
pub use setup::{Setup, Shuffle};
pub use step::Sampling;
pub use stock::{Initial, Stock, initial_particles};
pub use switch::{Decided, Deviations, SwitchState};
pub use tuning::HaloOptions;
pub use uniform::{NoChamber, run_uniform};
pub use vent_watch::VentWatch;

use crate::gas::FillError;
use crate::geometry::GeometryError;
use crate::gpu::GpuError;
use crate::output::CheckpointError;
use crate::partition::PartitionError;
use crate::ranks::RankError;
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
    Guard { told: Box<Told> },
    #[error("at {time:.6} s: {what}")]
    #[diagnostic(help("the run cannot be trusted beyond this point; please report it with the scene"))]
    Lost { time: f64, what: String },
    /// What an observer could not do, such as write a file.
    #[error("{0}")]
    Observer(String),
}
