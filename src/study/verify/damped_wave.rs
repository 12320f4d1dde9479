//! A damped cosine fitted to a series.

/// Frequency and damping of e^(-b t) (A cos w t + B sin w t) + C nearest to a series, A, B and C being the best for
/// each: by a search on ever finer grids.
pub(super) fn fit(series: &[(f64, f64)], guess: f64) -> [f64; 2] {
    let misfit = |w: f64, b: f64| {
        let columns = |t: f64| [(-b * t).exp() * (w * t).cos(), (-b * t).exp() * (w * t).sin(), 1.0];
        let mut matrix = [[0.0; 4]; 3];
        for &(t, value) in series {
            let c = columns(t);
            for row in 0..3 {
                for column in 0..3 {
                    matrix[row][column] += c[row] * c[column];
                }
                matrix[row][3] += c[row] * value;
            }
        }
        let best = solved(matrix);
        series.iter().map(|&(t, v)| (v - columns(t).iter().zip(best).map(|(c, a)| c * a).sum::<f64>()).powi(2)).sum()
    };
    let (mut center, mut reach) = ([guess, 0.05 * guess], [0.2 * guess, 0.05 * guess]);
    for _ in 0..12 {
        let mut best = (f64::INFINITY, center);
        for i in -6..=6 {
            for k in -6..=6 {
                let at = [center[0] + reach[0] * f64::from(i) / 6.0, center[1] + reach[1] * f64::from(k) / 6.0];
                let found: f64 = misfit(at[0], at[1]);
                if found < best.0 {
                    best = (found, at);
                }
            }
        }
        center = best.1;
        reach = reach.map(|r| 0.5 * r);
    }
    center
}

/// Gauss elimination of three equations with pivots on the diagonal.
fn solved(mut m: [[f64; 4]; 3]) -> [f64; 3] {
    for pivot in 0..3 {
        for row in pivot + 1..3 {
            let factor = m[row][pivot] / m[pivot][pivot];
            let above = m[pivot];
            m[row].iter_mut().zip(above).for_each(|(entry, above)| *entry -= factor * above);
        }
    }
    let mut x = [0.0; 3];
    for row in (0..3).rev() {
        let known: f64 = (row + 1..3).map(|k| m[row][k] * x[k]).sum();
        x[row] = (m[row][3] - known) / m[row][row];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A damped cosine's frequency and damping are found, also with an offset and some noise.
    #[test]
    fn the_fit_finds_frequency_and_damping() {
        let value = |t: f64, k: usize| {
            0.1 * (-0.4 * t).exp() * (3.7 * t).cos() + 0.01 + 1e-4 * f64::from((k * 7919 % 13) as u32) / 13.0
        };
        let series: Vec<(f64, f64)> = (0..80).map(|k| (0.05 * k as f64, value(0.05 * k as f64, k))).collect();
        let [frequency, damping] = fit(&series, 3.9);
        assert!((frequency - 3.7).abs() < 5e-3 && (damping - 0.4).abs() < 1e-2, "{frequency} {damping}");
    }
}
