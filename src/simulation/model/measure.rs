//! What the plan needs to know of the walls.

use super::behind::{backed_vents, facing_orifices};
use super::clearances::gaps_beside;
use super::contact::{dry_motions, dry_surfaces};
use super::holes::{Sides, hindered};
use super::moving::{Moving, extent};
use super::open_sections::open_sections;
use super::outlook::{borders, is_open_to_empty, source};
use super::pockets::pockets;
use super::separate::separate;
use super::strokes::strokes;
use super::surface_models::SurfaceModels;
use crate::geometry::{Narrowest, Vessel, WallInfo};
use crate::plan::{Measured, MeasuredVent, MeasuredWall, doubts_of_meshes};
use crate::scene::{Opening, Scene};

/// What the plan needs to know of the geometry.
pub fn measured(
    scene: &Scene,
    vessel: &Vessel,
    surface_models: &SurfaceModels,
    moving: &Moving,
    probe_volumes: &[f64],
) -> Measured {
    let (bounds_min, bounds_max) = moving.bounds(vessel);
    let chamber_volumes = vessel.chamber_volumes(&scene.chambers);
    let Narrowest { gap, body } = vessel.narrowest();
    let (separate_spaces, split_chambers) = separate(scene, vessel, body, gap.as_ref());
    let openings = found_openings(scene, vessel);
    let empty = vessel.gas_volume() - chamber_volumes.iter().sum::<f64>();
    Measured {
        open_to_empty: empty > 1e-3 * vessel.gas_volume() && is_open_to_empty(scene, vessel),
        gas_volume: vessel.gas_volume(),
        motion: moving.measured(&chamber_volumes),
        chamber_volumes,
        bounds_min,
        bounds_max,
        touching: borders(scene, vessel, &openings),
        open_sections: open_sections(scene, vessel, &openings),
        hindered: hindered(scene, vessel, moving),
        gaps_beside: gaps_beside(scene, vessel, moving),
        strokes: strokes(scene, vessel),
        dry_motions: dry_motions(scene, vessel, moving),
        pockets: pockets(scene, vessel, moving),
        separate_spaces,
        split_chambers,
        dry_surfaces: dry_surfaces(scene, vessel, moving),
        backed_vents: backed_vents(scene, vessel, &surface_models.vents),
        sources: scene.orifices.iter().map(|orifice| source(scene, vessel, orifice)).collect(),
        facing_orifices: facing_orifices(scene, vessel),
        openings,
        inflated: None,
        lightest_node: None,
        nodes_over_volume: None,
        smallest_gap: gap,
        thinnest_body: body,
        wall_area: vessel.walls.iter().map(|wall| wall.area).sum(),
        probe_volumes: probe_volumes.to_vec(),
        vents: surface_models
            .vents
            .iter()
            .map(|place| MeasuredVent { chamber: place.chamber, area: place.area })
            .collect(),
        modelled_surfaces: surface_models
            .placed
            .iter()
            .filter_map(|placed| Some((placed.surface, placed.chamber?)))
            .collect(),
        walls: vessel.walls.iter().enumerate().map(|(index, wall)| measured_wall(vessel, index, wall)).collect(),
    }
}

/// Meshes that are as large or as small as no vessel is: known also of a scene that is refused.
pub fn mesh_doubts(scene: &Scene) -> Vec<String> {
    let Ok(vessel) = Vessel::build(&scene.walls) else { return Vec::new() };
    let walls: Vec<MeasuredWall> =
        vessel.walls.iter().enumerate().map(|(index, wall)| measured_wall(&vessel, index, wall)).collect();
    doubts_of_meshes(scene, &walls)
}

pub fn measured_wall(vessel: &Vessel, index: usize, wall: &WallInfo) -> MeasuredWall {
    let (min, max) = extent(vessel, |of, _| of == index);
    let outside = vessel.outside_share(index);
    let hollow = vessel.hollow(index).map_or(0.0, |hollow| hollow.volume);
    MeasuredWall { min, max, area: wall.area, volume: wall.volume, cavity: wall.cavity, outside, hollow }
}

/// Holes of walls that join two chambers.
pub fn found_openings(scene: &Scene, vessel: &Vessel) -> Vec<Opening> {
    vessel
        .holes
        .iter()
        .filter_map(|hole| {
            let Sides([Some(a), Some(b)]) = Sides::of(scene, vessel, hole) else { return None };
            (a != b).then(|| Opening {
                name: hole.name.clone(),
                between: [a, b],
                area: hole.area,
                // The radius of a round hole: see `gas::discharge`.
                length: 2.0 * hole.area / hole.perimeter,
            })
        })
        .collect()
}
