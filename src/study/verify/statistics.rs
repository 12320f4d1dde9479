//! Means with their standard errors.

/// Mean and standard error of independent values.
pub fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    (mean, (variance / count).sqrt())
}

/// As [`mean_and_error`] for a series of correlated values: the error is that of the means of `blocks`
/// stretches, each of which must be longer than the correlation.
pub fn mean_of_series(values: &[f64], blocks: usize) -> (f64, f64) {
    let length = values.len() / blocks;
    let used = &values[values.len() - blocks * length..];
    let means: Vec<f64> = used.chunks(length).map(|block| block.iter().sum::<f64>() / length as f64).collect();
    mean_and_error(&means)
}

/// Relative standard error of the pressure of so many independent hits (method.md, "Noise").
pub fn error_of_hits(hits: f64) -> f64 {
    1.13 / hits.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sixteen values 0, 1, 0, 1, ...: mean 1/2, standard error .129. Pairs of equal values are half as many.
    #[test]
    fn standard_errors() {
        let fast: Vec<f64> = (0..16).map(|k| f64::from(k % 2)).collect();
        let (mean, error) = mean_and_error(&fast);
        assert!((mean - 0.5).abs() < 1e-12 && (error - 0.129).abs() < 1e-3);
        let slow: Vec<f64> = (0..16).map(|k| f64::from((k / 2) % 2)).collect();
        let (mean, error) = mean_of_series(&slow, 8);
        assert!((mean - 0.5).abs() < 1e-12 && (error - 0.189).abs() < 1e-3);
    }
}
