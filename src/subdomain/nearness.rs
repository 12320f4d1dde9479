//! How near two mid-step points must be for their particles to meet within a step.

use crate::plan::Plan;
use crate::scene::Method;

/// A cell's edge in the units of packed positions (`shaders/shared/grid.wgsl`).
const EDGE: f64 = 128.0;

/// The square of the largest diameter, in packed units, rounded down.
pub(super) fn diameter2(plan: &Plan) -> f64 {
    (EDGE * plan.diameter / plan.grid.cell).powi(2).floor()
}

/// The square of the relative speed, (m/s)^2, with which a pair that meets in the longest step comes from as far as a
/// cell's edge: what the plan takes for the fastest.
pub(super) fn fastest2(plan: &Plan) -> f64 {
    let edges = flown(plan.method, plan.diameter / plan.grid.cell);
    (2.0 * edges * plan.grid.cell / plan.time_step).powi(2)
}

/// What the fastest pairs fly in half the longest step, in edges; `diameter` too.
fn flown(method: Method, diameter: f64) -> f64 {
    match method {
        // Spheres touch on the way, not at the closest approach.
        Method::HardSphere => 1.0 - diameter,
        _ => (1.0 - diameter * diameter).max(0.0).sqrt(),
    }
}

/// The square of the distance, in packed units, below which particles of the largest diameter may meet in a step. In the
/// longest that is a cell's edge, of which the fastest pairs fly what it has beyond the diameter (method.md,
/// "What the plan decides, and why"). In a step of so many `halvings` they fly less.
pub(super) fn near2(plan: &Plan, halvings: u32) -> u32 {
    packed2(plan.method, plan.diameter / plan.grid.cell, halvings)
}

/// `diameter` in cells' edges.
fn packed2(method: Method, diameter: f64, halvings: u32) -> u32 {
    let flown = flown(method, diameter) * 0.5f64.powi(halvings.min(64) as i32);
    let edges = match method {
        Method::HardSphere => diameter + flown,
        _ => (diameter * diameter + flown * flown).sqrt(),
    };
    // Points as far apart are less than a unit an axis farther once packed.
    (EDGE * edges + 3f64.sqrt()).powi(2).ceil() as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// sigma^2 + (g dt/2)^2, of rigid spheres sigma + g dt/2, and packing: never less than the diameter, never more than
    /// an edge.
    #[test]
    fn a_step_cut_for_density_reaches_less() {
        let packed = |edges: f64| (EDGE * edges + 3f64.sqrt()).powi(2).ceil() as u32;
        for method in [Method::ClosestApproach, Method::HardSphere] {
            assert_eq!(packed2(method, 0.8, 0), 16_831);
            assert!((packed(0.8)..=packed(0.8) + 1).contains(&packed2(method, 0.8, 60)), "{method:?}");
        }
        assert_eq!(packed2(Method::ClosestApproach, 0.8, 1), packed((0.64f64 + 0.09).sqrt()));
        assert_eq!(packed2(Method::HardSphere, 0.8, 1), packed(0.9));
    }
}
