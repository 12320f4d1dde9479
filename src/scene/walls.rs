//! Walls: which keys a shape takes, and what its numbers may be.

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::errors::{Problem, list, near_mesh, quote};
use super::holes::holes;
use super::numbers::{corners, direction, normalised, point, positive, sides, small_count};
use super::parts::Parts;
use super::raw::{RawShape, RawSide, RawWall};
use super::raw_values::{At, Numbers};
use super::types::{GasSide, Shape, UnitSystem, Wall};
use super::units::Quantity;
use super::wall_surface;

const CYLINDER_SEGMENTS: u32 = 48;
const SPHERE_SUBDIVISIONS: u32 = 3;

/// How far from a right angle to its normal a plate's side may be (the cosine of the angle between them).
const SQUARE_TOLERANCE: f64 = 1e-6;

/// The wall of this index in the scene.
pub(super) fn wall(
    raw: &At<RawWall>,
    index: usize,
    parts: &Parts,
    units: UnitSystem,
    base_dir: &Path,
) -> Result<Wall, Problem> {
    refuse_foreign_keys(raw)?;
    let gas = gas_side(raw)?;
    let shape = match raw.value.shape.value {
        RawShape::Box => hollow_box(raw, units)?,
        RawShape::Cylinder => cylinder(raw, units)?,
        RawShape::Sphere => sphere(raw, units)?,
        RawShape::Plane => plane(raw, units)?,
        RawShape::Mesh => mesh(raw, parts.of_mesh(index), units, base_dir)?,
    };
    Ok(Wall {
        name: raw.value.name.value.clone(),
        shape,
        gas,
        surface: wall_surface::of_wall(&raw.value, units)?,
        parts: wall_surface::of_parts_of_wall(&raw.value, index, parts, units)?,
    })
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
                    ["name", "shape", "gas", "temperature", "accommodation", "heat_transfer", "friction", "part"]
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
    let path = existing(file, base_dir)?;
    // The file's `scale` leads to length units of the scene; those of `Shape::Mesh` lead to metres.
    let scale = match &raw.value.scale {
        Some(scale) => positive(scale, Quantity::Length, units)?,
        None => units.factor(Quantity::Length),
    };
    Ok(Shape::Mesh { path, scale, parts })
}

/// The absolute path of a file that is there.
pub(super) fn existing(file: &At<String>, base_dir: &Path) -> Result<PathBuf, Problem> {
    let joined = base_dir.join(&file.value);
    // Absolute, so that the resolved scene can be read from another folder.
    let path = std::path::absolute(&joined).unwrap_or_else(|_| joined.clone());
    if !path.is_file() {
        let what = match std::fs::read_link(&path) {
            Ok(target) => format!("a link to {}, which does not exist", quote(&target.to_string_lossy())),
            Err(_) if path.is_dir() => "which is a folder".to_string(),
            Err(_) => "which does not exist".to_string(),
        };
        let hint = match near_mesh(&joined) {
            Some(near) => {
                format!("did you mean `{near}`? It lies in {}", joined.parent().unwrap_or(base_dir).display())
            }
            None => format!("the path is relative to the folder of the scene file: {} was meant", joined.display()),
        };
        return Err(
            Problem::value(&file.span, format!("{}, {what}", quote(&file.value)), "an existing file").hint(&hint)
        );
    }
    Ok(path)
}
