//! From a curve cp(T) to a partition function: the weights h_K >= 0 of [`Modes`] by non-negative least squares
//! (docs/explanation/method.md, "Heat capacities").
//!
//! With u = (nu0 + L) R T the internal energy, L = d ln h / d ln T and cv = (nu0 + L + dL/dlnT) R. The target h of a
//! curve follows from L by integration; sums S_j = sum_K K^j h_K T^K over the target are S_0 = 1, S_1 = L, S_2 = L^2 +
//! dL/dlnT where the fit is exact. Rows of the least squares are the errors of S_0, of L and of cv, each to first
//! order in the h_K and relative to cp, at points of the range.
//!
//! A curve leaves two numbers open: nu0, and the internal energy at the coldest point (no curve is known down to
//! 0 K). First tried is what the polynomial itself says down to 0 K: nu0 = a/R - 5/2. Where that does not fit, nu0 of
//! 0, 1/2, 1, 3/2 (a molecule that does not rotate, ..., one that turns about three axes) are tried with energies
//! from the least to the most possible, and the best taken.

use super::least_squares::non_negative;
use super::species::{Mode, Modes};
use crate::scene::GAS_CONSTANT as R;

/// Points of the range, evenly spaced in ln T.
const POINTS: usize = 28;
/// Weights of the rows: of h itself, of L, of cv.
const ROWS: [f64; 3] = [0.02, 0.1, 1.0];
/// The device has room for this many modes of a gas.
pub const MOST_MODES: usize = 32;
/// A mode that has less than this share everywhere is left out.
const NEGLIGIBLE: f64 = 1e-7;
/// A residual that is good enough to stop looking.
const GOOD: f64 = 1e-4;

/// The modes of cp = a + b T + c T^2 (J/(mol K)) over a range of temperatures (K); `None` where it falls to 3/2 R + R or
/// below within it. Whether the residual will do is for the caller to say.
pub fn fit(cp: [f64; 3], range: [f64; 2]) -> Option<Modes> {
    let curve = Curve { cp, range };
    let least = (0..=POINTS).map(|k| curve.internal_cv(curve.temperature(k, POINTS))).fold(f64::INFINITY, f64::min);
    if least <= 0.0 {
        return None;
    }
    let coldest = curve.internal_cv(range[0]);
    let natural = cp[0] / R - 2.5;
    let mut best: Option<Modes> = None;
    let mut take = |found: Option<Modes>| {
        if let Some(found) = found
            && best.as_ref().is_none_or(|best| found.residual < best.residual)
        {
            best = Some(found);
        }
        best.as_ref().is_some_and(|best| best.residual < GOOD)
    };
    if natural >= 0.0 && take(curve.modes(natural, curve.energy_from_zero())) {
        return best;
    }
    for nu0 in [1.0, 1.5, 0.5, 0.0] {
        for eighths in 0..=8 {
            let energy = nu0 + (coldest - nu0) * f64::from(eighths) / 8.0;
            if coldest >= nu0 && take(curve.modes(nu0, energy)) {
                return best;
            }
        }
    }
    best
}

/// cp, and where it counts.
struct Curve {
    cp: [f64; 3],
    range: [f64; 2],
}

impl Curve {
    /// Of `count` + 1 temperatures from the coldest to the hottest.
    fn temperature(&self, index: usize, count: usize) -> f64 {
        let [low, high] = self.range;
        low * libm::exp(libm::log(high / low) * index as f64 / count as f64)
    }

    fn cp(&self, temperature: f64) -> f64 {
        let [a, b, c] = self.cp;
        a + temperature * (b + temperature * c)
    }

    /// cv of the internal energy over R.
    fn internal_cv(&self, temperature: f64) -> f64 {
        self.cp(temperature) / R - 2.5
    }

    /// The integral of cp/R - 5/2 from 0 K over T, at the coldest point.
    fn energy_from_zero(&self) -> f64 {
        let ([a, b, c], t) = (self.cp, self.range[0]);
        (a + t * (b / 2.0 + t * c / 3.0)) / R - 2.5
    }

