//! How near two mid-step points must be for their particles to meet within a step.

use crate::plan::Plan;
use crate::scene::Method;

/// A cell's edge in the units of packed positions (`shaders/shared/grid.wgsl`), squared.
const EDGE2: f64 = 128.0 * 128.0;
/// Two points at a distance d, in these units, are less than d + sqrt(3) apart once packed: for d up to an edge
/// (d + sqrt(3))^2 < d^2 + 447.
const PACKING2: u32 = 447;

/// The square of the largest diameter, in packed units, rounded down.
pub(super) fn diameter2(plan: &Plan) -> f64 {
    (EDGE2 * (plan.diameter / plan.grid.cell).powi(2)).floor()
}

/// The square of the distance, in packed units, below which particles of the largest diameter may meet in a step. In the
/// longest that the speeds allow that is a cell's edge, of which the fastest pairs fly what it has beyond the diameter
/// (specification, section 2); where density asks for `halvings` of the step, they fly less.
pub(super) fn near2(plan: &Plan, halvings: u32) -> u32 {
    edges2(plan.method, plan.diameter / plan.grid.cell, halvings)
}

fn edges2(method: Method, diameter: f64, halvings: u32) -> u32 {
    let shorter = 0.5f64.powi(halvings.min(64) as i32);
    let edges2 = match method {
        // Spheres touch on the way, not at the closest approach.
        Method::HardSphere => (diameter + (1.0 - diameter) * shorter).powi(2),
        _ => diameter * diameter + (1.0 - diameter * diameter) * shorter * shorter,
    };
    (EDGE2 * edges2).ceil() as u32 + PACKING2
}

#[cfg(test)]
mod tests {
    use super::*;

    /// sigma^2 + (g dt/2)^2, sigma + g dt/2 of rigid spheres; never less than the diameter, never more than an edge.
    #[test]
    fn a_step_cut_for_density_reaches_less() {
        for method in [Method::ClosestApproach, Method::HardSphere] {
            assert_eq!(edges2(method, 0.8, 0), 16384 + PACKING2);
            let least = (EDGE2 * 0.64f64).ceil() as u32 + PACKING2;
            assert!((least..=least + 1).contains(&edges2(method, 0.8, 60)), "{method:?}");
        }
        assert_eq!(edges2(Method::ClosestApproach, 0.8, 1), (EDGE2 * (0.64f64 + 0.09)).ceil() as u32 + PACKING2);
        assert_eq!(edges2(Method::HardSphere, 0.8, 1), (EDGE2 * 0.9f64 * 0.9).ceil() as u32 + PACKING2);
        let packed = |d: f64| (128.0 * d + 3f64.sqrt()).powi(2);
        assert!((1..=100).all(|k| packed(0.01 * f64::from(k)) < EDGE2 * (0.01 * f64::from(k)).powi(2) + 447.0));
    }
}
