//! The page of a study (sweep, pareto, stability): its table and the charts that its folder has.

use std::path::Path;

use super::super::error::OutputError;
use super::super::names::{
    PARETO_CHART_FILE, PARETO_FILE, PARETO_TABLE_FILE, STABILITY_CHART_FILE, STABILITY_FILE, STABILITY_TABLE_FILE,
    SWEEP_CHART_FILE, SWEEP_FILE, SWEEP_MODEL_CHART_FILE, SWEEP_TABLE_FILE,
};
use super::page::{Page, Table, Text};
use super::record::text_of;
use super::run::picture;

/// Rows of the table that are shown at most.
const MOST_ROWS: usize = 2000;

/// The files of a kind of study.
struct Kind {
    title: &'static str,
    /// By which it is known.
    table: &'static str,
    text: &'static str,
    pictures: &'static [(&'static str, &'static str)],
}

const KINDS: [Kind; 3] = [
    Kind {
        title: "Sweep over counts of devices",
        table: SWEEP_FILE,
        text: SWEEP_TABLE_FILE,
        pictures: &[(SWEEP_CHART_FILE, "Speed-up, measured"), (SWEEP_MODEL_CHART_FILE, "Speed-up, modelled")],
    },
    Kind {
        title: "Error against device time",
        table: PARETO_FILE,
        text: PARETO_TABLE_FILE,
        pictures: &[(PARETO_CHART_FILE, "Error against device time")],
    },
    Kind {
        title: "Where the methods fail",
        table: STABILITY_FILE,
        text: STABILITY_TABLE_FILE,
        pictures: &[(STABILITY_CHART_FILE, "What breaks first")],
    },
];

/// The page of the study in a folder; `None` if there is no study.
///
/// # Errors
/// If a file of it is broken.
pub fn page(folder: &Path) -> Result<Option<Page>, OutputError> {
    let Some(kind) = KINDS.iter().find(|kind| folder.join(kind.table).is_file()) else { return Ok(None) };
    let mut page = Page {
        title: kind.title.to_owned(),
        subtitle: format!("folder {}", folder.display()),
        tables: vec![table(&folder.join(kind.table), kind.table)?],
        ..Page::default()
    };
    if folder.join(kind.text).is_file() {
        page.texts.push(Text { title: kind.text.to_owned(), text: text_of(&folder.join(kind.text))? });
    } else {
        page.notes.push(format!("There is no {}: the study has not reached its end.", kind.text));
    }
    for (name, title) in kind.pictures {
        picture(folder, name, title, &mut page.pictures, &mut page.notes)?;
    }
    Ok(Some(page))
}

fn table(path: &Path, name: &str) -> Result<Table, OutputError> {
    let bad = |error: csv::Error| OutputError::BadRow {
        path: path.to_path_buf(),
        line: error.position().map_or(0, csv::Position::line),
        problem: error.to_string(),
    };
    let mut reader = csv::ReaderBuilder::new().from_path(path).map_err(bad)?;
    let cells = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect::<Vec<_>>();
    let head = cells(reader.headers().map_err(bad)?);
    let mut rows = Vec::new();
    for record in reader.records() {
        rows.push(cells(&record.map_err(bad)?));
    }
    let all = rows.len();
    rows.truncate(MOST_ROWS);
    let note = if all > MOST_ROWS { format!("The first {MOST_ROWS} of {all} rows.") } else { String::new() };
    Ok(Table { id: "table".to_owned(), title: name.to_owned(), note, head, rows })
}
