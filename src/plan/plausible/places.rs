//! Where walls and gas are: solids and moving walls that no gas meets, gas space that is empty though no wall holds the gas off it.

use super::{Measured, MeasuredWall};
use crate::plan::measured::IN_HOLES;
use crate::plan::text::significant;
use crate::plan::{DryMotion, Pocket};
use crate::scene::{Dimension, Opening, Scene, UnitSystem, Wall};

/// Share of a solid's volume outside of all that encloses the gas, from which on it hardly is in the gas. (A plate may be let into
/// walls, and a rod may go through one.)
const HARDLY_IN: f64 = 0.9;

/// How near the area of an opening is to that of the hole that it repeats.
const SAME_AREA: f64 = 0.02;

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
    let dry = measured.dry_motions.iter().map(|motion| dry_motion(scene, motion));
    let dry = dry.chain(measured.pockets.iter().map(|pocket| opens_behind(scene, pocket)));
    let unseen = measured.dry_surfaces.iter().map(|&surface| {
        let own = &scene.surfaces[surface];
        format!(
            "surface `{}`: no gas lies before it at any time of the run, so its columns are 0: does another wall cover this part of wall \
             `{}`? Measure on that wall then",
            own.name, scene.walls[own.wall].name
        )
    });
    out.chain(dry).chain(unseen).chain(repeated_holes(scene, measured)).chain(empty_space(scene, measured)).collect()
}

fn dry_motion(scene: &Scene, dry: &DryMotion) -> String {
    let question = if dry.other_way {
        "are its direction and its sign right? The gas lies on the other side"
    } else {
        "is the wall in the right place?"
    };
    let name = &scene.walls[dry.wall].name;
    if dry.since == 0.0 {
        return format!(
            "motion of wall `{name}`: the wall has no gas before it at any time of the run, so its motion changes nothing: {question}"
        );
    }
    let time = significant(dry.since / scene.units.factor(Dimension::Time));
    let symbol = scene.units.symbol(Dimension::Time);
    let question =
        if dry.other_way { question } else { "does it leave the vessel? Then its direction or its sign may be wrong" };
    format!("motion of wall `{name}`: from {time} {symbol} on the wall has no gas before it: {question}")
}

/// A vacuum that the columns of its chamber count as room of the gas.
fn opens_behind(scene: &Scene, pocket: &Pocket) -> String {
    let shown = |si: f64, dimension: Dimension| {
        format!("{} {}", significant(si / scene.units.factor(dimension)), scene.units.symbol(dimension))
    };
    format!(
        "motion of wall `{}`: from {} on a space opens behind it that no gas can reach: a vacuum, which pressures of chambers and control \
         volumes count as room of their gas. Make the body longer by more than {} at its back, so that it stays outside of the vessel, or \
         start it with gas behind",
        scene.walls[pocket.wall].name,
        shown(pocket.time, Dimension::Time),
        shown(pocket.further, Dimension::Length)
    )
}

/// A mesh of the metal of a vessel, whose gas is between its outer and its inner surface.
pub fn shell(units: UnitSystem, wall: &Wall, own: &MeasuredWall) -> Option<String> {
    let (factor, symbol) = units.length();
    (own.hollow > 0.0).then(|| {
        format!(
            "wall `{}`: its gas is a shell of about {} {symbol} between two surfaces, round {} L without gas: is it the metal of a vessel? \
             Leave only the inner surface in the mesh if the gas is within it",
            wall.name,
            significant(2.0 * own.volume / own.area / factor),
            significant(1e3 * own.hollow)
        )
    })
}

/// Openings with the area of a hole, or of all holes, that the walls have between the same chambers.
fn repeated_holes(scene: &Scene, measured: &Measured) -> Vec<String> {
    let repeated = declared_beside_holes(scene, measured).filter(|beside| beside.repeats);
    repeated.map(|beside| format!("{}: leave the opening out", beside.told(scene))).collect()
}

/// Openings beside holes, of another area.
pub fn notes(scene: &Scene, measured: &Measured) -> Vec<String> {
    let others = declared_beside_holes(scene, measured).filter(|beside| !beside.repeats);
    others.map(|beside| format!("{}: leave it out if it is one of the holes", beside.told(scene))).collect()
}

/// An opening of the scene between chambers that holes of walls join.
struct DeclaredBeside<'a> {
    opening: &'a Opening,
    holes: Vec<&'a Opening>,
    /// Whether its area is that of a hole, or of all.
    repeats: bool,
}

impl DeclaredBeside<'_> {
    fn told(&self, scene: &Scene) -> String {
        let holes: Vec<String> = self.holes.iter().map(|hole| format!("`{}`", hole.name)).collect();
        let [a, b] = self.opening.between.map(|chamber| &scene.chambers[chamber].name);
        let (which, is) = if holes.len() > 1 { ("holes", "join") } else { ("the hole", "joins") };
        format!(
            "opening `{}`: {which} {} of the walls {is} chambers `{a}` and `{b}` already, and its {} {} count beside {} in control volumes",
            self.opening.name,
            holes.join(", "),
            significant(self.opening.area / scene.units.factor(Dimension::Area)),
            scene.units.symbol(Dimension::Area),
            if holes.len() > 1 { "them" } else { "it" }
        )
    }
}

fn declared_beside_holes<'a>(scene: &'a Scene, measured: &'a Measured) -> impl Iterator<Item = DeclaredBeside<'a>> {
    let declared = scene.openings.iter().filter(|own| measured.openings.iter().all(|found| found.name != own.name));
    declared.filter_map(|opening| {
        let [a, b] = opening.between;
        let joins = |hole: &&Opening| hole.between == [a, b] || hole.between == [b, a];
        let holes: Vec<&Opening> = measured.openings.iter().filter(joins).collect();
        let whole: f64 = holes.iter().map(|hole| hole.area).sum();
        let same = |area: f64| (opening.area / area - 1.0).abs() < SAME_AREA;
        let repeats = same(whole) || holes.iter().any(|hole| same(hole.area));
        (!holes.is_empty()).then_some(DeclaredBeside { opening, holes, repeats })
    })
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
