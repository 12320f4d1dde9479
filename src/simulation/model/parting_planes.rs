//! Which closed fabric a particle is inside of.
//!
//! Particles know that they are inside of closed fabric, and by their places of which: between what two closed surfaces sweep in the run there is a
//! plane. Elastic ones must not come over that between them at the start.
//!
//! The plane is looked for among the axes; if none of these has both surfaces on its two sides, by E. G. Gilbert (1966): the point v of the
//! difference of both hulls that is nearest to the origin is the normal, found by moving v to the nearest point of the segment from it to the
//! corner that lies farthest against it. That is slow between faces that lie flat on each other: at last the normals of triangles are tried.

use glam::DVec3;

use super::error::ModelError;
use super::fabric::Surfaces;
use super::plane::Plane;

/// How far apart surfaces are at least, over their extent: f32 tells on which side of the plane a particle is, and flights keep a gap.
const APART: f64 = 1e-5;
const MOST_STEPS: u32 = 4096;

/// Of each surface the planes between it and the other closed ones.
///
/// # Errors
/// If there is none between two closed surfaces.
pub fn planes_between(surfaces: &Surfaces, starts: &[[f64; 3]]) -> Result<Vec<Vec<Plane>>, ModelError> {
    let mut planes = vec![Vec::new(); surfaces.all.len()];
    let closed: Vec<usize> = (0..surfaces.all.len()).filter(|&index| surfaces.all[index].closed).collect();
    if closed.len() < 2 {
        return Ok(planes);
    }
    let told = |one: usize, problem: String| ModelError::Fabric { fabric: surfaces.all[one].name.clone(), problem };
    let hulls: Vec<Vec<DVec3>> = closed.iter().map(|&index| surfaces.hull(index)).collect();
    for (k, &one) in closed.iter().enumerate() {
        for (l, &other) in closed.iter().enumerate().skip(k + 1) {
            let normals = [one, other].into_iter().flat_map(|index| normals_of(surfaces, index, starts));
            let Some(plane) = plane_between(&hulls[k], &hulls[l], normals) else {
                let problem = format!(
                    "no plane passes between what it and fabric \"{}\" sweep: closed fabrics are told apart by planes, so that none may lie \
                     in a fold or a hollow of another",
                    surfaces.all[other].name
                );
                return Err(told(one, problem));
            };
            planes[one].push(plane);
            planes[other].push(Plane { normal: plane.normal.map(|x| -x), ..plane });
        }
    }
    Ok(planes)
}

/// Of the triangles of a surface at the start.
fn normals_of<'a>(surfaces: &'a Surfaces, index: usize, starts: &'a [[f64; 3]]) -> impl Iterator<Item = DVec3> + 'a {
    surfaces.triangles[surfaces.all[index].triangles.clone()].iter().map(|triangle| {
        let [a, b, c] = triangle.map(|node| DVec3::from(starts[node as usize]));
        (b - a).cross(c - a)
    })
}

/// In the middle of the gap between two sets of points; the first set is on the side that the normal points away from.
fn plane_between(ones: &[DVec3], others: &[DVec3], normals: impl Iterator<Item = DVec3>) -> Option<Plane> {
    let far = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = ones.iter().chain(others).fold(far, |(low, high), &p| (low.min(p), high.max(p)));
    let (apart, origin) = (APART * low.distance(high), 0.5 * (low + high));
    let parts = |direction: DVec3| {
        let normal = direction.try_normalize()?;
        let along = |p: &DVec3| normal.dot(*p - origin);
        let most = ones.iter().map(along).fold(f64::NEG_INFINITY, f64::max);
        let least = others.iter().map(along).fold(f64::INFINITY, f64::min);
        let point = (origin + 0.5 * (most + least) * normal).to_array();
        (least - most > apart).then(|| Plane { point, normal: normal.to_array() })
    };
    let both = |direction: DVec3| parts(direction).or_else(|| parts(-direction));
    // (What is far to one side for the middles of both has a chance.)
    let middle = |set: &[DVec3]| set.iter().sum::<DVec3>() / set.len() as f64;
    let first = middle(others) - middle(ones);
    let known = [first, DVec3::X, DVec3::Y, DVec3::Z].into_iter().find_map(both);
    known.or_else(|| nearest_difference(ones, others, first, apart).and_then(parts)).or_else(|| {
        // Of many triangles few are tried: those that differ from the one before.
        let mut last = DVec3::ZERO;
        let mut normals = normals.filter(move |normal| {
            let is_new = normal.cross(last).length() > 1e-3 * normal.length() * last.length() || last == DVec3::ZERO;
            last = *normal;
            is_new
        });
        normals.by_ref().take(MOST_STEPS as usize).find_map(both)
    })
}

