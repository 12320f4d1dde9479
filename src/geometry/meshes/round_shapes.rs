//! Cylinders and spheres whose nodes lie on the round surface (walls of scenes keep the volume instead).

use super::mesh::TriangleMesh;
use crate::geometry::round::polyhedron;
use crate::geometry::soup::PartOf;
use glam::DVec3;
use std::f64::consts::TAU;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ends {
    Open,
    Closed,
}

/// About z, its middle in the origin; diagonals alternate.
pub(super) fn cylinder(radius: f64, height: f64, [around, along]: [u32; 2], ends: Ends) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let (n, m) = (around as usize, along as usize);
    let side = mesh.part("side");
    let levels: Vec<Vec<u32>> = (0..=m)
        .map(|level| {
            let z = height * (level as f64 / m as f64 - 0.5);
            ring(&mut mesh, radius, z, n)
        })
        .collect();
    for (j, i) in (0..m).flat_map(|j| (0..n).map(move |i| (j, i))) {
        let next = (i + 1) % n;
        let [a, b, c, d] = [levels[j][i], levels[j][next], levels[j + 1][next], levels[j + 1][i]];
        let pair = if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
        pair.into_iter().for_each(|corners| mesh.triangle(corners, side));
    }
    if ends == Ends::Closed {
        let (base, top) = (mesh.part("base"), mesh.part("top"));
        disc(&mut mesh, &levels[0], base);
        // Seen from +z the base's triangles go round counter-clockwise; its normal is against z.
        mesh.triangles.iter_mut().zip(&mesh.parts).filter(|(_, part)| **part == base).for_each(|(t, _)| t.swap(1, 2));
        disc(&mut mesh, &levels[m], top);
    }
    mesh
}

/// `count` nodes around z.
fn ring(mesh: &mut TriangleMesh, radius: f64, z: f64, count: usize) -> Vec<u32> {
    let node = |k: usize| {
        let angle = TAU * (k as f64 / count as f64);
        DVec3::new(radius * libm::cos(angle), radius * libm::sin(angle), z)
    };
    (0..count).map(|k| mesh.node(node(k))).collect()
}

/// A disc within a rim, in rings of about as many nodes as they are long; counter-clockwise seen from +z.
fn disc(mesh: &mut TriangleMesh, rim: &[u32], part: PartOf) {
    let [x, y, z] = mesh.nodes[rim[0] as usize];
    let radius = libm::hypot(x, y);
    let rings = ((rim.len() as f64 / TAU).round() as usize).max(1);
    let mut outer = rim.to_vec();
    for k in (1..rings).rev() {
        let share = k as f64 / rings as f64;
        let count = ((rim.len() as f64 * share).round() as usize).max(3);
        let inner = ring(mesh, radius * share, z, count);
        strip(mesh, &inner, &outer, part);
        outer = inner;
    }
    let middle = mesh.node(DVec3::new(0.0, 0.0, z));
    for k in 0..outer.len() {
        mesh.triangle([middle, outer[k], outer[(k + 1) % outer.len()]], part);
    }
}

/// Triangles between two rings that begin at the same angle: the one that lags behind goes on.
fn strip(mesh: &mut TriangleMesh, inner: &[u32], outer: &[u32], part: PartOf) {
    let (p, q) = (inner.len(), outer.len());
    let (mut i, mut j) = (0, 0);
    while i < p || j < q {
        // Compares the angles of the next nodes, (i + 1)/p and (j + 1)/q.
        if i == p || (j < q && (j + 1) * p <= (i + 1) * q) {
            mesh.triangle([inner[i % p], outer[j], outer[(j + 1) % q]], part);
            j += 1;
        } else {
            mesh.triangle([inner[i], outer[j % q], inner[(i + 1) % p]], part);
            i += 1;
        }
    }
}

pub(super) fn sphere(radius: f64, subdivisions: u32) -> TriangleMesh {
    let ball = polyhedron(subdivisions);
    let mut mesh = TriangleMesh::default();
    let part = mesh.part("sphere");
    for direction in ball.directions {
        mesh.node(direction * radius);
    }
    ball.triangles.into_iter().for_each(|corners| mesh.triangle(corners, part));
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closed_cylinder_is_the_prism() {
        for (around, along) in [(3, 1), (4, 3), (7, 2), (48, 10)] {
            let mesh = cylinder(0.1, 0.4, [around, along], Ends::Closed);
            assert_eq!(mesh.check_closed("c"), Ok(()));
            let end = 0.5 * f64::from(around) * 0.01 * libm::sin(TAU / f64::from(around));
            assert!((mesh.volume() / (0.4 * end) - 1.0).abs() < 1e-13, "{around}");
            let parts = mesh.measures();
            assert_eq!(parts.iter().map(|part| part.name.as_str()).collect::<Vec<_>>(), ["side", "base", "top"]);
            assert_eq!(parts[0].triangles, 2 * (around * along) as usize);
            for cap in &parts[1..] {
                // Flat and without overlaps: no triangle is turned the other way.
                assert!((cap.area / end - 1.0).abs() < 1e-13, "{around}: {} {end}", cap.area);
            }
        }
    }

    #[test]
    fn an_open_cylinder_has_two_rims() {
        let mesh = cylinder(0.1, 0.4, [12, 3], Ends::Open);
        assert!(!mesh.is_closed() && mesh.names == ["side"]);
        let error = mesh.check_closed("c").unwrap_err();
        assert!(matches!(error, crate::geometry::GeometryError::OpenEdges { count: 24, .. }), "{error}");
    }

    #[test]
    fn a_sphere_has_its_nodes_on_the_sphere() {
        let mut off = Vec::new();
        for subdivisions in 0..=4 {
            let mesh = sphere(0.3, subdivisions);
            assert_eq!(mesh.check_closed("s"), Ok(()));
            assert_eq!(mesh.triangles.len(), 20 << (2 * subdivisions));
            assert!(mesh.nodes.iter().all(|&p| (DVec3::from(p).length() - 0.3).abs() < 1e-15));
            off.push(1.0 - mesh.volume() / (4.0 / 3.0 * std::f64::consts::PI * 0.027));
        }
        // Second order: each subdivision quarters what is missing.
        assert!(off[4] > 0.0 && off[4] < 0.005 && (off[3] / off[4] - 4.0).abs() < 0.1, "{off:?}");
    }
}
