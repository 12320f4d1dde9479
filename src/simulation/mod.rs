//! A run: `model` makes of a scene what it needs, `timeloop` takes the steps, `control` says how long they are, `parallel` shares them
//! among ranks, `accounting` keeps the books, `zero_d` goes without particles, `refine` begins anew with others.
//!
//! `Simulation::run` submits intervals of steps, one ahead of what it reads: the tallies of an interval
//! set the step size of the interval after next, so the device never waits for the host. If neighbour
//! lists had too little room, the intervals since are run again with more, from a remembered state or where the device had
//! stalled.

mod accounting;
mod control;
mod error;
mod model;
mod parallel;
mod refine;
mod run_state;
mod timeloop;
mod zero_d;

pub use crate::subdomain::Ghosts;
pub use accounting::audit::{AccountState, audit_limits};
pub use accounting::averages::AveragesState;
pub use accounting::guards::{GuardState, GuardWarning};
pub use accounting::lists::Lists;
pub use accounting::row::{Layout, Row, SurfaceState, ZoneState};
pub use accounting::vent_watch::VentWatch;
pub use control::clock::{Clock, ClockState};
pub use control::ladder::{Demand, Ladder, LadderError, LadderState};
pub use control::state_error::RunStateError;
pub use control::surface_states::{SeenGas, SurfaceMemory, SurfaceStates, VentTarget};
pub use error::SimulationError;
pub use model::build::Model;
pub use model::error::{ModelError, NoChamber};
pub use model::fabric::{Surface as DeformingSurface, Surfaces};
pub use model::measure::mesh_doubts;
pub use model::placed_model::PlacedModel;
pub use model::places::chamber_of;
pub use model::surface_models::SurfaceModels;
pub use model::vent_places::VentPlace;
pub use parallel::balance::{BalanceMode, BalanceOptions, BalanceRecord, imbalance};
pub use parallel::exchange::Traffic;
pub use parallel::halo_tuner::HaloOptions;
pub use parallel::initial_particles::{Initial, InitialParticles, initial_particles};
pub use parallel::load::Load;
pub use refine::{RefineError, RefineReport, Refined, refine};
pub use run_state::{Feedback, RunState, particles_of};
pub use timeloop::host_setup::check_setup;
pub use timeloop::interrupt::{Interrupt, Request, signal_name};
pub use timeloop::meter::Done;
pub use timeloop::observer::{Continued, Moment, Observer, Options, Outcome};
pub use timeloop::schedule::{CheckpointEvery, Schedule, WallTime, WallTimeError, whole_number};
pub use timeloop::setup::{Setup, Shuffle};
pub use timeloop::simulation::Simulation;
pub use timeloop::step::Sampling;
pub use zero_d::reference::{reference, reference_of_volumes};
pub use zero_d::rows::RowObserver;
pub use zero_d::switch::{Decided, Deviations, SwitchState};
pub use zero_d::uniform::run_uniform;
