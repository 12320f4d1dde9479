//! From the scene file as written to the scene as meant: every list in turn, all problems gathered.

use std::path::Path;

use super::errors::{Problem, quote};
use super::lines::Lines;
use super::names::Names;
use super::numbers::{count, positive};
use super::parts::Parts;
use super::raw::{RawScene, RawUnits};
use super::raw_values::At;
use super::types::{Scene, UnitSystem};
use super::units::Quantity;
use super::{fabrics, flows, gases, motions, places, settings, vents, walls};

/// At most 56 bits of the seed are used.
const LARGEST_SEED: i64 = (1 << 56) - 1;
const SEED: u64 = 1;

/// The scene, or every problem found. `stem` is the title of a scene that gives none.
pub(super) fn validate(raw: &RawScene, stem: &str, base_dir: &Path) -> Result<Scene, Vec<Problem>> {
    let mut problems = Vec::new();
    let units = match raw.units {
        None | Some(RawUnits::Si) => UnitSystem::Si,
        Some(RawUnits::KgMmMs) => UnitSystem::KgMmMs,
        Some(RawUnits::TMmS) => UnitSystem::TMmS,
    };
    refuse_wrong_numbers_of_entries(raw, &mut problems);
    // References look names up by place in the file, so that an entry with another fault still is known.
    let gas_names = Names::collect("gas", raw.gas.iter().map(|g| &g.value.name), &mut problems);
    let wall_names = Names::collect("wall", raw.wall.iter().map(|w| &w.value.name), &mut problems);
    let chamber_names = Names::collect("chamber", raw.chamber.iter().map(|c| &c.value.name), &mut problems);
    let holes = raw.wall.iter().flat_map(|w| &w.value.hole).map(|h| &h.value.name);
    Names::collect("hole or opening", holes.chain(raw.opening.iter().map(|o| &o.value.name)), &mut problems);
    Names::collect("orifice", raw.orifice.iter().map(|o| &o.value.name), &mut problems);
    Names::collect("probe", raw.probe.iter().map(|p| &p.value.name), &mut problems);
    Names::collect("vent", raw.vent.iter().map(|v| &v.value.name), &mut problems);
    Names::collect("surface", raw.surface.iter().map(|s| &s.value.name), &mut problems);

    let fabric_names = Names::collect("fabric", raw.fabric.iter().map(|f| &f.value.name), &mut problems);
    refuse_names_of_walls(raw, &mut problems);
    fabrics::refuse(raw, &mut problems);

    let title = keep(title(raw, stem), &mut problems);
    let end_time = keep(positive(&raw.end_time, Quantity::Time, units), &mut problems);
    let seed = keep(raw.seed.as_ref().map_or(Ok(SEED), |s| count(s, 0..=LARGEST_SEED)), &mut problems);
    let gases = each(&raw.gas, &mut problems, |gas, _| gases::gas(gas, units));
    let parts = Parts::collect(raw, &wall_names, &fabric_names);
    let walls = each(&raw.wall, &mut problems, |wall, index| walls::wall(wall, index, &parts, units, base_dir));
    let last = raw.chamber.len().saturating_sub(1);
    let chambers = each(&raw.chamber, &mut problems, |chamber, i| {
        places::chamber(chamber, i == last, (&gas_names, &fabric_names), units)
    });
    let openings = each(&raw.opening, &mut problems, |opening, _| places::opening(opening, &chamber_names, units));
    let orifices = each(&raw.orifice, &mut problems, |orifice, _| flows::orifice(orifice, &gas_names, units));
    let probes = each(&raw.probe, &mut problems, |probe, _| places::probe(probe, units));
    let surfaces = each(&raw.surface, &mut problems, |surface, _| places::surface(surface, &wall_names, &parts));
    let places = vents::Places { walls: &wall_names, fabrics: &fabric_names, chambers: &chamber_names, parts: &parts };
    let vents = each(&raw.vent, &mut problems, |vent, _| vents::vent(vent, raw, &places, units));
    let motions = each(&raw.motion, &mut problems, |_, index| motions::motion(raw, index, &wall_names, units));
    let fabrics =
        each(&raw.fabric, &mut problems, |fabric, index| fabrics::fabric(fabric, index, &parts, units, base_dir));
    let gravity = keep(fabrics::gravity(raw, units), &mut problems);
    let model = keep(settings::model(&raw.model, units), &mut problems);
    let output = keep(settings::output(&raw.output), &mut problems);
    if gases.len() == raw.gas.len() {
        keep(settings::collision_number(&raw.model, &gases, &raw.gas, units), &mut problems);
    }

    match (title, end_time, seed, gravity, model, output) {
        (Some(title), Some(end_time), Some(seed), Some(gravity), Some(model), Some(output)) if problems.is_empty() => {
            Ok(Scene {
                title,
                units,
                end_time,
                seed,
                gases,
                walls,
                chambers,
                openings,
                orifices,
                probes,
                surfaces,
                vents,
                motions,
                fabrics,
                gravity,
                model,
                output,
                lines: Lines::default(),
            })
        }
        _ => Err(problems),
    }
}

