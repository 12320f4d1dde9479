//! The page of one run.

use std::path::Path;

use super::super::balance;
use super::super::error::OutputError;
use super::super::names::{AUDIT_FILE, BALANCE_FILE, PRESSURE_CHART_FILE, REPORT_FILE, SUBDOMAIN_CHART_FILE};
use super::super::table::{figure as digits, grouped};
use super::super::timing::PhaseTiming;
use super::columns::{Meaning, Unit};
use super::figure::{self, Curve, Figure};
use super::packed;
use super::page::{Page, Picture, Table, Text};
use super::record::Record;
use super::series::{MOST_VALUES, Series, joined};
use super::verdict::{verdict, warnings};
use super::view::Viewed;

/// A larger picture is left out of the page.
const LARGEST_PICTURE: usize = 6 << 20;

/// # Errors
/// If a file of the folder is broken.
pub fn page(record: &Record) -> Result<Page, OutputError> {
    let warned = warnings(record);
    let join = joined(&record.history, MOST_VALUES);
    let mut notes = vec![made_of(record)];
    if join > 1 {
        let rows = record.history.rows().len();
        notes.push(format!("Thinned: the history has {rows} rows; a point of a curve is the mean of {join} of them."));
    }
    notes.push("Values in the page have 7 digits; those of history.csv have all.".to_owned());
    let mut series = vec![Series::new("run", &record.history, &record.meanings, record.axis, join)];
    let balance = balance_of(record, &mut series)?;
    let viewed = Viewed::of(record)?;
    let mut pictures = Vec::new();
    if record.history.rows().is_empty() {
        notes.push("The history has no rows yet.".to_owned());
    }
    // For readers without scripts.
    picture(&record.path, PRESSURE_CHART_FILE, "Chamber pressures", &mut pictures, &mut notes)?;
    picture(&record.path, SUBDOMAIN_CHART_FILE, "Particles by the rank that owns them", &mut pictures, &mut notes)?;
    Ok(Page {
        title: record.scene.title.clone(),
        subtitle: subtitle(record),
        verdict: Some(verdict(record, &warned)),
        warnings: warned,
        heads: vec![forecast(record)],
        figures: figure::of_run(&record.history, &record.meanings, record.axis),
        balance,
        pictures,
        tables: [reasons(record), phases(record), costs(&[record])].into_iter().flatten().collect(),
        texts: record
            .audit
            .iter()
            .map(|text| Text { title: format!("Audit ({AUDIT_FILE})"), text: text.clone() })
            .collect(),
        view: viewed.view,
        view_notes: viewed.notes,
        is_run: true,
        notes,
        time: Unit::time(record.scene.units).symbol,
        series,
    })
}

fn subtitle(record: &Record) -> String {
    let end = 1e3 * record.scene.end_time;
    let particles = match record.planned("particles").and_then(toml::Value::as_integer) {
        Some(count) if count > 0 => format!("{} particles, ", grouped(count.unsigned_abs())),
        _ => String::new(),
    };
    let method = record.planned("method").and_then(toml::Value::as_str).unwrap_or("unknown");
    format!("{particles}method {method}, {end} ms, seed {}; folder {}", record.scene.seed, record.path.display())
}

fn made_of(record: &Record) -> String {
    match &record.environment {
        Some(environment) => format!(
            "Made from the files of the run, by `{}` (corpuscle {}).",
            environment.command.join(" "),
            environment.version
        ),
        None => "Made from the files of the run; it has no environment.json.".to_owned(),
    }
}

