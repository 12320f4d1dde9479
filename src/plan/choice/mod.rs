//! The plan of a scene that wishes an accuracy or has a budget: of all families of runs ([`families`]) and numbers of
//! particles the cheapest whose forecast error is small enough, or the most accurate that the budget pays for
//! (docs/explanation/method.md, "What the plan decides, and why").
//!
//! Explicit keys of `[model]` are constraints. What comes out is a request with every choice in it: the plan of that
//! request, made as any other's, is the plan of the run.

mod chooser;
mod cost;
mod families;
mod halvings;
mod holes;
mod kept;
mod possible;
mod report;
mod words;

use super::amounts::{Amounts, highest_temperature};
use super::forecast::{Forecaster, Outlook};
use super::heat::species;
use super::resolution::{Extreme, Resolution};
use super::{Measured, PlanError, Quantity};
use crate::gas::kinetics;
use crate::scene::{Method, Scene};
use chooser::{Chooser, range};
use cost::USUAL_RATE;
use families::families;

pub use holes::modelling_errors;
pub use report::Choice;

/// What to run of a scene with a wish.
///
/// # Errors
/// If no plan reaches the accuracy, or even the cheapest is beyond the budget.
pub fn choose(scene: &Scene, measured: &Measured, outlook: &Outlook) -> Result<Choice, PlanError> {
    if measured.motion.is_some() {
        return Err(PlanError::WishOfMotion);
    }
    if scene.model.switch.is_some() {
        return Err(PlanError::WishOfSwitch);
    }
    let mut unused = Vec::new();
    let species = species(scene, measured, &mut unused)?;
    let amounts = Amounts::of(scene, &species, measured)?;
    let forecaster = Forecaster::new(scene, measured, outlook, &species, &amounts);
    let (families, why) = families(scene, measured, &amounts, &forecaster)?;
    let (hottest, _) = highest_temperature(scene, measured);
    let wish = &scene.model.wish;
    let chooser = Chooser {
        scene,
        measured,
        amounts: &amounts,
        forecaster,
        families,
        extreme: Extreme(kinetics::thermal_square(hottest, amounts.lightest(scene))),
        rate: wish.device_rate.unwrap_or(USUAL_RATE),
        range: range(scene, &amounts),
    };
    let chosen = match wish.accuracy {
        Some(accuracy) => chooser.accurate(accuracy, wish)?,
        None => chooser.affordable(wish)?,
    };
    Ok(report::choice(&chooser, chosen, why))
}

#[cfg(test)]
mod tests;
