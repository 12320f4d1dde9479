//! When it pays to cut anew.
//!
//! Observations of the ranks' seconds per step are averaged, and a check compares the averages. Imbalance is the longest over the mean, where the mean is what all
//! would take if each had its share of the work: sum of share x seconds over sum of shares. A rebalance is due if
//!
//! 1. the averaged imbalance is above the threshold,
//! 2. the longest is above the mean by more than four standard errors of the averaged loads and what the largest of n
//!    ranks' noise is expected to be, sqrt(2 ln n) (the noise is learnt from the observations and kept over rebalances),
//! 3. (longest - mean) x steps until the next check is above the averaged seconds of a rebalance.
//!
//! If a rebalance leaves more than half of what was above 1, and the imbalance above the threshold, the next one needs
//! twice as much of each (threshold - 1 and saving), and so on; it needs the plain amounts again once the imbalance has
//! been below the threshold.

use std::fmt;

use serde::{Deserialize, Serialize};

/// What a new check counts in the averages.
const NEW: f64 = 0.25;
/// Relative noise of a load, before any is learnt.
const NOISE: f64 = 0.15;
/// Loads that it counts as, and loads over which the noise is averaged.
const NOISE_PRIOR: f64 = 3.0;
const NOISE_MEMORY: f64 = 20.0;
const STANDARD_ERRORS: f64 = 4.0;
const MOST_DEMAND: f64 = 64.0;

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Trigger {
    threshold: f64,
    /// Seconds of a rebalance: the estimate until one was measured.
    cost: f64,
    measured: bool,
    /// The averaged load of each rank over the mean, the averaged mean, and the sum of squared weights of an average.
    loads: Vec<f64>,
    /// Those of the observation before.
    before_loads: Vec<f64>,
    mean: f64,
    spread: f64,
    /// Since the last rebalance.
    observations: u32,
    /// Half the averaged square of the difference of two successive loads, and how many it is the mean of.
    noise: f64,
    noise_of: f64,
    /// What is asked more after rebalances in vain: a power of two.
    demand: f64,
    /// The imbalance before a rebalance that is yet to be judged.
    before: Option<f64>,
}

/// What a check found.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
pub enum Decision {
    /// There is but one rank, or nothing was measured.
    Idle,
    Balanced {
        imbalance: f64,
        threshold: f64,
    },
    /// The excess of the slowest rank may be noise: it is not above `needed`.
    Unsure {
        imbalance: f64,
        needed: f64,
    },
    /// A rebalance costs more than it saves until the next check.
    TooDear {
        imbalance: f64,
        saving: f64,
        needed: f64,
    },
    Rebalance {
        imbalance: f64,
        saving: f64,
        cost: f64,
    },
}

impl Decision {
    pub fn rebalances(&self) -> bool {
        matches!(self, Decision::Rebalance { .. })
    }
}

impl fmt::Display for Decision {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Decision::Idle => write!(to, "nothing to balance"),
            Decision::Balanced { imbalance, threshold } => {
                write!(to, "no rebalance: imbalance {imbalance:.3} is not above {threshold:.3}")
            }
            Decision::Unsure { imbalance, needed } => {
                write!(to, "no rebalance: imbalance {imbalance:.3} may be noise up to {:.3}", 1.0 + needed)
            }
            Decision::TooDear { imbalance, saving, needed } => write!(
                to,
                "no rebalance: imbalance {imbalance:.3}, but it would save {saving:.3e} s until the next check, and \
                 {needed:.3e} s are needed"
            ),
            Decision::Rebalance { imbalance, saving, cost } => {
                write!(to, "rebalance: imbalance {imbalance:.3}, saves {saving:.3e} s for {cost:.3e} s")
            }
        }
    }
}

impl Trigger {
    /// `threshold`: the imbalance from which on to act, usually 1.1. `estimate`: the seconds of a rebalance, until one
    /// is measured.
    pub fn new(threshold: f64, estimate: f64) -> Trigger {
        Trigger {
            threshold,
            cost: estimate,
            measured: false,
            loads: Vec::new(),
            before_loads: Vec::new(),
            mean: 0.0,
            spread: 0.0,
            observations: 0,
            noise: NOISE * NOISE,
            noise_of: NOISE_PRIOR,
            demand: 1.0,
            before: None,
        }
    }

