//! Motions: which wall moves, along what, and how far.

use super::errors::Problem;
use super::flows::curve;
use super::names::Names;
use super::numbers::{bounded, direction, show};
use super::raw::{RawMotion, RawScene, RawSide};
use super::raw_values::{At, NumberOr};
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
    let keys = "exactly one of `velocity`, `displacement`";
    let any = |at: &At<f64>, quantity| bounded(at, quantity, units, "a finite number", f64::is_finite);
    match (&raw.value.velocity, &raw.value.displacement) {
        (Some(at), None) => Ok(Course::Velocity(match &at.value {
            NumberOr::Number(value) => {
                let number = At { value: *value, span: at.span.clone() };
                Curve { points: vec![[0.0, any(&number, Quantity::Velocity)?]] }
            }
            NumberOr::Array(points) if points.is_empty() => {
                return Err(Problem::value(
                    &at.span,
                    "an empty curve",
                    "a number, or at least one point [time, velocity]",
                ));
            }
            NumberOr::Array(points) => curve(points, Quantity::Time, units, |value| any(value, Quantity::Velocity))?,
        })),
        (None, Some(at)) => {
            let allowed = "points [time, distance], the first of them [0, 0]";
            let Some(first) = at.value.first() else {
                return Err(Problem::value(&at.span, "an empty curve", allowed));
            };
            let path = curve(&at.value, Quantity::Time, units, |value| any(value, Quantity::Length))?;
            if path.points[0] != [0.0, 0.0] {
                let [time, distance] = &first.value.0;
                let found = format!("a first point [{}, {}]", show(time.value), show(distance.value));
                return Err(
                    Problem::value(&first.span, found, allowed).hint("the wall is drawn where it is at the start")
                );
            }
            Ok(Course::Displacement(path))
        }
        (None, None) => Err(Problem::missing(&raw.span, "velocity", keys)),
        (Some(one), Some(other)) => {
            let last = if one.span.start > other.span.start { &one.span } else { &other.span };
            Err(Problem::value(last, "a second law of the motion", keys))
        }
    }
}
