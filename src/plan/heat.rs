//! The gases as they are modelled: heat capacities that depend on the temperature become partition functions.

use super::amounts::highest_temperature;
use super::text::significant;
use super::{Measured, PlanError, Reason};
use crate::gas::{Species, fit};
use crate::scene::{HeatCapacity, Scene};

/// A curve that no gas can have within this is refused (docs/explanation/method.md, "Heat capacities").
const LARGEST_RESIDUAL: f64 = 0.01;
/// Beyond the coldest and the hottest that the scene names: gas that expands, and what is noise.
const COLDER: f64 = 0.8;
const EXPANDING: f64 = 0.6;
/// Ratio of two chambers' pressures below which they count as equal.
const EQUAL: f64 = 1.01;
const HOTTER: f64 = 1.1;

/// K, over which heat capacities count.
fn range(scene: &Scene, measured: &Measured) -> [f64; 2] {
    let chambers = scene.chambers.iter().map(|chamber| chamber.temperature);
    let orifices = scene.orifices.iter().flat_map(|orifice| orifice.temperature.points.iter().map(|point| point[1]));
    let walls = scene.heated_surfaces().map(|(_, heat)| heat.temperature);
    let coldest = chambers.chain(orifices).chain(walls).fold(f64::INFINITY, f64::min);
    // What is left behind a vent, behind a wall that recedes, or in a chamber that empties into another, expands as no other gas does.
    let pressures = || scene.chambers.iter().map(|chamber| chamber.pressure);
    let empties = pressures().fold(0.0, f64::max) > EQUAL * pressures().fold(f64::INFINITY, f64::min);
    let expands = empties || !scene.vents.is_empty() || !scene.motions.is_empty();
    let colder = if expands { EXPANDING } else { COLDER };
    [colder * coldest, HOTTER * highest_temperature(scene, measured).0]
}

/// Of each gas of the scene.
pub fn species(scene: &Scene, measured: &Measured, reasons: &mut Vec<Reason>) -> Result<Vec<Species>, PlanError> {
    let range = range(scene, measured);
    let one = |gas: &crate::scene::Gas| match gas.heat {
        HeatCapacity::Constant(cv) => Ok(Species::constant(gas.molar_mass, cv)),
        HeatCapacity::Curve(cp) => {
            let [low, high] = range.map(significant);
            let name = gas.name.clone();
            let Some(modes) = fit(cp, range) else {
                let least = range.map(|t| gas.heat.molar_cv(t)).into_iter().fold(f64::INFINITY, f64::min);
                return Err(PlanError::HeatCapacityLow { gas: name, range, least });
            };
            if modes.residual > LARGEST_RESIDUAL {
                let residual = 100.0 * modes.residual;
                let limit = 100.0 * LARGEST_RESIDUAL;
                return Err(PlanError::HeatCapacity { gas: name, range, residual, limit });
            }
            reasons.push(Reason {
                quantity: format!("cp(T) of {name}"),
                value: format!("{} modes", modes.modes.len()),
                why: format!(
                    "partition function within {} % of the curve's heat capacity from {low} to {high} K",
                    significant(100.0 * modes.residual)
                ),
            });
            Ok(Species::with_modes(gas.molar_mass, modes))
        }
    };
    scene.gases.iter().map(one).collect()
}
