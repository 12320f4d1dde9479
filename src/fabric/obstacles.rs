//! Rigid convex bodies that nodes do not enter, as the device has their faces.

use glam::DVec3;

use super::error::{MembraneError, check};
use super::input::Obstacle;
use super::layout::GpuObstacle;
use super::model::Model;
use super::registry::MOST_OBSTACLES;

/// Quanta from the middle of the grid: nodes and a place on the face so near to it differ by less than 2^31.
const FARTHEST: f64 = 1_073_741_824.0;

/// All faces that there is room for, those that are none behind; `limit` is where the grid ends, quanta.
///
/// # Errors
/// If there are more, or one is none.
pub(super) fn on_device(
    bodies: &[Vec<Obstacle>],
    model: &Model,
    limit: [u32; 3],
) -> Result<[GpuObstacle; MOST_OBSTACLES as usize], MembraneError> {
    let (found, most) = (bodies.iter().map(Vec::len).sum::<usize>(), MOST_OBSTACLES as usize);
    let expected = "no more than there is room for, 256";
    check(found <= most, || "the number of faces of obstacles".into(), found as f64, expected)?;
    let faces = bodies.iter().flat_map(|body| body.iter().enumerate().map(|(k, face)| (face, k + 1 == body.len())));
    let mut all = [GpuObstacle::default(); MOST_OBSTACLES as usize];
    for (k, ((obstacle, last), of_device)) in faces.zip(&mut all).enumerate() {
        let numbers = [obstacle.place, obstacle.velocity].concat();
        let number = numbers.iter().copied().find(|x| !x.is_finite()).unwrap_or(0.0);
        check(number.is_finite(), || format!("place and velocity of obstacle {k}"), number, "finite numbers")?;
        let length = DVec3::from(obstacle.normal).length();
        let sound = length > 0.0 && length.is_finite();
        check(sound, || format!("the normal of obstacle {k}"), length, "of a length beyond 0")?;
        let friction = obstacle.friction;
        let sound = friction >= 0.0 && friction.is_finite();
        check(sound, || format!("the friction of obstacle {k}"), friction, "0 or more")?;
        // That place on its face which is nearest to the middle of the grid.
        let normal = DVec3::from(obstacle.normal) / length;
        let middle = DVec3::from(limit.map(f64::from)) * 0.5;
        let place = (DVec3::from(obstacle.place) - DVec3::from(model.origin)) / model.quantum;
        let away = (place - middle).dot(normal);
        let expected = "at most 2^30 quanta from the middle of the grid";
        check(away.abs() < FARTHEST, || format!("the distance of obstacle {k}"), away, expected)?;
        *of_device = GpuObstacle {
            place: (middle + away * normal).to_array().map(|quanta| quanta.round() as i64 as u32),
            friction: friction as f32,
            normal: normal.as_vec3().to_array(),
            whole_normal: normal.to_array().map(|n| (4_194_304.0 * n).round() as i32),
            velocity: obstacle.velocity.map(|v| v as f32),
            last: u32::from(last),
            ..GpuObstacle::default()
        };
    }
    Ok(all)
}
