//! The page of several runs side by side: curves over each other, what differs in their inputs and plans, what they cost.

use std::path::{Path, PathBuf};

use super::super::error::OutputError;
use super::super::history::History;
use super::columns::{Meaning, Role, Unit};
use super::figure;
use super::page::{Page, Table};
use super::record::Record;
use super::run::costs;
use super::series::{MOST_VALUES, Series, joined, relative_difference};
use super::verdict::{verdict, warnings};

/// # Errors
/// If a folder has no run, or a file of it is broken.
pub fn page(folders: &[PathBuf]) -> Result<Page, OutputError> {
    let records = folders.iter().map(|folder| Record::read(folder)).collect::<Result<Vec<_>, _>>()?;
    let all: Vec<&Record> = records.iter().collect();
    let system = records[0].scene.units;
    // All in the units of the first.
    let meanings: Vec<Vec<Meaning>> = records
        .iter()
        .map(|record| record.history.headers().iter().map(|head| Meaning::of(head, system)).collect())
        .collect();
    let mut notes = Vec::new();
    let series = records.iter().zip(&meanings).map(|(record, meanings)| {
        let join = joined(&record.history, MOST_VALUES / records.len());
        if join > 1 {
            let told = format!("a point of a curve is the mean of {join} of its {} rows", record.history.rows().len());
            notes.push(format!("Thinned: {}: {told}.", record.name()));
        }
        Series::new(&record.name(), &record.history, meanings, record.axis, join)
    });
    let series = series.collect();
    notes.push("Values in the page have 7 digits; those of history.csv have all.".to_owned());
    let runs: Vec<(&History, &[Meaning])> =
        records.iter().zip(&meanings).map(|(record, meanings)| (&record.history, meanings.as_slice())).collect();
    let names: Vec<String> =
        records.iter().enumerate().map(|(k, record)| format!("{}: {}", k + 1, record.name())).collect();
    Ok(Page {
        title: format!("Comparison of {} runs", records.len()),
        subtitle: names.join("; "),
        heads: [Some(overview(&all)), Some(inputs(&all)), differences(&all, &meanings), costs(&all)]
            .into_iter()
            .flatten()
            .collect(),
        figures: figure::of_runs(&runs, records[0].axis),
        notes,
        time: Unit::time(system).symbol,
        series,
        ..Page::default()
    })
}

/// A run a row: whether it can be trusted.
fn overview(records: &[&Record]) -> Table {
    let row = |(index, record): (usize, &&Record)| {
        let warned = warnings(record);
        let found = verdict(record, &warned);
        let lines = std::iter::once(found.word).chain(found.lines).collect::<Vec<_>>().join("; ");
        let number = (index + 1).to_string();
        vec![number, record.name(), record.scene.title.clone(), lines, record.path.display().to_string()]
    };
    let rows = records.iter().enumerate().map(row).collect();
    Table::new("runs", "Runs", &["", "name", "title", "verdict", "folder"], rows)
}

