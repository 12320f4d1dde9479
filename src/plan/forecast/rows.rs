//! The rows of a history: each is of whole intervals of steps, so where steps are long it is longer than was asked for,
//! and the last shorter.

/// A row of the history.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    pub index: usize,
    /// s.
    pub window: f64,
}

/// The lengths of rows that should be of `window` and are of whole intervals, and their shares of all.
pub fn windows(end: f64, window: f64, interval: f64) -> Vec<(f64, f64)> {
    if interval <= window {
        return vec![(window, 1.0)];
    }
    let whole = (end / interval * (1.0 + 1e-9)).floor();
    let rest = end - whole * interval;
    if whole < 1.0 {
        return vec![(end, 1.0)];
    }
    let rows = whole + if rest > 1e-6 * interval { 1.0 } else { 0.0 };
    vec![(interval, whole / rows), (rest.max(1e-6 * interval), 1.0 - whole / rows)]
}

#[cfg(test)]
mod tests {
    use super::windows;

    /// Rows of 3 intervals and a bit: three of an interval, and one of what is left.
    #[test]
    fn long_intervals_are_rows() {
        assert_eq!(windows(1.0, 0.05, 0.01), [(0.05, 1.0)]);
        let found = windows(1.0, 0.05, 0.3);
        assert!(found[0] == (0.3, 0.75) && (found[1].0 - 0.1).abs() < 1e-12 && found[1].1 == 0.25, "{found:?}");
        let even = windows(0.9, 0.05, 0.3);
        assert!(even[0] == (0.3, 1.0) && even[1].1 == 0.0, "{even:?}");
        assert_eq!(windows(0.2, 0.05, 0.3), [(0.2, 1.0)]);
    }
}
