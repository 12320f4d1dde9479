//! What a plan is worth: the error of each column and its causes, and what it costs.

use serde::Serialize;

use crate::scene::Method;

/// What a plan is worth, and what it costs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Forecast {
    /// Relative, of the worst column: see `docs/explanation/planner.md`.
    pub error: f64,
    /// s of device time, at so many particle-steps a second.
    pub seconds: f64,
    pub particle_steps: f64,
    pub device_rate: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cheaper: Option<Alternative>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub better: Option<Alternative>,
    pub columns: Vec<ColumnForecast>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Alternative {
    pub method: Method,
    pub particles: u64,
    pub error: f64,
    pub seconds: f64,
}

/// Why a column is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cause {
    /// Finitely many particles.
    Noise,
    /// The Knudsen number of holes.
    Holes,
    /// Collisions that a step loses.
    LostCollisions,
    /// Rigid spheres have not the ideal gas's pressure.
    RigidSpheres,
    /// Fronts as wide as a mean free path.
    Fronts,
    /// Holes are modelled, and of what is behind them only a constant pressure is left.
    LeftOut,
    /// The coefficients of modelled holes are known to two per cent.
    Coefficients,
    /// A control volume has no waves.
    Transit,
    /// A control volume has no jets.
    Jets,
}

impl Cause {
    pub fn name(self) -> &'static str {
        match self {
            Cause::Noise => "noise of the particles",
            Cause::Holes => "Knudsen number of the holes",
            Cause::LostCollisions => "lost collisions",
            Cause::RigidSpheres => "pressure of rigid spheres",
            Cause::Fronts => "width of fronts",
            Cause::LeftOut => "what is left out behind holes",
            Cause::Coefficients => "discharge coefficients",
            Cause::Transit => "waves that it lacks",
            Cause::Jets => "jets that it lacks",
        }
    }
}

/// A column, and its parts.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ColumnForecast {
    pub name: String,
    /// Whether it counts.
    pub asked: bool,
    /// Relative.
    pub error: f64,
    pub parts: Vec<Part>,
}

impl ColumnForecast {
    pub(super) fn new(name: String, asked: bool, parts: Vec<(Cause, f64)>) -> ColumnForecast {
        let parts: Vec<Part> =
            parts.into_iter().filter(|part| part.1 > 0.0).map(|(cause, error)| Part { cause, error }).collect();
        let error = parts.iter().fold(0.0, |sum, part| sum + part.error * part.error).sqrt();
        ColumnForecast { name, asked, error, parts }
    }

    /// Its largest part.
    pub fn main_cause(&self) -> Option<Cause> {
        self.parts.iter().max_by(|a, b| a.error.total_cmp(&b.error)).map(|part| part.cause)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Part {
    pub cause: Cause,
    pub error: f64,
}

/// The column with the largest error of those that count.
pub fn worst(columns: &[ColumnForecast]) -> Option<&ColumnForecast> {
    columns.iter().filter(|column| column.asked).max_by(|a, b| a.error.total_cmp(&b.error))
}
