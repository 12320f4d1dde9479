//! Where points are.

use crate::geometry::Vessel;
use crate::scene::Scene;

/// The chamber that a point of the gas belongs to.
pub fn chamber_of(scene: &Scene, vessel: &Vessel, point: [f64; 3]) -> Option<usize> {
    let holds = |chamber: &crate::scene::Chamber| vessel.is_of(chamber, point);
    if vessel.is_gas(point) { scene.chambers.iter().position(holds) } else { None }
}

pub fn along(point: [f64; 3], direction: [f64; 3], distance: f64) -> [f64; 3] {
    std::array::from_fn(|axis| point[axis] + direction[axis] * distance)
}
