//! The wall shapes of a scene as closed triangle meshes, normals outwards (away from the solid the shape
//! describes, or away from what a shape without thickness encloses).
//!
//! Round bodies and holes keep what counts: a facetted cylinder or sphere has the volume of the round one (`round`), the
//! polygon of a hole the area of its circle.

use super::GeometryError;
use super::plate::{Frame, HoleOutline, Plate, Sheet, WallHoles, outlines};
use super::round::{cylinder, sphere};
use super::wall_mesh::WallMesh;
use crate::scene::{Face, Shape};
use glam::DVec3;

/// The mesh of a shape that is not a file; `wall` is its index, `subject` names it in errors.
pub(super) fn mesh_of(shape: &Shape, wall: u32, subject: &str) -> Result<WallMesh, GeometryError> {
    let positive = |what: &str, value: f64| {
        if value.is_finite() && value > 0.0 {
            return Ok(());
        }
        Err(GeometryError::Shape {
            wall: subject.into(),
            what: format!("the {what} must be positive and finite, found {value}"),
        })
    };
    match shape {
        Shape::Box { min, max, thickness, holes } => {
            for axis in 0..3 {
                positive(["x extent", "y extent", "z extent"][axis], max[axis] - min[axis])?;
            }
            match thickness {
                None if holes.is_empty() => Ok(plain_box(*min, *max)),
                None => Err(GeometryError::Hole {
                    wall: subject.into(),
                    hole: holes[0].name.clone(),
                    what: "needs a wall with a thickness".into(),
                }),
                Some(thickness) => {
                    positive("thickness", *thickness)?;
                    let cut = outlines(holes, subject)?;
                    hollow_box([*min, *max], *thickness, WallHoles { outlines: &cut, wall, subject })
                }
            }
        }
        Shape::Cylinder { base, axis, radius, height, segments } => {
            positive("radius", *radius)?;
            positive("height", *height)?;
            let axis = DVec3::from(*axis).try_normalize().ok_or_else(|| GeometryError::Shape {
                wall: subject.into(),
                what: "the axis has no direction".into(),
            })?;
            if !(3..=4096).contains(segments) {
                let what = format!("3 to 4096 segments make a cylinder, found {segments}");
                return Err(GeometryError::Shape { wall: subject.into(), what });
            }
            Ok(cylinder(DVec3::from(*base), axis, *radius, *height, *segments))
        }
        Shape::Sphere { center, radius, subdivisions } => {
            positive("radius", *radius)?;
            if *subdivisions > 7 {
                let what = format!("at most 7 subdivisions make a sphere, found {subdivisions}");
                return Err(GeometryError::Shape { wall: subject.into(), what });
            }
            Ok(sphere(DVec3::from(*center), *radius, *subdivisions))
        }
        Shape::Plane { center, normal, u, size, thickness, holes } => {
            positive("thickness", *thickness)?;
            positive("size along u", size[0])?;
            positive("size across u", size[1])?;
            let cut = outlines(holes, subject)?;
            let frame = Frame::new(DVec3::from(*center), DVec3::from(*normal), DVec3::from(*u)).ok_or_else(|| {
                GeometryError::Shape { wall: subject.into(), what: "u must not be along the normal".into() }
            })?;
            plate(frame, *size, *thickness, WallHoles { outlines: &cut, wall, subject })
        }
        Shape::Mesh { path, scale, parts } => {
            positive("scale", *scale)?;
            super::mesh_file::read(path, *scale, parts, subject)
        }
    }
}

/// Corner k of a box has the larger coordinate on the axes whose bit of k is set.
fn box_corners(mesh: &mut WallMesh, min: [f64; 3], max: [f64; 3]) -> [u32; 8] {
    std::array::from_fn(|k| {
        let corner = |axis: usize| {
            if k >> axis & 1 == 1 { max[axis] } else { min[axis] }
        };
        mesh.vertex(DVec3::new(corner(0), corner(1), corner(2)))
    })
}

