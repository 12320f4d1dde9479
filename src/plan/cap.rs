//! What holds the collision diameter down where gas is denser than in the mean (method.md, "Collisions").

use super::limits::{Quantity, limit};
use super::text::significant;
use super::{PlanError, Reason};
use crate::gas::kinetics;
use crate::scene::{DiameterCap, Method, Scene};

/// sigma = .7 n^(-1/3), f = .18: what is larger buys almost no resolution (docs/explanation/method.md, "Collisions").
const SPACINGS: f64 = 0.7;
/// A diameter larger than the plan's own is kept up to 1.5 times the mean density, where the cap of the plan's own begins:
/// the noise of a block is no dense gas. (Not beyond the occupancy from which on a plan warns.)
const ROOM: f64 = 1.14;

/// The cap in mean spacings of the local gas, if there is one.
///
/// # Errors
/// If one is asked of a method that has none, or is below the diameter at the mean density.
pub fn diameter_cap(
    scene: &Scene,
    method: Method,
    diameter: f64,
    number_density: f64,
    reasons: &mut Vec<Reason>,
) -> Result<Option<f64>, PlanError> {
    let asked = scene.model.diameter_cap;
    if method != Method::ClosestApproach {
        let wanted = matches!(asked, Some(DiameterCap::Spacings(_)));
        return if wanted { Err(PlanError::CapOf { method: method.name() }) } else { Ok(None) };
    }
    let in_spacings = diameter / kinetics::mean_spacing(number_density);
    let (cap, why) = match asked {
        Some(DiameterCap::Off) => return Ok(None),
        Some(DiameterCap::Spacings(asked)) if asked < in_spacings * (1.0 - 1e-9) => {
            return Err(PlanError::CapOfAll { asked, spacings: in_spacings });
        }
        Some(DiameterCap::Spacings(asked)) => (asked, "asked for".to_string()),
        None if stays_uniform(scene) => return Ok(None),
        None => {
            let most = limit(Quantity::Occupancy, method)
                .map_or(f64::INFINITY, |limit| kinetics::diameter(1.0, limit.bound.value()));
            let cap = SPACINGS.max(ROOM * in_spacings).min(most).max(in_spacings);
            (cap, "more costs steps and searches, and buys almost no resolution".into())
        }
    };
    let from = (cap / in_spacings).powi(3);
    let value = format!("{} spacings", significant(cap));
    let why =
        format!("local mean spacings, so less where gas is {from:.1} times as dense as the mean at the end: {why}");
    reasons.push(Reason { quantity: "diameter at most".into(), value, why });
    Ok(Some(cap))
}

/// Nothing in the scene makes gas denser in one place than in another.
fn stays_uniform(scene: &Scene) -> bool {
    let one = scene.chambers.len() == 1 && scene.chambers[0].region.is_none();
    let still = scene.orifices.is_empty() && scene.motions.is_empty();
    one && still && !scene.has_heat()
}
