//! Vents: where on a wall, and how much they let out.

use super::errors::Problem;
use super::flows::curve;
use super::names::Names;
use super::numbers::{described, not_negative, point, positive, show};
use super::parts::Parts;
use super::raw::{RawScene, RawVent};
use super::raw_values::{At, NumberOr, Numbers};
use super::types::{Curve, Disc, UnitSystem, Vent, VentFlow};
use super::units::Quantity;

/// The standard atmosphere, Pa.
const ATMOSPHERE: f64 = 101_325.0;

/// What vents refer to.
pub(super) struct Places<'a> {
    pub walls: &'a Names<'a>,
    pub fabrics: &'a Names<'a>,
    pub chambers: &'a Names<'a>,
    pub parts: &'a Parts<'a>,
}

pub(super) fn vent(raw: &At<RawVent>, scene: &RawScene, places: &Places, units: UnitSystem) -> Result<Vent, Problem> {
    match (&raw.value.wall, &raw.value.fabric) {
        (Some(wall), None) => on_wall(raw, wall, places, units),
        (None, Some(fabric)) => on_fabric(raw, fabric, (scene, places), units),
        (None, None) => {
            let keys = "exactly one of `wall`, `fabric`";
            Err(Problem::missing(&raw.span, if scene.fabric.is_empty() { "wall" } else { "fabric" }, keys))
        }
        (Some(wall), Some(fabric)) => {
            let later = if wall.span.start > fabric.span.start { &wall.span } else { &fabric.span };
            Err(Problem::value(later, "both `wall` and `fabric`", "exactly one of them"))
        }
    }
}

/// A vent of a closed fabric: whether it is closed is known once its mesh is read.
fn on_fabric(
    raw: &At<RawVent>,
    name: &At<String>,
    (scene, places): (&RawScene, &Places),
    units: UnitSystem,
) -> Result<Vent, Problem> {
    let vent = &raw.value;
    let fabric = places.fabrics.find(name)?;
    let foreign = [
        ("chamber", vent.chamber.as_ref().map(|at| &at.span)),
        ("external_pressure", vent.external_pressure.as_ref().map(|at| &at.span)),
        ("opening_pressure_absolute", vent.opening_pressure_absolute.as_ref().map(|at| &at.span)),
    ];
    if let Some((key, span)) = foreign.into_iter().find_map(|(key, span)| Some((key, span?))) {
        let found = format!("`{key}` of a vent on fabric");
        let allowed = "no such key: gas flows from inside of the fabric to what is around it";
        return Err(Problem::value(span, found, allowed)
            .hint("an `opening_pressure` is above the pressure around; without gas there give the fabric an `external_pressure`"));
    }
    let around = || {
        let rest = scene.chamber.iter().find(|at| at.value.inside.is_none() && at.value.region.is_none());
        rest.map(|at| &at.value.pressure)
    };
    let external = scene.fabric[fabric].value.external_pressure.as_ref().or_else(around);
    Ok(Vent {
        name: vent.name.value.clone(),
        wall: scene.wall.len() + fabric,
        face: vent.face.as_ref().map(|given| places.parts.find_of_fabric(given, fabric)).transpose()?,
        chamber: None,
        disc: disc(raw, units)?,
        area: vent.area.as_ref().map(|at| positive(at, Quantity::Area, units)).transpose()?,
        flow: flow(raw, units)?,
        opening_pressure: opening_pressure(vent, 0.0, units)?,
        external_pressure: external.map_or(Ok(0.0), |at| not_negative(at, Quantity::Pressure, units))?,
    })
}

fn on_wall(raw: &At<RawVent>, name: &At<String>, places: &Places, units: UnitSystem) -> Result<Vent, Problem> {
    let Places { walls, chambers, parts, .. } = places;
    let vent = &raw.value;
    let wall = walls.find(name)?;
    let pressure = |at: &Option<At<f64>>| at.as_ref().map(|at| not_negative(at, Quantity::Pressure, units)).transpose();
    let external_pressure = pressure(&vent.external_pressure)?.unwrap_or(ATMOSPHERE);
    Ok(Vent {
        name: vent.name.value.clone(),
        wall,
        face: vent.face.as_ref().map(|given| parts.find(given, wall)).transpose()?,
        chamber: vent.chamber.as_ref().map(|name| chambers.find(name)).transpose()?,
        disc: disc(raw, units)?,
        area: vent.area.as_ref().map(|at| positive(at, Quantity::Area, units)).transpose()?,
        flow: flow(raw, units)?,
        opening_pressure: opening_pressure(vent, external_pressure, units)?,
        external_pressure,
    })
}

