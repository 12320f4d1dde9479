//! What will be modelled and why: a [`Scene`](crate::scene::Scene) becomes a [`Plan`] (specification,
//! section 6).
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
//! - the particles of chambers and inflow sum to `particles`, at most 2^28 - 1;
//! - equal scenes give equal plans, bit for bit.

mod amounts;
mod cap;
mod choice;
mod control_volume;
mod decide;
mod error;
mod facets;
mod forecast;
mod heat;
mod inventory;
mod limits;
mod longest;
mod motion;
mod plausible;
mod population;
mod render;
mod resolution;
mod vents;
mod warnings;

use crate::gas::Species;
use crate::geometry::Grid;
use crate::scene::{Method, Opening, SurfaceId};
use serde::Serialize;

pub use choice::{Alternative, Choice, Forecast, choose, modelling_errors};
pub use decide::plan;
pub use error::{MOST_PARTICLES, PlanError};
pub use forecast::noise::{of_hits as noise_of_hits, of_zone as noise_of_zone};
pub use forecast::{Cause, ColumnForecast, Modelled, Outlook, Part, SeenHeat, SeenProbe, SeenSurface, worst};
pub use inventory::Inventory;
pub use limits::{Bound, FAST_TAIL, LIMITS, Limit, Quantity, Warning, limit, step_limit};
pub use plausible::of_scene as doubts_of;
pub use render::significant;
pub use resolution::{FASTEST_PAIR, LADDER_TAIL, PER_CELL};

/// What the plan needs to know of the geometry.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// m3.
    pub gas_volume: f64,
    /// m3, one per chamber of the scene.
    pub chamber_volumes: Vec<f64>,
    /// m, the box around all walls.
    pub bounds_min: [f64; 3],
    pub bounds_max: [f64; 3],
    /// The openings found from the holes of the walls; those declared in the scene are added.
    pub openings: Vec<Opening>,
    /// The narrowest passage of the gas between walls that face each other, m, where one was found.
    pub smallest_gap: Option<f64>,
    /// The thinnest body with gas on both sides, m, where one was found.
    pub thinnest_body: Option<f64>,
    /// m2, of all walls.
    pub wall_area: f64,
    /// m3 of gas, one per probe of the scene.
    pub probe_volumes: Vec<f64>,
    /// Of each vent of the scene.
    pub vents: Vec<MeasuredVent>,
    /// Each surface that is no mirror or has vents, with the index of a chamber that it borders on.
    pub coated: Vec<(SurfaceId, usize)>,
    /// Where walls move.
    pub motion: Option<MeasuredMotion>,
    /// Box, area and volume of each wall of the scene.
    pub walls: Vec<MeasuredWall>,
    /// Whether gas space that is in no chamber lies beside a chamber without a wall between.
    pub open_to_empty: bool,
}

/// The part of the gas space that may be in no chamber, as the inside of holes is.
const IN_HOLES: f64 = 0.01;

impl Measured {
    /// m3 of gas space in no chamber.
    fn empty_space(&self) -> f64 {
        self.gas_volume - self.chamber_volumes.iter().sum::<f64>()
    }

    /// That all gas space has gas at the start: what flows into empty space no control volume knows, and no forecast.
    ///
    /// # Errors
    /// If chambers leave more of it out than holes have.
    fn no_empty_space(&self, asked: &'static str) -> Result<(), PlanError> {
        let (chambers, gas) = (self.chamber_volumes.iter().sum::<f64>(), self.gas_volume);
        if self.empty_space() > IN_HOLES * gas {
            return Err(PlanError::EmptySpace { asked, chambers, gas });
        }
        Ok(())
    }
}

/// What moving walls do to the gas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredMotion {
    /// m3, of all gas at the end of the run.
    pub final_gas_volume: f64,
    /// The least volume of a chamber in the run, over that at the start.
    pub least_share: f64,
    /// m/s, of the fastest wall.
    pub fastest: f64,
}

/// A wall as it is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredWall {
    /// m, the corners of the box around it.
    pub min: [f64; 3],
    pub max: [f64; 3],
    /// m2.
    pub area: f64,
    /// m3, what it encloses: gas in a cavity, else solid.
    pub volume: f64,
    pub cavity: bool,
    /// Of a solid: the share of its volume that lies outside of what encloses the gas.
    pub outside: f64,
}

