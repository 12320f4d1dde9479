//! The maps as a table for a terminal, as CSV, as a page of the documentation and as SVG.

use std::fmt::Write;
use std::path::Path;

use crate::output::{MapCell, MapRow, OutputError, aligned, map_chart};
use crate::plan::{LIMITS, Limit, significant};
use crate::scene::Method;
use crate::study::verify::Check;

use super::{Axis, Effort, Point, State, first_broken};

/// An axis and the points found along it.
pub type Map<'a> = (&'a Axis, Vec<Point>);

/// Columns of the file of [`csv`].
const COLUMNS: [&str; 10] =
    ["axis", "method", "value", "quantity", "reference", "measured", "standard_error", "allowed", "state", "guard"];

/// A row for each quantity of each run.
///
/// # Errors
/// Those of the writer, of which none is known.
pub fn csv(maps: &[Map<'_>]) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(COLUMNS)?;
    for (axis, points) in maps {
        for point in points {
            let guard = axis.limit(point.method).map_or_else(String::new, |bound| bound.words());
            for check in &point.checks {
                let Check { quantity, reference, measured, error, tolerance, .. } = check;
                writer.write_record([
                    axis.name,
                    point.method.name(),
                    &point.value.to_string(),
                    quantity,
                    &reference.to_string(),
                    &format!("{measured:e}"),
                    &format!("{error:e}"),
                    &format!("{tolerance:e}"),
                    &State::of(check).word().to_lowercase(),
                    &guard,
                ])?;
            }
        }
    }
    let bytes = writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// The points of an axis in such a file; none where one of its runs is missing.
pub fn points_of(csv: &str, axis: &Axis, effort: Effort) -> Option<Vec<Point>> {
    let mut points: Vec<Point> = Vec::new();
    for record in csv::Reader::from_reader(csv.as_bytes()).records() {
        let record = record.ok()?;
        if record.get(0)? != axis.name {
            continue;
        }
        let method = axis.methods.iter().copied().find(|known| Some(known.name()) == record.get(1))?;
        let figure = |column: usize| record.get(column)?.parse::<f64>().ok();
        let value = figure(2)?;
        let check = Check::of(record.get(3)?, figure(4)?, (figure(5)?, figure(6)?), figure(7)?);
        match points.last_mut() {
            Some(last) if (last.method, last.value) == (method, value) => last.checks.push(check),
            _ => points.push(Point { method, value, checks: vec![check] }),
        }
    }
    let wanted = axis.methods.iter().flat_map(|&method| axis.values(effort).iter().map(move |&value| (method, value)));
    points.iter().map(|point| (point.method, point.value)).eq(wanted).then_some(points)
}

/// What a cell of a map says: the worst quantity and how many times its allowance it is off.
fn cell(point: &Point) -> String {
    match (point.state(), point.worst()) {
        (State::Broken, Some(check)) => {
            let name = check.quantity.split(',').next().unwrap_or_default();
            let name = name.split(" on ").next().unwrap_or_default();
            if check.measured.is_nan() { name.to_owned() } else { format!("{name} x{}", times(check)) }
        }
        (state, _) => state.word().to_owned(),
    }
}

fn times(check: &Check) -> String {
    let times = (check.measured - check.reference).abs() / check.tolerance;
    if times >= 100.0 { format!("{times:.0e}") } else { format!("{times:.1}") }
}

/// The rows of an axis' map: a title, then a cell for each value.
fn rows(axis: &Axis, points: &[Point]) -> (Vec<f64>, Vec<(Method, Vec<String>)>) {
    let of = |method: Method| points.iter().filter(move |point| point.method == method);
    let methods = axis.methods.iter().copied().filter(|&method| of(method).next().is_some());
    let rows: Vec<_> = methods.map(|method| (method, of(method).map(cell).collect::<Vec<_>>())).collect();
    let values = rows.first().map_or_else(Vec::new, |&(method, _)| of(method).map(|point| point.value).collect());
    (values, rows)
}

/// The map of an axis, and what broke first of each method.
pub fn text((axis, points): &Map<'_>) -> String {
    let (values, rows) = rows(axis, points);
    let mut table =
        vec![std::iter::once(axis.name.to_owned()).chain(values.iter().map(f64::to_string)).collect::<Vec<_>>()];
    table.extend(
        rows.into_iter().map(|(method, cells)| std::iter::once(method.name().to_owned()).chain(cells).collect()),
    );
    let mut text = aligned(&table);
    for &method in axis.methods {
        if let Some(sentence) = verdict(axis, points, method) {
            let _ = writeln!(text, "  {}: {sentence}", method.name());
        }
    }
    text
}

/// What broke first of a method, and what guards runs of it.
fn verdict(axis: &Axis, points: &[Point], method: Method) -> Option<String> {
    let safest = points.iter().find(|point| point.method == method)?.value;
    let found = first_broken(points, method);
    let mut sentence = match found.held {
        None => "nowhere known to hold".to_owned(),
        Some([first, last]) if first == safest => format!("holds to {last}"),
        Some([first, last]) if first == last => format!("holds at {last}"),
        Some([first, last]) => format!("holds from {first} to {last}"),
    };
    if !found.unclear.is_empty() {
        let values: Vec<String> = found.unclear.iter().map(f64::to_string).collect();
        let _ = write!(sentence, "; unclear at {}", values.join(", "));
    }
    for (value, check) in found.broken {
        let _ = if check.measured.is_nan() {
            write!(sentence, "; at {value} {}", check.quantity)
        } else {
            write!(
                sentence,
                "; at {value} {} is {} +- {}, off by {} times the {} allowed",
                check.quantity,
                significant(check.measured),
                significant(check.error),
                times(check),
                significant(check.tolerance)
            )
        };
    }
    let guard = axis.limit(method).map_or_else(String::new, |bound| format!(" (guard: {})", bound.words()));
    Some(sentence + &guard)
}

/// How the tables of the page are read.
const READING: &str = "\
Each table goes from safe to risky along an axis. A quantity is *broken* where it is off by more than its allowance and two
standard errors. It is *unclear* where the run does not know it to half of the allowance. A cell names the quantity that is
farthest off, and how many times its allowance; `stability.csv` has all quantities with their errors.

| quantity | allowance, fixed beforehand |
|---|---|
| energy | 1e-5 of all; with inflow 1e-4 |
| pressure | 1 % of n k T |
| equipartition | 2 % |
| collision rate, lost collisions | 3 % |
| wall tightness | as the audit |
| flow | 7 % of a continuum's |
| pressure on a piston | 5 %, and a fifth of its rise |
| density profile of a shock tube | .024 at 160,000 particles, as N^-.26 |
| push: momentum that passed the middle of a tube, over the exact one | as of a piston |";

/// A page with all maps and the table of limits. `made_by`: the command; `device`: what it ran on.
pub fn page(maps: &[Map<'_>], made_by: &str, device: &str) -> String {
    let mut page = format!(
        "# Limits\n\nWhere the methods fail, as found on {device} by\n\n```sh\n{made_by}\n```\n\n{READING}\n\n## Guards\n\n\
         `corpuscle plan` and `corpuscle run` warn beyond these limits, and refuse with `--strict` \
         ([errors](errors.md#warnings)).\n\n| quantity | method | limit | beyond it |\n|---|---|---|---|\n"
    );
    for limit in LIMITS {
        let _ = writeln!(page, "{}", guard(limit));
    }
    page += "\nThat of the time step depends on the rounds: [method](../explanation/method.md#what-the-plan-decides-and-why).\n";
    for (axis, points) in maps {
        let (values, rows) = rows(axis, points);
        let _ = writeln!(page, "\n## {}\n\n{}; {}.\n", axis.name, capital(axis.what), axis.runs);
        let head: Vec<String> = values.iter().map(f64::to_string).collect();
        let _ = writeln!(page, "| method | {} | guard |", head.join(" | "));
        let _ = writeln!(page, "|---|{}---|", "---|".repeat(values.len()));
        for (method, cells) in rows {
            let guard = axis.limit(method).map_or_else(String::new, |bound| bound.words());
            let _ = writeln!(page, "| {} | {} | {guard} |", method.name(), cells.join(" | "));
        }
    }
    page
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + letters.as_str())
}

/// Cells coloured by what broke.
///
/// # Errors
/// If the file cannot be written.
pub fn chart(path: &Path, maps: &[Map<'_>]) -> Result<(), OutputError> {
    let mut all = Vec::new();
    for (axis, points) in maps {
        let values: Vec<String> = rows(axis, points).0.iter().map(f64::to_string).collect();
        all.push(MapRow { title: axis.name.to_owned(), heads: values, cells: Vec::new() });
        for &method in axis.methods {
            let own = points.iter().filter(|point| point.method == method);
            let cells: Vec<MapCell> = own
                .map(|point| MapCell {
                    text: cell(point),
                    broken: match point.state() {
                        State::Holds => Some(None),
                        State::Unclear => None,
                        State::Broken => Some(Some(colour_of(point))),
                    },
                })
                .collect();
            if !cells.is_empty() {
                all.push(MapRow { title: method.name().to_owned(), heads: Vec::new(), cells });
            }
        }
    }
    map_chart(
        path,
        "Where the methods fail: the quantity that is farthest beyond its allowance, and how many times it",
        &all,
    )
}

/// A colour for each kind of quantity.
fn colour_of(point: &Point) -> usize {
    const KINDS: [&str; 7] =
        ["energy", "pressure", "equipartition", "collision rate", "lost collisions", "wall tightness", "flow"];
    let worst = point.worst().map_or("", |check| check.quantity.as_str());
    KINDS.iter().position(|kind| worst.starts_with(kind)).unwrap_or(6)
}

fn guard(limit: &Limit) -> String {
    let method = limit.method.map_or("all others", Method::name);
    format!("| {} | {method} | {} | {} |", limit.quantity.name(), limit.bound.words(), limit.effect)
}

#[cfg(test)]
mod tests {
    use super::super::AXES;
    use super::*;

    /// The page is made once in a while; its table of guards is that of today.
    #[test]
    fn the_guards_of_the_page_are_those_of_the_table() {
        let page = include_str!("../../../docs/reference/limits.md");
        let table = page.split("\n\n").find(|part| part.starts_with("| quantity | method")).unwrap();
        let expected: Vec<String> = LIMITS.iter().map(guard).collect();
        assert_eq!(table.lines().skip(2).collect::<Vec<_>>(), expected);
    }

    /// The table, the file and the page name what broke, by how much, and the guard.
    #[test]
    fn maps_tell_what_broke() {
        let axis = &AXES[0];
        let check = |measured| Check::of("pressure, \"p\"/nkT", 1.0, (measured, 0.001), 0.01);
        let point = |value, measured| Point { method: Method::Cell, value, checks: vec![check(measured)] };
        let map = (axis, vec![point(0.5, 1.001), point(2.0, 1.032)]);
        let text = text(&map);
        for part in [
            "time-step    0.5              2",
            "cell       holds  pressure x3.2",
            "holds to 0.5; at 2 pressure, \"p\"/nkT is 1.032",
            "(guard: at most 2)",
        ] {
            assert!(text.contains(part), "{part} is not in\n{text}");
        }
        let maps = [map];
        let csv = csv(&maps).unwrap();
        assert!(
            csv.contains("time-step,cell,2,\"pressure, \"\"p\"\"/nkT\",1,1.032e0,1e-3,1e-2,broken,at most 2\n"),
            "{csv}"
        );
        assert!(points_of(&csv, axis, Effort::Quick).is_none(), "some runs are missing");
        let whole: Vec<Point> = axis
            .methods
            .iter()
            .flat_map(|&method| {
                [0.2, 2.0].map(|value| Point { method, value, checks: vec![check(1.5), check(f64::NAN)] })
            })
            .collect();
        let file = super::csv(&[(axis, whole), (&AXES[1], vec![point(8.0, 1.0)])]).unwrap();
        let kept = points_of(&file, axis, Effort::Quick).unwrap();
        assert_eq!((kept.len(), kept[5].method, kept[5].value), (6, Method::Cell, 2.0));
        assert_eq!(kept[0].checks[0], check(1.5));
        assert!(kept[5].checks[1].measured.is_nan() && kept[5].checks[1].quantity == check(0.0).quantity);
        let page = page(&maps, "corpuscle stability time-step", "a device");
        for part in [
            "| method | 0.5 | 2 | guard |",
            "| cell | holds | pressure x3.2 | at most 2 |",
            "corpuscle stability time-step",
            "| share of collisions lost | all others | at most 0.03 |",
        ] {
            assert!(page.contains(part), "{part} is not in\n{page}");
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.svg");
        chart(&path, &maps).unwrap();
        let svg = std::fs::read_to_string(path).unwrap();
        assert!(svg.starts_with("<svg") && svg.contains("pressure x3.2") && svg.ends_with("</svg>\n"));
    }
}
