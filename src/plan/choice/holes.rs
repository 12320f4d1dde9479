//! Whether a hole that is resolved should rather be modelled (docs/explanation/planner.md): where resolving it takes more
//! particles than the statistics do, and only the flow through it matters, a `[[vent]]` does.
//!
//! The plan cannot know what matters, and a vent is another scene: gas that leaves is gone, and of the chamber behind it
//! only the pressure is left. So it says what each takes, and what the vent would be; where the scene says that only the flow
//! matters (`flow_only`), both are planned and the better one is taken (`simulation::flow_only`).

use super::possible::Possible;
use crate::gas::continuum_coefficient;
use crate::plan::amounts::Amounts;
use crate::plan::forecast::{Cause, DISCHARGE_UNKNOWN, Modelled, Outlook, pressures};
use crate::plan::heat::species;
use crate::plan::text::{grouped, significant};
use crate::plan::{Measured, OpeningPlan, Plan, PlanError, Quantity, limit};
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
        let high = pressure(a).max(pressure(b));
        let name = plan.chambers.get(behind).map_or("", |chamber| chamber.name.as_str());
        Some(format!(
            "; to resolve it takes {} particles, the statistics {}: if only the flow through it matters, mark it `flow_only`, or model it: a [[vent]] \
             in a closed wall with `area` = {} m2, `discharge` = {} and `external_pressure` = {} Pa, in \
             place of chamber `{name}`",
            grouped(resolving as u64),
            grouped(self.statistics as u64),
            significant(hole.area),
            significant(continuum_coefficient(if high > 0.0 { pressure(a).min(pressure(b)) / high } else { 0.0 })),
            significant(pressure(behind)),
        ))
    }
}

/// What is seen of a scene.
pub type Sight<'a> = (&'a Scene, &'a Measured, &'a Outlook);

/// What a part of a scene, whose holes are modelled by the vents of these indices, makes of the pressure of each of its chambers
/// ([`Modelled`]): by control volumes, the root mean square over the rows of the difference, over the mean. `kept`: its
/// chambers in the whole.
///
/// # Errors
/// If a gas cannot be modelled.
pub fn modelling_errors(
    [whole, part]: [Sight<'_>; 2],
    kept: &[usize],
    vents: &[usize],
) -> Result<Vec<Modelled>, PlanError> {
    let solved = |(scene, measured, outlook): Sight<'_>| -> Result<Vec<Vec<f64>>, PlanError> {
        let species = species(scene, measured, &mut Vec::new())?;
        let amounts = Amounts::of(scene, &species, measured)?;
        Ok(pressures(scene, measured, outlook, &species, &amounts))
    };
    let mut wider = part.0.clone();
    for &vent in vents {
        let area = wider.vents[vent].area.unwrap_or(part.1.vents[vent].area);
        wider.vents[vent].area = Some(area * (1.0 + DISCHARGE_UNKNOWN));
    }
    let (whole, wider, part) = (solved(whole)?, solved((&wider, part.1, part.2))?, solved(part)?);
    let rows = part.len().max(1) as f64;
    let difference = |[a, b]: [&[Vec<f64>]; 2], [i, k]: [usize; 2]| {
        let mean = a.iter().map(|row| row[i]).sum::<f64>() / rows;
        let squares = a.iter().zip(b).map(|(a, b)| (a[i] - b[k]).powi(2));
        let error = (squares.sum::<f64>() / rows).sqrt() / mean;
        // Less is rounding.
        if error <= 1e-9 { 0.0 } else { error }
    };
    let of_chamber = |(own, &chamber): (usize, &usize)| Modelled {
        left_out: difference([&whole, &part], [chamber, own]),
        coefficients: difference([&part, &wider], [own, own]),
    };
    Ok(kept.iter().enumerate().map(of_chamber).collect())
}

/// Particles with which the Knudsen number of a hole is that of the table of limits: lambda ~ d ~ N^(-1/3) at a fixed
/// occupancy.
fn resolving(method: Method, particles: f64, knudsen: f64) -> Option<f64> {
    let wanted = limit(Quantity::Knudsen, method)?.bound.value();
    Some(particles * (knudsen / wanted).powi(3))
}