    /// L at a temperature: u/(R T) - nu0, with `coldest` = u/(R T) at the coldest point.
    fn slope(&self, nu0: f64, coldest: f64, temperature: f64) -> f64 {
        let [a, b, c] = self.cp;
        let antiderivative = |t: f64| (a + t * (b / 2.0 + t * c / 3.0)) * t / R - 2.5 * t;
        let low = self.range[0];
        (coldest * low + antiderivative(temperature) - antiderivative(low)) / temperature - nu0
    }

    /// The fit with one choice of what is open; `None` where the internal energy would fall below that of nu0.
    fn modes(&self, nu0: f64, coldest: f64) -> Option<Modes> {
        let scale = self.range[1];
        let slopes: Vec<f64> = (0..=POINTS).map(|k| self.slope(nu0, coldest, self.temperature(k, POINTS))).collect();
        if slopes.iter().any(|slope| *slope < -1e-9) {
            return None;
        }
        let hottest = slopes.iter().copied().fold(0.0, f64::max);
        // Beyond the mean by six standard deviations of a Poisson distribution.
        let most = (hottest + 6.0 * (hottest + 0.5).sqrt() + 4.0).min(60.0) as usize;
        let step = libm::log(self.range[1] / self.range[0]) / POINTS as f64;
        let mut ln_target = 0.0;
        let (mut matrix, mut right) = (vec![Vec::new(); most + 1], Vec::new());
        // From the hottest point down, where h is 1.
        for k in (0..=POINTS).rev() {
            let temperature = self.temperature(k, POINTS);
            let slope = slopes[k];
            if k < POINTS {
                // The integral of L dlnT by Simpson's rule.
                let between = temperature * libm::exp(0.5 * step);
                ln_target -= step / 6.0 * (slope + 4.0 * self.slope(nu0, coldest, between) + slopes[k + 1]);
            }
            let change = self.internal_cv(temperature) - nu0 - slope;
            let relative = R / self.cp(temperature);
            let ln = libm::log(temperature / scale);
            let rows = [
                [1.0, 0.0, 0.0].map(|value| ROWS[0] * value),
                [-slope, 1.0, 0.0].map(|value| ROWS[1] * relative * value),
                [slope * slope - slope - change, 1.0 - 2.0 * slope, 1.0].map(|value| ROWS[2] * relative * value),
            ];
            let exact = [1.0, slope, slope * slope + change];
            let product = |row: &[f64; 3], sums: [f64; 3]| row[0] * sums[0] + row[1] * sums[1] + row[2] * sums[2];
            for row in &rows {
                for (power, column) in matrix.iter_mut().enumerate() {
                    let power = power as f64;
                    let value = libm::exp(power * ln - ln_target);
                    column.push(product(row, [value, power * value, power * power * value]));
                }
                right.push(product(row, exact));
            }
        }
        let weights = non_negative(&matrix, &right);
        self.kept(nu0, &weights)
    }

