//! A family of runs at a number of particles.

use super::cost::Cost;
use super::families::Family;
use crate::plan::forecast::{Candidate, ColumnForecast};
use crate::plan::limits::Quantity;

/// A family at a number of particles.
#[derive(Debug, Clone, PartialEq)]
pub struct Possible {
    pub family: Family,
    pub candidate: Candidate,
    /// s; `None`: that which a scene has that asks for none.
    pub time_step: Option<f64>,
    pub columns: Vec<ColumnForecast>,
    pub error: f64,
    pub cost: Cost,
    /// The limits that it would be beyond, of those that a choice keeps ([`kept`]).
    pub beyond: Vec<Quantity>,
}
