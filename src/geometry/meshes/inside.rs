//! Which points a closed mesh encloses.
//!
//! A point is inside where a ray from it along +x crosses the surface an odd number of times. Which triangles the ray
//! passes is decided in integers ([`LineIndex`]): y and z are rounded to 2^-48 of the mesh's extent, and a ray through an
//! edge or a node counts as moved by an infinitesimal. So of the triangles around an edge that it grazes it passes just
//! those that one ray beside it would pass. Only for points nearer to the surface than rounding the answer is either.

use super::mesh::TriangleMesh;
use crate::geometry::GeometryError;
use crate::geometry::closed::check_edges;
use crate::geometry::lines::LineIndex;
use crate::geometry::sampling::map;
use glam::DVec3;

/// Points that a thread takes at a time.
const CHUNK: usize = 1024;

/// A closed surface that is asked for many points.
#[derive(Debug, Clone)]
pub struct ClosedSurface {
    lines: LineIndex,
}

impl ClosedSurface {
    /// The surface of `triangles` with their nodes at `nodes` (m): not those of a mesh at rest, but where they are now.
    ///
    /// # Errors
    /// It is not closed, or a node is not finite; `subject` names it.
    pub fn new(nodes: &[[f64; 3]], triangles: &[[u32; 3]], subject: &str) -> Result<ClosedSurface, GeometryError> {
        let places: Vec<DVec3> = nodes.iter().copied().map(DVec3::from).collect();
        check_edges(subject, &places, triangles)?;
        let used = || triangles.iter().flatten().map(|&v| places[v as usize]);
        let (low, high) = used().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
        let lines = LineIndex::new(&places, triangles.iter().map(|&t| (t, 0)), low, high);
        Ok(ClosedSurface { lines })
    }

    /// Whether it encloses a point (m); a place that is no number is outside.
    pub fn contains(&self, [x, y, z]: [f64; 3]) -> bool {
        let mut crossings = 0u32;
        self.lines.cross(y, z, |crossing| crossings += u32::from(crossing.x > x));
        crossings % 2 == 1
    }

    /// What of the line along x through (y, z) it encloses, from and to, m.
    pub fn within(&self, y: f64, z: f64) -> Vec<(f64, f64)> {
        let mut crossings = Vec::new();
        self.lines.cross(y, z, |crossing| crossings.push(crossing.x));
        crossings.sort_by(f64::total_cmp);
        crossings.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect()
    }

    /// Of each point, on all cores.
    pub fn inside(&self, points: &[[f64; 3]]) -> Vec<bool> {
        let chunk = |k: usize| &points[k * CHUNK..points.len().min((k + 1) * CHUNK)];
        let answers = map(points.len().div_ceil(CHUNK), |k, _| {
            chunk(k).iter().map(|&point| self.contains(point)).collect::<Vec<bool>>()
        });
        answers.into_iter().flatten().collect()
    }
}

