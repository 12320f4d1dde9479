//! Walls: which keys a shape takes, and what its numbers may be.

use std::ops::Range;
use std::path::Path;

use super::errors::{Problem, list, quote};
use super::holes::holes;
use super::numbers::{bounded, corners, direction, normalised, not_negative, point, positive, sides, small_count};
use super::raw::{RawShape, RawSide, RawWall};
use super::raw_values::{At, Numbers};
use super::types::{GasSide, HeatTransfer, Shape, UnitSystem, Wall, WallHeat};
use super::units::Quantity;

const CYLINDER_SEGMENTS: u32 = 48;
const SPHERE_SUBDIVISIONS: u32 = 3;

/// How far from a right angle to its normal a plate's side may be (the cosine of the angle between them).
const SQUARE_TOLERANCE: f64 = 1e-6;

/// `parts` are the names of the parts that the scene uses, of a mesh.
pub(super) fn wall(raw: &At<RawWall>, parts: Vec<String>, units: UnitSystem, base_dir: &Path) -> Result<Wall, Problem> {
    refuse_foreign_keys(raw)?;
    let gas = gas_side(raw)?;
    let shape = match raw.value.shape.value {
        RawShape::Box => hollow_box(raw, units)?,
        RawShape::Cylinder => cylinder(raw, units)?,
        RawShape::Sphere => sphere(raw, units)?,
        RawShape::Plane => plane(raw, units)?,
        RawShape::Mesh => mesh(raw, parts, units, base_dir)?,
    };
    Ok(Wall {
        name: raw.value.name.value.clone(),
        shape,
        gas,
        heat: heat(raw, units)?,
        friction: friction(raw, units)?,
    })
}

fn friction(raw: &At<RawWall>, units: UnitSystem) -> Result<f64, Problem> {
    let share = |at| bounded(at, Quantity::Pure, units, "a number from 0 to 1", |share| (0.0..=1.0).contains(&share));
    raw.value.friction.as_ref().map_or(Ok(0.0), share)
}

fn heat(raw: &At<RawWall>, units: UnitSystem) -> Result<Option<WallHeat>, Problem> {
    let wall = &raw.value;
    let Some(temperature) = &wall.temperature else {
        let given = [("accommodation", &wall.accommodation), ("heat_transfer", &wall.heat_transfer)];
        return match given.into_iter().find_map(|(key, at)| at.as_ref().map(|at| (key, at))) {
            None => Ok(None),
            Some((key, at)) => Err(Problem::value(
                &at.span,
                format!("`{key}` of a wall without `temperature`"),
                format!("`{key}` together with `temperature`"),
            )),
        };
    };
    let transfer = match (&wall.accommodation, &wall.heat_transfer) {
        (Some(_), Some(at)) => {
            return Err(Problem::value(
                &at.span,
                "both `accommodation` and `heat_transfer`",
                "at most one of them: each follows from the other and the state of the gas",
            ));
        }
        (None, None) => HeatTransfer::Accommodation(1.0),
        (Some(at), None) => {
            let share =
                bounded(at, Quantity::Pure, units, "a number from 0 to 1", |share| (0.0..=1.0).contains(&share));
            HeatTransfer::Accommodation(share?)
        }
        (None, Some(at)) => HeatTransfer::Coefficient(not_negative(at, Quantity::HeatTransfer, units)?),
    };
    Ok(Some(WallHeat { temperature: positive(temperature, Quantity::Temperature, units)?, transfer }))
}

fn keys_of(shape: RawShape) -> &'static [&'static str] {
    match shape {
        RawShape::Box => &["min", "max", "thickness", "hole"],
        RawShape::Cylinder => &["base", "axis", "radius", "height", "segments"],
        RawShape::Sphere => &["center", "radius", "subdivisions"],
        RawShape::Plane => &["center", "normal", "u", "size", "thickness", "hole"],
        RawShape::Mesh => &["file", "scale"],
    }
}

fn name_of(shape: RawShape) -> &'static str {
    match shape {
        RawShape::Box => "box",
        RawShape::Cylinder => "cylinder",
        RawShape::Sphere => "sphere",
        RawShape::Plane => "plane",
        RawShape::Mesh => "mesh",
    }
}

