//! What a scene does that it may well mean, and its author may not know: told as notes, which are no warnings.

use super::text::{as_written, significant};
use super::{Measured, NoOpening};
use crate::geometry::Passage;
use crate::scene::{Chamber, Dimension, Scene};

/// Of the edge of a cube of all gas: a gap that is narrower may be one that was to be closed.
const NARROW: f64 = 0.02;

/// Of the holes and the vents, with the line of each in the file. `shut`: vents that no gas opens, with the absolute pressure at which
/// each would, Pa.
pub fn of_scene(scene: &Scene, measured: &Measured, shut: &[(&str, f64)]) -> Vec<String> {
    let holes = measured.no_openings.iter().map(|hole| no_opening(scene, hole));
    let shut = shut.iter().map(|&(name, absolute)| {
        format!(
            "vent `{name}`: it opens at {} absolute, which neither its chamber has at the start nor all gas together at the end: it \
             probably stays shut",
            pressure(scene, absolute)
        )
    });
    holes.chain(shut).map(|note| scene.lines.told(note)).collect()
}

/// Of chambers of unlike gas that touch, in a run of particles.
pub fn touching(scene: &Scene, measured: &Measured) -> Vec<String> {
    measured.touching.iter().filter_map(|&pair| mixing(scene, pair)).map(|note| scene.lines.told(note)).collect()
}

fn pressure(scene: &Scene, si: f64) -> String {
    let unit = scene.units.symbol(Dimension::Pressure);
    format!("{} {unit}", as_written(si / scene.units.factor(Dimension::Pressure)))
}

/// Two chambers of unlike gas without a wall between them.
fn mixing(scene: &Scene, pair: [usize; 2]) -> Option<String> {
    let [a, b] = pair.map(|chamber| &scene.chambers[chamber]);
    let both = |of: &dyn Fn(&Chamber) -> String| format!("{} and {}", of(a), of(b));
    let mut unlike = Vec::new();
    if a.pressure != b.pressure {
        unlike.push(both(&|chamber| pressure(scene, chamber.pressure)));
    }
    if a.temperature != b.temperature {
        unlike.push(both(&|chamber| format!("{} K", as_written(chamber.temperature))));
    }
    if a.mixture != b.mixture {
        unlike.push("unlike gas".into());
    }
    (!unlike.is_empty()).then(|| {
        format!(
            "chambers `{}` and `{}`: no wall lies between them where they touch, and they have {}: they mix from the first step. Add a \
             wall if that was not meant",
            a.name,
            b.name,
            unlike.join(", ")
        )
    })
}

fn no_opening(scene: &Scene, hole: &NoOpening) -> String {
    let wall = &scene.walls[hole.wall].name;
    match hole.chamber {
        Some(chamber) => format!(
            "hole `{}` of wall `{wall}`: the gas on both its sides is that of chamber `{}`, so it is no opening between chambers. Give \
             the gas behind it a [[chamber]] of its own if that was meant",
            hole.name, scene.chambers[chamber].name
        ),
        None => format!(
            "hole `{}` of wall `{wall}`: no gas lies before one of its sides, so nothing flows through it. Move the hole, or what covers it",
            hole.name
        ),
    }
}

/// The narrowest gap, if it lies between two walls, and few gaps that are meant are as narrow.
pub fn narrow_gap(scene: &Scene, measured: &Measured) -> Option<String> {
    let gap = measured.smallest_gap.filter(|gap| gap.walls[0] != gap.walls[1])?;
    if gap.length > NARROW * libm::cbrt(measured.gas_volume) {
        return None;
    }
    let length = significant(gap.length / scene.units.factor(Dimension::Length));
    Some(format!(
        "the narrowest gap, {length} {} {}: gas flows through it. Let the walls overlap if they were meant to touch",
        scene.units.symbol(Dimension::Length),
        between(scene, &gap, scene.units.length())?
    ))
}

/// "between walls `a` and `b` near (1, 2, 3) mm", in a unit of so many m.
pub fn between(scene: &Scene, gap: &Passage, (factor, symbol): (f64, &str)) -> Option<String> {
    let name = |wall: u32| scene.walls.get(wall as usize).map(|wall| format!("`{}`", wall.name));
    let [a, b] = [name(gap.walls[0])?, name(gap.walls[1])?];
    let walls = if a == b { format!("within wall {a}") } else { format!("between walls {a} and {b}") };
    // Rounding beside 0 is 0.
    let least = 1e-6 * gap.length;
    let place = gap.middle.map(|m| if m.abs() < least { "0".into() } else { significant(m / factor) }).join(", ");
    Some(format!("{walls} near ({place}) {symbol}"))
}
