//! `history_mean.csv`: mean and spread of the histories of runs that differ in their seed alone.
//!
//! Row k is that of the k-th rows of all runs. For each column of the history three: its name, the mean; `name:sd`, the
//! standard deviation over the runs (n - 1 in the denominator); `name:se`, the standard error of the mean, sd/sqrt(n). The
//! time is a column like the others: a window is a whole number of step intervals, whose length follows the gas, so runs
//! may differ a little in where it ends.

use super::OutputError;
use super::history::History;

/// Windows of a row may lie apart by this share of their length, no more.
const APART: f64 = 0.5;

/// The columns whose windows must agree: the middle of a window and its end.
const TIMES: [&str; 2] = ["time_s", "window_end_s"];

/// The table of the histories of at least two runs; `names` are those of the runs, for messages.
///
/// # Errors
/// If the histories differ in their columns or in the number of rows, or the windows of a row do not line up.
pub fn spread(histories: &[History], names: &[String]) -> Result<History, OutputError> {
    let [first, others @ ..] = histories else { return Err(OutputError::NoSpread { found: 0 }) };
    if others.is_empty() {
        return Err(OutputError::NoSpread { found: 1 });
    }
    let differ = |index: usize, what: String| OutputError::Unlike {
        one: names.first().cloned().unwrap_or_default(),
        other: names.get(index + 1).cloned().unwrap_or_default(),
        what,
    };
    for (index, other) in others.iter().enumerate() {
        if other.headers() != first.headers() {
            return Err(differ(index, "have other columns".into()));
        }
        let (own, found) = (first.rows().len(), other.rows().len());
        if own != found {
            return Err(differ(index, format!("have {own} and {found} rows, so that no row belongs to another")));
        }
    }
    for column in TIMES {
        let Some(times) = first.column(column) else { continue };
        for (index, other) in others.iter().enumerate() {
            let own = other.column(column).unwrap_or_default();
            let length = |row: usize| if row == 0 { times[0] } else { times[row] - times[row - 1] };
            let apart = (0..times.len()).find(|&row| {
                let off = (own[row] - times[row]).abs();
                off.is_nan() || off > APART * length(row)
            });
            if let Some(row) = apart {
                let (a, b) = (times[row], own[row]);
                return Err(differ(
                    index,
                    format!("do not line up: in row {} {column} is {a} and {b}; ask for fewer `rows`", row + 1),
                ));
            }
        }
    }
    let headers = first.headers().iter().flat_map(|head| [head.clone(), format!("{head}:sd"), format!("{head}:se")]);
    let mut table = History::with_headers(headers.collect())?;
    let count = histories.len() as f64;
    for row in 0..first.rows().len() {
        let of_column = |column: usize| {
            let values = || histories.iter().map(|history| history.rows()[row][column]);
            // Equal values have exactly their mean and no spread, whatever rounding would make of their sum.
            let reference = first.rows()[row][column];
            let mean = reference + values().map(|value| value - reference).sum::<f64>() / count;
            let deviation = (values().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt();
            [mean, deviation, deviation / count.sqrt()]
        };
        let values: Vec<f64> = (0..first.headers().len()).flat_map(of_column).collect();
        table.push(&values)?;
    }
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::Column;

    fn history(rows: &[[f64; 2]]) -> History {
        let mut history = History::new(&[Column::new("time", "s"), Column::new("box:pressure", "pa")]).unwrap();
        rows.iter().for_each(|row| history.push(row).unwrap());
        history
    }

    fn names(count: usize) -> Vec<String> {
        (1..=count).map(|k| format!("seed-{k}")).collect()
    }

    /// 1, 2, 6: mean 3, standard deviation sqrt(7), standard error sqrt(7/3).
    #[test]
    fn every_column_has_its_mean_and_spread() {
        let runs = [1.0, 2.0, 6.0].map(|pressure| history(&[[1.0, 5.0], [2.0, pressure]]));
        let table = spread(&runs, &names(3)).unwrap();
        let heads = ["time_s", "time_s:sd", "time_s:se", "box:pressure_pa", "box:pressure_pa:sd", "box:pressure_pa:se"];
        assert_eq!(table.headers(), heads);
        assert_eq!(table.rows()[0], [1.0, 0.0, 0.0, 5.0, 0.0, 0.0]);
        let last = &table.rows()[1];
        assert!((last[3] - 3.0).abs() < 1e-12 && (last[4] - 7f64.sqrt()).abs() < 1e-12);
        assert!((last[5] - (7f64 / 3.0).sqrt()).abs() < 1e-12);
        // No spread of what is equal, even if its multiples are no numbers of the machine.
        let same = [0, 1, 2].map(|_| history(&[[0.1, 101_325.7]]));
        assert_eq!(spread(&same, &names(3)).unwrap().rows()[0], [0.1, 0.0, 0.0, 101_325.7, 0.0, 0.0]);
    }

    #[test]
    fn rows_that_do_not_line_up_are_refused_by_name() {
        let first = history(&[[1.0, 1.0], [2.0, 1.0]]);
        let said = |other: History| spread(&[first.clone(), other], &names(2)).unwrap_err().to_string();
        let shorter = said(history(&[[1.0, 1.0]]));
        assert!(
            shorter.contains("seed-1") && shorter.contains("seed-2") && shorter.contains("2 and 1 rows"),
            "{shorter}"
        );
        let shifted = said(history(&[[1.0, 1.0], [2.6, 1.0]]));
        assert!(shifted.contains("row 2") && shifted.contains("2.6"), "{shifted}");
        assert!(spread(&[first.clone(), history(&[[1.0, 1.0], [2.4, 1.0]])], &names(2)).is_ok());
        let other = History::new(&[Column::new("time", "s")]).unwrap();
        assert!(said(other).contains("other columns"));
        assert!(spread(&[first], &names(1)).is_err() && spread(&[], &[]).is_err());
    }
}
