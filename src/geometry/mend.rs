//! What of a mesh from a file can be mended without a doubt, so that a surface is closed that was meant to be.
//!
//! A mesh whose edges all match is left as it is, to the last bit. Any other is mended within the tolerance t, a millionth
//! of the longest side of its box (some thousand quanta of the grid of positions), and at least four units in the last place
//! of an f32 as large as its coordinates:
//!
//! 1. corners nearer than t to an earlier one become that one (rounding of programs that write corners twice);
//! 2. triangles with two equal corners, or lower than t, are left out;
//! 3. an edge that no triangle shares, and on which (within t) lie corners of other such edges, is split at these
//!    (corners in the middle of edges), until there is none.
//!
//! What is open then is a leak.

use super::closed::{is_closed, is_flat};
use super::wall_mesh::{Mended, WallMesh};
use glam::DVec3;
use std::collections::HashMap;

/// Over the longest side of the mesh.
const TOLERANCE: f64 = 1e-6;
/// Over the largest coordinate: four units in the last place of an f32.
const LAST_PLACES: f64 = 4.0 * f32::EPSILON as f64;
/// Each splits one edge of a triangle; a triangle has three, and its parts may be split again.
const MOST_PASSES: usize = 16;

pub(super) fn mend(mesh: &mut WallMesh) {
    let place = |v: u32| mesh.vertices[v as usize];
    let all_finite = mesh.vertices.iter().all(|v| v.is_finite());
    let sound = || !mesh.triangles.iter().any(|t| is_flat(t.map(place))) && is_closed(&mesh.triangles);
    if !all_finite || mesh.triangles.is_empty() || sound() {
        return;
    }
    let (low, high) =
        mesh.vertices.iter().fold((mesh.vertices[0], mesh.vertices[0]), |(a, b), v| (a.min(*v), b.max(*v)));
    let largest = low.abs().max(high.abs()).max_element();
    let tolerance = (TOLERANCE * (high - low).max_element()).max(LAST_PLACES * largest);
    let welded = weld(mesh, tolerance);
    let flat = leave_out_flat(mesh, tolerance);
    let mut split = 0;
    for _ in 0..MOST_PASSES {
        match split_edges(mesh, tolerance) {
            0 => break,
            some => split += some,
        }
    }
    mesh.mended =
        Some(Mended { welded, flat, split, tolerance }).filter(|done| done.welded + done.flat + done.split > 0);
}

/// Corners nearer than this to an earlier one become that one; how many.
fn weld(mesh: &mut WallMesh, tolerance: f64) -> usize {
    let cell_of = |place: DVec3| (place / tolerance).floor().to_array().map(|x| x as i64);
    let mut kept: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut instead: Vec<u32> = Vec::with_capacity(mesh.vertices.len());
    let mut welded = 0;
    for (own, &place) in mesh.vertices.iter().enumerate() {
        let cell = cell_of(place);
        let around = (0..27).map(|k| [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1]);
        let cells = around.map(|step| std::array::from_fn(|axis| cell[axis].saturating_add(step[axis])));
        let others = cells.filter_map(|cell: [i64; 3]| kept.get(&cell)).flatten().copied();
        let near = others.filter(|&other| mesh.vertices[other as usize].distance(place) <= tolerance).min();
        match near {
            Some(other) => welded += usize::from(mesh.vertices[other as usize] != place),
            None => kept.entry(cell).or_default().push(own as u32),
        }
        instead.push(near.unwrap_or(own as u32));
    }
    mesh.triangles.iter_mut().flatten().for_each(|v| *v = instead[*v as usize]);
    welded
}

fn leave_out_flat(mesh: &mut WallMesh, tolerance: f64) -> usize {
    let place = |v: u32| mesh.vertices[v as usize];
    let kept: Vec<bool> = mesh.triangles.iter().map(|t| height(t.map(place)) > tolerance).collect();
    let mut keep = kept.iter();
    mesh.triangles.retain(|_| *keep.next().unwrap_or(&true));
    let mut keep = kept.iter();
    mesh.faces.retain(|_| *keep.next().unwrap_or(&true));
    kept.iter().filter(|kept| !**kept).count()
}

/// Over the longest edge; zero where corners coincide.
fn height([a, b, c]: [DVec3; 3]) -> f64 {
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    if longest == 0.0 { 0.0 } else { (b - a).cross(c - a).length() / longest }
}

/// A directed edge that no other triangle has the other way round.
#[derive(Clone, Copy)]
struct OpenEdge {
    triangle: usize,
    /// From this corner of the triangle to the next.
    corner: usize,
}

/// Splits at most one edge of each triangle; how many.
fn split_edges(mesh: &mut WallMesh, tolerance: f64) -> usize {
    let open = open_edges(&mesh.triangles);
    let mut ends: Vec<u32> =
        open.iter().flat_map(|e| [0, 1].map(|k| mesh.triangles[e.triangle][(e.corner + k) % 3])).collect();
    let x = |v: u32| mesh.vertices[v as usize].x;
    ends.sort_unstable_by(|&a, &b| x(a).total_cmp(&x(b)).then(a.cmp(&b)));
    ends.dedup();
    let mut splits: Vec<(OpenEdge, Vec<u32>)> = Vec::new();
    for &edge in &open {
        if splits.last().is_some_and(|(other, _)| other.triangle == edge.triangle) {
            continue;
        }
        let on_it = corners_on(mesh, &ends, edge, tolerance);
        if !on_it.is_empty() {
            splits.push((edge, on_it));
        }
    }
    for (edge, on_it) in &splits {
        let triangle = mesh.triangles[edge.triangle];
        let [a, b, apex] = [0, 1, 2].map(|k| triangle[(edge.corner + k) % 3]);
        let stops: Vec<u32> = [a].into_iter().chain(on_it.iter().copied()).chain([b]).collect();
        let face = mesh.faces[edge.triangle];
        for (k, part) in stops.windows(2).enumerate() {
            let part = [part[0], part[1], apex];
            if k == 0 {
                mesh.triangles[edge.triangle] = part;
            } else {
                mesh.triangle(part, face);
            }
        }
    }
    splits.len()
}