/// Which of the points a closed mesh encloses.
///
/// # Errors
/// It is not closed.
pub fn inside(points: &[[f64; 3]], mesh: &TriangleMesh) -> Result<Vec<bool>, GeometryError> {
    Ok(ClosedSurface::new(&mesh.nodes, &mesh.triangles, "the mesh")?.inside(points))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::sampling::r2;
    use crate::geometry::{MeshShape, Motion};

    /// A lattice whose lines pass nodes, edges and diagonals of a bag: the heights decide.
    #[test]
    fn rays_through_nodes_and_edges_are_not_mistaken() {
        let (side, gap, n) = (1.0, 0.1, 4);
        let bag = MeshShape::Teabag { side, elements: n, gap }.mesh([0.0; 3]).unwrap();
        let share = |k: i32| f64::from(k) / 16.0 - 0.75;
        let points: Vec<[f64; 3]> = (0..25 * 25)
            .flat_map(|k| [-0.2, -0.04, 0.0, 0.04, 0.2].map(|z| [share(k % 25), share(k / 25), z]))
            .collect();
        let found = inside(&points, &bag).unwrap();
        let mut count = 0;
        for (point, found) in points.iter().zip(found) {
            let [x, y, z] = *point;
            // Within the outermost row sheets rise linearly with the distance from the seam; in corners, too.
            let rise = ((0.5 - x.abs()).min(0.5 - y.abs()) * f64::from(n)).min(1.0);
            let expected = rise > 0.0 && z.abs() < 0.5 * gap * rise;
            let on_it = (z.abs() - 0.5 * gap * rise.max(0.0)).abs() < 1e-9 && rise >= 0.0;
            assert!(on_it || found == expected, "{point:?}: {found}");
            count += usize::from(expected);
        }
        // Of 15 x 15 lines within the seam all at z = 0; above and below those of 9 x 9 where it is that high.
        assert_eq!(count, 225 + 2 * 81);
    }

    /// Against the distance from the centre, with a hollow: a sphere turned inwards within another.
    #[test]
    fn a_hollow_is_outside() {
        let mut mesh = MeshShape::Sphere { radius: 1.0, subdivisions: 3 }.mesh([0.0; 3]).unwrap();
        let hollow = MeshShape::Sphere { radius: 0.5, subdivisions: 3 }.mesh([0.0; 3]).unwrap();
        let first = mesh.nodes.len() as u32;
        mesh.nodes.extend(hollow.nodes);
        mesh.triangles.extend(hollow.triangles.iter().map(|t| [t[0] + first, t[2] + first, t[1] + first]));
        let surface = ClosedSurface::new(&mesh.nodes, &mesh.triangles, "hollow").unwrap();
        let along = DVec3::new(0.6, 0.0, 0.8);
        for (r, expected) in [(0.0, false), (0.48, false), (0.52, true), (0.97, true), (1.01, false)] {
            for way in [along, -along, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE.normalize()] {
                assert_eq!(surface.contains((way * r).to_array()), expected, "{r} {way}");
            }
        }
        assert!(!surface.contains([f64::NAN, 0.0, 0.0]) && !surface.contains([0.75, f64::NAN, 0.0]));
    }

    /// Against the solid angle under which a point sees the surface (van Oosterom and Strackee 1983), of a bag whose nodes
    /// are anywhere near their places.
    #[test]
    fn points_agree_with_the_solid_angle() {
        let bag = MeshShape::Teabag { side: 1.0, elements: 6, gap: 0.2 }.mesh([0.0; 3]).unwrap();
        let shake = Motion::Shake { speed: 1.0, amplitude: Some(0.05), seed: 7 };
        let nodes = shake.frames(&bag, 30, 1.0).unwrap().at(0.9);
        let surface = ClosedSurface::new(&nodes, &bag.triangles, "bag").unwrap();
        let points: Vec<[f64; 3]> = (0..3000)
            .map(|i| {
                let [x, y] = r2(i);
                [1.2 * x - 0.6, 1.2 * y - 0.6, 0.4 * r2(7 * i + 3)[0] - 0.2]
            })
            .collect();
        let winding = |point: &[f64; 3]| {
            let angle = |t: &[u32; 3]| {
                let [a, b, c] = t.map(|v| DVec3::from(nodes[v as usize]) - DVec3::from(*point));
                let (p, q, r) = (a.length(), b.length(), c.length());
                2.0 * libm::atan2(a.dot(b.cross(c)), p * q * r + a.dot(b) * r + b.dot(c) * p + c.dot(a) * q)
            };
            bag.triangles.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
        };
        let found = surface.inside(&points);
        for (point, found) in points.iter().zip(&found) {
            assert!((winding(point) - f64::from(u8::from(*found))).abs() < 1e-6, "{point:?} {found}");
        }
        let share = found.iter().filter(|found| **found).count() as f64 / 3000.0;
        let volume = TriangleMesh { nodes, ..bag }.volume();
        assert!((share * 1.2 * 1.2 * 0.4 / volume - 1.0).abs() < 0.05, "{share} {volume}");
    }

    #[test]
    fn an_open_surface_is_refused() {
        let shape = MeshShape::Cylinder { radius: 1.0, height: 1.0, around: 8, along: Some(2), closed: false };
        let open = shape.mesh([0.0; 3]).unwrap();
        let error = inside(&[[0.0; 3]], &open).unwrap_err();
        assert!(matches!(error, GeometryError::OpenEdges { count: 16, .. }), "{error}");
    }
}
