//! What refers to places: chambers, openings between them, probes and surfaces.

use super::errors::Problem;
use super::gases::mixture;
use super::names::Names;
use super::numbers::{corners, direction, point, positive};
use super::parts::Parts;
use super::raw::{RawChamber, RawOpening, RawProbe, RawSurface};
use super::raw_region::RawRegion;
use super::raw_values::At;
use super::region::Region;
use super::types::{Chamber, Opening, Probe, Surface, UnitSystem};
use super::units::Quantity;

pub(super) fn region(raw: &RawRegion, units: UnitSystem) -> Result<Region, Problem> {
    Ok(match raw {
        RawRegion::Box(raw) => {
            let (min, max) = corners(&raw.min, &raw.max, units)?;
            Region::Box { min, max }
        }
        RawRegion::Sphere(raw) => Region::Sphere {
            center: point(&raw.center, units)?,
            radius: positive(&raw.radius, Quantity::Length, units)?,
        },
        RawRegion::Cylinder(raw) => Region::Cylinder {
            base: point(&raw.base, units)?,
            axis: direction(&raw.axis)?,
            radius: positive(&raw.radius, Quantity::Length, units)?,
            height: positive(&raw.height, Quantity::Length, units)?,
        },
    })
}

/// Only the last chamber may do without a region.
pub(super) fn chamber(
    raw: &At<RawChamber>,
    last: bool,
    (gases, fabrics): (&Names, &Names),
    units: UnitSystem,
) -> Result<Chamber, Problem> {
    let chamber = &raw.value;
    if chamber.region.is_none() && chamber.inside.is_none() && !last {
        return Err(Problem::missing(&raw.span, "region", "a region for every chamber but the last")
            .hint("a chamber without region has all gas space that no earlier one has: move it to the end"));
    }
    Ok(Chamber {
        name: chamber.name.value.clone(),
        region: chamber.region.as_ref().map(|r| region(&r.value, units)).transpose()?,
        inside: chamber.inside.as_ref().map(|name| fabrics.find(name)).transpose()?,
        pressure: positive(&chamber.pressure, Quantity::Pressure, units).map_err(|problem| {
            let hint = "pressures of chambers are absolute; space in no chamber is empty at the start";
            if chamber.pressure.value <= 0.0 { problem.hint(hint) } else { problem }
        })?,
        temperature: positive(&chamber.temperature, Quantity::Temperature, units)?,
        mixture: mixture(&chamber.gas, gases)?,
    })
}

pub(super) fn opening(raw: &At<RawOpening>, chambers: &Names, units: UnitSystem) -> Result<Opening, Problem> {
    let opening = &raw.value;
    let [first, second] = opening.between.value.as_slice() else {
        let found = format!("{} names", opening.between.value.len());
        return Err(Problem::value(&opening.between.span, found, "the names of two chambers"));
    };
    let find = |name: &At<String>| {
        chambers.find(name).map_err(|problem| match name.value.to_lowercase().as_str() {
            "outside" | "ambient" | "atmosphere" | "environment" | "air" => {
                problem.hint("what leads out of the scene is a [[vent]]")
            }
            _ => problem,
        })
    };
    let between = [find(first)?, find(second)?];
    if between[0] == between[1] {
        return Err(Problem::value(&opening.between.span, "the same chamber twice", "the names of two chambers"));
    }
    let area = positive(&opening.area, Quantity::Area, units)?;
    let length = match &opening.length {
        Some(length) => positive(length, Quantity::Length, units)?,
        None => (area / std::f64::consts::PI).sqrt(),
    };
    Ok(Opening { name: opening.name.value.clone(), between, area, length })
}

pub(super) fn probe(raw: &At<RawProbe>, units: UnitSystem) -> Result<Probe, Problem> {
    Ok(Probe { name: raw.value.name.value.clone(), region: region(&raw.value.region.value, units)? })
}

pub(super) fn surface(raw: &At<RawSurface>, walls: &Names, parts: &Parts) -> Result<Surface, Problem> {
    let surface = &raw.value;
    let wall = walls.find(&surface.wall)?;
    let face = surface.face.as_ref().map(|given| parts.find(given, wall)).transpose()?;
    Ok(Surface { name: surface.name.value.clone(), wall, face })
}
