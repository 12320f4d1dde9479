//! The keys of fabric: files, and what a scene with fabric cannot have.

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::errors::{Problem, quote};
use super::fabric::{Fabric, Fixed, Membrane, Turn};
use super::fabric_material::material;
use super::motions::{AngularLaw, law};
use super::numbers::{direction, not_negative, number, point, positive};
use super::parts::Parts;
use super::places::region;
use super::raw::RawScene;
use super::raw_fabric::{RawFabric, RawFixed, RawMaterial, RawTurn};
use super::raw_values::At;
use super::types::UnitSystem;
use super::units::Quantity;
use super::wall_surface;
use super::walls::existing;

/// Surfaces that deform, at most.
pub const MOST_FABRICS: usize = 16;

const MESHES: (&[&str], &str) = (&["stl", "obj"], "a file name that ends with .stl or .obj");
const MOTIONS: (&[&str], &str) =
    (&["nodes", "pvd", "series"], "a file name that ends with .nodes, .pvd, .vtk.series or .vtu.series");

/// The fabric of this index in the scene.
pub(super) fn fabric(
    raw: &At<RawFabric>,
    index: usize,
    parts: &Parts,
    units: UnitSystem,
    base_dir: &Path,
) -> Result<Fabric, Problem> {
    let fabric = &raw.value;
    let scale = match &fabric.scale {
        Some(scale) => positive(scale, Quantity::Length, units)?,
        None => units.factor(Quantity::Length),
    };
    Ok(Fabric {
        name: fabric.name.value.clone(),
        mesh: file(&fabric.file, MESHES, base_dir)?,
        scale,
        motion: fabric.motion.as_ref().map(|motion| file(motion, MOTIONS, base_dir)).transpose()?,
        turn: fabric.turn.as_ref().map(|turn| self::turn(fabric, turn, units)).transpose()?,
        membrane: match &fabric.material {
            Some(material) => Some(membrane(fabric, material, units, base_dir)?),
            None => no_membrane(fabric)?,
        },
        surface: wall_surface::of_fabric(fabric, units)?,
        surface_parts: wall_surface::of_parts_of_fabric(fabric, index, parts, units)?,
        parts: parts.of_fabric(index),
        external_pressure: fabric
            .external_pressure
            .as_ref()
            .map(|at| not_negative(at, Quantity::Pressure, units))
            .transpose()?,
    })
}

fn file(named: &At<String>, (endings, allowed): (&[&str], &str), base_dir: &Path) -> Result<PathBuf, Problem> {
    let ending = Path::new(&named.value).extension().map(|ending| ending.to_ascii_lowercase());
    if !ending.is_some_and(|ending| endings.iter().any(|known| ending == *known)) {
        return Err(Problem::value(&named.span, quote(&named.value), allowed));
    }
    existing(named, base_dir)
}

fn turn(fabric: &RawFabric, raw: &At<RawTurn>, units: UnitSystem) -> Result<Turn, Problem> {
    if let Some(motion) = &fabric.motion {
        let found = "`motion` of a fabric with a `turn`";
        return Err(Problem::value(&motion.span, found, "one of the two: each says where its nodes go"));
    }
    let laws = (&raw.value.angular_velocity, &raw.value.angle);
    Ok(Turn {
        axis: direction(&raw.value.axis)?,
        center: point(&raw.value.center, units)?,
        course: law::<AngularLaw>(&raw.span, laws, units)?,
    })
}

fn membrane(
    fabric: &RawFabric,
    raw: &At<RawMaterial>,
    units: UnitSystem,
    base_dir: &Path,
) -> Result<Membrane, Problem> {
    let moved =
        [("motion", fabric.motion.as_ref().map(|at| &at.span)), ("turn", fabric.turn.as_ref().map(|at| &at.span))];
    if let (Some((key, span)), None) = (moved.into_iter().find_map(|(key, span)| Some((key, span?))), &fabric.fixed) {
        let found = format!("`{key}` of a fabric with a `material` and without `fixed`");
        return Err(Problem::value(
            span,
            found,
            "`fixed` beside it: it moves the nodes that are held, the gas the others",
        ));
    }
    Ok(Membrane {
        material: material(raw, units)?,
        reference: fabric.reference.as_ref().map(|at| file(at, MESHES, base_dir)).transpose()?,
        fixed: fixed(fabric, units)?,
        reference_scale: fabric.reference_scale.as_ref().map_or(Ok(1.0), |at| positive(at, Quantity::Pure, units))?,
        reference_time: reference_time(fabric, units)?,
        added_mass: or_none(fabric.added_mass.as_ref(), Quantity::SurfaceDensity, units)?,
        wall_friction: or_none(fabric.wall_friction.as_ref(), Quantity::Pure, units)?,
    })
}