/// In the order of their triangles.
fn open_edges(triangles: &[[u32; 3]]) -> Vec<OpenEdge> {
    let mut balance: HashMap<(u32, u32), i32> = HashMap::new();
    let sides = |t: &[u32; 3]| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
    for (a, b) in triangles.iter().flat_map(sides) {
        *balance.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
    }
    let open = |&(a, b): &(u32, u32)| balance[&(a.min(b), a.max(b))] != 0;
    let of_triangle = |(triangle, t): (usize, &[u32; 3])| {
        let corners: Vec<usize> = (0..3).filter(|&corner| open(&sides(t)[corner])).collect();
        corners.into_iter().map(move |corner| OpenEdge { triangle, corner })
    };
    triangles.iter().enumerate().flat_map(of_triangle).collect()
}

/// Those of `ends` (by x) that lie on an edge between its own ends, from the first to the second.
fn corners_on(mesh: &WallMesh, ends: &[u32], edge: OpenEdge, tolerance: f64) -> Vec<u32> {
    let place = |v: u32| mesh.vertices[v as usize];
    let triangle = mesh.triangles[edge.triangle];
    let [a, b, apex] = [0, 1, 2].map(|k| triangle[(edge.corner + k) % 3]);
    let (from, way) = (place(a), place(b) - place(a));
    let length = way.length();
    let [low, high] = [from.x.min(place(b).x) - tolerance, from.x.max(place(b).x) + tolerance];
    let start = ends.partition_point(|&v| place(v).x < low);
    let mut found: Vec<(f64, u32)> = ends[start..]
        .iter()
        .take_while(|&&v| place(v).x <= high)
        .filter(|&&v| v != a && v != b && v != apex)
        .filter_map(|&v| {
            let along = (place(v) - from).dot(way) / length;
            let off = (place(v) - from - way * (along / length)).length();
            (off <= tolerance && along > tolerance && along < length - tolerance).then_some((along, v))
        })
        .collect();
    found.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
    found.into_iter().map(|(_, v)| v).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::closed::{area, check_closed, signed_volume};

    fn tetrahedron() -> WallMesh {
        let mut mesh = WallMesh { vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z], ..WallMesh::default() };
        for t in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
            mesh.triangle(t, None);
        }
        mesh
    }

    fn volume_of_mended(mut mesh: WallMesh) -> (f64, Option<Mended>) {
        mend(&mut mesh);
        assert_eq!(check_closed("t", &mesh.vertices, &mesh.triangles), Ok(()));
        assert!((area(&mesh.vertices, &mesh.triangles) - (1.5 + 0.75f64.sqrt())).abs() < 1e-5);
        (signed_volume(&mesh.vertices, &mesh.triangles), mesh.mended)
    }

    #[test]
    fn a_sound_mesh_is_left_alone() {
        let mut mesh = tetrahedron();
        mend(&mut mesh);
        assert_eq!((mesh.triangles, mesh.mended), (tetrahedron().triangles, None));
    }

    #[test]
    fn corners_that_differ_by_rounding_are_one() {
        let mut mesh = tetrahedron();
        mesh.vertices.push(DVec3::X + 1e-9);
        mesh.triangles[3][0] = 4;
        let (volume, mended) = volume_of_mended(mesh);
        assert!((volume - 1.0 / 6.0).abs() < 1e-15);
        assert!(mended.is_some_and(|done| (done.welded, done.flat, done.split) == (1, 0, 0)), "{mended:?}");
        // Beyond the tolerance it is a leak.
        let mut mesh = tetrahedron();
        mesh.vertices.push(DVec3::X + 1e-5);
        mesh.triangles[3][0] = 4;
        mend(&mut mesh);
        assert_eq!(mesh.mended, None);
        assert!(check_closed("t", &mesh.vertices, &mesh.triangles).is_err());
    }

    /// Two corners in an edge of the one neighbour, one of them in both of its edges, and a triangle without area.
    #[test]
    fn edges_are_split_where_a_neighbour_has_a_corner() {
        let mut mesh = tetrahedron();
        mesh.vertices.extend([DVec3::X * 0.25, DVec3::X * 0.5, DVec3::Z * 0.5]);
        // (0, 2, 1) keeps its edge 1 to 0; (0, 1, 3) has corners in two of its edges.
        mesh.triangles[1] = [0, 4, 6];
        for t in [[4, 5, 6], [5, 1, 6], [1, 3, 6], [0, 4, 1]] {
            mesh.triangle(t, None);
        }
        let (volume, mended) = volume_of_mended(mesh);
        assert!((volume - 1.0 / 6.0).abs() < 1e-15, "{volume}");
        assert!(mended.is_some_and(|done| (done.welded, done.flat, done.split) == (0, 1, 2)), "{mended:?}");
    }
}