/// One flat table serves all shapes, so that serde keeps the places of its values.
fn refuse_foreign_keys(raw: &At<RawWall>) -> Result<(), Problem> {
    fn place<T>(value: &Option<At<T>>) -> Option<Range<usize>> {
        value.as_ref().map(|at| at.span.clone())
    }
    let wall = &raw.value;
    let given = [
        ("min", place(&wall.min)),
        ("max", place(&wall.max)),
        ("thickness", place(&wall.thickness)),
        ("base", place(&wall.base)),
        ("axis", place(&wall.axis)),
        ("radius", place(&wall.radius)),
        ("height", place(&wall.height)),
        ("segments", place(&wall.segments)),
        ("center", place(&wall.center)),
        ("subdivisions", place(&wall.subdivisions)),
        ("normal", place(&wall.normal)),
        ("u", place(&wall.u)),
        ("size", place(&wall.size)),
        ("file", place(&wall.file)),
        ("scale", place(&wall.scale)),
        ("hole", wall.hole.first().map(|hole| hole.span.clone())),
    ];
    let shape = wall.shape.value;
    for (key, place) in given {
        if let Some(span) = place
            && !keys_of(shape).contains(&key)
        {
            let allowed = format!(
                "of a {}: {}",
                name_of(shape),
                list(
                    ["name", "shape", "gas", "temperature", "accommodation", "heat_transfer", "friction"]
                        .iter()
                        .chain(keys_of(shape))
                        .copied()
                )
            );
            return Err(Problem::value(&span, format!("`{key}` of a {}", name_of(shape)), allowed));
        }
    }
    Ok(())
}

fn gas_side(raw: &At<RawWall>) -> Result<GasSide, Problem> {
    let wall = &raw.value;
    match (&wall.gas, &wall.thickness) {
        (Some(gas), Some(_)) => Err(Problem::value(
            &gas.span,
            "`gas` of a wall with a thickness",
            "no `gas` here: a hollow box or a plate has gas on both sides",
        )),
        (None, Some(_)) => Ok(GasSide::Both),
        // Its lack of a thickness is the greater fault, reported with its other keys.
        (_, None) if wall.shape.value == RawShape::Plane => Ok(GasSide::Both),
        (None, None) => {
            Err(Problem::missing(&raw.span, "gas", "\"inside\" or \"outside\": on which side of the wall the gas is"))
        }
        (Some(gas), None) => Ok(match gas.value {
            RawSide::Inside => GasSide::Inside,
            RawSide::Outside => GasSide::Outside,
        }),
    }
}

/// The value of a key that the shape cannot do without.
fn need<'a, T>(raw: &At<RawWall>, value: &'a Option<At<T>>, key: &str, allowed: &str) -> Result<&'a At<T>, Problem> {
    value.as_ref().ok_or_else(|| {
        Problem::missing(&raw.span, key, format!("{allowed} (a {} needs it)", name_of(raw.value.shape.value)))
    })
}

fn need_point<'a>(
    raw: &At<RawWall>,
    value: &'a Option<At<Numbers<3>>>,
    key: &str,
) -> Result<&'a At<Numbers<3>>, Problem> {
    need(raw, value, key, "three numbers")
}

fn hollow_box(raw: &At<RawWall>, units: UnitSystem) -> Result<Shape, Problem> {
    let wall = &raw.value;
    let (min_at, max_at) = (need_point(raw, &wall.min, "min")?, need_point(raw, &wall.max, "max")?);
    let (min, max) = corners(min_at, max_at, units)?;
    let thickness = wall.thickness.as_ref().map(|t| positive(t, Quantity::Length, units)).transpose()?;
    if let (None, Some(hole)) = (thickness, wall.hole.first()) {
        return Err(Problem::value(
            &hole.span,
            "a hole in a box without `thickness`",
            "holes in a box with `thickness`",
        )
        .hint("a hole leads through a solid wall: give the box a `thickness` (and leave `gas` out)"));
    }
    let holes = holes(&wall.hole, Some((min, max)), None, units)?;
    Ok(Shape::Box { min, max, thickness, holes })
}