    /// The modes that matter, with the residual that they leave.
    fn kept(&self, nu0: f64, weights: &[f64]) -> Option<Modes> {
        let mode = |(power, &weight): (usize, &f64)| {
            (weight > 0.0).then(|| Mode { power: power as f64, ln_weight: libm::log(weight) })
        };
        let modes: Vec<Mode> = weights.iter().enumerate().filter_map(mode).collect();
        if modes.is_empty() {
            return None;
        }
        let mut found = Modes { nu0, scale: self.range[1], range: self.range, residual: 0.0, modes };
        let share = |modes: &Modes, index: usize| {
            // Shares of powers are largest at an end of the range or between; the points see it.
            (0..=POINTS).map(|k| modes.share(index, self.temperature(k, POINTS))).fold(0.0, f64::max)
        };
        let mut shares: Vec<(f64, Mode)> =
            (0..found.modes.len()).map(|index| (share(&found, index), found.modes[index])).collect();
        shares.retain(|(share, _)| *share >= NEGLIGIBLE);
        shares.sort_by(|a, b| b.0.total_cmp(&a.0));
        shares.truncate(MOST_MODES);
        shares.sort_by(|a, b| a.1.power.total_cmp(&b.1.power));
        found.modes = shares.into_iter().map(|(_, mode)| mode).collect();
        found.residual = (0..=4 * POINTS)
            .map(|k| {
                let temperature = self.temperature(k, 4 * POINTS);
                let [mean, variance] = found.moments(temperature);
                let cp = self.cp(temperature);
                ((nu0 + mean + variance - self.internal_cv(temperature)) * R / cp).abs()
            })
            .fold(0.0, f64::max);
        Some(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RANGE: [f64; 2] = [235.0, 1080.0];

    #[test]
    fn a_linear_curve_gets_the_poisson_weights() {
        let slope = 0.005;
        let modes = fit([3.5 * R, slope * R, 0.0], RANGE).unwrap();
        assert!(modes.residual < 1e-4, "{modes:?}");
        assert!((modes.nu0 - 1.0).abs() < 1e-12);
        // h_K = alpha^K / K!, alpha = b / 2R.
        let weight = |power: f64| modes.modes.iter().find(|mode| mode.power == power).map(|mode| mode.ln_weight);
        let alpha = 0.5 * slope * RANGE[1];
        let ratio = |k: f64| libm::exp(weight(k).unwrap() - weight(k - 1.0).unwrap()) / (alpha / k);
        assert!((ratio(1.0) - 1.0).abs() < 0.02 && (ratio(2.0) - 1.0).abs() < 0.05, "{modes:?}");
    }

    /// Air, nitrogen, carbon dioxide, water, methane and propane as quadratics of the usual tables.
    #[test]
    fn gases_of_the_tables_are_met_within_a_per_cent() {
        for (name, cp, most) in [
            ("air", [28.11, 1.967e-3, 4.802e-6], 2e-3),
            ("nitrogen", [27.2, 4.93e-3, 0.0], 2e-3),
            ("carbon dioxide", [23.0, 5.6e-2, -2.2e-5], 1e-2),
            ("water", [32.24, 1.923e-3, 1.055e-5], 2e-3),
            ("methane", [19.89, 5.024e-2, 1.269e-5], 1e-2),
            ("propane", [-4.04, 3.048e-1, -1.572e-4], 1e-2),
        ] {
            let modes = fit(cp, [290.0, 900.0]).unwrap();
            assert!(modes.residual < most, "{name}: {modes:?}");
            assert!(modes.modes.len() <= MOST_MODES);
        }
    }

    /// The residual is the largest difference of the heat capacities themselves.
    #[test]
    fn the_residual_is_what_the_heat_capacity_is_off() {
        let cp = [23.0, 5.6e-2, -2.2e-5];
        let modes = fit(cp, RANGE).unwrap();
        let worst = (0..=400).map(|k| RANGE[0] + (RANGE[1] - RANGE[0]) * f64::from(k) / 400.0).map(|t: f64| {
            let [mean, variance] = modes.moments(t);
            let asked = cp[0] + t * (cp[1] + t * cp[2]);
            ((2.5 + modes.nu0 + mean + variance) * R / asked - 1.0).abs()
        });
        let worst = worst.fold(0.0, f64::max);
        assert!((worst / modes.residual - 1.0).abs() < 0.02, "{worst} {}", modes.residual);
    }

    /// No classical gas has a heat capacity that falls.
    #[test]
    fn a_falling_curve_leaves_a_residual() {
        let modes = fit([45.0, -0.02, 0.0], [290.0, 900.0]).unwrap();
        assert!(modes.residual > 0.01, "{}", modes.residual);
        assert!(fit([20.0, -0.01, 0.0], [290.0, 900.0]).is_none(), "less than a monatomic gas has");
    }
}
