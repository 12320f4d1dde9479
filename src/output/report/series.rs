//! The history as a page holds it: in the units of the scene, and thinned where it is long.
//!
//! A row is a mean over its window. Rows that are joined are the mean of their means, so that what a page shows of a long
//! history are the averages of longer windows.

use serde::Serialize;

use super::super::history::History;
use super::columns::Meaning;
use super::packed;

/// Of all columns together, in one page.
pub const MOST_VALUES: usize = 1_500_000;

/// The columns of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Series {
    pub name: String,
    pub rows: usize,
    pub time: String,
    pub columns: Vec<Packed>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Packed {
    pub head: String,
    pub values: String,
}

/// So many rows are joined, for a page of so many values at most.
pub fn joined(history: &History, most: usize) -> usize {
    let values = history.rows().len() * history.headers().len();
    values.div_ceil(most.max(1)).max(1)
}

impl Series {
    /// `axis`: the column of the time, s.
    pub fn new(name: &str, history: &History, meanings: &[Meaning], axis: usize, join: usize) -> Series {
        let groups = || history.rows().chunks(join);
        let mean =
            |rows: &[Vec<f64>], column: usize| rows.iter().map(|row| row[column]).sum::<f64>() / rows.len() as f64;
        let values = |column: usize| {
            let factor = meanings[column].unit.factor;
            packed::floats(groups().map(move |rows| mean(rows, column) / factor))
        };
        let column = |(index, head): (usize, &String)| Packed { head: head.clone(), values: values(index) };
        Series {
            name: name.to_owned(),
            rows: groups().len(),
            time: values(axis),
            columns: history.headers().iter().enumerate().map(column).collect(),
        }
    }
}

/// Root mean square of the difference of two columns over the mean of the first, both at the rows of the first within the
/// span of the second, which is linear between its rows; `None` without such rows.
pub fn relative_difference(first: &[[f64; 2]], second: &[[f64; 2]]) -> Option<f64> {
    let (mut square, mut mean, mut count) = (0.0, 0.0, 0.0);
    let mut next = 0;
    for &[time, value] in first {
        while next < second.len() && second[next][0] < time {
            next += 1;
        }
        let other = match (next.checked_sub(1).map(|k| second[k]), second.get(next)) {
            (_, Some(&[at, value])) if at == time => value,
            (Some([early, low]), Some(&[late, high])) => low + (high - low) * (time - early) / (late - early),
            _ => continue,
        };
        square += (value - other) * (value - other);
        mean += value.abs();
        count += 1.0;
    }
    let relative = (square / count).sqrt() / (mean / count);
    relative.is_finite().then_some(relative)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::Column;
    use crate::scene::UnitSystem;

    #[test]
    fn joined_rows_are_means_in_the_units_of_the_scene() {
        let mut history = History::new(&[Column::new("time", "s"), Column::new("a:pressure", "pa")]).unwrap();
        (0..5).for_each(|k| history.push(&[f64::from(k), 1e6 * f64::from(k * k)]).unwrap());
        let meanings: Vec<Meaning> = history.headers().iter().map(|head| Meaning::of(head, UnitSystem::TMmS)).collect();
        let series = Series::new("run", &history, &meanings, 0, 2);
        assert_eq!(series.rows, 3);
        assert_eq!(series.time, packed::floats([0.5, 2.5, 4.0].into_iter()));
        assert_eq!(series.columns[1].values, packed::floats([0.5, 6.5, 16.0].into_iter()));
        assert_eq!((joined(&history, 10), joined(&history, 9), joined(&history, 1)), (1, 2, 10));
    }

    #[test]
    fn differences_are_relative_and_between_rows() {
        let first = [[0.0, 10.0], [1.0, 10.0], [2.0, 10.0]];
        let slanted = [[0.5, 10.0], [1.5, 12.0]];
        // Only the row at 1 s is within the span: 11 there.
        assert!((relative_difference(&first, &slanted).unwrap() - 0.1).abs() < 1e-12);
        assert_eq!(relative_difference(&first, &first), Some(0.0));
        assert_eq!(relative_difference(&first, &[]), None);
        assert_eq!(relative_difference(&[[0.0, 0.0]], &[[0.0, 0.0]]), None);
    }
}
