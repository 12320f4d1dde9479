//! `balance.csv`: how the work was shared out among the ranks, a row per interval of steps.
//!
//! Rows are written as the run goes. They hold measured times, so that no two runs leave the same bytes; what a resumed
//! run finds of steps that it will do again is dropped.

use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

use super::OutputError;
use super::error::write_atomically;
use super::history::{History, number};
use super::names::BALANCE_FILE;

/// An interval among ranks. An imbalance is that of the fullest rank over the mean.
#[derive(Debug, Clone, PartialEq)]
pub struct BalanceRow {
    /// At the end of the interval.
    pub step: u64,
    /// s.
    pub time: f64,
    /// Particles that each rank owns, and ghosts that it has besides, in the last step.
    pub owned: Vec<u64>,
    pub ghosts: Vec<u64>,
    /// Of the last step: by the cost model, and in device time; `None` where nothing is timed.
    pub imbalance_work: f64,
    pub imbalance_seconds: Option<f64>,
    /// By weight before and after, if the cells were shared out anew before the interval.
    pub rebalanced: Option<[f64; 2]>,
    /// Particles that went to another owner, bytes sent by all ranks, and seconds of the slowest rank in a rebalance: in
    /// the interval.
    pub moved: u64,
    pub bytes: u64,
    pub rebalance_seconds: f64,
}

const HEADER: &str = "step,time_s,ranks,imbalance_particles,imbalance_work,imbalance_seconds,rebalanced,\
    weight_imbalance_before,weight_imbalance_after,moved,bytes,rebalance_s,\
    owned_min,owned_mean,owned_max,ghosts_min,ghosts_mean,ghosts_max";

/// Writes `balance.csv` as the run goes.
#[derive(Debug)]
pub struct BalanceWriter {
    path: PathBuf,
    file: fs::File,
}

impl BalanceWriter {
    /// Starts `balance.csv` in the existing folder `dir`, replacing an earlier one.
    pub fn create(dir: &Path) -> Result<BalanceWriter, OutputError> {
        BalanceWriter::keeping(dir, String::new())
    }

    /// Goes on with what is there of the steps up to `step`.
    pub fn resume(dir: &Path, step: u64) -> Result<BalanceWriter, OutputError> {
        let text = fs::read_to_string(dir.join(BALANCE_FILE)).unwrap_or_default();
        let done = |line: &&str| line.split(',').next().and_then(|s| s.parse().ok()).is_some_and(|s: u64| s <= step);
        let kept = text.lines().skip(1).filter(done).map(|line| format!("{line}\n")).collect();
        BalanceWriter::keeping(dir, kept)
    }

    fn keeping(dir: &Path, rows: String) -> Result<BalanceWriter, OutputError> {
        let path = dir.join(BALANCE_FILE);
        write_atomically(&path, |out| write!(out, "{HEADER}\n{rows}"))?;
        let file = OpenOptions::new().append(true).open(&path).map_err(OutputError::io("open", &path))?;
        Ok(BalanceWriter { path, file })
    }

    pub fn row(&mut self, row: &BalanceRow) -> Result<(), OutputError> {
        // One unbuffered write per row: the row is the system's as soon as this returns.
        self.file.write_all(line(row).as_bytes()).map_err(OutputError::io("write", &self.path))
    }
}

/// What a run has written into the file so far; what is blank there is no number.
///
/// # Errors
/// If it is no such table.
pub(super) fn read(path: &Path) -> Result<History, OutputError> {
    let text = fs::read_to_string(path).map_err(OutputError::io("read", path))?;
    let whole = text.rfind('\n').map_or("", |end| &text[..end]);
    let mut lines = whole.lines();
    let heads: Vec<String> = lines.next().unwrap_or("").split(',').map(str::to_owned).collect();
    let mut history = History::with_headers(heads)?;
    for (index, line) in lines.enumerate() {
        let value = |(cell, head): (&str, &String)| match cell {
            "" => Ok(f64::NAN),
            cell => cell.parse().map_err(|_| OutputError::BadValue {
                path: path.to_path_buf(),
                line: index as u64 + 2,
                header: head.clone(),
                found: cell.to_owned(),
            }),
        };
        let row = line.split(',').zip(history.headers()).map(value).collect::<Result<Vec<f64>, _>>()?;
        history.push(&row).map_err(|error| OutputError::BadRow {
            path: path.to_path_buf(),
            line: index as u64 + 2,
            problem: error.to_string(),
        })?;
    }
    Ok(history)
}

