//! The triangles of a polygon in space, as faces of OBJ files are.
//!
//! The polygon is seen along its mean normal, the sum of the cross products of its corners (Newell's). Where the fan
//! about its first corner covers it, that fan is taken; else ears are clipped ([`polygon`](super::polygon)). Neither adds a
//! corner, so that neighbours meet along whole edges, whatever the diagonals. Corners that are off the mean plane are let
//! be up to [`MOST_WARP`]; beyond it the surface would depend on the diagonals by more than that.

use super::polygon::clip;
use glam::{DVec2, DVec3};

/// How far corners may be off the mean plane, over the polygon's extent.
pub(super) const MOST_WARP: f64 = 0.05;
/// Height of a triangle of a fan over the polygon's extent, from which on it is one.
const LEAST_HEIGHT: f64 = 1e-6;
/// Area over the square of the extent, below which the corners lie on a line.
const FLAT: f64 = 1e-12;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Fault {
    Crossed,
    /// How far a corner is off the plane, over the polygon's extent.
    Warped {
        off: f64,
    },
}

/// Triangles as places in `corners`, turned as these are. None of fewer than three corners that differ; of corners on a
/// line those of a fan, without area.
pub(super) fn triangulated(corners: &[DVec3]) -> Result<Vec<[usize; 3]>, Fault> {
    let ring = differing(corners);
    let fan = |ring: &[usize]| (2..ring.len()).map(|k| [ring[0], ring[k - 1], ring[k]]).collect();
    if ring.len() <= 3 {
        return Ok(fan(&ring));
    }
    let first = corners[ring[0]];
    let normal: DVec3 = ring.windows(2).map(|pair| (corners[pair[0]] - first).cross(corners[pair[1]] - first)).sum();
    let extent = ring.iter().map(|&k| (corners[k] - first).abs().max_element()).fold(0.0, f64::max);
    if normal.length() <= FLAT * extent * extent {
        let farthest = ring.iter().map(|&k| corners[k] - first).max_by(|a, b| a.length().total_cmp(&b.length()));
        let line = farthest.unwrap_or_default().normalize_or_zero();
        let on_it = ring.iter().all(|&k| (corners[k] - first).cross(line).length() <= LEAST_HEIGHT * extent);
        return if on_it { Ok(fan(&ring)) } else { Err(Fault::Crossed) };
    }
    let normal = normal.normalize();
    let middle = ring.iter().map(|&k| corners[k] - first).sum::<DVec3>() / ring.len() as f64;
    let off = ring.iter().map(|&k| (corners[k] - first - middle).dot(normal).abs()).fold(0.0, f64::max) / extent;
    if off > MOST_WARP {
        return Err(Fault::Warped { off });
    }
    let (u, v) = axes(normal);
    let seen = |k: usize| DVec2::new((corners[k] - first).dot(u), (corners[k] - first).dot(v));
    if fan_covers(&ring.iter().map(|&k| seen(k)).collect::<Vec<_>>(), LEAST_HEIGHT * extent) {
        return Ok(fan(&ring));
    }
    // Corners at one place are one, as where a hole is joined to the outline by an edge to and fro.
    let mut names: Vec<usize> = Vec::new();
    let mut points: Vec<DVec2> = Vec::new();
    let outline: Vec<usize> = ring
        .iter()
        .map(|&k| {
            let known = names.iter().position(|&other| corners[other] == corners[k]);
            known.unwrap_or_else(|| {
                names.push(k);
                points.push(seen(k));
                names.len() - 1
            })
        })
        .collect();
    let triangles = clip(&points, outline).ok_or(Fault::Crossed)?;
    Ok(triangles.into_iter().map(|t| t.map(|k| names[k as usize])).collect())
}

/// The corners without those that repeat the one before.
fn differing(corners: &[DVec3]) -> Vec<usize> {
    let mut ring: Vec<usize> = Vec::with_capacity(corners.len());
    for k in 0..corners.len() {
        if ring.last().is_none_or(|&last| corners[last] != corners[k]) {
            ring.push(k);
        }
    }
    while ring.len() > 1 && corners[ring[0]] == corners[ring[ring.len() - 1]] {
        ring.pop();
    }
    ring
}

