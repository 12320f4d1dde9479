//! What a scene does that it may well mean, and its author may not know: told as notes, which are no warnings.

use super::text::{as_written, significant};
use super::vent_notes::{SAME, absolute_question, pressure};
use super::{GapBeside, Hindered, Hindrance, Measured, MeasuredVent, OpenSection};
use crate::gas::vent::opens;
use crate::geometry::Passage;
use crate::scene::{Chamber, Dimension, GasSide, Scene, Vent};

/// Of the edge of a cube of all gas: a gap that is narrower may be one that was to be closed.
const NARROW: f64 = 0.02;
/// Of the pressure in a chamber: one outside that is lower may be above the atmosphere.
const GAUGE: f64 = 0.3;
/// Share of a section from which on all of it is open.
const WHOLE: f64 = 0.98;

/// Vents that no gas opens.
pub struct Shut<'a> {
    /// With the absolute pressure at which each would open, Pa.
    pub vents: &'a [(&'a str, f64)],
    /// The pressure of all gas together at the end, Pa.
    pub end: f64,
}

/// What holes and vents do that may be meant, with the line of each in the file.
pub fn of_scene(scene: &Scene, measured: &Measured, shut: &Shut<'_>) -> Vec<String> {
    let holes = measured.hindered.iter().map(|hole| hindered(scene, hole));
    let open = scene.vents.iter().zip(&measured.vents).filter_map(|vent| open_at_start(scene, vent));
    let question = |name: &str| {
        scene.vents.iter().find(|vent| vent.name == name).map_or("", |vent| absolute_question(scene, vent, shut.end))
    };
    let shut = shut.vents.iter().map(|&(name, absolute)| {
        format!(
            "vent `{name}`: it opens at {} absolute, which neither its chamber has at the start nor all gas together at the end: it \
             probably stays shut{}",
            pressure(scene, absolute),
            question(name)
        )
    });
    let vents = open.chain(unlike_outsides(scene, measured)).chain(shut);
    holes
        .chain(separate(scene, measured))
        .chain(vents)
        .chain(facing(scene, measured))
        .map(|note| scene.lines.told(note))
        .collect()
}

/// Of chambers that touch, in a run of particles: those of unlike gas, and all that no wall parts though none of its gaps is told.
pub fn touching(scene: &Scene, measured: &Measured) -> Vec<String> {
    let share = |pair: [usize; 2]| measured.open_sections.iter().find(|own| own.between == pair).map(|own| own.share);
    let unlike = |&pair: &[usize; 2]| Some((pair, mixing(scene, pair, share(pair).unwrap_or(1.0))?));
    let unlike: Vec<([usize; 2], String)> = measured.touching.iter().filter_map(unlike).collect();
    let rest = untold_sections(measured).filter(|own| unlike.iter().all(|known| known.0 != own.between));
    let rest: Vec<String> = rest.map(|section| unparted(scene, section)).collect();
    unlike.into_iter().map(|(_, note)| note).chain(rest).map(|note| scene.lines.told(note)).collect()
}

/// Of walls that part chambers in a part of where they touch: what a control volume does not know.
pub fn open_beside_walls(scene: &Scene, measured: &Measured) -> Vec<String> {
    let sections = untold_sections(measured).filter(|section| section.share < WHOLE);
    sections.map(|section| scene.lines.told(unparted(scene, section))).collect()
}

/// Those between chambers of which no gap is told.
fn untold_sections(measured: &Measured) -> impl Iterator<Item = &OpenSection> {
    let is_told = |[a, b]: [usize; 2]| {
        let mut gaps = measured.gaps_beside.iter().filter_map(|beside| beside.chambers);
        gaps.any(|own| own == [a, b] || own == [b, a])
    };
    measured.open_sections.iter().filter(move |section| !is_told(section.between))
}

/// Spaces of gas that nothing joins, and chambers that are in several of them.
fn separate(scene: &Scene, measured: &Measured) -> Vec<String> {
    let spaces =
        measured.separate_spaces.map(|count| format!("{count} separate gas spaces: no gas flows between them"));
    let split = measured.split_chambers.iter().map(|split| {
        let volumes: Vec<String> = split.volumes.iter().map(|volume| significant(1e3 * volume)).collect();
        format!(
            "chamber `{}`: its gas lies in {} spaces that no gas flows between, of {} L: give each a [[chamber]], or join them by a hole",
            scene.chambers[split.chamber].name,
            split.volumes.len(),
            volumes.join(", ")
        )
    });
    spaces.into_iter().chain(split).collect()
}

/// Orifices that blow at a wall right before them.
fn facing(scene: &Scene, measured: &Measured) -> Vec<String> {
    let told = measured.facing_orifices.iter().map(|facing| {
        let [distance, radius] =
            [facing.distance, facing.radius].map(|m| significant(m / scene.units.factor(Dimension::Length)));
        format!(
            "orifice `{}`: its jet meets wall `{}` after {distance} {}, and its disc has a radius of {radius}: does `direction` point into \
             the wall?",
            scene.orifices[facing.orifice].name,
            scene.walls[facing.wall].name,
            scene.units.symbol(Dimension::Length)
        )
    });
    told.collect()
}

/// "chambers `a` and `b`: no wall lies between them on about 40 % of where they touch".
fn no_wall(scene: &Scene, [a, b]: [usize; 2], share: f64) -> String {
    let part = if share < WHOLE { format!("on about {:.0} % of ", (100.0 * share).max(1.0)) } else { String::new() };
    format!(
        "chambers `{}` and `{}`: no wall lies between them {part}where they touch",
        scene.chambers[a].name, scene.chambers[b].name
    )
}

