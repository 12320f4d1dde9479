//! Motions: which wall moves, along what, and how far.

use std::ops::Range;

use super::errors::Problem;
use super::flows::curve;
use super::names::Names;
use super::numbers::{bounded, direction, show};
use super::raw::{RawMotion, RawScene, RawSide};
use super::raw_values::{At, NumberOr, Numbers};
use super::types::{Course, Curve, Motion, UnitSystem};
use super::units::Quantity;

/// Walls that move, at most: the device knows the places of so many.
pub const MOST_MOTIONS: usize = 4;

/// The motion of this number in the file.
pub(super) fn motion(scene: &RawScene, index: usize, walls: &Names, units: UnitSystem) -> Result<Motion, Problem> {
    let raw = &scene.motion[index];
    let motion = &raw.value;
    let name = &motion.wall;
    let wall = walls.find(name)?;
    if scene.motion[..index].iter().any(|other| other.value.wall.value == name.value) {
        return Err(Problem::value(&name.span, "a second motion of the same wall", "one motion for each wall"));
    }
    if matches!(scene.wall[wall].value.gas.as_ref().map(|side| side.value), Some(RawSide::Inside)) {
        let found = format!("the wall {:?}, which encloses the gas", name.value);
        return Err(Problem::value(&name.span, found, "a body with the gas outside of it").hint(
            "give the vessel as a wall at rest, and the piston as a body of its own that reaches into its walls",
        ));
    }
    if scene.vent.iter().filter_map(|vent| vent.value.wall.as_ref()).any(|wall| wall.value == name.value) {
        let found = format!("the wall {:?}, which has a vent", name.value);
        return Err(Problem::value(&name.span, found, "a wall without vents, or the vent on a wall at rest"));
    }
    Ok(Motion { wall, direction: direction(&motion.direction)?, course: course(raw, units)? })
}

fn course(raw: &At<RawMotion>, units: UnitSystem) -> Result<Course, Problem> {
    law::<StraightLaw>(&raw.span, (&raw.value.velocity, &raw.value.displacement), units)
}

/// What is said of a law of motion, and its quantities.
pub(super) trait Law {
    const KEYS: &'static str;
    /// The key that is missed if there is none.
    const FIRST_KEY: &'static str;
    const POINTS_OF_VELOCITY: &'static str;
    const POINTS_OF_PATH: &'static str;
    const HINT: &'static str;
    const VELOCITY: Quantity;
    const PATH: Quantity;
}

/// Along a line.
struct StraightLaw;

impl Law for StraightLaw {
    const KEYS: &'static str = "exactly one of `velocity`, `displacement`";
    const FIRST_KEY: &'static str = "velocity";
    const POINTS_OF_VELOCITY: &'static str = "a number, or at least one point [time, velocity]";
    const POINTS_OF_PATH: &'static str = "points [time, distance], the first of them [0, 0]";
    const HINT: &'static str = "the wall is drawn where it is at the start";
    const VELOCITY: Quantity = Quantity::Velocity;
    const PATH: Quantity = Quantity::Length;
}

/// About an axis.
pub(super) struct AngularLaw;

impl Law for AngularLaw {
    const KEYS: &'static str = "exactly one of `angular_velocity`, `angle`";
    const FIRST_KEY: &'static str = "angular_velocity";
    const POINTS_OF_VELOCITY: &'static str = "a number, or at least one point [time, angular velocity]";
    const POINTS_OF_PATH: &'static str = "points [time, angle], the first of them [0, 0]";
    const HINT: &'static str = "the fabric is drawn where it is at the start";
    const VELOCITY: Quantity = Quantity::AngularVelocity;
    const PATH: Quantity = Quantity::Pure;
}

type VelocityKey = Option<At<NumberOr<Numbers<2>>>>;
type PathKey = Option<At<Vec<At<Numbers<2>>>>>;

/// The law that one of two keys gives; `span` is that of their table.
pub(super) fn law<L: Law>(
    span: &Range<usize>,
    (velocity, path): (&VelocityKey, &PathKey),
    units: UnitSystem,
) -> Result<Course, Problem> {
    let any = |at: &At<f64>, quantity| bounded(at, quantity, units, "a finite number", f64::is_finite);
    match (velocity, path) {
        (Some(at), None) => Ok(Course::Velocity(match &at.value {
            NumberOr::Number(value) => {
                let number = At { value: *value, span: at.span.clone() };
                Curve { points: vec![[0.0, any(&number, L::VELOCITY)?]] }
            }
            NumberOr::Array(points) if points.is_empty() => {
                return Err(Problem::value(&at.span, "an empty curve", L::POINTS_OF_VELOCITY));
            }
            NumberOr::Array(points) => curve(points, Quantity::Time, units, |value| any(value, L::VELOCITY))?,
        })),
        (None, Some(at)) => {
            let Some(first) = at.value.first() else {
                return Err(Problem::value(&at.span, "an empty curve", L::POINTS_OF_PATH));
            };
            let path = curve(&at.value, Quantity::Time, units, |value| any(value, L::PATH))?;
            if path.points[0] != [0.0, 0.0] {
                let [time, distance] = &first.value.0;
                let found = format!("a first point [{}, {}]", show(time.value), show(distance.value));
                return Err(Problem::value(&first.span, found, L::POINTS_OF_PATH).hint(L::HINT));
            }
            Ok(Course::Displacement(path))
        }
        (None, None) => Err(Problem::missing(span, L::FIRST_KEY, L::KEYS)),
        (Some(one), Some(other)) => {
            let last = if one.span.start > other.span.start { &one.span } else { &other.span };
            Err(Problem::value(last, "a second law of the motion", L::KEYS))
        }
    }
}