/// What stands above tables and charts; the latter are XML, in which most control characters cannot be.
fn title(raw: &RawScene, stem: &str) -> Result<String, Problem> {
    match &raw.title {
        None => Ok(stem.chars().filter(|&c| !unwritable(c)).collect()),
        Some(title) if title.value.chars().any(unwritable) => {
            Err(Problem::value(&title.span, quote(&title.value), "a text without control characters"))
        }
        Some(title) => Ok(title.value.clone()),
    }
}

fn unwritable(c: char) -> bool {
    (c.is_control() && !matches!(c, '\t' | '\n' | '\r')) || matches!(c, '\u{fffe}' | '\u{ffff}')
}

fn refuse_wrong_numbers_of_entries(raw: &RawScene, problems: &mut Vec<Problem>) {
    let needed = [
        ("gas", raw.gas.is_empty(), "at least one [[gas]]"),
        ("wall", raw.wall.is_empty(), "at least one [[wall]]"),
        ("chamber", raw.chamber.is_empty(), "at least one [[chamber]]"),
    ];
    for (key, empty, allowed) in needed {
        if empty {
            problems.push(Problem::missing(&(0..0), key, allowed));
        }
    }
    if let Some(surplus) = raw.gas.get(gases::MOST_GASES) {
        let found = format!("{} gases", raw.gas.len());
        problems.push(Problem::value(&surplus.span, found, format!("at most {}", gases::MOST_GASES)));
    }
    if let Some(surplus) = raw.fabric.get(fabrics::MOST_FABRICS) {
        let found = format!("{} fabrics", raw.fabric.len());
        problems.push(Problem::value(&surplus.span, found, format!("at most {}", fabrics::MOST_FABRICS)));
    }
    if let Some(surplus) = raw.motion.get(motions::MOST_MOTIONS) {
        let found = format!("{} motions", raw.motion.len());
        problems.push(Problem::value(&surplus.span, found, format!("at most {}", motions::MOST_MOTIONS)));
    }
}

/// Fabrics have columns as walls do.
fn refuse_names_of_walls(raw: &RawScene, problems: &mut Vec<Problem>) {
    for name in raw.fabric.iter().map(|fabric| &fabric.value.name) {
        if raw.wall.iter().any(|wall| wall.value.name.value == name.value) {
            let found = format!("{}, which is the name of a wall", quote(&name.value));
            problems.push(Problem::value(&name.span, found, "a name that no wall has"));
        }
    }
}

fn keep<T>(result: Result<T, Problem>, problems: &mut Vec<Problem>) -> Option<T> {
    result.map_err(|problem| problems.push(problem)).ok()
}

/// The entries of a list that are well; the problems of the others.
fn each<R, T>(
    list: &[At<R>],
    problems: &mut Vec<Problem>,
    read: impl Fn(&At<R>, usize) -> Result<T, Problem>,
) -> Vec<T> {
    list.iter().enumerate().filter_map(|(index, raw)| keep(read(raw, index), problems)).collect()
}