fn line(row: &BalanceRow) -> String {
    let optional = |value: Option<f64>| value.map(number).unwrap_or_default();
    let owned: Vec<f64> = row.owned.iter().map(|&n| n as f64).collect();
    let mut fields = vec![
        row.step.to_string(),
        number(row.time),
        row.owned.len().to_string(),
        number(over_mean(&owned)),
        number(row.imbalance_work),
        optional(row.imbalance_seconds),
        u8::from(row.rebalanced.is_some()).to_string(),
        optional(row.rebalanced.map(|[before, _]| before)),
        optional(row.rebalanced.map(|[_, after]| after)),
        row.moved.to_string(),
        row.bytes.to_string(),
        number(row.rebalance_seconds),
    ];
    for counts in [&row.owned, &row.ghosts] {
        let mean = counts.iter().sum::<u64>() as f64 / counts.len().max(1) as f64;
        fields.push(counts.iter().min().unwrap_or(&0).to_string());
        fields.push(number(mean));
        fields.push(counts.iter().max().unwrap_or(&0).to_string());
    }
    fields.join(",") + "\n"
}

/// The largest over the mean; 1 where there is nothing.
pub fn over_mean(values: &[f64]) -> f64 {
    let sum: f64 = values.iter().sum();
    if sum > 0.0 { values.iter().copied().fold(0.0, f64::max) * values.len() as f64 / sum } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(step: u64) -> BalanceRow {
        BalanceRow {
            step,
            time: 1e-6 * step as f64,
            owned: vec![10, 30],
            ghosts: vec![4, 1],
            imbalance_work: 1.25,
            imbalance_seconds: None,
            rebalanced: None,
            moved: 3,
            bytes: 480,
            rebalance_seconds: 0.0,
        }
    }

    #[test]
    fn a_row_has_a_value_for_each_column_and_blanks_for_what_is_not_known() {
        assert_eq!(HEADER.split(',').count(), line(&row(32)).split(',').count());
        assert_eq!(line(&row(32)), "32,3.2e-5,2,1.5,1.25,,0,,,3,480,0,10,20,30,1,2.5,4\n");
        let rebalanced = BalanceRow {
            rebalanced: Some([1.5, 1.01]),
            imbalance_seconds: Some(1.4),
            rebalance_seconds: 0.5,
            ..row(64)
        };
        assert_eq!(line(&rebalanced), "64,6.4e-5,2,1.5,1.25,1.4,1,1.5,1.01,3,480,0.5,10,20,30,1,2.5,4\n");
    }

    /// A resumed run writes the rows of the steps that it does again once, not twice.
    #[test]
    fn resuming_drops_the_rows_after_the_step() {
        let dir = tempfile::tempdir().unwrap();
        let mut writer = BalanceWriter::create(dir.path()).unwrap();
        for step in [32, 64, 96] {
            writer.row(&row(step)).unwrap();
        }
        let whole = fs::read_to_string(dir.path().join(BALANCE_FILE)).unwrap();
        let mut resumed = BalanceWriter::resume(dir.path(), 64).unwrap();
        assert_ne!(fs::read_to_string(dir.path().join(BALANCE_FILE)).unwrap(), whole);
        resumed.row(&row(96)).unwrap();
        assert_eq!(fs::read_to_string(dir.path().join(BALANCE_FILE)).unwrap(), whole);
        assert_eq!(whole.lines().next(), Some(HEADER));
    }
}
