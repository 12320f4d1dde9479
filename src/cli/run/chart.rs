//! `pressure.svg`: each chamber's pressure (solid) over its control-volume reference (dashed). The legend
//! states the largest relative difference of their means over stretches of the run, and that of the peaks.

use std::path::Path;

use super::table::{Owners, pressure_columns, time_column};
use crate::output::{History, OutputError, PALETTE, Series, line_chart};
use crate::scene::Scene;

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

/// Stretches of the run over which the two are compared: rows of few particles are noisy, and so is a peak
/// taken from them.
const STRETCHES: usize = 20;

/// The means of the points in each stretch, (time, measured, expected); stretches without points are left out.
fn means(measured: &[[f64; 2]], expected: &[[f64; 2]]) -> Vec<[f64; 3]> {
    let end = measured.last().map_or(0.0, |point| point[0]);
    let mut sums = vec![([0.0; 3], 0.0); STRETCHES];
    for (m, e) in measured.iter().zip(expected) {
        let stretch = ((m[0] / end * STRETCHES as f64) as usize).min(STRETCHES - 1);
        let (sum, count) = &mut sums[stretch];
        for (total, own) in sum.iter_mut().zip([m[0], m[1], e[1]]) {
            *total += own;
        }
        *count += 1.0;
    }
    sums.iter().filter(|(_, count)| *count > 0.0).map(|(sum, count)| sum.map(|total| total / count)).collect()
}

/// In words, where there is something to compare.
fn comparison(measured: &[[f64; 2]], expected: &[[f64; 2]]) -> String {
    let relative = |found: f64, reference: f64| (found - reference) / reference;
    let means = means(measured, expected);
    let differences = means.iter().map(|&[time, m, e]| (relative(m, e), time));
    let largest = differences.filter(|(error, _)| error.is_finite()).max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    let peak = |column: usize| means.iter().map(|mean| mean[column]).fold(f64::NEG_INFINITY, f64::max);
    match largest {
        Some((error, time)) => {
            let of_peak = relative(peak(1), peak(2));
            format!(
                " (means of 1/{STRETCHES} of the run: largest difference {:+.1} % at {time:.1} ms, of the peak {:+.1} %)",
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
        let expected = [[0.1, 100.0], [1.0, 200.0], [2.0, 150.0]];
        let measured = [[0.1, 99.0], [1.0, 202.0], [2.0, 144.0]];
        let text = " (means of 1/20 of the run: largest difference -4.0 % at 2.0 ms, of the peak +1.0 %)";
        assert_eq!(comparison(&measured, &expected), text);
        assert_ne!(comparison(&expected, &expected), text);
        // Two rows of one stretch whose errors cancel do not differ.
        let noisy = [[1.98, 110.0], [2.0, 90.0]];
        assert!(comparison(&noisy, &[[1.98, 100.0], [2.0, 100.0]]).contains("difference +0.0 %"));
    }

    #[test]
    fn nothing_to_compare_is_nothing_to_tell() {
        assert_eq!(comparison(&[], &[]), "");
        assert_eq!(comparison(&[[0.0, 1.0]], &[[0.0, 0.0]]), "");
    }
}