fn or_none(at: Option<&At<f64>>, quantity: Quantity, units: UnitSystem) -> Result<f64, Problem> {
    at.map_or(Ok(0.0), |at| not_negative(at, quantity, units))
}

fn reference_time(fabric: &RawFabric, units: UnitSystem) -> Result<Option<f64>, Problem> {
    let Some(at) = &fabric.reference_time else { return Ok(None) };
    if fabric.reference_scale.is_none() {
        let found = "`reference_time` without `reference_scale`";
        return Err(Problem::value(&at.span, found, "both: the scale goes to 1 in that time"));
    }
    positive(at, Quantity::Time, units).map(Some)
}

fn fixed(fabric: &RawFabric, units: UnitSystem) -> Result<Fixed, Problem> {
    let Some(at) = &fabric.fixed else { return Ok(Fixed::Nothing) };
    Ok(match &at.value {
        RawFixed::Edge => Fixed::Edge,
        RawFixed::Within(regions) if regions.is_empty() => {
            return Err(Problem::value(&at.span, "an empty list", "\"edge\", or at least one region"));
        }
        RawFixed::Within(regions) => {
            Fixed::Within(regions.iter().map(|own| region(&own.value, units)).collect::<Result<_, _>>()?)
        }
    })
}

/// What only a membrane has.
fn no_membrane(fabric: &RawFabric) -> Result<Option<Membrane>, Problem> {
    let given: [(&str, Option<&Range<usize>>); 6] = [
        ("reference", fabric.reference.as_ref().map(|at| &at.span)),
        ("fixed", fabric.fixed.as_ref().map(|at| &at.span)),
        ("reference_scale", fabric.reference_scale.as_ref().map(|at| &at.span)),
        ("reference_time", fabric.reference_time.as_ref().map(|at| &at.span)),
        ("added_mass", fabric.added_mass.as_ref().map(|at| &at.span)),
        ("wall_friction", fabric.wall_friction.as_ref().map(|at| &at.span)),
    ];
    match given.into_iter().find_map(|(key, span)| Some((key, span?))) {
        None => Ok(None),
        Some((key, span)) => Err(Problem::value(
            span,
            format!("`{key}` of a fabric without a `material`"),
            format!("`{key}` together with `material`: the gas moves fabric of a material only"),
        )),
    }
}

/// Of free fall, m/s2.
pub(super) fn gravity(raw: &RawScene, units: UnitSystem) -> Result<[f64; 3], Problem> {
    let Some(at) = &raw.gravity else { return Ok([0.0; 3]) };
    if raw.fabric.iter().all(|fabric| fabric.value.material.is_none()) {
        let found = "`gravity` in a scene without a fabric that has a `material`";
        return Err(Problem::value(&at.span, found, "`gravity` beside such a fabric: it acts on nothing else"));
    }
    let mut si = [0.0; 3];
    for (value, component) in si.iter_mut().zip(&at.value.0) {
        *value = number(component, Quantity::Acceleration, units)?;
    }
    Ok(si)
}

/// What a scene with fabric cannot have (what the command line may ask for, too, is refused of the model).
pub(super) fn refuse(raw: &RawScene, problems: &mut Vec<Problem>) {
    if raw.fabric.is_empty() {
        return;
    }
    for chamber in raw.chamber.iter().filter(|chamber| chamber.value.region.is_some()) {
        let found = format!("chamber {:?} with a `region` in a scene with fabric", chamber.value.name.value);
        problems.push(
            Problem::value(
                &chamber.span,
                found,
                "`inside`, the name of a closed [[fabric]]; the last chamber has the rest",
            )
            .hint("probes may have regions"),
        );
    }
    let without_gas = raw.fabric.iter().find(|fabric| fabric.value.external_pressure.is_some());
    let outside = raw.chamber.iter().find(|chamber| chamber.value.inside.is_none() && chamber.value.region.is_none());
    if let (Some(fabric), Some(chamber)) = (without_gas, outside) {
        let found = format!(
            "chamber {:?} around fabric {:?}, which has an `external_pressure`",
            chamber.value.name.value, fabric.value.name.value
        );
        problems.push(
            Problem::value(&chamber.span, found, "no chamber outside: an `external_pressure` is in place of gas there")
                .hint("give the chamber `inside`, or leave out either of the two"),
        );
    }
}
