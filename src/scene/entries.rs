//! Where the entries of a scene stand in its text.

use std::ops::Range;

use super::lines::Lines;
use super::raw::RawScene;
use super::raw_values::At;

pub(super) fn lines(raw: &RawScene, text: &str) -> Lines {
    let ends: Vec<usize> = text.match_indices('\n').map(|(at, _)| at).collect();
    let line = |span: &Range<usize>| 1 + ends.partition_point(|&end| end < span.start);
    let mut entries: Vec<(String, usize)> = Vec::new();
    let mut add = |kind: &str, name: &At<String>, span: &Range<usize>| {
        entries.push((format!("{kind} `{}`", name.value), line(span)));
    };
    raw.gas.iter().for_each(|at| add("gas", &at.value.name, &at.span));
    for wall in &raw.wall {
        add("wall", &wall.value.name, &wall.span);
        wall.value.hole.iter().for_each(|hole| add("hole", &hole.value.name, &hole.span));
    }
    for chamber in &raw.chamber {
        add("chamber", &chamber.value.name, &chamber.span);
        add("chambers", &chamber.value.name, &chamber.span);
    }
    for orifice in &raw.orifice {
        add("orifice", &orifice.value.name, &orifice.span);
        add("orifices", &orifice.value.name, &orifice.span);
    }
    raw.probe.iter().for_each(|at| add("probe", &at.value.name, &at.span));
    raw.surface.iter().for_each(|at| add("surface", &at.value.name, &at.span));
    raw.opening.iter().for_each(|at| add("opening", &at.value.name, &at.span));
    for vent in &raw.vent {
        add("vent", &vent.value.name, &vent.span);
        add("vents", &vent.value.name, &vent.span);
    }
    raw.fabric.iter().for_each(|at| add("fabric", &at.value.name, &at.span));
    raw.motion.iter().for_each(|at| add("motion of wall", &at.value.wall, &at.span));
    let of_walls = raw.wall.iter().map(|wall| ("wall", &wall.value.name.value, &wall.value.part));
    let of_fabrics = raw.fabric.iter().map(|fabric| ("fabric", &fabric.value.name.value, &fabric.value.part));
    for (kind, name, parts) in of_walls.chain(of_fabrics) {
        entries.extend(parts.iter().map(|at| (format!("{kind} `{name}/{}`", at.value.face.value), line(&at.span))));
    }
    // Behind the entries of the vents: sentences about one begin as theirs do.
    let absolute = raw.vent.iter().filter_map(|vent| Some((vent, vent.value.opening_pressure_absolute.as_ref()?)));
    entries
        .extend(absolute.map(|(vent, at)| {
            (format!("vent `{}`: opening_pressure_absolute", vent.value.name.value), line(&at.span))
        }));
    entries.push(("the run".into(), line(&raw.end_time.span)));
    let keys = [("diameter", &raw.model.diameter), ("time_step", &raw.model.time_step)];
    let given = keys.iter().filter_map(|(key, at)| Some((format!("the model: {key}"), line(&at.as_ref()?.span))));
    entries.extend(given);
    Lines(entries)
}