    /// Takes in the seconds per step of each rank, measured or predicted. What is not finite or nothing is left out.
    ///
    /// # Panics
    /// If there are not as many shares as ranks.
    pub fn observe(&mut self, seconds: &[f64], shares: &[f64]) {
        assert_eq!(seconds.len(), shares.len(), "one share per rank");
        let whole: f64 = shares.iter().sum();
        let mean = seconds.iter().zip(shares).map(|(seconds, share)| seconds * share).sum::<f64>() / whole;
        if mean.is_finite() && mean > 0.0 {
            self.average(seconds, mean);
        }
    }

    /// Decides by what was observed. `steps_to_next`: steps until the next check.
    pub fn check(&mut self, steps_to_next: u64) -> Decision {
        if self.loads.len() < 2 || self.observations == 0 {
            return Decision::Idle;
        }
        let imbalance = self.imbalance();
        self.judge_last(imbalance);
        let threshold = 1.0 + (self.threshold - 1.0) * self.demand;
        if imbalance <= threshold {
            return Decision::Balanced { imbalance, threshold };
        }
        let excess = imbalance - 1.0;
        let largest = (2.0 * libm::log(self.loads.len() as f64)).sqrt();
        let needed = (STANDARD_ERRORS + largest) * (self.noise * self.spread).sqrt();
        if excess <= needed {
            return Decision::Unsure { imbalance, needed };
        }
        let saving = excess * self.mean * steps_to_next as f64;
        if saving <= self.cost * self.demand {
            return Decision::TooDear { imbalance, saving, needed: self.cost * self.demand };
        }
        Decision::Rebalance { imbalance, saving, cost: self.cost }
    }

    /// Says that a rebalance was done and took so many seconds. The loads before it count no more.
    pub fn rebalanced(&mut self, seconds: f64) {
        if seconds.is_finite() && seconds >= 0.0 {
            let part = if self.measured { NEW } else { 1.0 };
            self.cost += part * (seconds - self.cost);
            self.measured = true;
        }
        self.before = (self.observations > 0).then(|| self.imbalance());
        self.observations = 0;
    }

    /// The averaged imbalance; 1 before the first observation.
    pub fn imbalance(&self) -> f64 {
        self.loads.iter().copied().fold(1.0, f64::max)
    }

    /// Averaged seconds of a rebalance.
    pub fn cost(&self) -> f64 {
        self.cost
    }

    fn average(&mut self, seconds: &[f64], mean: f64) {
        if self.loads.len() != seconds.len() {
            self.loads = vec![1.0; seconds.len()];
            self.observations = 0;
        }
        self.observations = self.observations.saturating_add(1);
        let part = (1.0 / f64::from(self.observations)).max(NEW);
        let loads: Vec<f64> = seconds.iter().map(|seconds| seconds / mean).collect();
        for (average, load) in self.loads.iter_mut().zip(&loads) {
            *average += part * (load - *average);
        }
        let before = std::mem::replace(&mut self.before_loads, loads);
        if self.observations > 1 {
            // Of two observations, so that a drift is no noise; both have their own.
            let pairs = self.before_loads.iter().zip(&before);
            let off_square = pairs.map(|(now, then)| (now - then).powi(2)).sum::<f64>() / (2 * seconds.len()) as f64;
            let freedoms = (seconds.len() - 1) as f64;
            self.noise_of = (self.noise_of + freedoms).min(NOISE_MEMORY.max(freedoms));
            self.noise += freedoms / self.noise_of * (off_square - self.noise);
        }
        self.mean += part * (mean - self.mean);
        self.spread = if self.observations == 1 { 1.0 } else { (1.0 - part).powi(2) * self.spread + part * part };
    }

    /// Whether the last rebalance was in vain.
    fn judge_last(&mut self, imbalance: f64) {
        if imbalance <= self.threshold {
            self.demand = 1.0;
        } else if let Some(before) = self.before
            && imbalance - 1.0 > 0.5 * (before - 1.0)
        {
            self.demand = (2.0 * self.demand).min(MOST_DEMAND);
        }
        self.before = None;
    }
}
