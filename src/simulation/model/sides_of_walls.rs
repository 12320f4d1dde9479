//! On which side of closed fabric a wall is that moves.

use glam::DVec3;

use super::error::ModelError;
use crate::geometry::{Bag, Vessel};
use crate::scene::Scene;

/// Places on each edge of a wall's triangles that are looked at.
const PLACES: u32 = 32;

/// The chamber that a wall is in at the start, of a scene with closed fabric.
///
/// # Errors
/// If it is on both sides of some.
pub fn home(scene: &Scene, vessel: &Vessel, wall: usize) -> Result<Option<usize>, ModelError> {
    let rest = scene.chambers.iter().position(|chamber| chamber.inside.is_none());
    for (index, bag) in vessel.bags.iter().enumerate().filter_map(|(index, bag)| Some((index, bag.as_ref()?))) {
        match is_in(vessel, wall, bag) {
            Some(false) => {}
            Some(true) => {
                let inside = scene.chambers.iter().position(|chamber| chamber.inside == Some(index));
                return Ok(inside.or(rest));
            }
            None => return Err(on_both_sides(scene, wall, index, None)),
        }
    }
    Ok(rest)
}

/// A wall does not stay on one side of a fabric: at the start, or by a time, s.
pub fn on_both_sides(scene: &Scene, wall: usize, fabric: usize, time: Option<f64>) -> ModelError {
    let how =
        time.map_or("is on both of its sides at the start".into(), |time| format!("comes through it by {time:e} s"));
    let problem = format!(
        "wall \"{}\" moves and {how}: the room that it takes from the gas on each side is not known",
        scene.walls[wall].name
    );
    ModelError::Fabric { fabric: scene.fabrics[fabric].name.clone(), problem }
}

/// Whether a wall is all inside of closed fabric, or all outside; none if neither, by places on its edges, and the nodes of the fabric in it.
pub fn is_in(vessel: &Vessel, wall: usize, bag: &Bag) -> Option<bool> {
    let triangles: Vec<[u32; 3]> =
        vessel.triangles.iter().filter(|triangle| triangle.wall as usize == wall).map(|t| t.vertices).collect();
    let corner = |vertex: u32| DVec3::from(vessel.vertices[vertex as usize]);
    let corners = || triangles.iter().flatten().map(|&vertex| corner(vertex));
    let low = corners().fold(DVec3::INFINITY, DVec3::min);
    let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
    if low.cmpgt(bag.bounds.1.into()).any() || high.cmplt(bag.bounds.0.into()).any() {
        return Some(false);
    }
    let edges = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut places = edges.flat_map(|[a, b]| {
        (0..PLACES).map(move |k| corner(a).lerp(corner(b), f64::from(k) / f64::from(PLACES)).to_array())
    });
    let inside = places.next().is_some_and(|place| bag.contains(place));
    if places.any(|place| bag.contains(place) != inside) {
        return None;
    }
    // (A hollow box around a bag has none of it in its solid.)
    let pierced = Bag::new(&vessel.vertices, &triangles, "a wall").is_ok_and(|solid| bag.has_node_in(&solid));
    (!pierced).then_some(inside)
}