/// Where a vent is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredVent {
    pub chamber: usize,
    /// m2 of wall.
    pub area: f64,
}

/// What will be modelled; all SI.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Plan {
    pub method: Method,
    /// Initial and injected together; none in a control volume, as are diameter, rounds and step.
    pub particles: u64,
    pub initial_particles: u64,
    pub injected_particles: u64,
    pub moles_per_particle: f64,
    /// m; 0 without collisions, as are `occupancy`, `rounds` and `collision_limit`.
    pub diameter: f64,
    /// Where gas is dense, the diameter is at most so many of its mean spacings; only of `closest-approach`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub diameter_cap: Option<f64>,
    /// n pi sigma^3 / 6 at the mean density at the end.
    pub occupancy: f64,
    /// m, at the mean density at the end; infinite without collisions.
    pub mean_free_path: f64,
    /// Z of the spin exchange.
    pub collision_number: f64,
    /// Pairing rounds per step; 0 where particles collide within their cells.
    pub rounds: u32,
    /// Largest x = dt/tau: that at which these rounds lose at most 2 % of the events; 2 for `cell`.
    pub collision_limit: f64,
    /// The largest of the ladder, s.
    pub time_step: f64,
    /// A step is `time_step` / 2^level, level < `ladder_levels`.
    pub ladder_levels: u32,
    /// Steps between changes of the level.
    pub steps_per_interval: u32,
    /// Steps between tallies of the zones, which lie about the middle of an interval; 0: none.
    pub tally_every: u32,
    /// A block of the coarse grid is 2^this cells along each axis.
    pub block_cells_log2: u32,
    /// K, the mean at the end of the run: that of the energy of all gas.
    pub temperature_reference: f64,
    /// K, the highest the scene can reach.
    pub temperature_max: f64,
    pub seed: u64,
    /// s.
    pub end_time: f64,
    /// Steps at the top of the ladder; dense moments take more.
    pub estimated_steps: f64,
    pub grid: Grid,
    pub chambers: Vec<ChamberPlan>,
    pub gases: Vec<GasPlan>,
    pub openings: Vec<OpeningPlan>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub vents: Vec<VentPlan>,
    pub reasons: Vec<Reason>,
    pub warnings: Vec<String>,
    /// What the scene lacks, and kernels are therefore compiled without.
    #[serde(skip)]
    pub left_out: Vec<&'static str>,
    /// What the scene holds, and what of it no vessel has; in its units, so no part of what checkpoints are compared by.
    #[serde(skip)]
    pub inventory: Inventory,
    /// Of a scene that wishes an accuracy or has a budget.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub forecast: Option<Forecast>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChamberPlan {
    pub name: String,
    /// m3.
    pub volume: f64,
    /// Initial particles of each gas.
    pub particles: Vec<u64>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GasPlan {
    pub name: String,
    /// kg/mol.
    pub molar_mass: f64,
    /// zeta; of a heat capacity that depends on the temperature, that at `temperature_reference`.
    pub spin_dof: f64,
    /// P of specification section 3.
    pub exchange_probability: f64,
    /// Initial and injected.
    pub particles: u64,
    #[serde(rename = "partition_function", skip_serializing_if = "Species::is_constant")]
    pub species: Species,
}

impl Plan {
    /// All warnings: what no vessel has first.
    pub fn told(&self) -> Vec<String> {
        [self.inventory.doubts.as_slice(), &self.warnings].concat()
    }

    /// The gases as they are modelled, by index.
    pub fn species(&self) -> Vec<Species> {
        self.gases.iter().map(|gas| gas.species.clone()).collect()
    }
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OpeningPlan {
    pub name: String,
    /// Chamber indices.
    pub between: [usize; 2],
    /// m2.
    pub area: f64,
    /// m.
    pub length: f64,
    /// Mean free path over length at the mean density at the end.
    pub knudsen: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VentPlan {
    pub name: String,
    /// Index of the chamber that it empties.
    pub chamber: usize,
    /// m2 that the gas flows through, and m2 of wall over which that is spread.
    pub area: f64,
    pub place: f64,
    /// kg/s at the start.
    pub initial_mass_flow: f64,
    /// The largest flux over its place, in units of p / sqrt(R T / M).
    pub largest_flux: f64,
}

/// Why a quantity has its value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reason {
    pub quantity: String,
    pub value: String,
    pub why: String,
}

#[cfg(test)]
mod tests;