/// Corners of a face, counter-clockwise seen from outside, and the axes (u, v) with u x v outwards.
fn face_corners(axis: usize, positive: bool) -> ([usize; 4], [usize; 2]) {
    // (y, z), (z, x), (x, y) are right-handed about x, y, z.
    let (mut u, mut v) = ((axis + 1) % 3, (axis + 2) % 3);
    if !positive {
        std::mem::swap(&mut u, &mut v);
    }
    let base = usize::from(positive) << axis;
    ([base, base | 1 << u, base | 1 << u | 1 << v, base | 1 << v], [u, v])
}

fn plain_box(min: [f64; 3], max: [f64; 3]) -> WallMesh {
    let mut mesh = WallMesh::default();
    let corners = box_corners(&mut mesh, min, max);
    for axis in 0..3 {
        for positive in [false, true] {
            let (face, _) = face_corners(axis, positive);
            mesh.quad(face.map(|k| corners[k]), Some(Face::Box { axis, positive }));
        }
    }
    mesh
}

/// The shell around the cavity `min`..`max`. The faces of the box are those of the cavity: a surface of a box
/// measures what the gas in the cavity does to it.
fn hollow_box([min, max]: [[f64; 3]; 2], thickness: f64, holes: WallHoles<'_>) -> Result<WallMesh, GeometryError> {
    let mut mesh = WallMesh::default();
    let cavity = box_corners(&mut mesh, min, max);
    let outside = box_corners(&mut mesh, min.map(|x| x - thickness), max.map(|x| x + thickness));
    for axis in 0..3 {
        for positive in [false, true] {
            let face = Face::Box { axis, positive };
            let (corners, [u, v]) = face_corners(axis, positive);
            let sign = if positive { 1.0 } else { -1.0 };
            let frame =
                Frame { origin: DVec3::ZERO, u: DVec3::AXES[u], v: DVec3::AXES[v], n: DVec3::AXES[axis] * sign };
            let level = sign * if positive { max[axis] } else { min[axis] };
            // A hole's two axes are in x, y, z order, the frame's may be the other way round.
            let outlines: Vec<HoleOutline> = holes
                .outlines
                .iter()
                .filter(|h| h.face == face)
                .map(|h| if u < v { h.clone() } else { h.transposed() })
                .collect();
            Plate {
                frame,
                lower: Sheet { level, corners: corners.map(|k| cavity[k]), face: Some(face) },
                upper: Sheet {
                    level: level + thickness,
                    corners: corners.map(|k| outside[k]),
                    face: Some(Face::Outside),
                },
                side_face: None,
            }
            .add_to(&mut mesh, WallHoles { outlines: &outlines, ..holes })?;
        }
    }
    match holes.outlines.iter().find(|h| !matches!(h.face, Face::Box { axis, .. } if axis < 3)) {
        Some(hole) => Err(hole.misplaced(holes.subject, "names no face of a box")),
        None => Ok(mesh),
    }
}

fn plate(frame: Frame, size: [f64; 2], thickness: f64, holes: WallHoles<'_>) -> Result<WallMesh, GeometryError> {
    if let Some(hole) = holes.outlines.iter().find(|h| h.face != Face::Plane) {
        return Err(hole.misplaced(holes.subject, "names a face of a box, but the wall is a plane"));
    }
    let mut mesh = WallMesh::default();
    let mut level = |h: f64| {
        [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
            .map(|(a, b)| mesh.vertex(frame.point(glam::DVec2::new(a * size[0], b * size[1]), h)))
    };
    let (low, high) = (level(-0.5 * thickness), level(0.5 * thickness));
    for i in 0..4 {
        let next = (i + 1) % 4;
        mesh.quad([low[i], low[next], high[next], high[i]], Some(Face::Rim));
    }
    Plate {
        frame,
        lower: Sheet { level: -0.5 * thickness, corners: low, face: Some(Face::Back) },
        upper: Sheet { level: 0.5 * thickness, corners: high, face: Some(Face::Front) },
        side_face: Some(Face::Rim),
    }
    .add_to(&mut mesh, holes)?;
    Ok(mesh)
}
