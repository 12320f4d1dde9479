//! Bags of two flat sheets that are sewn along their rim.
//!
//! The rim's nodes are shared, at z = 0. All others lie in the planes z = +-gap/2, mirrored between the sheets, as are
//! their triangles. No triangle has all three corners on the rim: it would lie in both sheets.

use super::mesh::TriangleMesh;
use crate::geometry::soup::PartOf;
use glam::DVec3;
use std::f64::consts::TAU;

/// One of the two sheets.
struct Sheet<'a> {
    /// Nodes by their place in the cut.
    nodes: &'a [u32],
    part: PartOf,
    /// Its normal is against z.
    lower: bool,
}

impl Sheet<'_> {
    /// A triangle of places in the cut, counter-clockwise seen from +z.
    fn add(&self, mesh: &mut TriangleMesh, corners: [usize; 3]) {
        let [a, b, c] = corners.map(|k| self.nodes[k]);
        mesh.triangle(if self.lower { [a, c, b] } else { [a, b, c] }, self.part);
    }
}

/// Both sheets of a cut: places in the plane, which of them are on the rim, and triangles counter-clockwise.
fn sewn(places: &[[f64; 2]], on_rim: impl Fn(usize) -> bool, cut: &[[usize; 3]], gap: f64) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let upper: Vec<u32> = places
        .iter()
        .enumerate()
        .map(|(k, &[x, y])| mesh.node(DVec3::new(x, y, if on_rim(k) { 0.0 } else { gap / 2.0 })))
        .collect();
    let lower: Vec<u32> = places
        .iter()
        .enumerate()
        .map(|(k, &[x, y])| if on_rim(k) { upper[k] } else { mesh.node(DVec3::new(x, y, -gap / 2.0)) })
        .collect();
    let sheets = [
        Sheet { nodes: &upper, part: mesh.part("upper"), lower: false },
        Sheet { nodes: &lower, part: mesh.part("lower"), lower: true },
    ];
    for sheet in &sheets {
        cut.iter().for_each(|&corners| sheet.add(&mut mesh, corners));
    }
    mesh
}