fn cylinder(raw: &At<RawWall>, units: UnitSystem) -> Result<Shape, Problem> {
    let wall = &raw.value;
    Ok(Shape::Cylinder {
        base: point(need_point(raw, &wall.base, "base")?, units)?,
        axis: direction(need_point(raw, &wall.axis, "axis")?)?,
        radius: positive(need(raw, &wall.radius, "radius", "a positive number")?, Quantity::Length, units)?,
        height: positive(need(raw, &wall.height, "height", "a positive number")?, Quantity::Length, units)?,
        segments: wall.segments.as_ref().map_or(Ok(CYLINDER_SEGMENTS), |n| small_count(n, 3..=4096))?,
    })
}

fn sphere(raw: &At<RawWall>, units: UnitSystem) -> Result<Shape, Problem> {
    let wall = &raw.value;
    Ok(Shape::Sphere {
        center: point(need_point(raw, &wall.center, "center")?, units)?,
        radius: positive(need(raw, &wall.radius, "radius", "a positive number")?, Quantity::Length, units)?,
        subdivisions: wall.subdivisions.as_ref().map_or(Ok(SPHERE_SUBDIVISIONS), |n| small_count(n, 0..=7))?,
    })
}

fn plane(raw: &At<RawWall>, units: UnitSystem) -> Result<Shape, Problem> {
    let wall = &raw.value;
    let thickness = need(raw, &wall.thickness, "thickness", "a positive number")?;
    let center = point(need_point(raw, &wall.center, "center")?, units)?;
    let normal = direction(need_point(raw, &wall.normal, "normal")?)?;
    let u_at = need_point(raw, &wall.u, "u")?;
    let u = square_to(normal, direction(u_at)?).ok_or_else(|| {
        Problem::value(&u_at.span, "a direction that is not perpendicular to `normal`", "`u` perpendicular to `normal`")
    })?;
    let size = sides(need(raw, &wall.size, "size", "two positive numbers")?, units)?;
    let holes = holes(&wall.hole, None, Some(size), units)?;
    Ok(Shape::Plane { center, normal, u, size, thickness: positive(thickness, Quantity::Length, units)?, holes })
}

/// `u` made exactly perpendicular to `normal` (to rounding), where it nearly is.
fn square_to(normal: [f64; 3], u: [f64; 3]) -> Option<[f64; 3]> {
    let cosine: f64 = normal.iter().zip(&u).map(|(n, u)| n * u).sum();
    if cosine.abs() > SQUARE_TOLERANCE {
        return None;
    }
    // Left alone where only rounding is off, so that a resolved scene reads back as it was.
    if cosine.abs() <= 4.0 * f64::EPSILON {
        return Some(u);
    }
    Some(normalised(std::array::from_fn(|axis| u[axis] - cosine * normal[axis])))
}

fn mesh(raw: &At<RawWall>, parts: Vec<String>, units: UnitSystem, base_dir: &Path) -> Result<Shape, Problem> {
    let file = need(raw, &raw.value.file, "file", "the path of an STL or OBJ file")?;
    let known = Path::new(&file.value)
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("stl") || e.eq_ignore_ascii_case("obj"));
    if !known {
        return Err(Problem::value(&file.span, quote(&file.value), "a file name that ends with .stl or .obj"));
    }
    let joined = base_dir.join(&file.value);
    // Absolute, so that the resolved scene can be read from another folder.
    let path = std::path::absolute(&joined).unwrap_or_else(|_| joined.clone());
    if !path.is_file() {
        let what = match std::fs::read_link(&path) {
            Ok(target) => format!("a link to {}, which does not exist", quote(&target.to_string_lossy())),
            Err(_) if path.is_dir() => "which is a folder".to_string(),
            Err(_) => "which does not exist".to_string(),
        };
        let hint = format!("the path is relative to the folder of the scene file: {} was meant", joined.display());
        return Err(
            Problem::value(&file.span, format!("{}, {what}", quote(&file.value)), "an existing file").hint(&hint)
        );
    }
    // The file's `scale` leads to length units of the scene; those of `Shape::Mesh` lead to metres.
    let scale = match &raw.value.scale {
        Some(scale) => positive(scale, Quantity::Length, units)?,
        None => units.factor(Quantity::Length),
    };
    Ok(Shape::Mesh { path, scale, parts })
}