fn unparted(scene: &Scene, section: &OpenSection) -> String {
    let (joined, question) = if section.share < WHOLE {
        ("it is an open passage, which the plan counts as no hole", "Let the wall cover it if that was not meant")
    } else {
        ("they are one gas space", "Add a wall, or leave one of them out, if that was not meant")
    };
    format!("{}: {joined}. {question}", no_wall(scene, section.between, section.share))
}

/// Two chambers of unlike gas without a wall between them, on a share of where they touch.
fn mixing(scene: &Scene, pair: [usize; 2], share: f64) -> Option<String> {
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
            "{}, and they have {}: they mix from the first step. Add a wall if that was not meant",
            no_wall(scene, pair, share),
            unlike.join(", ")
        )
    })
}

fn hindered(scene: &Scene, hole: &Hindered) -> String {
    let name = |wall: usize| &scene.walls[wall].name;
    let subject = format!("hole `{}` of wall `{}`", hole.name, name(hole.wall));
    let (open, by, joins) = match hole.why {
        Hindrance::OneChamber(chamber) => {
            return format!(
                "{subject}: the gas on both its sides is that of chamber `{}`, so it is no opening between chambers. Give the gas behind \
                 it a [[chamber]] of its own if that was meant",
                scene.chambers[chamber].name
            );
        }
        Hindrance::Covered { open, by, joins } => (open, by, joins),
    };
    let encloses = scene.walls[by].gas == GasSide::Inside;
    let area = |si: f64| significant(si / scene.units.factor(Dimension::Area));
    let (covered, whose) = if encloses {
        (format!("lies outside of wall `{}`, which encloses the gas", name(by)), "into the gas".to_string())
    } else {
        (format!("is covered by wall `{}`", name(by)), "or that wall".to_string())
    };
    if open == 0.0 {
        return format!(
            "{subject}: no gas lies before one of its sides: it {covered}. Nothing flows through it: move the hole {whose}"
        );
    }
    let counted =
        if joins { "Plans and control volumes count all of it" } else { "The plan knows of no opening there" };
    format!(
        "{subject}: about {} of its {} {} are open: the rest {covered}. {counted}: move the hole {whose} if that was not meant",
        significant(libm::round(100.0 * open) / 100.0 * hole.area / scene.units.factor(Dimension::Area)),
        area(hole.area),
        scene.units.symbol(Dimension::Area),
    )
}

/// Vents with a positive opening pressure that are open from the start.
fn open_at_start(scene: &Scene, (vent, place): (&Vent, &MeasuredVent)) -> Option<String> {
    let chamber = &scene.chambers[place.chamber];
    if vent.opening_pressure <= 0.0 || !opens(vent, false, chamber.pressure) {
        return None;
    }
    let question = if vent.external_pressure < GAUGE * chamber.pressure {
        "Is `external_pressure` gauge? It is absolute"
    } else {
        "Its pressure of opening holds nothing back"
    };
    Some(format!(
        "vent `{}`: it is open from the start: chamber `{}` has {}, {} more than outside, and it opens at {} more. {question}",
        vent.name,
        chamber.name,
        pressure(scene, chamber.pressure),
        pressure(scene, chamber.pressure - vent.external_pressure),
        pressure(scene, vent.opening_pressure),
    ))
}

/// Vents of one chamber that lead to unlike pressures: the first two of each.
fn unlike_outsides(scene: &Scene, measured: &Measured) -> Vec<String> {
    let vents: Vec<(&Vent, usize)> =
        scene.vents.iter().zip(&measured.vents).map(|(vent, place)| (vent, place.chamber)).collect();
    let first = |chamber: usize| vents.iter().find(|(_, own)| *own == chamber).map(|(vent, _)| *vent);
    let unlike = |chamber: usize| {
        let one = first(chamber)?;
        let differs = |(vent, own): &&(&Vent, usize)| {
            *own == chamber && (vent.external_pressure - one.external_pressure).abs() > SAME * one.external_pressure
        };
        let (other, _) = vents.iter().find(differs)?;
        Some(format!(
            "vents `{}` and `{}` of chamber `{}`: outside of one are {}, outside of the other {}: do they lead to unlike places? \
             `external_pressure` is absolute, and {} where it is not given",
            one.name,
            other.name,
            scene.chambers[chamber].name,
            pressure(scene, one.external_pressure),
            pressure(scene, other.external_pressure),
            pressure(scene, 101_325.0),
        ))
    };
    (0..scene.chambers.len()).filter_map(unlike).collect()
}

/// Gaps round walls that part chambers or move. `told`: that the narrowest gap between two walls is told otherwise.
pub fn gaps_beside(scene: &Scene, measured: &Measured, told: bool) -> Vec<String> {
    let known = measured.smallest_gap.filter(|_| told).map(|gap| gap.walls);
    let note = |beside: &GapBeside| {
        let gap = beside.gap;
        let wall = &scene.walls[beside.wall].name;
        let flows = match beside.chambers {
            Some(pair) => {
                let [a, b] = pair.map(|chamber| &scene.chambers[chamber].name);
                format!("chambers `{a}` and `{b}` are open to each other beside this wall")
            }
            None => "gas flows round the wall as it moves".to_string(),
        };
        let length = significant(gap.length / scene.units.factor(Dimension::Length));
        Some(format!(
            "wall `{wall}`: a gap of {length} {} lies {}, so {flows}. Let the walls overlap if they were meant to touch",
            scene.units.symbol(Dimension::Length),
            between(scene, &gap, scene.units.length())?
        ))
    };
    let gaps = measured.gaps_beside.iter().filter(|beside| Some(beside.gap.walls) != known);
    gaps.filter_map(note).map(|note| scene.lines.told(note)).collect()
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
