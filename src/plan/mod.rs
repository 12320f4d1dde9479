//! What will be modelled and why: a [`Scene`](crate::scene::Scene) becomes a [`Plan`] (docs/explanation/method.md,
//! "What the plan decides, and why").
//!
//! All moles of the run are shared evenly: one `moles_per_particle` nu for every gas, so that mixtures
//! thermalise to one temperature (section 1). The density, diameter and mean free path are those of the
//! mean state at the end of the run, when all gas is in.
//!
//! Invariants of a plan:
//! - `end_time` is an integer multiple of `time_step`;
//! - the grid's cell edge h satisfies h >= sqrt(sigma^2 + (g_max time_step / 2)^2), g_max = 6 sqrt(k
//!   `temperature_max` / m) of the lightest gas (section 2); for `cell` it holds a few particles, for free flight
//!   h = n^(-1/3);
//! - the particles of chambers and inflow sum to `particles`, at most 2^27 - 1;
//! - equal scenes give equal plans, bit for bit.

mod amounts;
mod cap;
mod choice;
mod continuum;
mod control_volume;
mod decide;
mod error;
mod fabric;
mod facets;
mod forecast;
mod heat;
mod inventory;
mod limits;
mod longest;
mod measured;
mod motion;
mod notes;
mod planned;
mod plausible;
mod population;
mod reach;
mod reason;
mod render;
mod resolution;
mod text;
mod vent_notes;
mod vents;
mod warnings;

pub use choice::{Choice, choose, modelling_errors};
pub use decide::plan;
pub use error::{MOST_PARTICLES, PlanError};
pub use fabric::smoothings;
pub use forecast::noise::{of_hits as noise_of_hits, of_zone as noise_of_zone};
pub use forecast::{
    Alternative, Cause, ColumnForecast, Forecast, Modelled, Outlook, Part, SeenHeat, SeenProbe, SeenSurface, worst,
};
pub use inventory::Inventory;
pub use limits::{Bound, FAST_TAIL, LIMITS, Limit, Quantity, Warning, limit, step_limit};
pub use measured::{
    DryMotion, FacingOrifice, GapBeside, Hindered, Hindrance, Measured, MeasuredMotion, MeasuredVent, MeasuredWall,
    OpenSection, Pocket, SplitChamber, Stroke,
};
pub use planned::{ChamberPlan, GasPlan, OpeningPlan, Plan, VentPlan};
pub use plausible::{by_meshes as doubts_of_meshes, by_scene as doubts_of};
pub use reach::notes as notes_of_reach;
pub use reason::Reason;
pub use resolution::{COLLISION_CELL, FASTEST_PAIR, LADDER_TAIL, PER_CELL, SPACINGS_FLOWN, TILE_EDGE};
pub use text::significant;

#[cfg(test)]
mod tests;