/// Diagonals alternate between neighbouring squares; those of the four corners begin in the corner.
pub(super) fn teabag(side: f64, elements: u32, gap: f64) -> TriangleMesh {
    let n = elements as usize;
    let at = |k: usize| side * (k as f64 / n as f64 - 0.5);
    let number = |i: usize, j: usize| j * (n + 1) + i;
    let places: Vec<[f64; 2]> = (0..=n).flat_map(|j| (0..=n).map(move |i| [at(i), at(j)])).collect();
    let mut cut = Vec::with_capacity(2 * n * n);
    for (j, i) in (0..n).flat_map(|j| (0..n).map(move |i| (j, i))) {
        let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
        let rising = match ([0, n - 1].contains(&i), [0, n - 1].contains(&j)) {
            (true, true) => (i == 0) == (j == 0),
            _ => (i + j) % 2 == 0,
        };
        cut.extend(if rising { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
    }
    let on_rim = |k: usize| [k % (n + 1), k / (n + 1)].iter().any(|&x| x == 0 || x == n);
    sewn(&places, on_rim, &cut, gap)
}

/// Ring k of `rings` has 6 k nodes.
pub(super) fn cushion(radius: f64, rings: u32, gap: f64) -> TriangleMesh {
    let rings = rings as usize;
    let first = |ring: usize| if ring == 0 { 0 } else { 1 + 3 * ring * (ring - 1) };
    let node = |ring: usize, k: usize| if ring == 0 { 0 } else { first(ring) + k % (6 * ring) };
    let mut places = vec![[0.0, 0.0]];
    for (ring, k) in (1..=rings).flat_map(|ring| (0..6 * ring).map(move |k| (ring, k))) {
        let (r, angle) = (radius * (ring as f64 / rings as f64), TAU * (k as f64 / (6 * ring) as f64));
        places.push([r * libm::cos(angle), r * libm::sin(angle)]);
    }
    let mut cut = Vec::with_capacity(6 * rings * rings);
    for (ring, sector) in (1..=rings).flat_map(|ring| (0..6).map(move |sector| (ring, sector))) {
        let outer = |k: usize| node(ring, ring * sector + k);
        let inner = |k: usize| node(ring - 1, (ring - 1) * sector + k);
        cut.extend((0..ring).map(|k| [inner(k), outer(k), outer(k + 1)]));
        cut.extend((1..ring).map(|k| [inner(k - 1), outer(k), inner(k)]));
    }
    sewn(&places, |k| k >= first(rings), &cut, gap)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Closed, outwards, no node twice, no triangle with all corners on the rim, and below z what is above it.
    fn check(mesh: &TriangleMesh, gap: f64) {
        assert_eq!(mesh.check_closed("bag"), Ok(()));
        assert!(mesh.volume() > 0.0);
        assert!(mesh.least_distance() >= 0.999 * gap, "{}", mesh.least_distance());
        let z = |v: u32| mesh.nodes[v as usize][2];
        assert!(mesh.triangles.iter().all(|t| t.iter().any(|&v| z(v) != 0.0)));
        let half = mesh.triangles.len() / 2;
        for (above, below) in mesh.triangles[..half].iter().zip(&mesh.triangles[half..]) {
            let mirrored = |v: u32| {
                let [x, y, z] = mesh.nodes[v as usize];
                [x, y, -z]
            };
            let other = [below[0], below[2], below[1]].map(|v| mesh.nodes[v as usize]);
            assert_eq!(above.map(mirrored), other);
        }
    }

    #[test]
    fn a_teabag_is_closed_with_even_and_odd_elements() {
        for n in [2, 3, 4, 7, 20] {
            let mesh = teabag(0.5, n, 0.002);
            check(&mesh, 0.002);
            let n = n as usize;
            assert_eq!(mesh.triangles.len(), 4 * n * n);
            assert_eq!(mesh.nodes.len(), 2 * (n - 1) * (n - 1) + 4 * n);
            let flat: f64 = 2.0 * 0.25;
            assert!(mesh.area() > flat && mesh.area() < 1.01 * flat, "{}", mesh.area());
        }
        // The middle is flat, and beside the seam sheets rise: the frustum's volume, less what its corners lack.
        let (inner, whole) = (0.9f64, 1.0f64);
        let frustum = 0.01 * (inner * inner + inner * whole + whole * whole) / 3.0;
        let volume = teabag(1.0, 20, 0.01).volume();
        assert!((volume / frustum - 1.0).abs() < 1e-3, "{volume} {frustum}");
    }

    /// Elsewhere diagonals alternate: along a row each inner node has four or eight triangles.
    #[test]
    fn diagonals_of_a_teabag_alternate() {
        let mesh = teabag(1.0, 8, 0.01);
        let upper = &mesh.triangles[..mesh.triangles.len() / 2];
        let count = |v: u32| upper.iter().filter(|t| t.contains(&v)).count();
        let inner: Vec<usize> = (1..8).flat_map(|j| (1..8).map(move |i| j * 9 + i)).map(|v| count(v as u32)).collect();
        assert!(inner.iter().all(|&n| n == 4 || n == 8) && inner.windows(2).any(|pair| pair[0] != pair[1]));
    }

    #[test]
    fn a_cushion_is_closed_and_its_rim_is_the_circle() {
        for rings in [1, 2, 3, 12] {
            let mesh = cushion(0.3, rings, 0.003);
            check(&mesh, 0.003);
            let rings = rings as usize;
            assert_eq!(mesh.triangles.len(), 12 * rings * rings);
            let rim: Vec<_> = mesh.nodes.iter().filter(|p| p[2] == 0.0).collect();
            assert_eq!(rim.len(), 6 * rings);
            assert!(rim.iter().all(|p| (libm::hypot(p[0], p[1]) - 0.3).abs() < 1e-15));
        }
        // The polygon of 72 corners.
        let polygon = 36.0 * libm::sin(TAU / 72.0) * 0.09;
        let flat = cushion(0.3, 12, 1e-5).area() / 2.0;
        assert!((flat / polygon - 1.0).abs() < 1e-6, "{flat} {polygon}");
    }
}