/// What the plan has said of the errors.
fn forecast(record: &Record) -> Table {
    let head = ["column", "counts", "error", "most of it from"];
    let empty = |note: &str| Table::new("forecast", "Error forecast", &head, Vec::new()).noted(note);
    let Some(forecast) = record.planned("forecast").and_then(toml::Value::as_table) else {
        let how =
            "None: the scene wishes no accuracy and sets no budget. `corpuscle plan SCENE --accuracy 0.02` forecasts.";
        return empty(how);
    };
    let percent = |value: Option<&toml::Value>| {
        value.and_then(toml::Value::as_float).map_or("unknown".to_owned(), |error| format!("{:.2} %", 100.0 * error))
    };
    let column = |column: &toml::Value| {
        let text = |key: &str| column.get(key).and_then(toml::Value::as_str).unwrap_or_default().to_owned();
        let asked = column.get("asked").and_then(toml::Value::as_bool).unwrap_or(false);
        let parts = column.get("parts").and_then(toml::Value::as_array).map_or(&[][..], Vec::as_slice);
        let error = |part: &toml::Value| part.get("error").and_then(toml::Value::as_float).unwrap_or(0.0);
        let worst = parts.iter().max_by(|a, b| error(a).total_cmp(&error(b)));
        let cause = worst.and_then(|part| part.get("cause")).and_then(toml::Value::as_str).unwrap_or("nothing known");
        let counts = if asked { "yes" } else { "no" };
        vec![text("name"), counts.to_owned(), percent(column.get("error")), cause.replace('-', " ")]
    };
    let columns = forecast.get("columns").and_then(toml::Value::as_array);
    let rows = columns.map_or(Vec::new(), |columns| columns.iter().map(column).collect());
    let note = format!(
        "Predicted before the run: the pressures are wrong by {} (root mean square over the rows, over the mean).",
        percent(forecast.get("error"))
    );
    Table::new("forecast", "Error forecast", &head, rows).noted(note)
}

fn reasons(record: &Record) -> Option<Table> {
    let reasons = record.planned("reasons")?.as_array()?;
    let row = |reason: &toml::Value| {
        ["quantity", "value", "why"]
            .map(|key| reason.get(key).and_then(toml::Value::as_str).unwrap_or("").to_owned())
            .to_vec()
    };
    let rows = reasons.iter().map(row).collect();
    Some(Table::new("plan", "What was modelled, and why", &["quantity", "value", "why"], rows))
}

/// As the run prints it.
fn phases(record: &Record) -> Option<Table> {
    let head = ["phase", "wall s", "%", "ns/particle-step", "dispatches"];
    let timing = record.timing.as_ref()?;
    let device: f64 = timing.phases.iter().map(|phase| phase.device_seconds).sum();
    if timing.phases.is_empty() || device <= 0.0 {
        let note = "This device does not time its phases.";
        return Some(Table::new("phases", "Phases of the step", &head, Vec::new()).noted(note));
    }
    let row = |phase: &PhaseTiming| {
        let share = phase.device_seconds / device;
        let wall = share * timing.stepping_seconds;
        let each = 1e9 * wall / timing.particle_steps.max(1) as f64;
        let cells =
            [format!("{wall:.4}"), format!("{:.1}", 100.0 * share), format!("{each:.2}"), grouped(phase.dispatches)];
        [vec![phase.name.clone()], cells.to_vec()].concat()
    };
    let rows = timing.phases.iter().map(row).collect();
    let note =
        "Wall time by phase, in the order of the step; one step of each interval is timed and stands for all of it.";
    Some(Table::new("phases", "Phases of the step", &head, rows).noted(note))
}

/// What runs have cost, a column each.
pub fn costs(records: &[&Record]) -> Option<Table> {
    records.iter().find(|record| record.timing.is_some() || record.environment.is_some())?;
    let row = |name: &str, value: &dyn Fn(&Record) -> Option<String>| {
        let cells = records.iter().map(|record| value(record).unwrap_or_else(|| "unknown".to_owned()));
        std::iter::once(name.to_owned()).chain(cells).collect::<Vec<String>>()
    };
    let seconds = |value: f64| format!("{} s", digits(value, 4));
    let rows = vec![
        row("device", &|record| record.environment.as_ref().map(|known| known.adapter.name.clone())),
        row("driver", &|record| {
            record.environment.as_ref().map(|known| format!("{} {}", known.adapter.driver, known.adapter.driver_info))
        }),
        row("ranks", &|record| record.timing.as_ref().map(|timing| timing.ranks.len().max(1).to_string())),
        row("particles at the end", &|record| Some(grouped(record.planned("particles")?.as_integer()?.unsigned_abs()))),
        row("steps", &|record| record.timing.as_ref().map(|timing| grouped(timing.steps))),
        row("particle-steps", &|record| record.timing.as_ref().map(|timing| grouped(timing.particle_steps))),
        row("wall time of the steps", &|record| record.timing.as_ref().map(|timing| seconds(timing.stepping_seconds))),
        row("set-up", &|record| record.timing.as_ref().map(|timing| seconds(timing.set_up_seconds))),
        row("million particle-steps per second", &|record| {
            let timing = record.timing.as_ref().filter(|timing| timing.stepping_seconds > 0.0)?;
            Some(digits(1e-6 * timing.particle_steps as f64 / timing.stepping_seconds, 4))
        }),
        row("version", &|record| record.environment.as_ref().map(|known| known.version.clone())),
    ];
    let head = ["what"].into_iter().map(str::to_owned).chain(records.iter().map(|record| record.name())).collect();
    let id = "costs".to_owned();
    Some(Table { id, title: "Costs".to_owned(), note: String::new(), head, rows })
}

