//! Is a triangle mesh the surface of a solid? Watertight, consistently oriented, without degenerate triangles.
//!
//! A mesh is closed when each directed edge (a, b) of a triangle is met by exactly one (b, a) of another.
//! Several disjoint parts are allowed. The signed volume is positive when the normals point outwards.

use super::error::{GeometryError, Places};
use glam::DVec3;

/// Twice the area over the square of the longest edge, below which a triangle counts as degenerate.
const FLAT: f64 = 1e-12;

/// Checks that `triangles` (indices into `vertices`, m) form closed, consistently oriented surfaces.
/// `wall` names the wall in the error.
pub fn check_closed(wall: &str, vertices: &[DVec3], triangles: &[[u32; 3]]) -> Result<(), GeometryError> {
    let wall = wall.to_string();
    if triangles.is_empty() {
        return Err(GeometryError::Empty { wall });
    }
    let bad: Vec<usize> = (0..vertices.len()).filter(|&v| !vertices[v].is_finite()).collect();
    if !bad.is_empty() {
        let first = Places::of(bad.iter().map(|&v| vec![vertices[v]]), "");
        return Err(GeometryError::NotFinite { wall, count: bad.len(), first });
    }
    let flat: Vec<[DVec3; 3]> =
        triangles.iter().map(|t| t.map(|v| vertices[v as usize])).filter(|corners| is_flat(*corners)).collect();
    if !flat.is_empty() {
        let first = Places::of(flat.iter().map(|corners| corners.to_vec()), "");
        return Err(GeometryError::Degenerate { wall, count: flat.len(), first });
    }
    check_edges(&wall, vertices, triangles)
}

/// The same of edges alone: triangles may have no area, as those of a mesh in motion may at times.
pub(super) fn check_edges(wall: &str, vertices: &[DVec3], triangles: &[[u32; 3]]) -> Result<(), GeometryError> {
    let wall = wall.to_string();
    // Sorted: triangles that share an edge become neighbours.
    let mut edges: Vec<(u32, u32, bool)> = directed_edges(triangles).collect();
    edges.sort_unstable();
    let (mut open, mut crowded, mut turned) = (Vec::new(), Vec::new(), Vec::new());
    for group in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let edge = (group[0].0, group[0].1);
        match group {
            [_] => open.push(edge),
            [first, second] if first.2 != second.2 => {}
            [_, _] => turned.push(edge),
            _ => crowded.push(edge),
        }
    }
    let name = |edges: &[(u32, u32)]| {
        Places::of(edges.iter().map(|&(a, b)| vec![vertices[a as usize], vertices[b as usize]]), "to")
    };
    if !open.is_empty() {
        return Err(GeometryError::OpenEdges { wall, count: open.len(), first: name(&open) });
    }
    if !crowded.is_empty() {
        return Err(GeometryError::CrowdedEdges { wall, count: crowded.len(), first: name(&crowded) });
    }
    if !turned.is_empty() {
        return Err(GeometryError::Orientation { wall, count: turned.len(), first: name(&turned) });
    }
    Ok(())
}

/// Whether each directed edge is met by exactly one the other way round.
pub(super) fn is_closed(triangles: &[[u32; 3]]) -> bool {
    let mut edges: Vec<(u32, u32, bool)> = directed_edges(triangles).collect();
    edges.sort_unstable();
    let matched = |pair: &[(u32, u32, bool)]| pair.len() == 2 && !pair[0].2 && pair[1].2;
    edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).all(matched)
}

/// (lower vertex, higher vertex, runs upwards).
fn directed_edges(triangles: &[[u32; 3]]) -> impl Iterator<Item = (u32, u32, bool)> {
    let sides = |t: &[u32; 3]| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
    triangles.iter().flat_map(sides).map(|(a, b)| (a.min(b), a.max(b), a < b))
}

pub(super) fn is_flat([a, b, c]: [DVec3; 3]) -> bool {
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    let doubled = (b - a).cross(c - a).length();
    // An overflow to NaN counts as degenerate too.
    doubled.is_nan() || doubled <= FLAT * longest
}

/// Volume on the side the normals point away from, m3, by the divergence theorem: sum of a . (b x c) / 6.
/// Positive when the normals of a closed surface point outwards.
pub fn signed_volume(vertices: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let Some(first) = triangles.first() else {
        return 0.0;
    };
    // Relative to a vertex of the mesh, so that a mesh far from the origin loses no digits.
    signed_volume_about(vertices[first[0] as usize], vertices, triangles)
}

/// The same of the cone from a point to a surface that need not be closed, m3.
pub fn signed_volume_about(origin: DVec3, vertices: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let corner = |v: u32| vertices[v as usize] - origin;
    triangles.iter().map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2])))).sum::<f64>() / 6.0
}

/// m2.
pub fn area(vertices: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let corner = |v: u32| vertices[v as usize];
    triangles.iter().map(|t| (corner(t[1]) - corner(t[0])).cross(corner(t[2]) - corner(t[0])).length()).sum::<f64>()
        / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> (Vec<DVec3>, Vec<[u32; 3]>) {
        (vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z], vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    }

    #[test]
    fn a_tetrahedron_is_closed_and_has_a_sixth_of_the_cube() {
        let (vertices, triangles) = tetrahedron();
        assert_eq!(check_closed("t", &vertices, &triangles), Ok(()));
        assert!((signed_volume(&vertices, &triangles) - 1.0 / 6.0).abs() < 1e-15);
        assert!((area(&vertices, &triangles) - (1.5 + 0.75f64.sqrt())).abs() < 1e-15);
        let turned: Vec<[u32; 3]> = triangles.iter().map(|t| [t[0], t[2], t[1]]).collect();
        assert!((signed_volume(&vertices, &turned) + 1.0 / 6.0).abs() < 1e-15);
    }

    #[test]
    fn the_volume_does_not_depend_on_the_distance_from_the_origin() {
        let (mut vertices, triangles) = tetrahedron();
        vertices.iter_mut().for_each(|v| *v += DVec3::new(4096.0, -8192.0, 1024.0));
        assert!((signed_volume(&vertices, &triangles) - 1.0 / 6.0).abs() < 1e-12);
    }

    #[test]
    fn each_defect_has_its_error() {
        let (vertices, triangles) = tetrahedron();
        let open = check_closed("t", &vertices, &triangles[1..]).unwrap_err();
        let GeometryError::OpenEdges { count: 3, first, .. } = open else { panic!("{open}") };
        let listed = "in m: (0, 0, 0) to (1, 0, 0); (0, 0, 0) to (0, 1, 0); (1, 0, 0) to (0, 1, 0)";
        assert_eq!(first.to_string(), listed);

        let mut turned = triangles.clone();
        turned[3].swap(0, 1);
        assert!(matches!(check_closed("t", &vertices, &turned), Err(GeometryError::Orientation { count: 3, .. })));

        let doubled = [triangles.clone(), triangles.clone()].concat();
        assert!(matches!(check_closed("t", &vertices, &doubled), Err(GeometryError::CrowdedEdges { count: 6, .. })));

        let mut flat = triangles.clone();
        flat.push([0, 1, 1]);
        assert!(matches!(check_closed("t", &vertices, &flat), Err(GeometryError::Degenerate { count: 1, .. })));

        let mut broken = vertices.clone();
        broken[2].y = f64::NAN;
        assert!(matches!(check_closed("t", &broken, &triangles), Err(GeometryError::NotFinite { count: 1, .. })));
        assert!(matches!(check_closed("t", &vertices, &[]), Err(GeometryError::Empty { .. })));
    }
}
