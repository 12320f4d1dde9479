//! Where the methods fail: along axes such as the time step or the Knudsen number of a hole, which quantity leaves its
//! allowance first, and by how much.
//!
//! An [`Axis`] has a run for each of its values and each method; a run gives [`Check`]s as the reference cases do
//! ([`verify`](super::verify)), of quantities that a law knows: energy, pressure, equipartition, collision rate, lost
//! collisions, tightness of the walls, flow, density profile. Allowances are fixed beforehand. Another axis is another
//! entry of [`AXES`].

mod at_rest;
mod axes;
mod effort;
mod flows;
mod half_turn;
pub mod report;

use crate::gpu::Device;
use crate::plan::Bound;
use crate::scene::Method;
use crate::simulation::SimulationError;
use crate::study::StudyError;
use crate::study::verify::Check;

pub use axes::AXES;
pub use effort::Effort;
pub(crate) use effort::ROUNDS;

/// Standard errors by which a quantity must be beyond its allowance to be broken, and within which one must know it.
const SURE: f64 = 2.0;

/// A run of a method with a value of the axis.
type Runner = fn(&Device, Method, f64, Effort) -> Result<Vec<Check>, StudyError>;

/// What is varied, and what a run with a value of it shows.
pub struct Axis {
    pub name: &'static str,
    pub what: &'static str,
    /// The scene of the runs.
    pub runs: &'static str,
    pub methods: &'static [Method],
    /// From safe to risky.
    quick: &'static [f64],
    usual: &'static [f64],
    full: &'static [f64],
    /// That which guards runs.
    limit: fn(Method) -> Option<Bound>,
    run: Runner,
}

impl Axis {
    pub fn values(&self, effort: Effort) -> &'static [f64] {
        match effort {
            Effort::Quick => self.quick,
            Effort::Usual => self.usual,
            Effort::Full => self.full,
        }
    }

    pub fn limit(&self, method: Method) -> Option<Bound> {
        (self.limit)(method)
    }

    /// # Errors
    /// If a run fails but for what the method is to blame for.
    pub fn run(&self, device: &Device, method: Method, value: f64, effort: Effort) -> Result<Point, StudyError> {
        let checks = match (self.run)(device, method, value, effort) {
            // A run that its own checks stop: what it knows is no number.
            Err(StudyError::Simulation(error @ (SimulationError::Lost { .. } | SimulationError::Ladder { .. }))) => {
                vec![Check::of(format!("run stopped, {error}"), 0.0, (f64::NAN, 0.0), 1.0)]
            }
            done => done?,
        };
        Ok(Point { method, value, checks })
    }
}

/// What came of a run.
pub struct Point {
    pub method: Method,
    pub value: f64,
    pub checks: Vec<Check>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    Holds,
    Broken,
    /// The run knows too little.
    Unclear,
}

impl State {
    pub fn of(check: &Check) -> State {
        let off = (check.measured - check.reference).abs();
        if off.is_nan() || check.error.is_nan() || off > check.tolerance + SURE * check.error {
            State::Broken
        } else if SURE * check.error <= check.tolerance {
            State::Holds
        } else {
            State::Unclear
        }
    }

    pub fn word(self) -> &'static str {
        match self {
            State::Holds => "holds",
            State::Broken => "BROKEN",
            State::Unclear => "unclear",
        }
    }
}

impl Point {
    /// The broken quantity that is farthest beyond its allowance.
    pub fn worst(&self) -> Option<&Check> {
        let times = |check: &Check| {
            let off = (check.measured - check.reference).abs() / check.tolerance;
            if off.is_nan() { f64::INFINITY } else { off }
        };
        let broken = self.checks.iter().filter(|check| State::of(check) == State::Broken);
        broken.max_by(|a, b| times(a).total_cmp(&times(b)))
    }

    pub fn state(&self) -> State {
        let is = |state: State| self.checks.iter().any(|check| State::of(check) == state);
        if is(State::Broken) {
            State::Broken
        } else if is(State::Unclear) {
            State::Unclear
        } else {
            State::Holds
        }
    }
}

/// Of one method along an axis.
pub struct Found<'a> {
    /// The first stretch of values at which all hold: its first and its last one.
    pub held: Option<[f64; 2]>,
    /// The values before the first broken one after it that the runs do not tell of.
    pub unclear: Vec<f64>,
    /// The last broken value before that stretch and the first one after it, with what broke. Without a stretch: the first.
    pub broken: Vec<(f64, &'a Check)>,
}

