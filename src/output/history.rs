//! The history: one row of averages per output time, as a table in memory and as `history.csv`.
//!
//! A column is headed `name_unit` (`inner:pressure_pa`), or `name` alone where the unit is empty. A value is
//! written with the fewest digits that read back to the same f64. The writer hands each row to the
//! system whole, so a killed run leaves every finished row.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::OutputError;
use super::appended::{AppendedFile, AppendedState};
use super::error::write_atomically;
use super::names::HISTORY_FILE;

/// What one column holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// For instance `inner:pressure`.
    pub name: String,
    /// In lower case (`s`, `pa`, `k`, `kg_m3`); empty for a pure number.
    pub unit: &'static str,
}

impl Column {
    pub fn new(name: impl Into<String>, unit: &'static str) -> Column {
        Column { name: name.into(), unit }
    }

    /// The column's head in the file.
    pub fn header(&self) -> String {
        if self.unit.is_empty() { self.name.clone() } else { format!("{}_{}", self.name, self.unit) }
    }
}

/// The table in memory: every row is as long as the list of headers, and headers are unique.
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    headers: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl History {
    /// An empty table. Errors: two columns with the same header.
    pub fn new(columns: &[Column]) -> Result<History, OutputError> {
        History::with_headers(columns.iter().map(Column::header).collect())
    }

    /// An empty table under these headers. Errors: two are the same.
    pub(super) fn with_headers(headers: Vec<String>) -> Result<History, OutputError> {
        if let Some(header) = repeated(&headers) {
            return Err(OutputError::DuplicateColumn { header });
        }
        Ok(History { headers, rows: Vec::new() })
    }

    pub fn headers(&self) -> &[String] {
        &self.headers
    }

    pub fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    /// Appends a row in the order of the columns. Errors: a row of another length.
    pub fn push(&mut self, row: &[f64]) -> Result<(), OutputError> {
        if row.len() != self.headers.len() {
            return Err(OutputError::RowLength { found: row.len(), expected: self.headers.len() });
        }
        self.rows.push(row.to_vec());
        Ok(())
    }

    /// The values under a header, or `None` if the table has no such column.
    pub fn column(&self, header: &str) -> Option<Vec<f64>> {
        let index = self.headers.iter().position(|h| h == header)?;
        Some(self.rows.iter().map(|row| row[index]).collect())
    }

    /// The points (x, y) of one column against another, for a chart.
    pub fn points(&self, x_header: &str, y_header: &str) -> Option<Vec<[f64; 2]>> {
        let x = self.column(x_header)?;
        let y = self.column(y_header)?;
        Some(x.into_iter().zip(y).map(|(x, y)| [x, y]).collect())
    }

    /// The same bytes as a [`HistoryWriter`] leaves for these rows.
    pub fn write_csv(&self, path: &Path) -> Result<(), OutputError> {
        write_atomically(path, |out| {
            out.write_all(&csv_line(self.headers.iter().map(String::as_str))?)?;
            for row in &self.rows {
                out.write_all(&csv_line(row.iter().map(|&value| number(value)))?)?;
            }
            Ok(())
        })
    }

    /// Errors name the file, the line and the column.
    pub fn read(path: &Path) -> Result<History, OutputError> {
        History::from_csv(path, File::open(path).map_err(OutputError::io("open", path))?)
    }

    /// As [`History::read`], of a file that is being written or whose writer was killed: a last line without an end does
    /// not count. Also returns whether there was one.
    pub fn read_so_far(path: &Path) -> Result<(History, bool), OutputError> {
        let bytes = std::fs::read(path).map_err(OutputError::io("open", path))?;
        let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
        Ok((History::from_csv(path, &bytes[..whole])?, whole < bytes.len()))
    }

    /// `path` stands in messages.
    fn from_csv(path: &Path, text: impl Read) -> Result<History, OutputError> {
        let bad_row = |line: u64, problem: String| OutputError::BadRow { path: path.to_path_buf(), line, problem };
        let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(text);
        let headers: Vec<String> =
            reader.headers().map_err(|error| bad_row(1, error.to_string()))?.iter().map(str::to_owned).collect();
        if headers.is_empty() {
            return Err(bad_row(1, "the file is empty".to_owned()));
        }
        if let Some(header) = repeated(&headers) {
            return Err(bad_row(1, format!("two columns are called {header:?}")));
        }
        let mut rows = Vec::new();
        for record in reader.records() {
            let record =
                record.map_err(|error| bad_row(error.position().map_or(0, |at| at.line()), error.to_string()))?;
            let line = record.position().map_or(0, |at| at.line());
            if record.len() != headers.len() {
                let (found, expected) = (record.len(), headers.len());
                return Err(bad_row(line, format!("{found} values where the header has {expected} columns")));
            }
            let mut row = Vec::with_capacity(headers.len());
            for (field, header) in record.iter().zip(&headers) {
                row.push(field.parse().map_err(|_| OutputError::BadValue {
                    path: path.to_path_buf(),
                    line,
                    header: header.clone(),
                    found: field.to_owned(),
                })?);
            }
            rows.push(row);
        }
        Ok(History { headers, rows })
    }
}

