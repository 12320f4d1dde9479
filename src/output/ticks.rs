//! The numbers along the axes of a chart.

/// Tick labels with just the digits that tell neighbours apart.
pub(super) struct Ticks {
    decimals: usize,
    scientific: bool,
}

impl Ticks {
    /// At most so many labels on an axis.
    pub const WANTED: usize = 9;

    pub fn over(range: &std::ops::Range<f64>) -> Ticks {
        let largest = range.start.abs().max(range.end.abs());
        // The smallest distance at which the axis may set its labels: 1, 2 or 5 times a power of ten.
        let spacing = (range.end - range.start) / (2.5 * Ticks::WANTED as f64);
        let scientific = !(1e-3..1e6).contains(&largest);
        let unit = if scientific { 10f64.powf(largest.log10().floor()) } else { 1.0 };
        let decimals = (-(spacing / unit).log10().floor()).clamp(0.0, 12.0) as usize;
        Ticks { decimals, scientific }
    }

    pub fn label(&self, value: f64) -> String {
        let decimals = self.decimals;
        if self.scientific && value != 0.0 {
            let text = format!("{value:.decimals$e}");
            return match text.split_once('e') {
                Some((mantissa, exponent)) => format!("{}e{exponent}", without_zeros(mantissa)),
                None => text,
            };
        }
        without_zeros(&format!("{value:.decimals$}")).to_owned()
    }
}

fn without_zeros(number: &str) -> &str {
    let short = if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { number };
    if short == "-0" { "0" } else { short }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tick_labels_tell_neighbours_apart_without_idle_zeros() {
        let label = |range: std::ops::Range<f64>, value| Ticks::over(&range).label(value);
        assert_eq!(label(0.0..100.0, 20.0), "20");
        assert_eq!(label(0.0..1.0, 0.2), "0.2");
        assert_eq!(label(101_000.0..101_001.0, 101_000.5), "101000.5");
        assert_eq!(label(0.0..2e7, 5e6), "5e6");
        assert_eq!(label(0.0..2e-7, 1.5e-7), "1.5e-7");
        assert_ne!(label(101.0..101.1, 101.02), label(101.0..101.1, 101.04));
    }
}
