//! Gas of the scene behind vents, and walls right before orifices.

use glam::DVec3;

use super::orifices::disc_of;
use super::places::chamber_of;
use super::vent_places::VentPlace;
use crate::geometry::{Triangle, Vessel};
use crate::plan::FacingOrifice;
use crate::scene::{GasSide, Scene, Shape, Vent};

/// Thickness over the edge of a vent's place: a wall that is thinner parts gas from gas.
const THIN: f64 = 0.25;
/// Steps through a wall to the gas behind it.
const STEPS: u32 = 32;
/// Distance over the radius of an orifice: a wall that is nearer stops the jet.
const NEAR: f64 = 0.5;

/// The vents with gas behind most of their places, and its chamber.
pub fn backed_vents(scene: &Scene, vessel: &Vessel, places: &[VentPlace]) -> Vec<[usize; 2]> {
    let mut found = Vec::new();
    for (index, (vent, place)) in scene.vents.iter().zip(places).enumerate() {
        // What is around fabric is no mistake.
        let Some(wall) = scene.walls.get(vent.wall) else { continue };
        let deep = match wall.shape {
            _ if wall.gas == GasSide::Inside => continue,
            Shape::Box { thickness: Some(thickness), .. } | Shape::Plane { thickness, .. } => 1.01 * thickness,
            _ => THIN * place.area.sqrt(),
        };
        let lift = 1e-4 * deep;
        let mut behind = vec![0; scene.chambers.len()];
        let mut looked = 0;
        for (point, normal) in looked_at(vessel, vent) {
            let at = |distance: f64| (point + distance * normal).to_array();
            if chamber_of(scene, vessel, at(lift)) != Some(place.chamber) {
                continue;
            }
            looked += 1;
            let ways = (1..=STEPS).map(|k| -deep * f64::from(k) / f64::from(STEPS) - lift);
            if let Some(chamber) = ways.filter_map(|way| chamber_of(scene, vessel, at(way))).next() {
                behind[chamber] += 1;
            }
        }
        let most = (0..behind.len()).max_by_key(|&chamber| (behind[chamber], std::cmp::Reverse(chamber)));
        found.extend(most.filter(|&chamber| 2 * behind[chamber] > looked).map(|chamber| [index, chamber]));
    }
    found
}

/// Places of a vent with the normals into the gas.
fn looked_at(vessel: &Vessel, vent: &Vent) -> Vec<(DVec3, DVec3)> {
    let own = |triangle: &&Triangle| {
        triangle.wall as usize == vent.wall && (vent.face.is_none() || triangle.face == vent.face)
    };
    let mut places = Vec::new();
    for triangle in vessel.triangles.iter().filter(own) {
        let [a, b, c] = triangle.vertices.map(|vertex| DVec3::from(vessel.vertices[vertex as usize]));
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let Some(disc) = &vent.disc else {
            places.push(((a + b + c) / 3.0, normal));
            continue;
        };
        let center = DVec3::from(disc.center);
        let off = (center - a).dot(normal);
        if off.abs() > 0.01 * disc.diameter {
            continue;
        }
        let (u, v) = normal.any_orthonormal_pair();
        let ring = (0..8).map(|k| {
            let angle = std::f64::consts::TAU * f64::from(k) / 8.0;
            center - off * normal + 0.25 * disc.diameter * (libm::cos(angle) * u + libm::sin(angle) * v)
        });
        places.extend(ring.map(|place| (place, normal)));
    }
    places
}

/// Orifices whose jets meet a wall at once.
pub fn facing_orifices(scene: &Scene, vessel: &Vessel) -> Vec<FacingOrifice> {
    let facing = |(index, orifice): (usize, &crate::scene::Orifice)| {
        let (middle, along, radius) = disc_of(orifice);
        let hits = vessel.triangles.iter().filter_map(|triangle| {
            let corners = triangle.vertices.map(|vertex| DVec3::from(vessel.vertices[vertex as usize]));
            Some((distance_to(corners, middle, along)?, triangle.wall as usize))
        });
        let (distance, wall) = hits.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (distance < NEAR * radius).then_some(FacingOrifice { orifice: index, wall, distance, radius })
    };
    scene.orifices.iter().enumerate().filter_map(facing).collect()
}

/// How far a ray flies to a triangle.
fn distance_to([a, b, c]: [DVec3; 3], from: DVec3, along: DVec3) -> Option<f64> {
    let normal = (b - a).cross(c - a);
    let distance = (a - from).dot(normal) / along.dot(normal);
    let place = from + distance * along;
    let within = [(a, b), (b, c), (c, a)].iter().all(|(p, q)| (*q - *p).cross(place - *p).dot(normal) >= 0.0);
    (distance > 0.0 && distance.is_finite() && within).then_some(distance)
}
