use crate::geometry::Grid; pub use crate::scene::Method;
#[derive(Clone, Debug, PartialEq, serde::Serialize)] pub struct ChamberPlan{pub name:String, pub volume:f64, pub particles: Vec<u64>}
#[derive(Clone, Debug, PartialEq, serde::Serialize)] pub struct GasPlan{pub name:String, pub molar_mass:f64, pub spin_dof:f64, pub exchange_probability:f64, pub particles:u64}
#[derive(Clone, Debug, PartialEq, serde::Serialize)] pub struct OpeningPlan{pub name:String, pub between:[usize;2], pub area:f64, pub length:f64, pub knudsen:f64}
#[derive(Clone, Debug, PartialEq, serde::Serialize)] pub struct Reason{pub quantity:String, pub value:String, pub why:String}
#[derive(Clone, Debug, PartialEq, serde::Serialize)] pub struct Plan {
  pub method: Method, pub particles: u64, pub initial_particles: u64, pub injected_particles: u64,
  pub moles_per_particle: f64, pub chambers: Vec<ChamberPlan>, pub gases: Vec<GasPlan>,
  pub openings: Vec<OpeningPlan>,
  pub diameter: f64, pub occupancy: f64, pub mean_free_path: f64, pub collision_number: f64,
  pub rounds: u32, pub collision_limit: f64,
  pub time_step: f64, pub ladder_levels: u32, pub steps_per_interval: u32, pub tally_every: u32,
  pub grid: Grid, pub block_cells_log2: u32, pub temperature_reference: f64, pub temperature_max: f64, pub seed: u64, pub end_time: f64,
  pub estimated_steps: f64, pub reasons: Vec<Reason>, pub warnings: Vec<String> }
