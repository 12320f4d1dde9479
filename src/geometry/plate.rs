//! A flat sheet of material with holes through it: a plane, or one side of a hollow box.

use super::GeometryError;
use super::polygon::{area, convex_overlap, perimeter, triangulate};
use super::wall_mesh::{FoundHole, WallMesh};
use crate::scene::{Face, Hole, Outline};
use glam::{DVec2, DVec3};

/// A hole as a convex counter-clockwise polygon in the two axes of its face, m.
#[derive(Debug, Clone)]
pub(super) struct HoleOutline {
    pub name: String,
    pub face: Face,
    center: DVec2,
    points: Vec<DVec2>,
}

impl HoleOutline {
    /// The same hole with the two axes exchanged, again counter-clockwise.
    pub fn transposed(&self) -> HoleOutline {
        let points = self.points.iter().rev().map(|p| DVec2::new(p.y, p.x)).collect();
        HoleOutline { center: DVec2::new(self.center.y, self.center.x), points, ..self.clone() }
    }

    pub fn misplaced(&self, subject: &str, what: &str) -> GeometryError {
        GeometryError::Hole { wall: subject.into(), hole: self.name.clone(), what: what.into() }
    }
}

/// The polygons of the holes of a wall.
pub(super) fn outlines(holes: &[Hole], subject: &str) -> Result<Vec<HoleOutline>, GeometryError> {
    let outline = |hole: &Hole| {
        let wrong = |what: String| GeometryError::Hole { wall: subject.into(), hole: hole.name.clone(), what };
        let center = DVec2::from(hole.center);
        let points = match hole.outline {
            Outline::Rectangle { size } => {
                if !size.iter().all(|s| s.is_finite() && *s > 0.0) {
                    return Err(wrong(format!("needs a positive size, found {size:?}")));
                }
                let half = DVec2::from(size) / 2.0;
                [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                    .map(|(a, b)| center + half * DVec2::new(a, b))
                    .to_vec()
            }
            Outline::Circle { diameter, segments } => {
                if !(diameter.is_finite() && diameter > 0.0 && (3..=4096).contains(&segments)) {
                    return Err(wrong(format!(
                        "needs a positive diameter and 3 to 4096 segments, found {diameter} and {segments}"
                    )));
                }
                let step = std::f64::consts::TAU / f64::from(segments);
                // The corner radius whose polygon, n/2 r^2 sin(2 pi / n), has the circle's area.
                let area = std::f64::consts::PI * diameter * diameter / 4.0;
                let radius = (2.0 * area / (f64::from(segments) * libm::sin(step))).sqrt();
                (0..segments)
                    .map(|i| step * f64::from(i))
                    .map(|angle| center + radius * DVec2::new(libm::cos(angle), libm::sin(angle)))
                    .collect()
            }
        };
        if !center.is_finite() {
            return Err(wrong("needs a finite centre".into()));
        }
        Ok(HoleOutline { name: hole.name.clone(), face: hole.face, center, points })
    };
    holes.iter().map(outline).collect()
}

/// The holes of a wall.
#[derive(Debug, Clone, Copy)]
pub(super) struct WallHoles<'a> {
    pub outlines: &'a [HoleOutline],
    /// The wall's index, and its name in errors.
    pub wall: u32,
    pub subject: &'a str,
}

/// Right-handed axes of a sheet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub origin: DVec3,
    pub u: DVec3,
    pub v: DVec3,
    pub n: DVec3,
}

impl Frame {
    /// From a normal and a direction in the plane, made orthonormal; `None` when they are parallel.
    pub fn new(origin: DVec3, normal: DVec3, u: DVec3) -> Option<Frame> {
        let n = normal.try_normalize()?;
        let v = n.cross(u.try_normalize()?);
        if v.length() < 1e-6 {
            return None;
        }
        let v = v.normalize();
        Some(Frame { origin, u: v.cross(n), v, n })
    }

    pub fn point(&self, plane: DVec2, level: f64) -> DVec3 {
        self.origin + self.u * plane.x + self.v * plane.y + self.n * level
    }

    fn plane(&self, point: DVec3) -> DVec2 {
        DVec2::new((point - self.origin).dot(self.u), (point - self.origin).dot(self.v))
    }
}