/// The keys of scenes and plans that are not the same in all.
fn inputs(records: &[&Record]) -> Table {
    let mut flat: Vec<Vec<(String, String)>> = Vec::new();
    for record in records {
        let mut keys = Vec::new();
        flatten("", &toml::Value::Table(record.scene_table.clone()), &mut keys);
        // What a plan says of its own: its reasons repeat it in words.
        let own = record.plan.iter().filter(|(key, value)| !value.is_array() && *key != "forecast");
        own.for_each(|(key, value)| flatten(&format!("plan: {key}"), value, &mut keys));
        flat.push(keys);
    }
    let mut names: Vec<&String> = Vec::new();
    for (name, _) in flat.iter().flatten() {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let value = |keys: &[(String, String)], name: &String| {
        keys.iter().find(|(key, _)| key == name).map_or("not given".to_owned(), |(_, value)| value.clone())
    };
    let row = |name: &String| {
        let cells: Vec<String> = flat.iter().map(|keys| value(keys, name)).collect();
        let differ = cells.iter().any(|cell| cell != &cells[0]);
        differ.then(|| [vec![name.clone()], cells].concat())
    };
    let rows: Vec<Vec<String>> = names.into_iter().filter_map(row).collect();
    let note = if rows.is_empty() { "None: scenes and plans are the same." } else { "" };
    headed("inputs", "Differences in inputs and plans", "key", records, rows).noted(note)
}

/// A table with a column for each run.
fn headed(id: &str, title: &str, first: &str, records: &[&Record], rows: Vec<Vec<String>>) -> Table {
    let names: Vec<String> = records.iter().map(|record| record.name()).collect();
    let head: Vec<&str> = std::iter::once(first).chain(names.iter().map(String::as_str)).collect();
    Table::new(id, title, &head, rows)
}

/// Keys with the way to them; entries of lists by their names, or by number from 1.
fn flatten(path: &str, value: &toml::Value, into: &mut Vec<(String, String)>) {
    let below = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    match value {
        toml::Value::Table(table) => table.iter().for_each(|(key, value)| flatten(&below(key), value, into)),
        toml::Value::Array(list) if list.iter().any(toml::Value::is_table) => {
            for (index, entry) in list.iter().enumerate() {
                let name = entry.get("name").and_then(toml::Value::as_str);
                let name = name.map_or_else(|| (index + 1).to_string(), |name| format!("`{name}`"));
                flatten(&format!("{path} {name}"), entry, into);
            }
        }
        other => into.push((path.to_owned(), other.to_string())),
    }
}

/// By how much the computed columns of the others are off those of the first.
fn differences(records: &[&Record], meanings: &[Vec<Meaning>]) -> Option<Table> {
    let points = |record: &Record, head: &str| record.history.points("time_s", head);
    let first = records[0];
    let row = |(head, meaning): (&String, &Meaning)| {
        let judged = ["pressure", "temperature", "mass flow", "heat flux"].contains(&meaning.quantity.as_str());
        if !judged || meaning.role != Role::Computed {
            return None;
        }
        let own = points(first, head)?;
        let cells = records[1..].iter().map(|record| {
            let other = points(record, head).and_then(|other| relative_difference(&own, &other));
            other.map_or("nothing to compare".to_owned(), |share| format!("{:.2} %", 100.0 * share))
        });
        Some(std::iter::once(head.clone()).chain(cells).collect())
    };
    let rows: Vec<Vec<String>> = first.history.headers().iter().zip(&meanings[0]).filter_map(row).collect();
    let note = format!(
        "Root mean square over the rows, over the mean, of the difference to {}; between rows the others are linear.",
        first.name()
    );
    let others = &records[1..];
    (!rows.is_empty()).then(|| headed("differences", "Differences of curves", "column", others, rows).noted(note))
}

/// Reads the folders of several runs and writes their page.
///
/// # Errors
/// If one has no run, a file is broken, or the page cannot be written.
pub fn write(folders: &[PathBuf], out: &Path) -> Result<(), OutputError> {
    page(folders)?.write(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_have_the_way_to_them() {
        let text = "seed = 1\n[model]\nrounds = 2\n[[wall]]\nname = 'a'\nmin = [1, 2]\n[[wall.hole]]\nface = '+x'\n";
        let mut keys = Vec::new();
        flatten("", &toml::Value::Table(text.parse().unwrap()), &mut keys);
        let found: Vec<(&str, &str)> = keys.iter().map(|(key, value)| (key.as_str(), value.as_str())).collect();
        for expected in
            [("seed", "1"), ("model.rounds", "2"), ("wall `a`.min", "[1, 2]"), ("wall `a`.hole 1.face", "\"+x\"")]
        {
            assert!(found.contains(&expected), "{expected:?} in {found:?}");
        }
    }
}
