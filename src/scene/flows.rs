//! Orifices: curves against time, and jets.

use super::errors::Problem;
use super::gases::mixture;
use super::names::Names;
use super::numbers::{bounded, direction, not_negative, point, positive, show};
use super::raw::{RawJet, RawOrifice};
use super::raw_values::{At, NumberOr, Numbers};
use super::types::{Curve, Jet, JetSpeed, Orifice, UnitSystem};
use super::units::Quantity;

/// Largest Mach number of a jet.
pub const FASTEST_JET: f64 = 20.0;

pub(super) fn orifice(raw: &At<RawOrifice>, gases: &Names, units: UnitSystem) -> Result<Orifice, Problem> {
    let orifice = &raw.value;
    let temperature = &orifice.temperature;
    Ok(Orifice {
        name: orifice.name.value.clone(),
        position: point(&orifice.position, units)?,
        direction: direction(&orifice.direction)?,
        area: positive(&orifice.area, Quantity::Area, units)?,
        mass_flow: mass_flow(&orifice.mass_flow, units)?,
        temperature: match &temperature.value {
            NumberOr::Number(value) => {
                let at = At { value: *value, span: temperature.span.clone() };
                Curve { points: vec![[0.0, positive(&at, Quantity::Temperature, units)?]] }
            }
            NumberOr::Array(points) if points.is_empty() => {
                return Err(Problem::value(
                    &temperature.span,
                    "an empty curve",
                    "a temperature (K), or at least one point [time, K]",
                ));
            }
            NumberOr::Array(points) => {
                curve(points, Quantity::Time, units, |at| positive(at, Quantity::Temperature, units))?
            }
        },
        mixture: mixture(&orifice.gas, gases)?,
        jet: orifice.jet.as_ref().map(|jet| self::jet(jet, units)).transpose()?,
    })
}

fn mass_flow(raw: &At<Vec<At<Numbers<2>>>>, units: UnitSystem) -> Result<Curve, Problem> {
    if raw.value.len() < 2 {
        let found = match raw.value.len() {
            0 => "an empty curve",
            _ => "a curve of one point",
        };
        return Err(Problem::value(&raw.span, found, "at least two points [time, mass flow]")
            .hint("the flow is linear between the points and zero before the first and after the last"));
    }
    curve(&raw.value, Quantity::Time, units, |at| not_negative(at, Quantity::MassFlow, units))
}

const SWAPPED: &str = "the second numbers of the points are in order: a point is [time, value], are they swapped?";

/// Points in order of time (or of another quantity), the second number of each read by `ordinate`.
pub(super) fn curve(
    raw: &[At<Numbers<2>>],
    abscissa: Quantity,
    units: UnitSystem,
    ordinate: impl Fn(&At<f64>) -> Result<f64, Problem>,
) -> Result<Curve, Problem> {
    let mut points: Vec<[f64; 2]> = Vec::with_capacity(raw.len());
    let mut earlier: Option<&At<f64>> = None;
    for point in raw {
        let [time_at, value_at] = &point.value.0;
        let time = not_negative(time_at, abscissa, units)?;
        if let (Some(last), Some(previous)) = (points.last(), earlier)
            && time <= last[0]
        {
            let (noun, beyond) = if abscissa == Quantity::Time { ("time", "after") } else { ("pressure", "above") };
            let allowed = format!(
                "a {noun} {beyond} that of the point before, {} {}",
                show(previous.value),
                units.symbol(abscissa)
            );
            let problem = Problem::value(&time_at.span, format!("the {noun} {}", show(time_at.value)), allowed);
            let swapped = abscissa == Quantity::Time && is_swapped(raw);
            return Err(if swapped { problem.hint(SWAPPED) } else { problem });
        }
        points.push([time, ordinate(value_at)?]);
        earlier = Some(time_at);
    }
    Ok(Curve { points })
}

/// Whether the second numbers of all points are as times are: in order, from 0 on.
fn is_swapped(raw: &[At<Numbers<2>>]) -> bool {
    let second = |point: &At<Numbers<2>>| point.value.0[1].value;
    second(&raw[0]) == 0.0 && raw.windows(2).all(|pair| second(&pair[0]) < second(&pair[1]))
}

fn jet(raw: &At<RawJet>, units: UnitSystem) -> Result<Jet, Problem> {
    let keys = "exactly one of `mach`, `velocity`";
    let (raw, span) = (&raw.value, &raw.span);
    let speed = match (&raw.mach, &raw.velocity) {
        (Some(mach), None) => {
            let within = |mach: f64| mach > 0.0 && mach <= FASTEST_JET;
            let refused = |problem: Problem| {
                if mach.value > FASTEST_JET { problem.hint("a speed is a `velocity`") } else { problem }
            };
            let read = bounded(mach, Quantity::Pure, UnitSystem::Si, "a number above 0 and at most 20", within);
            JetSpeed::Mach(read.map_err(refused)?)
        }
        (None, Some(velocity)) => JetSpeed::Velocity(positive(velocity, Quantity::Velocity, units)?),
        (Some(_), Some(velocity)) => {
            return Err(Problem::value(&velocity.span, "both `mach` and `velocity`", keys));
        }
        (None, None) => return Err(Problem::value(span, "neither `mach` nor `velocity`", keys)),
    };
    let degrees = match &raw.cone_angle {
        None => 0.0,
        Some(angle) => {
            bounded(angle, Quantity::Pure, UnitSystem::Si, "an angle from 0 to below 90 (degrees)", |degrees| {
                (0.0..90.0).contains(&degrees)
            })?
        }
    };
    Ok(Jet { speed, cone_angle: degrees.to_radians() })
}