/// Two rectangles over one another, from the level of `lower` to that of `upper` along the frame's normal.
pub(super) struct Plate {
    pub frame: Frame,
    pub lower: Sheet,
    pub upper: Sheet,
    /// Of the walls of the holes.
    pub side_face: Option<Face>,
}

/// One of its two sides.
pub(super) struct Sheet {
    /// m.
    pub level: f64,
    /// The vertices of the rectangle, counter-clockwise seen from above.
    pub corners: [u32; 4],
    pub face: Option<Face>,
}

impl Plate {
    /// Adds the lower sheet (normal downwards), the upper one and the walls of the holes.
    pub fn add_to(&self, mesh: &mut WallMesh, holes: WallHoles<'_>) -> Result<(), GeometryError> {
        let WallHoles { outlines, wall, subject } = holes;
        // The lower rectangle is the smaller one where they differ: a hole must end in the cavity.
        let rectangle = self.lower.corners.map(|k| self.frame.plane(mesh.vertices[k as usize]));
        check_apart(&rectangle, outlines, subject)?;
        let low = self.sheet(mesh, &self.lower, holes, true)?;
        let high = self.sheet(mesh, &self.upper, holes, false)?;
        let mut first = 0;
        for hole in outlines {
            let n = hole.points.len();
            for i in 0..n {
                let (a, b) = (first + i, first + (i + 1) % n);
                mesh.quad([low[b], low[a], high[a], high[b]], self.side_face);
            }
            first += n;
            let middle = (self.lower.level + self.upper.level) / 2.0;
            mesh.holes.push(FoundHole {
                name: hole.name.clone(),
                wall,
                center: self.frame.point(hole.center, middle).to_array(),
                normal: self.frame.n.to_array(),
                thickness: self.upper.level - self.lower.level,
                area: area(&hole.points),
                perimeter: perimeter(&hole.points),
                outline: hole.points.iter().map(|&corner| self.frame.point(corner, middle).to_array()).collect(),
            });
        }
        Ok(())
    }

    /// One pierced rectangle; returns the new vertices of the holes in order.
    fn sheet(
        &self,
        mesh: &mut WallMesh,
        sheet: &Sheet,
        holes: WallHoles<'_>,
        downwards: bool,
    ) -> Result<Vec<u32>, GeometryError> {
        let &Sheet { level, corners, face } = sheet;
        let rings: Vec<Vec<DVec2>> = holes.outlines.iter().map(|hole| hole.points.clone()).collect();
        let rectangle = corners.map(|k| self.frame.plane(mesh.vertices[k as usize]));
        let triangles = triangulate(&rectangle, &rings).ok_or_else(|| GeometryError::Shape {
            wall: holes.subject.into(),
            what: "the holes of a face lie too close together".into(),
        })?;
        let rim: Vec<u32> = rings.iter().flatten().map(|p| mesh.vertex(self.frame.point(*p, level))).collect();
        let vertex = |k: u32| corners.get(k as usize).copied().unwrap_or_else(|| rim[k as usize - corners.len()]);
        for t in triangles {
            let [a, b, c] = t.map(vertex);
            mesh.triangle(if downwards { [a, c, b] } else { [a, b, c] }, face);
        }
        Ok(rim)
    }
}

/// Every hole strictly within the rectangle and clear of every other.
fn check_apart(rectangle: &[DVec2; 4], holes: &[HoleOutline], subject: &str) -> Result<(), GeometryError> {
    let extent = rectangle[0].distance(rectangle[2]);
    for (i, hole) in holes.iter().enumerate() {
        let inside = |p: &DVec2| {
            (0..4).all(|k| {
                let (a, b) = (rectangle[k], rectangle[(k + 1) % 4]);
                (b - a).perp_dot(*p - a) / (b - a).length() > 1e-6 * extent
            })
        };
        if !hole.points.iter().all(inside) {
            return Err(hole.misplaced(subject, "does not lie within its face"));
        }
        if let Some(other) = holes[..i].iter().find(|other| convex_overlap(&hole.points, &other.points)) {
            return Err(hole.misplaced(subject, &format!("overlaps hole `{}`", other.name)));
        }
    }
    Ok(())
}
