//! Round bodies as facets. They keep their volume: the corners lie as far outside of the round surface as it takes, so
//! that facets lie on both sides of it. With a = 2 pi / n, a prism of n facets has the radius R sqrt(a / sin a) to its corners; a
//! sphere the cube root of its volume over that of the polyhedron inscribed in it.

use super::wall_mesh::WallMesh;
use crate::scene::{Face, Shape};
use glam::DVec3;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// How a round body is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facets {
    pub count: u32,
    /// The largest distance of a point of them from the round surface, over its radius.
    pub stray: f64,
}

/// The facets of a body that is round, of its curved side.
pub fn facets(shape: &Shape) -> Option<Facets> {
    match shape {
        Shape::Cylinder { segments, .. } => {
            let corner = corner_over_radius(*segments);
            let middle = corner * libm::cos(PI / f64::from(*segments));
            Some(Facets { count: *segments, stray: (corner - 1.0).max(1.0 - middle) })
        }
        Shape::Sphere { subdivisions, .. } => {
            let ball = polyhedron(*subdivisions);
            let corner = ball.corner_over_radius();
            let nearest = ball.triangles.iter().map(|t| {
                let [a, b, c] = t.map(|k| ball.directions[k as usize]);
                a.dot((b - a).cross(c - a).normalize())
            });
            let nearest = corner * nearest.fold(1.0, f64::min);
            Some(Facets { count: ball.triangles.len() as u32, stray: (corner - 1.0).max(1.0 - nearest) })
        }
        Shape::Box { .. } | Shape::Plane { .. } | Shape::Mesh { .. } => None,
    }
}

fn corner_over_radius(segments: u32) -> f64 {
    let step = TAU / f64::from(segments);
    (step / libm::sin(step)).sqrt()
}

pub(super) fn cylinder(base: DVec3, axis: DVec3, radius: f64, height: f64, segments: u32) -> WallMesh {
    let radius = radius * corner_over_radius(segments);
    let mut mesh = WallMesh::default();
    // The coordinate axis furthest from the cylinder's: exact rims for a cylinder along x, y or z.
    let least = (0..3).min_by(|&a, &b| axis[a].abs().total_cmp(&axis[b].abs())).unwrap_or(0);
    let u = (DVec3::AXES[least] - axis * axis[least]).normalize();
    let v = axis.cross(u);
    let mut rim = |level: f64| -> Vec<u32> {
        (0..segments)
            .map(|i| {
                let angle = std::f64::consts::TAU * f64::from(i) / f64::from(segments);
                let out = u * libm::cos(angle) + v * libm::sin(angle);
                mesh.vertex(base + axis * level + out * radius)
            })
            .collect()
    };
    let (low, high) = (rim(0.0), rim(height));
    let (bottom, top) = (mesh.vertex(base), mesh.vertex(base + axis * height));
    for i in 0..segments as usize {
        let next = (i + 1) % segments as usize;
        mesh.quad([low[i], low[next], high[next], high[i]], Some(Face::Side));
        mesh.triangle([bottom, low[next], low[i]], Some(Face::Base));
        mesh.triangle([top, high[i], high[next]], Some(Face::Top));
    }
    mesh
}

/// Unit directions and the triangles between them.
pub(super) struct Polyhedron {
    pub directions: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
}

impl Polyhedron {
    /// How far a corner is from the centre where the volume is that of a sphere of the radius 1.
    fn corner_over_radius(&self) -> f64 {
        let of_triangle = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|k| self.directions[k as usize]);
            a.dot(b.cross(c)) / 6.0
        };
        let volume: f64 = self.triangles.iter().map(of_triangle).sum();
        libm::cbrt(4.0 / 3.0 * PI / volume)
    }
}

pub(super) fn sphere(center: DVec3, radius: f64, subdivisions: u32) -> WallMesh {
    let ball = polyhedron(subdivisions);
    let radius = radius * ball.corner_over_radius();
    let mut mesh = WallMesh::default();
    for direction in ball.directions {
        mesh.vertex(center + direction * radius);
    }
    for t in ball.triangles {
        mesh.triangle(t, None);
    }
    mesh
}