/// How ranks have shared the work over time; adds its series to those of the page.
fn balance_of(record: &Record, series: &mut Vec<Series>) -> Result<Vec<Figure>, OutputError> {
    let path = record.path.join(BALANCE_FILE);
    if !path.exists() {
        return Ok(Vec::new());
    }
    let history = balance::read(&path)?;
    let meanings: Vec<Meaning> = history.headers().iter().map(|head| Meaning::of(head, record.scene.units)).collect();
    let Some(axis) = history.headers().iter().position(|head| head == "time_s") else { return Ok(Vec::new()) };
    let join = joined(&history, MOST_VALUES / 4);
    let index = series.len();
    series.push(Series::new("balance", &history, &meanings, axis, join));
    let charts = [
        ("Imbalance: the fullest rank over the mean", "imbalance_", &["particles", "work", "seconds"][..]),
        ("Particles of a rank", "owned_", &["min", "mean", "max"]),
        ("Copies of neighbours' particles at a rank", "ghosts_", &["min", "mean", "max"]),
        ("Particles that went to another rank, by interval", "", &["moved"]),
        ("Bytes sent, by interval", "", &["bytes"]),
    ];
    let figure = |(title, prefix, names): (&str, &str, &[&str])| {
        let found = names.iter().filter_map(|name| {
            let head = format!("{prefix}{name}");
            Some((*name, history.headers().iter().position(|other| *other == head)?))
        });
        let curve = |(place, (name, column)): (usize, (&str, usize))| Curve {
            series: index,
            column,
            label: name.to_owned(),
            colour: place,
            dash: "solid",
            shape: place,
            on: true,
        };
        let curves: Vec<Curve> = found.enumerate().map(curve).collect();
        let alt = format!("Line chart against time. {title}: {}.", names.join(", "));
        Figure { id: format!("balance-{prefix}{}", names[0]), title: title.to_owned(), alt, curves }
    };
    Ok(charts.into_iter().map(figure).filter(|figure| !figure.curves.is_empty()).collect())
}

/// Puts an SVG file of the folder on the page, if it is there.
pub fn picture(
    folder: &Path,
    name: &str,
    title: &str,
    pictures: &mut Vec<Picture>,
    notes: &mut Vec<String>,
) -> Result<(), OutputError> {
    let path = folder.join(name);
    if !path.exists() {
        return Ok(());
    }
    let svg = std::fs::read(&path).map_err(OutputError::io("read", &path))?;
    if svg.len() > LARGEST_PICTURE {
        notes.push(format!("{name} is left out: it has {:.1} MB.", 1e-6 * svg.len() as f64));
        return Ok(());
    }
    let alt = format!("{title} ({name})");
    pictures.push(Picture { title: title.to_owned(), alt, svg: packed::bytes(svg) });
    Ok(())
}

/// Reads the folder of a run and writes its page into it, or into `out`; returns where.
///
/// # Errors
/// If no run is there, a file of it is broken, or the page cannot be written.
pub fn write(folder: &Path, out: Option<&Path>) -> Result<std::path::PathBuf, OutputError> {
    let page = page(&Record::read(folder)?)?;
    let path = out.map_or_else(|| folder.join(REPORT_FILE), Path::to_path_buf);
    page.write(&path)?;
    Ok(path)
}