/// Writes `history.csv` as the run goes and keeps the table.
#[derive(Debug)]
pub struct HistoryWriter {
    file: AppendedFile,
    history: History,
}

/// How far a history had got.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct HistoryState {
    pub rows: u64,
    pub file: AppendedState,
}

impl HistoryWriter {
    /// Starts `history.csv` in the existing folder `dir` with its header, replacing an earlier one.
    pub fn create(dir: &Path, columns: &[Column]) -> Result<HistoryWriter, OutputError> {
        let history = History::new(columns)?;
        let file = AppendedFile::create(&dir.join(HISTORY_FILE))?;
        let mut writer = HistoryWriter { file, history };
        let header = csv_line(writer.history.headers.iter().map(String::as_str));
        writer.append(header)?;
        Ok(writer)
    }

    /// Goes on with the `history.csv` of `dir`: rows that were written after the state are dropped.
    ///
    /// # Errors
    /// The file is missing, shorter than it was or altered, or its columns are others; then it is left as it is.
    pub fn resume(dir: &Path, columns: &[Column], state: &HistoryState) -> Result<HistoryWriter, OutputError> {
        let path = dir.join(HISTORY_FILE);
        let (file, kept) = AppendedFile::resume(&path, state.file)?;
        let history = History::from_csv(&path, kept.as_slice())?;
        if history.headers != History::new(columns)?.headers {
            return Err(OutputError::OtherColumns { path });
        }
        if history.rows.len() as u64 != state.rows {
            let (found, expected) = (history.rows.len() as u64, state.rows);
            return Err(OutputError::RowCount { path, found, expected });
        }
        Ok(HistoryWriter { file, history })
    }

    /// How far it has got, all of it on the disc.
    pub fn state(&self) -> Result<HistoryState, OutputError> {
        Ok(HistoryState { rows: self.history.rows.len() as u64, file: self.file.state()? })
    }

    /// Appends one row, in the order of the columns, to the file and to the table.
    pub fn row(&mut self, values: &[f64]) -> Result<(), OutputError> {
        self.history.push(values)?;
        self.append(csv_line(values.iter().map(|&value| number(value))))
    }

    pub fn history(&self) -> &History {
        &self.history
    }

    pub fn path(&self) -> &Path {
        self.file.path()
    }

    fn append(&mut self, line: std::io::Result<Vec<u8>>) -> Result<(), OutputError> {
        // One unbuffered write per row: the row is the system's as soon as this returns.
        let line = line.map_err(OutputError::io("write", self.file.path()))?;
        self.file.append(&line)
    }
}

fn csv_line<T: AsRef<[u8]>>(fields: impl Iterator<Item = T>) -> std::io::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(fields)?;
    writer.into_inner().map_err(|error| error.into_error())
}

/// The shortest text that parses back to the same f64.
pub(super) fn number(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 || (1e-4..1e15).contains(&magnitude) { format!("{value}") } else { format!("{value:e}") }
}

