//! Where chambers are open to each other beside what was to part them.

use super::outlook::{is_in_hole, surface_of};
use super::places::chamber_of;
use crate::geometry::{Vessel, region_volume};
use crate::plan::OpenSection;
use crate::scene::{Opening, Scene};

/// Depth of the gas on both sides of a region's surface, at least, over the edge of a cube of its volume: a facet of a round wall lies
/// nearer to its circle.
const DEEP: f64 = 0.02;
/// Places on each side within that depth.
const PLACES: u32 = 8;
/// Share of a section: what is less is within the rounding of the points on the surface of a region.
const LEAST: f64 = 0.02;

/// `found`: the openings that holes of walls are; what the scene declares beside them is open on purpose.
pub fn open_sections(scene: &Scene, vessel: &Vessel, found: &[Opening]) -> Vec<OpenSection> {
    let open = areas(scene, vessel, true);
    if open.is_empty() {
        return Vec::new();
    }
    let bare = vessel.without(|wall| !vessel.walls[wall].cavity);
    let sections = areas(scene, &bare, false);
    let declared = |pair: [usize; 2]| -> f64 {
        let own = scene.openings.iter().filter(|own| found.iter().all(|found| found.name != own.name));
        let joins = |opening: &&Opening| opening.between == pair || opening.between == [pair[1], pair[0]];
        own.filter(joins).map(|opening| opening.area).sum()
    };
    let section = |(between, area): ([usize; 2], f64)| {
        let whole = sections.iter().find(|known| known.0 == between).map_or(area, |known| known.1);
        // A declared opening may be the whole of it.
        let is_open = area - 2.0 * declared(between) > LEAST * whole;
        is_open.then_some(OpenSection { between, share: (area / whole).min(1.0) })
    };
    open.into_iter().filter_map(section).collect()
}

/// Pairs of chambers with the area, m2, over which deep gas of both meets, that in holes of walls left out if so said.
fn areas(scene: &Scene, vessel: &Vessel, without_holes: bool) -> Vec<([usize; 2], f64)> {
    let mut found: Vec<([usize; 2], f64)> = Vec::new();
    for (index, chamber) in scene.chambers.iter().enumerate() {
        let Some(region) = &chamber.region else { continue };
        let deep = DEEP * libm::cbrt(region_volume(region));
        for (point, outward, area) in surface_of(region) {
            let at = |distance: f64| chamber_of(scene, vessel, (point + distance * outward).to_array());
            let depths = || (1..=PLACES).map(|k| deep * f64::from(k) / f64::from(PLACES));
            let near = 1e-2 * deep;
            let Some(other) = at(near).filter(|other| *other != index && at(-near) == Some(index)) else { continue };
            let is_deep = depths().all(|depth| at(depth) == Some(other) && at(-depth) == Some(index));
            let is_hole = || vessel.holes.iter().any(|hole| is_in_hole(hole, point, deep));
            if !is_deep || without_holes && is_hole() {
                continue;
            }
            let pair = [index.min(other), index.max(other)];
            match found.iter_mut().find(|known| known.0 == pair) {
                Some(known) => known.1 += area,
                None => found.push((pair, area)),
            }
        }
    }
    found
}
