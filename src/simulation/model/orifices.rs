//! Discs of orifices lie in the gas.

use glam::DVec3;

use super::error::ModelError;
use crate::geometry::Vessel;
use crate::plan::significant;
use crate::scene::{Dimension, Orifice, Scene};

/// `hint`: of the hollow that the disc lies in.
pub fn orifice_in_wall(scene: &Scene, orifice: &Orifice, point: DVec3, hint: Option<String>) -> ModelError {
    let (factor, unit) = (scene.units.factor(Dimension::Length), scene.units.symbol(Dimension::Length));
    let [x, y, z] = point.to_array().map(|m| significant(m / factor));
    let radius = significant((orifice.area / std::f64::consts::PI).sqrt() / factor);
    let found = format!("of a radius of {radius} {unit}, is not in the gas: ({x}, {y}, {z}) {unit}");
    ModelError::OrificeInWall {
        orifice: orifice.name.clone(),
        found,
        hint: hint.map_or(String::new(), |hint| format!("; {hint}")),
    }
}

/// What the help of a disc says that lies in the hollow of a vessel whose gas is in its metal.
fn hint(scene: &Scene, vessel: &Vessel, point: DVec3) -> Option<String> {
    let hollow = vessel.hollow_at(point.to_array())?;
    Some(format!(
        "the gas of wall `{}` is in the shell between its two surfaces, and the disc looks into the {} L within, which have none: leave only \
         the inner surface in the mesh if it is the metal of a vessel",
        scene.walls[hollow.wall].name,
        significant(1e3 * hollow.volume)
    ))
}

/// The middle of an orifice's disc, lifted a little off its wall, the disc's normal, and its radius, a little less, m.
pub fn disc_of(orifice: &Orifice) -> (DVec3, DVec3, f64) {
    let radius = (orifice.area / std::f64::consts::PI).sqrt();
    let normal = DVec3::from(orifice.direction);
    (DVec3::from(orifice.position) + normal * (1e-4 * radius), normal, 0.999 * radius)
}

/// The middle of the disc and a ring of points just inside it.
fn disc_points(orifice: &Orifice) -> impl Iterator<Item = DVec3> {
    let (center, normal, radius) = disc_of(orifice);
    let (u, v) = normal.any_orthonormal_pair();
    (0..=8).map(move |k| {
        let angle = std::f64::consts::TAU * f64::from(k) / 8.0;
        let arm = if k == 8 { 0.0 } else { radius };
        center + arm * (libm::cos(angle) * u + libm::sin(angle) * v)
    })
}

/// Whether the disc would lie in the gas if it looked the other way.
fn points_into_wall(orifice: &Orifice, vessel: &Vessel) -> bool {
    let turned = Orifice { direction: orifice.direction.map(|x| -x), ..orifice.clone() };
    disc_points(orifice).all(|point| !vessel.is_gas(point.into()))
        && disc_points(&turned).all(|point| vessel.is_gas(point.into()))
}

/// A ring of points just inside each orifice's disc must lie in the gas.
pub fn check_orifices(scene: &Scene, vessel: &Vessel) -> Result<(), ModelError> {
    for orifice in &scene.orifices {
        for point in disc_points(orifice) {
            if !vessel.is_gas(point.into()) {
                let hollow = hint(scene, vessel, point);
                return Err(if points_into_wall(orifice, vessel) {
                    let turn = || "turn `direction` round: it is that of the flow, into the gas".to_string();
                    ModelError::OrificeIntoWall { orifice: orifice.name.clone(), hint: hollow.unwrap_or_else(turn) }
                } else {
                    orifice_in_wall(scene, orifice, point, hollow)
                });
            }
        }
    }
    Ok(())
}

/// No wall may cross a disc on which particles are born.
pub fn check_discs(scene: &Scene, vessel: &Vessel) -> Result<(), ModelError> {
    for orifice in &scene.orifices {
        let (center, normal, radius) = disc_of(orifice);
        let corners = vessel.triangles.iter().map(|triangle| triangle.vertices.map(|v| vessel.vertices[v as usize]));
        let crossed = corners.filter_map(|corners| nearest_crossing(corners.map(DVec3::from), center, normal));
        if let Some(point) = crossed.into_iter().find(|point| point.distance(center) < radius) {
            return Err(orifice_in_wall(scene, orifice, point, None));
        }
    }
    Ok(())
}

/// Where a triangle crosses a plane, the point that is nearest to one of the plane.
pub fn nearest_crossing(corners: [DVec3; 3], center: DVec3, normal: DVec3) -> Option<DVec3> {
    let above = corners.map(|corner| normal.dot(corner - center));
    let mut ends = (0..3).map(|k| (k, (k + 1) % 3)).filter(|&(a, b)| (above[a] > 0.0) != (above[b] > 0.0));
    let mut end = || ends.next().map(|(a, b)| corners[a].lerp(corners[b], above[a] / (above[a] - above[b])));
    let (from, to) = (end()?, end()?);
    let along = to - from;
    let share = (center - from).dot(along) / along.length_squared();
    // (Of a triangle that touches the plane in a point alone the share is no number.)
    Some(from + along * if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 })
}
