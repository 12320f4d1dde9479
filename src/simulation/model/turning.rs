//! Fabric that turns as a whole about an axis at rest (`[fabric.turn]`).
//!
//! A node p at the distance r from the axis is at time t, with the angle a(t) and the unit axis n through c, at
//!
//! ```text
//! c + (p - c)_n + cos a (p - c)_r + sin a n x (p - c)
//! ```
//!
//! where (p - c)_n is its part along the axis and (p - c)_r the rest (Rodrigues 1840). Places at the start and the end of each step are exact;
//! within a step a node flies along the chord.

use glam::DVec3;

use crate::gas::{bends, displacement, turns};
use crate::scene::{Course, Turn};
use std::f64::consts::{PI, TAU};

/// Where nodes are at a time, s, that are at these places at the start, m.
pub fn turned(turn: &Turn, nodes: &[[f64; 3]], time: f64) -> Vec<[f64; 3]> {
    let angle = displacement(&turn.course, time);
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    let at = |&node: &[f64; 3]| {
        let Circle { center, arm, ahead } = Circle::of(turn, node);
        (center + cosine * arm + sine * ahead).to_array()
    };
    nodes.iter().map(at).collect()
}

/// The speed of the fastest node in a run, m/s.
pub fn fastest(turn: &Turn, nodes: &[[f64; 3]]) -> f64 {
    let speed = match &turn.course {
        Course::Velocity(curve) => curve.points.iter().map(|[_, velocity]| velocity.abs()).fold(0.0, f64::max),
        Course::Displacement(curve) => {
            let slope = |pair: &[[f64; 2]]| ((pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0])).abs();
            curve.points.windows(2).map(slope).fold(0.0, f64::max)
        }
    };
    speed * nodes.iter().map(|&node| Circle::of(turn, node).arm.length()).fold(0.0, f64::max)
}

/// Times at which the velocities of its nodes bend, s; one at least, since they do not rest.
pub fn bends_of(turn: &Turn) -> Vec<f64> {
    bends(&turn.course).chain([0.0]).collect()
}

/// The corners of what nodes sweep in a run that ends at a time, s, m.
pub fn swept(turn: &Turn, nodes: &[[f64; 3]], end: f64) -> [DVec3; 2] {
    let times = turns(&turn.course).into_iter().filter(|&time| time > 0.0 && time < end).chain([0.0, end]);
    let angles = || times.clone().map(|time| displacement(&turn.course, time));
    let (least, most) = (angles().fold(f64::INFINITY, f64::min), angles().fold(f64::NEG_INFINITY, f64::max));
    nodes.iter().fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], &node| {
        let circle = Circle::of(turn, node);
        let along = |axis: usize| circle.range(axis, [least, most]);
        let [x, y, z] = [along(0), along(1), along(2)];
        [low.min(DVec3::new(x[0], y[0], z[0])), high.max(DVec3::new(x[1], y[1], z[1]))]
    })
}

/// The circle of a node: at the angle a it is at center + cos a arm + sin a ahead.
struct Circle {
    center: DVec3,
    arm: DVec3,
    ahead: DVec3,
}

impl Circle {
    fn of(turn: &Turn, node: [f64; 3]) -> Circle {
        let (axis, center) = (DVec3::from(turn.axis), DVec3::from(turn.center));
        let from = DVec3::from(node) - center;
        let along = axis * axis.dot(from);
        Circle { center: center + along, arm: from - along, ahead: axis.cross(from) }
    }

    /// The least and the largest coordinate between two angles.
    fn range(&self, axis: usize, [least, most]: [f64; 2]) -> [f64; 2] {
        let (middle, arm, ahead) = (self.center[axis], self.arm[axis], self.ahead[axis]);
        let at = |angle: f64| middle + libm::cos(angle) * arm + libm::sin(angle) * ahead;
        let (size, phase) = (libm::hypot(arm, ahead), libm::atan2(ahead, arm));
        // Whether the angle of an extreme, or that and some turns, lies between both.
        let passes = |extreme: f64| extreme + TAU * libm::ceil((least - extreme) / TAU) <= most;
        let (low, high) = (at(least).min(at(most)), at(least).max(at(most)));
        [if passes(phase + PI) { middle - size } else { low }, if passes(phase) { middle + size } else { high }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Curve;

    fn turn(points: &[[f64; 2]]) -> Turn {
        let axis = DVec3::new(1.0, 2.0, 2.0) / 3.0;
        let course = Course::Displacement(Curve { points: points.to_vec() });
        Turn { axis: axis.to_array(), center: [0.3, -0.2, 0.1], course }
    }

    const NODES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.3, 0.4, 0.1], [-0.2, -0.3, 0.7]];

    /// A third of a turn about the diagonal swaps axes; distances from the axis, and along it, stay.
    #[test]
    fn nodes_go_in_circles() {
        let axis = DVec3::ONE.normalize().to_array();
        let third = Turn { axis, center: [0.0; 3], course: Course::Velocity(Curve { points: vec![[0.0, TAU / 3.0]] }) };
        let there = turned(&third, &[[1.0, 0.0, 0.0]], 1.0)[0];
        assert!((DVec3::from(there) - DVec3::Y).length() < 1e-15, "{there:?}");
        assert!((fastest(&third, &[[1.0, 0.0, 0.0]]) - TAU / 3.0 * (2.0f64 / 3.0).sqrt()).abs() < 1e-14);
        let law = turn(&[[0.0, 0.0], [1.0, 5.0]]);
        for (before, after) in NODES.iter().zip(turned(&law, &NODES, 0.7)) {
            let [before, after] = [*before, after].map(|node| DVec3::from(node) - DVec3::from(law.center));
            assert!((before.length() - after.length()).abs() < 1e-14);
            assert!((before - after).dot(DVec3::from(law.axis)).abs() < 1e-14);
        }
    }

    /// The box is that of many moments, for a part of a turn, to and fro, and many turns.
    #[test]
    fn boxes_hold_what_is_swept_and_no_more() {
        for points in [
            &[[0.0, 0.0], [1.0, 0.3]][..],
            &[[0.0, 0.0], [0.4, 1.9], [1.0, -0.8]],
            &[[0.0, 0.0], [0.5, -4.0], [1.0, -3.0]],
            &[[0.0, 0.0], [1.0, 40.0]],
        ] {
            let law = turn(points);
            let [low, high] = swept(&law, &NODES, 1.0);
            let moments = (0..=20_000).flat_map(|k| turned(&law, &NODES, f64::from(k) / 20_000.0));
            let far = [DVec3::INFINITY, DVec3::NEG_INFINITY];
            let found = moments.map(DVec3::from).fold(far, |[low, high], node| [low.min(node), high.max(node)]);
            assert!(low.cmple(found[0] + 1e-12).all() && high.cmpge(found[1] - 1e-12).all(), "{points:?}");
            assert!(
                (found[0] - low).length() < 1e-5 && (high - found[1]).length() < 1e-5,
                "{points:?} {found:?} {low} {high}"
            );
        }
    }
}
