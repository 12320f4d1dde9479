//! Straight lines through loads that drift.
//!
//! Discounted least squares: of each rank's observations (s_k, y_k), s the step and k the age, the line a + b (s - s_0) minimises
//!
//! ```text
//! sum_k KEEP^k (y_k - a - b (s_k - s_0))^2
//! ```
//!
//! with the newest at s_0. All ranks are observed at the same steps, so weights and standard errors are the same for all: with noise of
//! variance v in each observation the variance of a value of the line is v times a sum over the squares of the weights, which
//! [`Trend::at`] gives. A drift is told from noise by the mean square of the ranks' slopes, over what noise would make of it.
//!
//! Source: R. G. Brown, Smoothing, Forecasting and Prediction of Discrete Time Series, Prentice-Hall 1963, chapter 12.

use serde::{Deserialize, Serialize};

/// What an observation counts beside the next newer one.
const KEEP: f64 = 0.75;
/// Observations before a line says anything: with two any noise is a slope.
const FEWEST: u32 = 3;
/// Standard deviations by which the mean square of the slopes must be above that of noise. (Of n ranks, whose loads have one
/// sum, it is that of n - 1 squares.)
const SURE: f64 = 6.0;

/// Sums over observations at x, in steps from the newest: of weight w, w x, w x x.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize, Deserialize)]
struct Moments([f64; 3]);

impl Moments {
    /// A new observation, so many steps after the one before; those before count `keep` of what they did.
    fn add(&mut self, steps: f64, keep: f64) {
        let [zeroth, first, second] = self.0;
        self.0 = [
            keep * zeroth + 1.0,
            keep * (first - steps * zeroth),
            keep * (second - 2.0 * steps * first + steps * steps * zeroth),
        ];
    }
}

#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize)]
pub(super) struct Trend {
    /// The step of the newest observation, and how many there are.
    newest: u64,
    observations: u32,
    weights: Moments,
    /// Of the squares of the weights.
    squares: Moments,
    /// Sums of w y and w x y, by rank.
    loads: Vec<[f64; 2]>,
}

impl Trend {
    pub(super) fn observe(&mut self, step: u64, loads: &[f64]) {
        let steps = step.saturating_sub(self.newest) as f64;
        self.loads.resize(loads.len(), [0.0; 2]);
        for ([sum, moment], load) in self.loads.iter_mut().zip(loads) {
            *moment = KEEP * (*moment - steps * *sum);
            *sum = KEEP * *sum + load;
        }
        self.weights.add(steps, KEEP);
        self.squares.add(steps, KEEP * KEEP);
        self.newest = step;
        self.observations = self.observations.saturating_add(1);
    }

    /// The loads at a step and the variance of each over that of an observation, `variance`; none unless they drift by more than such
    /// noise would let it seem.
    pub(super) fn at(&self, step: u64, variance: f64) -> Option<(Vec<f64>, f64)> {
        let Moments([w0, w1, w2]) = self.weights;
        let determinant = w0 * w2 - w1 * w1;
        if self.observations < FEWEST || determinant <= 0.0 || self.loads.len() < 2 {
            return None;
        }
        let slope = |&[sum, moment]: &[f64; 2]| (w0 * moment - w1 * sum) / determinant;
        // An observation at x is weighed with w (p + q x) in a value of the line.
        let spread = |p: f64, q: f64| {
            let Moments([s0, s1, s2]) = self.squares;
            p * p * s0 + 2.0 * p * q * s1 + q * q * s2
        };
        let of_noise = variance * spread(-w1 / determinant, w0 / determinant);
        let freedoms = (self.loads.len() - 1) as f64;
        let squares = self.loads.iter().map(|load| slope(load).powi(2)).sum::<f64>() / self.loads.len() as f64;
        if squares <= of_noise * (1.0 + SURE * (2.0 / freedoms).sqrt()) {
            return None;
        }
        let ahead = step.saturating_sub(self.newest) as f64;
        let value = |load: &[f64; 2]| (w2 * load[0] - w1 * load[1]) / determinant + slope(load) * ahead;
        let values = self.loads.iter().map(value).collect();
        Some((values, spread((w2 - w1 * ahead) / determinant, (w0 * ahead - w1) / determinant)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Loads on lines are found again at any later step, though they were observed at unequal distances.
    #[test]
    fn lines_are_followed() {
        let mut trend = Trend::default();
        for step in [32, 64, 96, 112, 160] {
            let off = 1e-3 * step as f64;
            trend.observe(step, &[1.0 + off, 1.0 - off]);
        }
        let (loads, spread) = trend.at(200, 1e-8).unwrap();
        assert!((loads[0] - 1.2).abs() < 1e-12 && (loads[1] - 0.8).abs() < 1e-12, "{loads:?}");
        assert!(trend.at(160, 1e-8).unwrap().1 < spread, "what is farther ahead is less sure");
        assert!(trend.at(200, 1.0).is_none(), "noise could be such a drift");
    }

    /// A value of a line is a sum of the observations, each times a factor; the variance is the sum of the squares of these.
    #[test]
    fn the_spread_is_that_of_the_values() {
        let steps = [32, 64, 96];
        let value = |loads: [f64; 3]| {
            let mut trend = Trend::default();
            steps.iter().zip(loads).for_each(|(&step, load)| trend.observe(step, &[load, -load]));
            trend.at(128, 0.0).map(|(loads, spread)| (loads[0], spread))
        };
        let parts = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|loads| value(loads).unwrap());
        let sum: f64 = parts.iter().map(|(part, _)| part * part).sum();
        assert!((parts[0].1 - sum).abs() < 1e-12 * sum, "{} of {sum}", parts[0].1);
    }
}
