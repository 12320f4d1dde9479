//! A plan, as it is printed and kept.

use serde::Serialize;

use super::forecast::Forecast;
use super::inventory::Inventory;
use super::reason::Reason;
use crate::gas::Species;
use crate::geometry::Grid;
use crate::scene::Method;

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
    /// P of docs/explanation/method.md, "Spin exchange".
    pub exchange_probability: f64,
    /// Initial and injected.
    pub particles: u64,
    #[serde(rename = "partition_function", skip_serializing_if = "Species::is_constant")]
    pub species: Species,
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
