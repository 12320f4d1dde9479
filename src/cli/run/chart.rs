//! `pressure.svg`: each chamber's pressure (solid) over its control-volume reference (dashed). The legend
//! states the largest relative difference over time, and that of the two peaks.

use std::path::Path;

use crate::output::{History, OutputError, PALETTE, Series, line_chart};
use crate::scene::Scene;

use super::table::{Owners, pressure_columns, time_column};

pub fn draw(path: &Path, scene: &Scene, history: &History) -> Result<(), OutputError> {
    let series: Vec<Series> = Owners::of(scene)
        .chambers
        .iter()
        .enumerate()
        .flat_map(|(index, owner)| chamber(owner, PALETTE[index % PALETTE.len()], history))
        .collect();
    line_chart(path, &format!("{}: chamber pressures", scene.title), "time, ms", "pressure, kPa", &series)
}

fn chamber(owner: &str, colour: [u8; 3], history: &History) -> [Series; 2] {
    let time = time_column().header();
    // ms and kPa.
    let points = |header: String| -> Vec<[f64; 2]> {
        let points = history.points(&time, &header).unwrap_or_default();
        points.into_iter().map(|[time, pressure]| [1e3 * time, 1e-3 * pressure]).collect()
    };
    let [measured, expected] = pressure_columns(owner).map(|column| points(column.header()));
    let name = format!("{owner}, control volume{}", comparison(&measured, &expected));
    [
        Series { name: owner.to_owned(), points: measured, dashed: false, colour },
        Series { name, points: expected, dashed: true, colour },
    ]
}

/// In words, where there is something to compare.
fn comparison(measured: &[[f64; 2]], expected: &[[f64; 2]]) -> String {
    let relative = |found: f64, reference: f64| (found - reference) / reference;
    let differences = measured.iter().zip(expected).map(|(m, e)| (relative(m[1], e[1]), m[0]));
    let largest = differences.filter(|(error, _)| error.is_finite()).max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    let peak = |points: &[[f64; 2]]| points.iter().map(|point| point[1]).fold(f64::NEG_INFINITY, f64::max);
    let of_peak = relative(peak(measured), peak(expected));
    match largest {
        Some((error, time)) => {
            format!(
                " (largest difference {:+.2} % at {time:.2} ms, of the peak {:+.2} %)",
                100.0 * error,
                100.0 * of_peak
            )
        }
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_difference_and_that_of_the_peak_are_told() {
        let expected = [[0.0, 100.0], [1.0, 200.0], [2.0, 150.0]];
        let measured = [[0.0, 99.0], [1.0, 202.0], [2.0, 144.0]];
        let text = " (largest difference -4.00 % at 2.00 ms, of the peak +1.00 %)";
        assert_eq!(comparison(&measured, &expected), text);
        assert_ne!(comparison(&expected, &expected), text);
    }

    #[test]
    fn nothing_to_compare_is_nothing_to_tell() {
        assert_eq!(comparison(&[], &[]), "");
        assert_eq!(comparison(&[[0.0, 1.0]], &[[0.0, 0.0]]), "");
    }
}
