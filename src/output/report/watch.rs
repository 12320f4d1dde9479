//! A run that goes on elsewhere, as text for a terminal: how far it is, its last values with their courses, what it warns of.

use std::fmt::Write;

use std::path::Path;

use super::super::error::OutputError;
use super::super::history::History;
use super::super::marker::check_marker;
use super::super::names::HISTORY_FILE;
use super::super::snapshot_read::snapshots_of;
use super::super::table::{figure, grouped};
use super::columns::{Meaning, Role, Unit};
use super::record::Record;
use super::state::Progressing;
use super::verdict::{Verdict, Warned, verdict, warnings};

/// Steps of a course from its least to its largest value.
const COURSE: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
const BAR: usize = 32;
/// Letters of a course.
const LONGEST_COURSE: usize = 40;
/// Warnings that are told at most, the last ones.
const WARNINGS: usize = 5;

/// What can be seen of a run at a moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    title: String,
    pub state: Progressing,
    verdict: Verdict,
    /// Of the simulated time, in the scene's unit.
    reached: f64,
    end: f64,
    time: &'static str,
    /// As the run has logged it last: time left, rates; may be empty.
    told: String,
    rows: [u64; 2],
    snapshots: [u64; 2],
    lines: Vec<Line>,
    warned: Vec<Warned>,
}

/// A column of the history.
#[derive(Debug, Clone, PartialEq)]
struct Line {
    name: String,
    values: Vec<f64>,
}

/// # Errors
/// If no run is in the folder, or a file is broken. A run that has just begun has no history yet: `None`.
pub fn seen(folder: &Path) -> Result<Option<Seen>, OutputError> {
    let history = folder.join(HISTORY_FILE);
    // A header that is being written has no end yet.
    let begun = std::fs::read(&history).is_ok_and(|bytes| bytes.contains(&b'\n'));
    if !begun {
        check_marker(folder)?;
        return Ok(None);
    }
    let record = Record::read(folder)?;
    let time = Unit::time(record.scene.units);
    let warned = warnings(&record);
    Ok(Some(Seen {
        title: record.scene.title.clone(),
        verdict: verdict(&record, &warned),
        reached: record.reached() / time.factor,
        end: record.scene.end_time / time.factor,
        time: time.symbol,
        told: last_told(&record.log),
        rows: [record.history.rows().len() as u64, u64::from(record.scene.output.rows)],
        snapshots: [snapshots_of(folder)?.len() as u64, u64::from(record.scene.output.snapshots) + 1],
        lines: lines(&record.history, &record.meanings),
        warned,
        state: record.state,
    }))
}

/// Of `50 %: 50.43 ms of 100.00 ms, 1 min 31 s left, 105 steps/s, ...` what is behind the times.
fn last_told(log: &str) -> String {
    let rest = |line: &str| {
        let (_, message) = line.split_once(" INFO ")?;
        let (share, rest) = message.split_once(" %: ")?;
        share.trim().parse::<f64>().ok()?;
        Some(rest.split_once(" of ")?.1.split_once(", ")?.1.to_owned())
    };
    log.lines().rev().find_map(rest).unwrap_or_default()
}

/// What moves: pressures, temperatures and flows that were computed, and the number of particles.
fn lines(history: &History, meanings: &[Meaning]) -> Vec<Line> {
    let shown = |meaning: &&(usize, &Meaning)| {
        let (_, meaning) = meaning;
        let whole = meaning.owner.is_empty() && ["particles", "step"].contains(&meaning.quantity.as_str());
        let watched = ["pressure", "temperature", "mass flow"].contains(&meaning.quantity.as_str());
        meaning.role == Role::Computed && (whole || watched && meaning.component.is_empty())
    };
    let line = |(index, meaning): (usize, &Meaning)| {
        let owner = if meaning.owner.is_empty() { String::new() } else { format!("{} ", meaning.owner) };
        let unit = if meaning.unit.symbol.is_empty() { String::new() } else { format!(", {}", meaning.unit.symbol) };
        let values = history.rows().iter().map(|row| row[index] / meaning.unit.factor).collect();
        Line { name: format!("{owner}{}{unit}", meaning.quantity), values }
    };
    let all: Vec<(usize, &Meaning)> = meanings.iter().enumerate().collect();
    all.iter().filter(shown).map(|&one| line(one)).collect()
}