/// An icosahedron whose triangles are quartered `subdivisions` times.
pub(super) fn polyhedron(subdivisions: u32) -> Polyhedron {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let mut directions: Vec<DVec3> = Vec::new();
    for axis in 0..3 {
        for (a, b) in [(-1.0, -golden), (1.0, -golden), (-1.0, golden), (1.0, golden)] {
            let mut p = DVec3::ZERO;
            p[(axis + 1) % 3] = a;
            p[(axis + 2) % 3] = b;
            directions.push(p.normalize());
        }
    }
    let mut triangles = icosahedron(&directions);
    for _ in 0..subdivisions {
        let mut middles: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        let mut finer = Vec::with_capacity(4 * triangles.len());
        for t in &triangles {
            let middle = [0, 1, 2].map(|k| {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    directions.push((directions[a as usize] + directions[b as usize]).normalize());
                    (directions.len() - 1) as u32
                })
            });
            finer.extend([
                [t[0], middle[0], middle[2]],
                [middle[0], t[1], middle[1]],
                [middle[2], middle[1], t[2]],
                middle,
            ]);
        }
        triangles = finer;
    }
    Polyhedron { directions, triangles }
}

/// The 20 faces: triples of vertices at the edge length, the shortest distance there is.
fn icosahedron(directions: &[DVec3]) -> Vec<[u32; 3]> {
    let near = |a: usize, b: usize| directions[a].dot(directions[b]) > 0.4;
    let n = directions.len();
    let mut faces = Vec::new();
    for a in 0..n {
        for b in a + 1..n {
            for c in b + 1..n {
                if near(a, b) && near(b, c) && near(c, a) {
                    let outwards = directions[a].dot(directions[b].cross(directions[c])) > 0.0;
                    faces.push(if outwards { [a, b, c] } else { [a, c, b] }.map(|v| v as u32));
                }
            }
        }
    }
    faces
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The area of a prism's polygon, and the volume of a polyhedron, are those of the round body.
    #[test]
    fn facets_keep_the_volume() {
        for segments in [3, 4, 48, 1024] {
            let r = corner_over_radius(segments);
            let area = 0.5 * f64::from(segments) * r * r * libm::sin(TAU / f64::from(segments));
            assert!((area / PI - 1.0).abs() < 1e-13, "{segments}: {area}");
        }
        // The icosahedron in a sphere of radius 1 has 2.5362 (handbooks), of 4.18879.
        assert!((polyhedron(0).corner_over_radius() - (4.188_790 / 2.536_151f64).cbrt()).abs() < 1e-6);
        assert!(polyhedron(5).corner_over_radius() - 1.0 < 1e-3);
    }

    /// Facets lie on both sides of the surface; finer ones nearer to it. Those of a hexagon: corners at 1.0996, middles at .9523.
    #[test]
    fn facets_stray_from_the_surface() {
        let cylinder = |segments| {
            let axis = [0.0, 0.0, 1.0];
            facets(&Shape::Cylinder { base: [0.0; 3], axis, radius: 2.0, height: 1.0, segments }).unwrap()
        };
        assert!((cylinder(6).stray - 0.0996).abs() < 1e-3 && cylinder(6).count == 6);
        assert!(cylinder(48).stray < 2e-3);
        let sphere = |subdivisions| facets(&Shape::Sphere { center: [0.0; 3], radius: 2.0, subdivisions }).unwrap();
        assert_eq!([0, 1, 3].map(|k| sphere(k).count), [20, 80, 1280]);
        assert!(sphere(1).stray > 0.04 && sphere(3).stray < 0.01, "{:?} {:?}", sphere(1), sphere(3));
        assert!(facets(&Shape::Box { min: [0.0; 3], max: [1.0; 3], thickness: None, holes: vec![] }).is_none());
    }
}