/// Where a method holds and what breaks on either side, of points in the order of the axis.
pub fn first_broken(points: &[Point], method: Method) -> Found<'_> {
    let own: Vec<(State, &Point)> =
        points.iter().filter(|point| point.method == method).map(|point| (point.state(), point)).collect();
    let start = own.iter().position(|&(state, _)| state == State::Holds).unwrap_or(0);
    let (before, rest) = own.split_at(start);
    let length = rest.iter().take_while(|&&(state, _)| state == State::Holds).count();
    let (stretch, after) = rest.split_at(length);
    let broken = |&&(state, _): &&(State, &Point)| state == State::Broken;
    let first_after = after.iter().position(|point| broken(&point)).unwrap_or(after.len());
    let told = before.iter().rev().find(broken).into_iter().chain(after.get(first_after));
    let known = before.iter().chain(&after[..first_after]);
    Found {
        held: stretch.first().zip(stretch.last()).map(|((_, first), (_, last))| [first.value, last.value]),
        unclear: known.filter(|(state, _)| *state == State::Unclear).map(|(_, point)| point.value).collect(),
        broken: told.filter_map(|(_, point)| point.worst().map(|check| (point.value, check))).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(quantity: &str, measured: f64, error: f64) -> Check {
        Check::of(quantity, 1.0, (measured, error), 0.02)
    }

    /// Broken is what is surely beyond its allowance, or no number; unclear what the run does not know.
    #[test]
    fn noise_breaks_nothing() {
        assert_eq!(State::of(&check("x", 1.019, 0.001)), State::Holds);
        assert_eq!(State::of(&check("x", 1.025, 0.005)), State::Holds);
        assert_eq!(State::of(&check("x", 0.969, 0.005)), State::Broken);
        assert_eq!(State::of(&check("x", 1.03, 0.011)), State::Unclear);
        assert_eq!(State::of(&check("x", f64::NAN, 0.0)), State::Broken);
        assert_eq!(State::of(&check("x", 1.0, f64::NAN)), State::Broken);
    }

    #[test]
    fn the_first_that_breaks_is_found_with_the_worst_of_its_quantities() {
        let point = |method, value, checks| Point { method, value, checks };
        let points = [
            point(Method::Cell, 0.5, vec![check("a", 1.0, 0.0)]),
            point(Method::Cell, 1.0, vec![check("a", 1.0, 0.0), check("b", 1.03, 0.02)]),
            point(Method::None, 1.0, vec![check("a", 1.5, 0.0)]),
            point(Method::Cell, 2.0, vec![check("a", 0.9, 0.0), check("b", 1.3, 0.0)]),
            point(Method::Cell, 3.0, vec![check("a", f64::NAN, 0.0)]),
        ];
        let what = |found: &Found<'_>| -> Vec<(f64, String)> {
            found.broken.iter().map(|(value, check)| (*value, check.quantity.clone())).collect()
        };
        let found = first_broken(&points, Method::Cell);
        assert_eq!(
            (found.held, found.unclear.clone(), what(&found)),
            (Some([0.5, 0.5]), vec![1.0], vec![(2.0, "b".into())]),
            "what is unclear does not hold"
        );
        let none = first_broken(&points, Method::None);
        assert!(none.held.is_none() && what(&none) == [(1.0, "a".into())]);
        assert!(first_broken(&points, Method::HardSphere).broken.is_empty());
        assert_eq!(points[1].state(), State::Unclear);
        assert_eq!(points[4].worst().unwrap().quantity, "a");
        // What holds in the middle alone is told from both sides.
        let middle: Vec<Point> = [1.5, 1.1, 1.03, 1.0, 1.0, 1.2, 1.4]
            .into_iter()
            .enumerate()
            .map(|(k, measured)| {
                point(Method::Cell, k as f64, vec![check("a", measured, if k == 2 { 0.02 } else { 0.0 })])
            })
            .collect();
        let found = first_broken(&middle, Method::Cell);
        assert_eq!((found.held, found.unclear.clone()), (Some([3.0, 4.0]), vec![2.0]));
        assert_eq!(what(&found), [(1.0, "a".into()), (5.0, "a".into())]);
    }

    /// Values run one way, from safe to risky; names are unique; the limits are those of the table.
    #[test]
    fn axes_are_in_order() {
        for (index, axis) in AXES.iter().enumerate() {
            assert!(AXES[index + 1..].iter().all(|other| other.name != axis.name));
            for values in [axis.quick, axis.usual, axis.full] {
                let rising = values[0] < values[1];
                assert!(
                    values.windows(2).all(|pair| (pair[0] < pair[1]) == rising && pair[0] != pair[1]),
                    "{}",
                    axis.name
                );
            }
        }
        assert_eq!(AXES[0].limit(Method::Cell), Some(Bound::AtMost(2.0)));
        assert_eq!(AXES[1].limit(Method::ClosestApproach), Some(Bound::AtLeast(3.0)));
    }
}
