//! A gas at rest in a cube, the scene of most closed forms: what it is made of, and what follows from that
//! by the formulas of docs/explanation/method.md, written here once more, independently.

use std::f64::consts::PI;

use crate::simulation::Model;
use crate::study::StudyError;

use super::witness::model_of;

pub const GAS_CONSTANT: f64 = 8.314462618;
/// m.
pub const EDGE: f64 = 0.1;
pub const TEMPERATURE: f64 = 300.0;

/// One gas or several in a cube of [`EDGE`]; all that a case may want to vary.
#[derive(Debug, Clone, Copy)]
pub struct EquilibriumBox<'a> {
    pub method: &'a str,
    pub particles: u64,
    pub occupancy: f64,
    /// x = dt/tau.
    pub step_over_tau: f64,
    /// Not of the method `cell`.
    pub rounds: u32,
    pub steps: u32,
    /// Molar mass of the (mean) gas, kg/mol.
    pub molar_mass: f64,
    /// `[[gas]]` tables.
    pub gases: &'a str,
    /// More `[[wall]]` tables.
    pub walls: &'a str,
    /// Gas or mixture, in TOML.
    pub mixture: &'a str,
    pub rows: u32,
    pub snapshots: u32,
    pub collision_number: f64,
}

pub const NITROGEN: &str = "[[gas]]\nname = \"nitrogen\"\nmolar_mass = 0.028\ngamma = 1.4\n";

impl Default for EquilibriumBox<'_> {
    fn default() -> Self {
        EquilibriumBox {
            method: "closest-approach",
            walls: "",
            particles: 1000,
            occupancy: 0.1,
            step_over_tau: 0.1,
            rounds: 3,
            steps: 100,
            molar_mass: 0.028,
            gases: NITROGEN,
            mixture: "\"nitrogen\"",
            rows: 1,
            snapshots: 0,
            collision_number: 5.0,
        }
    }
}

impl EquilibriumBox<'_> {
    /// Particles per m3.
    pub fn number_density(&self) -> f64 {
        self.particles as f64 / EDGE.powi(3)
    }

    /// m.
    pub fn diameter(&self) -> f64 {
        (6.0 * self.occupancy / (PI * self.number_density())).cbrt()
    }

    /// sqrt(kT/m), m/s.
    pub fn thermal_speed(&self) -> f64 {
        (GAS_CONSTANT * TEMPERATURE / self.molar_mass).sqrt()
    }

    /// m.
    pub fn mean_free_path(&self) -> f64 {
        1.0 / (2f64.sqrt() * PI * self.number_density() * self.diameter().powi(2))
    }

    /// s.
    pub fn collision_time(&self) -> f64 {
        self.mean_free_path() / (self.thermal_speed() * (8.0 / PI).sqrt())
    }

    /// What of the gas does not collide as in free space, m from the walls: near one a pair does not meet behind it.
    pub fn wall_layer(&self) -> f64 {
        2.0 * self.diameter() + self.mean_free_path()
    }

    /// Where particles have no diameter `step_over_tau` is of the time in which thermal speed takes them a mean spacing.
    pub fn time_step(&self) -> f64 {
        if self.method == "half-turn" {
            return self.step_over_tau / self.number_density().cbrt() / self.thermal_speed();
        }
        self.step_over_tau * self.collision_time()
    }

    /// # Errors
    /// If no plan can be made for it.
    pub fn model(&self) -> Result<Model, StudyError> {
        model_of("equilibrium-box", &self.toml())
    }

    pub fn toml(&self) -> String {
        let time_step = self.time_step();
        let rounds = if self.method == "cell" { String::new() } else { format!("rounds = {}\n", self.rounds) };
        let collisions =
            format!("occupancy = {}\n{rounds}collision_number = {}\n", self.occupancy, self.collision_number);
        let collisions = if self.method == "half-turn" { String::new() } else { collisions };
        format!(
            "end_time = {end:e}\nseed = 7\n{gases}\n\
             [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [{EDGE}, {EDGE}, {EDGE}]\n\
             gas = \"inside\"\n{walls}\
             [[chamber]]\nname = \"all\"\npressure = 101325.0\ntemperature = {TEMPERATURE}\ngas = {mixture}\n\
             [[surface]]\nname = \"walls\"\nwall = \"box\"\n\
             [model]\nmethod = \"{method}\"\nparticles = {particles}\n\
             time_step = {time_step:e}\n{collisions}\
             [output]\nrows = {rows}\nsnapshots = {snapshots}\n",
            end = time_step * f64::from(self.steps),
            gases = self.gases,
            mixture = self.mixture,
            particles = self.particles,
            method = self.method,
            walls = self.walls,
            rows = self.rows,
            snapshots = self.snapshots,
        )
    }
}
