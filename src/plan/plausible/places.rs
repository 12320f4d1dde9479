//! Where walls and gas are: solids and moving walls that no gas meets, gas space that is empty though no wall holds the gas off it.

use super::Measured;
use crate::plan::measured::IN_HOLES;
use crate::plan::text::significant;
use crate::scene::{Dimension, Scene};

/// Share of a solid's volume outside of all that encloses the gas, from which on it hardly is in the gas. (A plate may be let into
/// walls, and a rod may go through one.)
const HARDLY_IN: f64 = 0.9;

pub fn doubts(scene: &Scene, measured: &Measured) -> Vec<String> {
    let moves = |wall: usize| scene.motions.iter().any(|motion| motion.wall == wall);
    let walls = scene.walls.iter().zip(&measured.walls).enumerate();
    let out = walls.filter(|(index, (_, found))| found.outside > HARDLY_IN && !moves(*index)).map(|(_, (wall, found))| {
        format!(
            "wall `{}`: {:.0} % of its volume lies outside of what encloses the gas, and meets none: is it in the right place?",
            wall.name,
            100.0 * found.outside.min(1.0)
        )
    });
    let dry = measured.dry_motions.iter().map(|&wall| {
        format!(
            "motion of wall `{}`: the wall has no gas before it at any time of the run, so its motion changes nothing: is the wall in \
             the right place?",
            scene.walls[wall].name
        )
    });
    let unseen = measured.dry_surfaces.iter().map(|&surface| {
        let own = &scene.surfaces[surface];
        format!(
            "surface `{}`: no gas lies before it at any time of the run, so its columns are 0: does another wall cover this part of wall \
             `{}`? Measure on that wall then",
            own.name, scene.walls[own.wall].name
        )
    });
    out.chain(dry).chain(unseen).chain(empty_space(scene, measured)).collect()
}

fn empty_space(scene: &Scene, measured: &Measured) -> Option<String> {
    let empty = measured.empty_space();
    if empty < IN_HOLES * measured.gas_volume || !measured.open_to_empty {
        return None;
    }
    let volume = |si: f64| significant(si / scene.units.factor(Dimension::Volume));
    Some(format!(
        "the gas space: {} of its {} {} ({} %) are in no chamber, so empty at the start, and no wall holds the gas of the chambers off \
         them: leave out the `region` of the last chamber, or give the rest a chamber of its own",
        volume(empty),
        volume(measured.gas_volume),
        scene.units.symbol(Dimension::Volume),
        significant(100.0 * empty / measured.gas_volume)
    ))
}
