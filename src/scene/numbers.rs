//! Numbers of the scene file, checked and converted to SI.
//!
//! A number is finite, and in SI zero or of magnitude 1e-30 to 1e30, so that products of a few of them
//! neither overflow nor vanish.

use std::ops::{Range, RangeInclusive};

use super::errors::Problem;
use super::raw_values::{At, Numbers};
use super::types::UnitSystem;
use super::units::Quantity;

const SMALLEST: f64 = 1e-30;
const LARGEST: f64 = 1e30;

/// As short as exact.
pub(super) fn show(number: f64) -> String {
    if number.fract() == 0.0 && number.abs() < 1e15 { format!("{number}") } else { format!("{number:?}") }
}

/// "a positive number (mm)".
pub(super) fn described(description: &str, quantity: Quantity, units: UnitSystem) -> String {
    match units.symbol(quantity) {
        "" => description.to_string(),
        symbol => format!("{description} ({symbol})"),
    }
}

fn converted(value: f64, span: &Range<usize>, quantity: Quantity, units: UnitSystem) -> Result<f64, Problem> {
    let si = value * units.factor(quantity);
    if si.is_finite() && (value == 0.0 || (SMALLEST..=LARGEST).contains(&si.abs())) {
        return Ok(si);
    }
    let allowed = described("a finite number", quantity, units);
    let problem = Problem::value(span, show(value), allowed);
    Err(if value.is_finite() { problem.hint("in SI its magnitude must lie between 1e-30 and 1e30") } else { problem })
}

pub(super) fn number(at: &At<f64>, quantity: Quantity, units: UnitSystem) -> Result<f64, Problem> {
    converted(at.value, &at.span, quantity, units)
}

pub(super) fn positive(at: &At<f64>, quantity: Quantity, units: UnitSystem) -> Result<f64, Problem> {
    bounded(at, quantity, units, "a positive number", |si| si > 0.0)
}

pub(super) fn not_negative(at: &At<f64>, quantity: Quantity, units: UnitSystem) -> Result<f64, Problem> {
    bounded(at, quantity, units, "a number not below 0", |si| si >= 0.0)
}

/// A number that passes `test`, which `description` puts in words.
pub(super) fn bounded(
    at: &At<f64>,
    quantity: Quantity,
    units: UnitSystem,
    description: &str,
    test: impl Fn(f64) -> bool,
) -> Result<f64, Problem> {
    let refused = || Problem::value(&at.span, show(at.value), described(description, quantity, units));
    if !at.value.is_finite() {
        return Err(refused());
    }
    let si = number(at, quantity, units)?;
    if test(si) { Ok(si) } else { Err(refused()) }
}

/// A whole number within `allowed`, both ends included.
pub(super) fn count(at: &At<i64>, allowed: RangeInclusive<i64>) -> Result<u64, Problem> {
    match u64::try_from(at.value) {
        Ok(value) if allowed.contains(&at.value) => Ok(value),
        _ => Err(Problem::value(
            &at.span,
            at.value.to_string(),
            format!("a whole number from {} to {}", allowed.start(), allowed.end()),
        )),
    }
}

/// As [`count`], for limits that fit 32 bits.
pub(super) fn small_count(at: &At<i64>, allowed: RangeInclusive<i64>) -> Result<u32, Problem> {
    let value = count(at, allowed)?;
    u32::try_from(value)
        .map_err(|_| Problem::value(&at.span, value.to_string(), format!("a whole number up to {}", u32::MAX)))
}

/// Coordinates or lengths, m.
pub(super) fn point<const N: usize>(at: &At<Numbers<N>>, units: UnitSystem) -> Result<[f64; N], Problem> {
    let mut si = [0.0; N];
    for (value, number_at) in si.iter_mut().zip(&at.value.0) {
        *value = number(number_at, Quantity::Length, units)?;
    }
    Ok(si)
}

/// Two positive lengths, m.
pub(super) fn sides(at: &At<Numbers<2>>, units: UnitSystem) -> Result<[f64; 2], Problem> {
    let [a, b] = &at.value.0;
    Ok([positive(a, Quantity::Length, units)?, positive(b, Quantity::Length, units)?])
}

/// The corners of a box, m: every coordinate of `max` above that of `min`.
pub(super) fn corners(
    min_at: &At<Numbers<3>>,
    max_at: &At<Numbers<3>>,
    units: UnitSystem,
) -> Result<([f64; 3], [f64; 3]), Problem> {
    let (min, max) = (point(min_at, units)?, point(max_at, units)?);
    for axis in 0..3 {
        if max[axis] <= min[axis] {
            let (low, high) = (&min_at.value.0[axis], &max_at.value.0[axis]);
            let allowed = format!("more than the {} of `min`", show(low.value));
            return Err(Problem::value(&high.span, show(high.value), described(&allowed, Quantity::Length, units)));
        }
    }
    Ok((min, max))
}

/// A direction, scaled to unit length.
pub(super) fn direction(at: &At<Numbers<3>>) -> Result<[f64; 3], Problem> {
    let mut vector = [0.0; 3];
    for (value, number_at) in vector.iter_mut().zip(&at.value.0) {
        *value = number(number_at, Quantity::Pure, UnitSystem::Si)?;
    }
    if vector == [0.0; 3] {
        return Err(Problem::value(&at.span, "a vector of length 0", "a vector with a direction"));
    }
    Ok(normalised(vector))
}

/// Leaves a vector alone that already has unit length to rounding, so that a resolved scene reads back
/// as it was.
pub(super) fn normalised(vector: [f64; 3]) -> [f64; 3] {
    let length = vector.iter().map(|c| c * c).sum::<f64>().sqrt();
    if (length - 1.0).abs() <= 4.0 * f64::EPSILON { vector } else { vector.map(|c| c / length) }
}
