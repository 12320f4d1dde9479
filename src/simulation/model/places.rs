//! Where points are.

use crate::geometry::{Vessel, region_contains};
use crate::scene::Scene;

/// The chamber that a point of the gas belongs to.
pub fn chamber_of(scene: &Scene, vessel: &Vessel, point: [f64; 3]) -> Option<usize> {
    let holds = |chamber: &crate::scene::Chamber| chamber.region.as_ref().is_none_or(|r| region_contains(r, point));
    if vessel.is_gas(point) { scene.chambers.iter().position(holds) } else { None }
}

pub fn along(point: [f64; 3], direction: [f64; 3], distance: f64) -> [f64; 3] {
    std::array::from_fn(|axis| point[axis] + direction[axis] * distance)
}
