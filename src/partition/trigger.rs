//! When it pays to cut anew.
//!
//! Observations of the ranks' seconds per step are averaged, the newest counting the more the less noise they have (from a
//! quarter to all), and a check compares the averages. Loads that drift, as gas does, are not averaged but followed to the step of the
//! check, on straight lines (`trend.rs`): an average of a drift is late. Imbalance is the longest over the mean, where the mean is what all
//! would take if each had its share of the work: sum of share x seconds over sum of shares. A rebalance is due if
//!
//! 1. the imbalance is above the threshold, by two of its standard errors if they are small,
//! 2. the longest is above the mean by more than four standard errors of the loads and what the largest of n
//!    ranks' noise is expected to be, sqrt(2 ln n) (the noise is learnt from the observations and kept over rebalances),
//! 3. (longest - mean) x steps until the next check is above the averaged seconds of a rebalance.
//!
//! If a rebalance leaves more than half of what was above 1, and the imbalance above the threshold, the next one needs
//! twice as much of each (threshold - 1 and saving), and so on; it needs the plain amounts again once the imbalance has
//! been below the threshold.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::trend::Trend;

/// What a new observation counts in the averages at least.
const NEW: f64 = 0.25;
/// Loads that the noise which is thought likely counts as, loads from which on it counts no more, and loads over which
/// the noise is averaged.
const NOISE_PRIOR: f64 = 3.0;
const NOISE_LEARNT: f64 = 8.0;
const NOISE_MEMORY: f64 = 20.0;
const STANDARD_ERRORS: f64 = 4.0;
/// Added twice to the threshold at most; larger noise is judged by itself.
const MOST_ERROR: f64 = 0.01;
const MOST_DEMAND: f64 = 64.0;

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Trigger {
    threshold: f64,
    /// Relative noise of a load, before any is learnt.
    likely: f64,
    /// Seconds of a rebalance: the estimate until one was measured.
    cost: f64,
    measured: bool,
    /// The averaged load of each rank over the mean, the averaged mean, and the sum of squared weights of an average.
    loads: Vec<f64>,
    /// Those of the two observations before, the newer first.
    before_loads: [Vec<f64>; 2],
    mean: f64,
    spread: f64,
    /// The same observations on lines.
    trend: Trend,
    /// Since the last rebalance.
    observations: u32,
    /// A sixth of the averaged square of the second difference of successive loads, in which a drift is no noise, and how
    /// many it is the mean of.
    noise: f64,
    noise_of: f64,
    /// What is asked more after rebalances in vain: a power of two.
    demand: f64,
    /// The imbalance that the last check found, and that before a rebalance that is yet to be judged.
    found: Option<f64>,
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
    /// is measured. `likely`: the relative noise of a load, until it is learnt.
    pub fn new(threshold: f64, estimate: f64, likely: f64) -> Trigger {
        Trigger {
            threshold,
            likely,
            cost: estimate,
            measured: false,
            loads: Vec::new(),
            before_loads: Default::default(),
            mean: 0.0,
            spread: 0.0,
            trend: Trend::default(),
            observations: 0,
            noise: 0.0,
            noise_of: 0.0,
            demand: 1.0,
            found: None,
            before: None,
        }
    }

    /// Takes in the seconds per step of each rank at a step, measured or predicted. What is not finite or nothing is left out.
    ///
    /// # Panics
    /// If there are not as many shares as ranks.
    pub fn observe(&mut self, step: u64, seconds: &[f64], shares: &[f64]) {
        assert_eq!(seconds.len(), shares.len(), "one share per rank");
        let whole: f64 = shares.iter().sum();
        let mean = seconds.iter().zip(shares).map(|(seconds, share)| seconds * share).sum::<f64>() / whole;
        if mean.is_finite() && mean > 0.0 {
            self.average(step, seconds, mean);
        }
    }

    /// Decides at a step by what was observed until then. `steps_to_next`: steps until the next check.
    pub fn check(&mut self, step: u64, steps_to_next: u64) -> Decision {
        if self.loads.len() < 2 || self.observations == 0 {
            return Decision::Idle;
        }
        let (imbalance, error) = self.imbalance_at(step);
        self.judge_last(imbalance);
        self.found = Some(imbalance);
        let threshold = 1.0 + (self.threshold - 1.0) * self.demand;
        if imbalance <= threshold {
            return Decision::Balanced { imbalance, threshold };
        }
        // Every observation is another chance to be above the threshold by noise.
        let surely = threshold + 2.0 * error.min(MOST_ERROR);
        if imbalance <= surely {
            return Decision::Unsure { imbalance, needed: surely - 1.0 };
        }
        let excess = imbalance - 1.0;
        let largest = (2.0 * libm::log(self.loads.len() as f64)).sqrt();
        let needed = (STANDARD_ERRORS + largest) * error;
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
        self.before = self.found.take();
        self.observations = 0;
        self.trend = Trend::default();
    }

    /// The imbalance of the averages; 1 before the first observation.
    pub fn imbalance(&self) -> f64 {
        self.loads.iter().copied().fold(1.0, f64::max)
    }

    /// At a step, and its standard error: as it is by the averages or, if the loads drift, on their lines.
    fn imbalance_at(&self, step: u64) -> (f64, f64) {
        let variance = self.variance();
        match self.trend.at(step, variance) {
            Some((loads, spread)) => (loads.into_iter().fold(1.0, f64::max), (variance * spread).sqrt()),
            None => (self.imbalance(), (variance * self.spread).sqrt()),
        }
    }

    /// Averaged seconds of a rebalance.
    pub fn cost(&self) -> f64 {
        self.cost
    }

    fn average(&mut self, step: u64, seconds: &[f64], mean: f64) {
        if self.loads.len() != seconds.len() {
            self.loads = vec![1.0; seconds.len()];
            self.observations = 0;
            self.trend = Trend::default();
        }
        self.observations = self.observations.saturating_add(1);
        let part = (1.0 / f64::from(self.observations)).max(self.newest());
        let loads: Vec<f64> = seconds.iter().map(|seconds| seconds / mean).collect();
        for (average, load) in self.loads.iter_mut().zip(&loads) {
            *average += part * (load - *average);
        }
        if self.observations > 2 {
            let [last, earlier] = &self.before_loads;
            let triples = loads.iter().zip(last).zip(earlier);
            let bends = triples.map(|((now, last), earlier)| (now - 2.0 * last + earlier).powi(2));
            let off_square = bends.sum::<f64>() / (6 * seconds.len()) as f64;
            let freedoms = (seconds.len() - 1) as f64;
            self.noise_of = (self.noise_of + freedoms).min(NOISE_MEMORY.max(freedoms));
            self.noise += freedoms / self.noise_of * (off_square - self.noise);
        }
        self.trend.observe(step, &loads);
        self.before_loads.swap(0, 1);
        self.before_loads[0] = loads;
        self.mean += part * (mean - self.mean);
        self.spread = if self.observations == 1 { 1.0 } else { (1.0 - part).powi(2) * self.spread + part * part };
    }

    /// Of a load over the mean, by its noise.
    fn variance(&self) -> f64 {
        let prior = if self.noise_of < NOISE_LEARNT { NOISE_PRIOR } else { 0.0 };
        (prior * self.likely * self.likely + self.noise_of * self.noise) / (prior + self.noise_of)
    }

    /// What a new observation counts: as much as leaves the standard errors that are asked for within a quarter of what
    /// the threshold allows, so that loads that grow are seen as soon as noise lets them.
    fn newest(&self) -> f64 {
        let allowed = 0.25 * (self.threshold - 1.0) / STANDARD_ERRORS;
        let ratio = allowed * allowed / self.variance().max(1e-12);
        (2.0 * ratio / (1.0 + ratio)).clamp(NEW, 1.0)
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
