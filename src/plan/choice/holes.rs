//! Whether a hole that is resolved should rather be modelled (specification, section 6.2): where resolving it takes more
//! particles than the statistics do, and only the flow through it matters, a `[[vent]]` does.
//!
//! The plan cannot know what matters, and a vent is another scene: gas that leaves is gone, and of the chamber behind it
//! only the pressure is left. So it says what each takes, and what the vent would be.

use super::Possible;
use crate::gas::CONTINUUM_COEFFICIENT;
use crate::plan::forecast::Cause;
use crate::plan::render::{grouped, significant};
use crate::plan::{OpeningPlan, Plan, Quantity, limit};
use crate::scene::{Method, Scene};

/// What the wish asks of the statistics, and what lies behind holes.
#[derive(Debug, Clone, PartialEq)]
pub struct Holes {
    /// Particles of which the noise alone would be the error aimed at.
    statistics: f64,
    /// Pa, of each chamber at the start.
    pressures: Vec<f64>,
}

impl Holes {
    pub fn new(scene: &Scene, chosen: &Possible, aim: f64) -> Holes {
        let asked = chosen.columns.iter().filter(|column| column.asked);
        let parts = asked.flat_map(|column| &column.parts).filter(|part| part.cause == Cause::Noise);
        // It falls with the root of their number.
        let noise = parts.map(|part| part.error).fold(0.0, f64::max);
        Holes {
            statistics: chosen.candidate.particles * (noise / aim).powi(2),
            pressures: scene.chambers.iter().map(|chamber| chamber.pressure).collect(),
        }
    }

    /// What would be cheaper than resolving a hole; nothing where it is resolved, or the statistics take as much.
    pub fn advice(&self, plan: &Plan, hole: &OpeningPlan) -> Option<String> {
        if matches!(plan.method, Method::None | Method::ControlVolume) {
            return None;
        }
        let resolving = resolving(plan.method, plan.particles as f64, hole.knudsen)?;
        if resolving <= self.statistics.max(plan.particles as f64) {
            return None;
        }
        let pressure = |chamber: usize| self.pressures.get(chamber).copied().unwrap_or(0.0);
        let volume = |chamber: usize| plan.chambers.get(chamber).map_or(0.0, |chamber| chamber.volume);
        // Gas flows to the lower pressure; where none is lower, to where there is room.
        let [a, b] = hole.between;
        let behind = match pressure(a).total_cmp(&pressure(b)) {
            std::cmp::Ordering::Less => a,
            std::cmp::Ordering::Greater => b,
            std::cmp::Ordering::Equal => [a, b][usize::from(volume(b) > volume(a))],
        };
        let name = plan.chambers.get(behind).map_or("", |chamber| chamber.name.as_str());
        Some(format!(
            "; to resolve it takes {} particles, the statistics {}: if only the flow through it matters, model it: a [[vent]] \
             in a closed wall with `area` = {} m2, `discharge` = {CONTINUUM_COEFFICIENT} and `external_pressure` = {} Pa, in \
             place of chamber `{name}`",
            grouped(resolving as u64),
            grouped(self.statistics as u64),
            significant(hole.area),
            significant(pressure(behind)),
        ))
    }
}

/// Particles with which the Knudsen number of a hole is that of the table of limits: lambda ~ d ~ N^(-1/3) at a fixed
/// occupancy.
fn resolving(method: Method, particles: f64, knudsen: f64) -> Option<f64> {
    let wanted = limit(Quantity::Knudsen, method)?.bound.value();
    Some(particles * (knudsen / wanted).powi(3))
}