/// Pa above the external pressure, from whichever of the two keys is given.
fn opening_pressure(vent: &RawVent, external: f64, units: UnitSystem) -> Result<f64, Problem> {
    match (&vent.opening_pressure, &vent.opening_pressure_absolute) {
        (None, None) => Ok(0.0),
        (Some(gauge), None) => not_negative(gauge, Quantity::Pressure, units),
        (None, Some(absolute)) => {
            let si = not_negative(absolute, Quantity::Pressure, units)?;
            if si < external {
                let factor = units.factor(Quantity::Pressure);
                let allowed = format!("at least the external pressure, {}", show(external / factor));
                let problem = Problem::value(
                    &absolute.span,
                    show(absolute.value),
                    described(&allowed, Quantity::Pressure, units),
                );
                return Err(problem.hint("a pressure above the external one is an `opening_pressure`"));
            }
            Ok(si - external)
        }
        (Some(gauge), Some(absolute)) => {
            let later = if gauge.span.start > absolute.span.start { &gauge.span } else { &absolute.span };
            let found = "both `opening_pressure` and `opening_pressure_absolute`";
            Err(Problem::value(later, found, "at most one of them: above the external pressure, or absolute"))
        }
    }
}

fn disc(raw: &At<RawVent>, units: UnitSystem) -> Result<Option<Disc>, Problem> {
    match (&raw.value.position, &raw.value.diameter) {
        (None, None) => Ok(None),
        (Some(position), Some(diameter)) => {
            Ok(Some(Disc { center: point(position, units)?, diameter: positive(diameter, Quantity::Length, units)? }))
        }
        (Some(position), None) => {
            Err(Problem::value(&position.span, "`position` without `diameter`", "both of them, or neither"))
        }
        (None, Some(diameter)) => {
            Err(Problem::value(&diameter.span, "`diameter` without `position`", "both of them, or neither"))
        }
    }
}

fn flow(raw: &At<RawVent>, units: UnitSystem) -> Result<VentFlow, Problem> {
    let vent = &raw.value;
    let keys = "exactly one of `discharge`, `discharge_by_pressure`, `leak_velocity`";
    let coefficient = |at: &At<f64>| not_negative(at, Quantity::Pure, units);
    let by_pressure = |at: &At<Vec<At<Numbers<2>>>>, ordinate: Quantity| -> Result<Curve, Problem> {
        if at.value.is_empty() {
            return Err(Problem::value(&at.span, "an empty curve", "at least one point [pressure, value]"));
        }
        curve(&at.value, Quantity::Pressure, units, |value| not_negative(value, ordinate, units))
    };
    match (&vent.discharge, &vent.discharge_by_pressure, &vent.leak_velocity) {
        (Some(at), None, None) => Ok(VentFlow::Discharge(match &at.value {
            NumberOr::Number(value) => {
                let number = At { value: *value, span: at.span.clone() };
                Curve { points: vec![[0.0, coefficient(&number)?]] }
            }
            NumberOr::Array(points) if points.is_empty() => {
                return Err(Problem::value(&at.span, "an empty curve", "a number, or at least one point [time, C23]"));
            }
            NumberOr::Array(points) => curve(points, Quantity::Time, units, coefficient)?,
        })),
        (None, Some(at), None) => Ok(VentFlow::DischargeByPressure(by_pressure(at, Quantity::Pure)?)),
        (None, None, Some(at)) => Ok(VentFlow::LeakVelocity(by_pressure(at, Quantity::Velocity)?)),
        (None, None, None) => Err(Problem::missing(&raw.span, "discharge", keys)),
        (discharge, by_pressure, leak) => {
            let spans = [
                discharge.as_ref().map(|at| &at.span),
                by_pressure.as_ref().map(|at| &at.span),
                leak.as_ref().map(|at| &at.span),
            ];
            let last = spans.into_iter().flatten().max_by_key(|span| span.start).unwrap_or(&raw.span);
            Err(Problem::value(last, "a second law of the flow", keys))
        }
    }
}
