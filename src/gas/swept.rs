//! How much room the gas has while walls move: the volumes of zones against how far a wall has moved.
//!
//! A wall that moves takes from a zone what it sweeps of it. Measured at some displacements and linear between them:
//! exact for a piston, whose cross-section does not change. Of several walls the changes add up, as long as the walls
//! do not meet.

use super::curve::{displacement, velocity};
use crate::scene::Course;

/// What one wall does to the volumes of all zones.
#[derive(Debug, Clone, PartialEq)]
pub struct Swept {
    pub course: Course,
    /// Displacements, m, in order; at least two.
    pub at: Vec<f64>,
    /// By displacement, then zone: the volume less that of the wall at the start, m3.
    pub change: Vec<Vec<f64>>,
}

impl Swept {
    /// The change of a zone's volume since the start, m3, and of that with the displacement, m2.
    fn slope(&self, zone: usize, moved: f64) -> (f64, f64) {
        let last = self.at.len() - 1;
        let after = self.at.partition_point(|&at| at <= moved).clamp(1, last);
        let [x0, x1] = [self.at[after - 1], self.at[after]];
        let [v0, v1] = [self.change[after - 1][zone], self.change[after][zone]];
        let slope = (v1 - v0) / (x1 - x0);
        (v0 + slope * (moved - x0), slope)
    }

    /// m3.
    pub fn change(&self, zone: usize, time: f64) -> f64 {
        self.slope(zone, displacement(&self.course, time)).0
    }

    /// m3/s.
    pub fn rate(&self, zone: usize, time: f64) -> f64 {
        self.slope(zone, displacement(&self.course, time)).1 * velocity(&self.course, time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Curve;

    #[test]
    fn a_volume_follows_its_wall() {
        let course = Course::Velocity(Curve { points: vec![[0.0, 2.0]] });
        let swept = Swept { course, at: vec![0.0, 1.0, 3.0], change: vec![vec![0.0], vec![-0.5], vec![-0.9]] };
        assert!((swept.change(0, 0.25) + 0.25).abs() < 1e-15 && (swept.change(0, 1.0) + 0.7).abs() < 1e-15);
        assert!((swept.rate(0, 0.25) + 1.0).abs() < 1e-15 && (swept.rate(0, 1.0) + 0.4).abs() < 1e-15);
    }
}