impl Seen {
    /// In lines of at most `width` letters.
    pub fn render(&self, width: usize) -> String {
        let mut text = String::new();
        let state = match &self.state {
            Progressing::Going(holder) => format!("goes on ({holder})"),
            _ => self.verdict.word.clone(),
        };
        let _ = writeln!(text, "{}: {state}", self.title);
        if self.state == Progressing::Stopped {
            self.verdict.lines.iter().for_each(|line| text += &format!("  {line}\n"));
        }
        text += &self.progress();
        let [rows, snapshots] =
            [self.rows, self.snapshots].map(|[found, all]| format!("{} of {}", grouped(found), grouped(all)));
        let _ = writeln!(text, "rows {rows}, snapshots {snapshots}\n");
        text += &self.table(width);
        let skipped = self.warned.len().saturating_sub(WARNINGS);
        if skipped > 0 {
            let _ = writeln!(text, "\n{skipped} earlier warnings");
        }
        for Warned { when, what, remedy } in &self.warned[skipped..] {
            let remedy = if remedy.is_empty() { String::new() } else { format!("; {remedy}") };
            let _ = write!(text, "\nwarning {when}: {what}{remedy}");
        }
        text.trim_end().lines().map(|line| wrapped(line, width)).collect()
    }

    fn progress(&self) -> String {
        let share = if self.end > 0.0 { (self.reached / self.end).clamp(0.0, 1.0) } else { 1.0 };
        let full = (BAR as f64 * share) as usize;
        let bar = "#".repeat(full) + &".".repeat(BAR - full);
        let told = match &self.state {
            Progressing::Going(_) if !self.told.is_empty() => format!(", {}", self.told),
            _ => String::new(),
        };
        let [reached, end] = [self.reached, self.end].map(|time| figure(time, 4));
        format!("[{bar}] {:.0} %  {reached} of {end} {}{told}\n", 100.0 * share, self.time)
    }

    fn table(&self, width: usize) -> String {
        if self.lines.iter().all(|line| line.values.is_empty()) {
            return "no rows yet\n".to_owned();
        }
        let widest = self.lines.iter().map(|line| line.name.chars().count()).max().unwrap_or(0);
        let room = width.saturating_sub(widest + 3 * 12 + 2).clamp(8, LONGEST_COURSE);
        let mut text = format!("{:<widest$} {:>11} {:>11} {:>11}\n", "", "now", "least", "most");
        for Line { name, values } in &self.lines {
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let now = values.last().copied().unwrap_or(0.0);
            let [now, least_told, most_told] = [now, least, most].map(digits);
            let course = course(values, [least, most], room);
            let _ = writeln!(text, "{name:<widest$} {now:>11} {least_told:>11} {most_told:>11}  {course}");
        }
        text
    }
}

/// Five digits, and a power of ten where they would be many zeros.
fn digits(value: f64) -> String {
    let size = value.abs();
    if size >= 1e7 || (size > 0.0 && size < 1e-3) {
        return format!("{value:.4e}");
    }
    let decimals = if size >= 1.0 { (4 - size.log10() as i32).max(0) as usize } else { 5 };
    format!("{value:.decimals$}")
}

/// In lines of at most `width` letters, broken between words; what follows is set in.
fn wrapped(line: &str, width: usize) -> String {
    let mut lines = vec![String::new()];
    for word in line.split_inclusive(' ') {
        let letters = lines.last().map_or(0, |line| line.chars().count());
        if letters > 0 && letters + word.trim_end().chars().count() > width {
            lines.push("    ".to_owned());
        }
        if let Some(last) = lines.last_mut() {
            last.push_str(word);
        }
    }
    lines.iter().map(|line| format!("{}\n", line.trim_end())).collect()
}

/// Means of the values in so many parts, as heights.
fn course(values: &[f64], [least, most]: [f64; 2], letters: usize) -> String {
    let parts = values.len().min(letters);
    (0..parts)
        .map(|k| {
            let part = &values[k * values.len() / parts..(k + 1) * values.len() / parts];
            let mean = part.iter().sum::<f64>() / part.len() as f64;
            let share = if most > least { (mean - least) / (most - least) } else { 0.0 };
            COURSE[((share * COURSE.len() as f64) as usize).min(COURSE.len() - 1)]
        })
        .collect()
}

#[cfg(test)]
mod tests;