/// Two axes of the plane across a unit normal, u x v along it.
fn axes(normal: DVec3) -> (DVec3, DVec3) {
    let least = (0..3).min_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(0);
    let u = (DVec3::AXES[least] - normal * normal[least]).normalize();
    (u, normal.cross(u))
}

/// Whether all triangles about the first point have this height, and turn less than once about it.
fn fan_covers(points: &[DVec2], least: f64) -> bool {
    let mut turned = 0.0;
    for k in 2..points.len() {
        let [a, b] = [points[k - 1] - points[0], points[k] - points[0]];
        let longest = a.length().max(b.length()).max(a.distance(b));
        if a.perp_dot(b) <= least * longest {
            return false;
        }
        turned += libm::atan2(a.perp_dot(b), a.dot(b));
    }
    turned < std::f64::consts::TAU
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: &[DVec3], triangles: &[[usize; 3]]) -> DVec3 {
        let one = |t: &[usize; 3]| (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]) / 2.0;
        triangles.iter().map(one).sum()
    }

    fn flat(points: &[[f64; 2]]) -> Vec<DVec3> {
        points.iter().map(|p| DVec3::new(p[0], p[1], 0.25 * p[0])).collect()
    }

    #[test]
    fn a_convex_face_is_a_fan() {
        let square = flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(triangulated(&square), Ok(vec![[0, 1, 2], [0, 2, 3]]));
        let doubled = [square[0], square[0], square[1], square[2], square[3], square[0]];
        assert_eq!(triangulated(&doubled), Ok(vec![[0, 2, 3], [0, 3, 4]]));
    }

    /// No triangle of a face is turned over, and together they have its area.
    #[test]
    fn a_concave_face_is_covered_once() {
        let arrow = flat(&[[0.0, 0.0], [2.0, -1.0], [0.5, 0.0], [2.0, 1.0]]);
        let u = flat(&[[0., 0.], [6., 0.], [6., 6.], [4., 6.], [4., 2.], [2., 2.], [2., 6.], [0., 6.]]);
        let on_an_edge = flat(&[[0.0, 0.0], [0.0, -1.0], [-2.0, -1.0], [-2.0, 0.0], [-1.0, 0.0]]);
        // A square with a square hole, joined by an edge to and fro.
        let ring =
            flat(&[[0., 0.], [3., 0.], [3., 3.], [0., 3.], [0., 0.], [1., 1.], [1., 2.], [2., 2.], [2., 1.], [1., 1.]]);
        for (face, whole) in [(arrow, 0.5), (u, 28.0), (on_an_edge.into_iter().rev().collect(), 2.0), (ring, 8.0)] {
            let triangles = triangulated(&face).unwrap();
            let parts: Vec<f64> = triangles.iter().map(|t| area(&face, std::slice::from_ref(t)).z).collect();
            assert!(parts.iter().all(|&part| part > 0.0) || parts.iter().all(|&part| part < 0.0), "{parts:?}");
            assert!((parts.iter().sum::<f64>().abs() - whole).abs() < 1e-12, "{parts:?}");
        }
    }

    #[test]
    fn a_crossed_and_a_warped_face_are_refused() {
        let bow = flat(&[[0.0, 0.0], [2.0, 1.0], [2.0, 0.0], [0.0, 1.5]]);
        assert_eq!(triangulated(&bow), Err(Fault::Crossed));
        // Its halves are equal, so that their areas cancel.
        assert_eq!(triangulated(&flat(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]])), Err(Fault::Crossed));
        assert_eq!(triangulated(&flat(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.5, 0.0]])).unwrap().len(), 2);
        let mut quad = flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        quad[2].z += 0.1;
        assert_eq!(triangulated(&quad).unwrap().len(), 2);
        quad[2].z += 0.4;
        assert!(matches!(triangulated(&quad), Err(Fault::Warped { off }) if off > MOST_WARP));
    }
}