/// The direction from one hull to the other where they are nearest, or none if they meet.
fn nearest_difference(ones: &[DVec3], others: &[DVec3], start: DVec3, apart: f64) -> Option<DVec3> {
    let mut nearest = start;
    for _ in 0..MOST_STEPS {
        let farthest = |set: &[DVec3], way: DVec3| {
            let along = |p: &&DVec3| p.dot(way);
            set.iter().max_by(|p, q| along(p).total_cmp(&along(q))).copied().unwrap_or(DVec3::ZERO)
        };
        // The corner of the difference that lies farthest against the nearest point so far.
        let corner = farthest(others, -nearest) - farthest(ones, nearest);
        let length = nearest.length();
        if length <= apart {
            return None;
        }
        if corner.dot(nearest) > apart * length {
            return Some(nearest);
        }
        let edge = corner - nearest;
        let share = (-nearest.dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
        if share.is_nan() || share <= 0.0 {
            return None;
        }
        nearest += share * edge;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::MeshShape;

    /// Where its nodes are, and the normals of its triangles.
    type Shape = (Vec<DVec3>, Vec<DVec3>);

    fn nodes(shape: MeshShape, turn: f64, at: DVec3) -> Shape {
        let turned = glam::DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), turn);
        let mesh = shape.mesh([0.0; 3]).unwrap();
        let nodes: Vec<DVec3> = mesh.nodes.iter().map(|&node| turned * DVec3::from(node) + at).collect();
        let normals = mesh.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|node| nodes[node as usize]);
            (b - a).cross(c - a)
        });
        let normals = normals.collect();
        (nodes, normals)
    }

    fn parted((ones, one_normals): &Shape, (others, other_normals): &Shape) -> bool {
        let normals = one_normals.iter().chain(other_normals).copied();
        let Some(plane) = plane_between(ones, others, normals) else { return false };
        let above = |p: &DVec3| (*p - DVec3::from(plane.point)).dot(plane.normal.into());
        assert!(ones.iter().all(|p| above(p) < 0.0) && others.iter().all(|p| above(p) > 0.0), "{plane:?}");
        true
    }

    /// Cushions askew that nearly touch, balls a hundredth of their radius apart, and what meets.
    #[test]
    fn planes_are_found_where_there_are_any() {
        let cushion = MeshShape::Cushion { radius: 0.05, rings: 6, gap: 1e-3 };
        let ball = MeshShape::Sphere { radius: 0.03, subdivisions: 2 };
        for turn in [0.0, 0.4, 1.1] {
            let normal = glam::DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), turn) * DVec3::Z;
            for (distance, are_apart) in [(1.2e-3, true), (1.02e-3, true), (0.9e-3, false)] {
                let at = DVec3::new(3.0, -7.0, 1.0);
                let [one, other] = [at, at + distance * normal + 0.01 * normal.any_orthonormal_vector()];
                let found = parted(&nodes(cushion, turn, one), &nodes(cushion, turn, other));
                assert_eq!(found, are_apart, "{turn} {distance}");
            }
        }
        let way = DVec3::new(1.0, 2.0, -2.0) / 3.0;
        assert!(parted(&nodes(ball, 0.3, DVec3::ZERO), &nodes(ball, 0.9, 0.0603 * way)));
        assert!(!parted(&nodes(ball, 0.3, DVec3::ZERO), &nodes(ball, 0.9, 0.05 * way)));
        // One within another.
        assert!(!parted(
            &nodes(ball, 0.0, DVec3::ZERO),
            &nodes(MeshShape::Sphere { radius: 0.01, subdivisions: 1 }, 0.0, DVec3::ZERO)
        ));
    }
}