fn repeated(headers: &[String]) -> Option<String> {
    let mut seen = std::collections::HashSet::new();
    headers.iter().find(|header| !seen.insert(*header)).cloned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn columns() -> Vec<Column> {
        vec![Column::new("time", "s"), Column::new("inner:pressure", "pa"), Column::new("inner:particles, \"air\"", "")]
    }

    #[test]
    fn the_header_joins_name_and_unit_and_quotes_what_csv_needs() {
        let dir = tempfile::tempdir().unwrap();
        let writer = HistoryWriter::create(dir.path(), &columns()).unwrap();
        let text = std::fs::read_to_string(writer.path()).unwrap();
        assert_eq!(text, "time_s,inner:pressure_pa,\"inner:particles, \"\"air\"\"\"\n");
    }

    #[test]
    fn every_row_is_in_the_file_before_the_writer_ends_and_the_table_writes_the_same_bytes() {
        let dir = tempfile::tempdir().unwrap();
        let mut writer = HistoryWriter::create(dir.path(), &columns()).unwrap();
        writer.row(&[0.0, 101325.0, 12.0]).unwrap();
        writer.row(&[2.5e-7, f64::NAN, -0.0]).unwrap();
        let running = std::fs::read(writer.path()).unwrap();
        assert_eq!(
            std::str::from_utf8(&running).unwrap().lines().skip(1).collect::<Vec<_>>(),
            ["0,101325,12", "2.5e-7,NaN,-0"]
        );
        let whole = dir.path().join("whole.csv");
        writer.history().write_csv(&whole).unwrap();
        assert_eq!(std::fs::read(&whole).unwrap(), running);
        // The comparison can fail: one more row, other bytes.
        writer.row(&[1.0, 2.0, 3.0]).unwrap();
        assert_ne!(std::fs::read(writer.path()).unwrap(), running);
    }

    /// Whatever rows came after the checkpoint, the file and the table end as those of a run without interruption.
    #[test]
    fn a_resumed_history_ends_as_an_uninterrupted_one() {
        let row = |k: usize| [k as f64 * 0.1, if k == 2 { f64::NAN } else { 1.0 / (k as f64 - 3.0) }, -0.0];
        let whole = tempfile::tempdir().unwrap();
        let mut uninterrupted = HistoryWriter::create(whole.path(), &columns()).unwrap();
        (0..6).for_each(|k| uninterrupted.row(&row(k)).unwrap());
        for (cut, lost) in [(0, 3), (3, 0), (3, 2), (6, 0)] {
            let dir = tempfile::tempdir().unwrap();
            let mut writer = HistoryWriter::create(dir.path(), &columns()).unwrap();
            (0..cut).for_each(|k| writer.row(&row(k)).unwrap());
            let state = writer.state().unwrap();
            (0..lost).for_each(|k| writer.row(&[k as f64, 7.0, 7.0]).unwrap());
            drop(writer);
            let mut resumed = HistoryWriter::resume(dir.path(), &columns(), &state).unwrap();
            (cut..6).for_each(|k| resumed.row(&row(k)).unwrap());
            assert_eq!(std::fs::read(resumed.path()).unwrap(), std::fs::read(uninterrupted.path()).unwrap());
            // The table too, by bits: a NaN is not equal to itself.
            let bits = |history: &History| -> Vec<u64> { history.rows.concat().iter().map(|v| v.to_bits()).collect() };
            assert_eq!(bits(resumed.history()), bits(uninterrupted.history()));
        }
    }

    #[test]
    fn a_history_of_other_columns_is_not_gone_on_with() {
        let dir = tempfile::tempdir().unwrap();
        let mut writer = HistoryWriter::create(dir.path(), &columns()).unwrap();
        writer.row(&[0.0, 1.0, 2.0]).unwrap();
        let state = writer.state().unwrap();
        let resumed = HistoryWriter::resume(dir.path(), &columns()[..2], &state);
        assert!(matches!(resumed, Err(OutputError::OtherColumns { .. })));
        let more = HistoryState { rows: 2, ..state };
        assert!(matches!(HistoryWriter::resume(dir.path(), &columns(), &more), Err(OutputError::RowCount { .. })));
    }

    proptest! {
        #[test]
        fn a_value_reads_back_to_the_same_bits(bits in any::<u64>()) {
            let value = f64::from_bits(bits);
            let back: f64 = number(value).parse().unwrap();
            prop_assert!(back.to_bits() == bits || (value.is_nan() && back.is_nan()));
        }
    }

    #[test]
    fn fewer_digits_would_not_read_back() {
        let third = 1.0f64 / 3.0;
        assert_ne!(format!("{third:.15}").parse::<f64>().unwrap(), third);
        assert_eq!(number(third).parse::<f64>().unwrap(), third);
    }

    #[test]
    fn a_written_table_reads_back_and_gives_its_columns() {
        let dir = tempfile::tempdir().unwrap();
        let mut writer = HistoryWriter::create(dir.path(), &columns()).unwrap();
        writer.row(&[0.0, 1.0 / 3.0, 7.0]).unwrap();
        writer.row(&[1e-3, 2e17, 8.0]).unwrap();
        let read = History::read(writer.path()).unwrap();
        assert_eq!(&read, writer.history());
        assert_eq!(read.column("inner:pressure_pa"), Some(vec![1.0 / 3.0, 2e17]));
        let points = read.points("time_s", "inner:pressure_pa");
        assert_eq!(points, Some(vec![[0.0, 1.0 / 3.0], [1e-3, 2e17]]));
        assert_eq!(read.column("outer:pressure_pa"), None);
    }

    #[test]
    fn a_bad_file_is_an_error_with_file_line_and_column() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("history.csv");
        let message = |text: &str| {
            std::fs::write(&path, text).unwrap();
            let message = History::read(&path).unwrap_err().to_string();
            assert!(message.contains("history.csv"), "{message}");
            message
        };
        let word = message("time_s,p_pa\n0,1\n1,high\n");
        assert!(word.contains(":3:") && word.contains("\"p_pa\"") && word.contains("\"high\""), "{word}");
        let short = message("time_s,p_pa\n0,1\n1\n");
        assert!(short.contains(":3: 1 values") && short.contains("2 columns"), "{short}");
        assert!(message("a,a\n0,1\n").contains("two columns are called \"a\""));
        assert!(message("").contains("empty"));
        std::fs::remove_file(&path).unwrap();
        assert!(History::read(&path).unwrap_err().to_string().contains("cannot open"));
    }

    #[test]
    fn rows_of_another_length_and_repeated_columns_are_refused() {
        let mut history = History::new(&columns()).unwrap();
        let error = history.push(&[1.0]).unwrap_err().to_string();
        assert_eq!(error, "a history row has 1 values, the table has 3 columns");
        let twice = [Column::new("a", "pa"), Column::new("a", "pa")];
        assert!(matches!(History::new(&twice), Err(OutputError::DuplicateColumn { .. })));
    }
}
