//! When the cells are shared out anew, and what came of it.
//!
//! Every rank's load in the last step of an interval comes with the sums of the interval's tallies, so that all
//! ranks decide alike. Nothing here changes a result.

use std::time::Instant;

use super::decomposition::{Decomposition, Histogram};
use super::load::Load;
use crate::partition::{By, CostModel, Decision, IntegerWeights, Measurement, Trigger};
use crate::simulation::error::SimulationError;

/// Steps that a rebalance is thought to cost at most before one was measured.
const STEPS_OF_A_REBALANCE: f64 = 2.0;
/// Relative noise of the loads that the trigger sees, before it has learnt it. They are formed from counts of work, with the same costs for
/// all ranks: timers' noise is in what ranks whose gas differs cost beside each other, not in a rank's load. (Twice the .001 by which `imbalance_work` of the corner's two ranks
/// scatters about its drift, as the trigger forms it from second differences.)
const NOISE: f64 = 0.002;

/// How the cells are shared out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BalanceMode {
    /// Boxes of equal size.
    Off,
    /// By the initial particles.
    Initial,
    /// By the load, whenever that pays.
    #[default]
    Dynamic,
    /// By the load, so many times as soon as it is known, whether it pays or not: to study a state.
    AtOnce { times: u32 },
    /// At pseudo-random times to pseudo-random cuts: to test that results do not change.
    Forced { seed: u64 },
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BalanceOptions {
    pub mode: BalanceMode,
    pub by: By,
    /// Steps between two checks (at the ends of intervals).
    pub every: u64,
    /// Imbalance (longest over mean) from which on to act.
    pub threshold: f64,
}

impl Default for BalanceOptions {
    fn default() -> BalanceOptions {
        BalanceOptions { mode: BalanceMode::default(), by: By::Cost, every: 64, threshold: 1.1 }
    }
}

impl BalanceOptions {
    pub fn at_start(&self) -> bool {
        self.mode != BalanceMode::Off
    }
}

/// An interval among ranks: a line of `balance.csv`.
#[derive(Debug, Clone, PartialEq)]
pub struct BalanceRecord {
    /// At the end of the interval.
    pub step: u64,
    /// s.
    pub time: f64,
    /// By rank.
    pub loads: Vec<Load>,
    /// By the cost model, s per step, by rank.
    pub predicted: Vec<f64>,
    /// Fullest over mean by weight, before and after, if the cells were shared out anew before the interval.
    pub rebalanced: Option<[f64; 2]>,
}

pub struct Balance {
    options: BalanceOptions,
    model: CostModel,
    /// From the first loads on.
    trigger: Option<Trigger>,
    next_check: u64,
    /// Steps of the interval that was read last.
    interval: u64,
    /// The step of the last rebalance, until its cost is known; loads of before count no more.
    since: Option<u64>,
    rebalances: Vec<(u64, [f64; 2])>,
    latest: Option<BalanceRecord>,
}

impl Balance {
    pub fn new(options: BalanceOptions, ranks: usize) -> Balance {
        Balance {
            options,
            model: CostModel::new(options.by, ranks),
            trigger: None,
            next_check: options.every,
            interval: 0,
            since: None,
            rebalances: Vec::new(),
            latest: None,
        }
    }

    /// The loads of an interval that was read.
    pub fn take(&mut self, first_step: u64, steps: u32, time: f64, loads: Vec<Load>) {
        if loads.is_empty() {
            return;
        }
        self.interval = steps.into();
        let measured: Vec<Measurement> = loads.iter().map(Load::measurement).collect();
        self.model.observe(&measured);
        let predicted: Vec<f64> = match self.options.by {
            By::Particles => loads.iter().map(|load| load.owned as f64).collect(),
            By::Cost => loads.iter().enumerate().map(|(rank, load)| self.model.seconds(rank, &load.work())).collect(),
        };
        if self.since.is_none_or(|since| first_step >= since) {
            let unit = self.unit(&loads);
            if self.since.take().is_some()
                && let Some(trigger) = &mut self.trigger
            {
                let longest = loads.iter().map(|load| load.rebalancing).fold(0.0, f64::max);
                trigger.rebalanced(longest / unit);
            }
            let trigger = self.trigger.get_or_insert_with(|| {
                let mean = predicted.iter().sum::<f64>() / predicted.len() as f64;
                // Most of a rebalance is an exchange among all, and so is the first of a run; in that of a small run the driver
                // may have been compiling for longer.
                let first = loads.iter().map(|load| load.rebalancing).fold(0.0, f64::max);
                let most = STEPS_OF_A_REBALANCE * mean;
                let estimate = if first > 0.0 { most.min(first / unit) } else { most };
                Trigger::new(self.options.threshold, estimate, NOISE)
            });
            trigger.observe(first_step + u64::from(steps), &predicted, &self.model.shares());
        }
        let rebalanced = self.rebalances.iter().find(|(step, _)| *step == first_step).map(|(_, imbalance)| *imbalance);
        self.latest = Some(BalanceRecord { step: first_step + u64::from(steps), time, loads, predicted, rebalanced });
    }

    /// Seconds of a unit of `predicted`: without a cost model particles stand for seconds.
    fn unit(&self, loads: &[Load]) -> f64 {
        match self.options.by {
            By::Cost => 1.0,
            By::Particles => {
                let (seconds, owned) = loads.iter().fold((0.0, 0), |(s, n), load| (s + load.seconds, n + load.owned));
                if seconds > 0.0 { seconds / owned.max(1) as f64 } else { 1e-6 }
            }
        }
    }

    /// The interval that was read last, if there are loads of it.
    pub fn latest(&self) -> Option<&BalanceRecord> {
        self.latest.as_ref()
    }

    /// How often the cells were shared out anew.
    pub fn rebalances(&self) -> usize {
        self.rebalances.len()
    }

    /// Before an interval: shares the cells out anew where that is due. Collective.
    ///
    /// # Errors
    /// If a device or another rank fails.
    pub fn act(
        &mut self,
        step: u64,
        histogram: &mut Histogram<'_>,
        decomposition: &mut Decomposition,
    ) -> Result<f64, SimulationError> {
        let (weights, shares) = match self.options.mode {
            BalanceMode::Off | BalanceMode::Initial => return Ok(0.0),
            BalanceMode::Forced { seed } => match forced(seed, step, histogram.comm.size()) {
                Some(shares) => (IntegerWeights { particle: 1, candidate: 1, wall: 1, sheet: 1, cell: 0 }, shares),
                None => return Ok(0.0),
            },
            BalanceMode::Dynamic | BalanceMode::AtOnce { .. } => {
                if !self.due(step) {
                    return Ok(0.0);
                }
                (self.model.weights(), self.shares())
            }
        };
        let start = Instant::now();
        let before = decomposition.weights(histogram, weights)?;
        let moved = decomposition.rebalance(histogram, weights, &shares)?;
        if !moved && self.options.mode == BalanceMode::Dynamic {
            // No cut could be better. To have looked costs little, and says nothing of what a rebalance costs.
            return Ok(start.elapsed().as_secs_f64());
        }
        let after = decomposition.weights(histogram, weights)?;
        let over = |weights: &[u64]| imbalance(weights.iter().zip(&shares).map(|(&w, share)| w as f64 / share));
        self.rebalances.push((step, [over(&before), over(&after)]));
        self.since = Some(step);
        Ok(start.elapsed().as_secs_f64())
    }

    /// Of the weights, that even out the ranks' times.
    fn shares(&self) -> Vec<f64> {
        let Some(latest) = &self.latest else {
            return self.model.shares();
        };
        let load = |load: &Load| (load.work(), load.of_halo());
        self.model.shares_beside_halos(&latest.loads.iter().map(load).collect::<Vec<_>>())
    }

    /// Whether it is time to look, and what is seen asks for a rebalance.
    fn due(&mut self, step: u64) -> bool {
        let Some(trigger) = self.trigger.as_mut().filter(|_| self.since.is_none()) else {
            return false;
        };
        if let BalanceMode::AtOnce { times } = self.options.mode {
            return self.rebalances.len() < times as usize;
        }
        if step < self.next_check {
            return false;
        }
        self.next_check = step + self.options.every;
        // Checks are at the ends of intervals.
        let decision: Decision = trigger.check(step, self.options.every.max(self.interval));
        tracing::debug!("step {step}: {decision}");
        decision.rebalances()
    }
}

/// Unequal shares, at one interval in three.
fn forced(seed: u64, step: u64, ranks: usize) -> Option<Vec<f64>> {
    let draw = |k: u32| crate::gas::philox4x32_10([step as u32, k, 0, 0], [seed as u32, (seed >> 32) as u32]);
    let share = |rank: usize| 0.2 + f64::from(draw(1 + rank as u32)[0] % 1000) / 1000.0;
    (step > 0 && draw(0)[0].is_multiple_of(3)).then(|| (0..ranks).map(share).collect())
}

/// Fullest over mean.
pub fn imbalance(of: impl Iterator<Item = f64> + Clone) -> f64 {
    let ranks = of.clone().count() as f64;
    let sum: f64 = of.clone().sum();
    if sum > 0.0 { of.fold(0.0, f64::max) * ranks / sum } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two ranks of which one has so much more to do than the mean, for two intervals whose times are noisy.
    fn after_two_intervals(excess: f64, first_exchange: f64) -> Balance {
        let mut balance = Balance::new(BalanceOptions::default(), 2);
        for (turn, noise) in [0.8, 1.3].into_iter().enumerate() {
            let load = |off: f64, noise: f64| {
                let particles = (1e5 * (1.0 + off)) as u64;
                let seconds = 1e-6 * particles as f64 * noise;
                let rebalancing = if turn == 0 { first_exchange } else { 0.0 };
                Load {
                    seconds,
                    particles,
                    owned: particles,
                    candidates: 10 * particles,
                    rebalancing,
                    ..Load::default()
                }
            };
            balance.take(32 * turn as u64, 32, 0.0, vec![load(excess, noise), load(-excess, 1.0 / noise)]);
        }
        balance
    }

    /// Counts of work tell at the first check, whatever the timers say; what is below the threshold stays.
    #[test]
    fn two_ranks_are_rebalanced_at_the_first_check() {
        assert!(!after_two_intervals(0.2, 0.0).due(63));
        assert!(after_two_intervals(0.2, 0.0).due(64));
        assert!(!after_two_intervals(0.05, 0.0).due(64));
        assert!(!after_two_intervals(-0.05, 0.0).due(64));
    }

    /// An imbalance from the start that is a quarter above what the threshold allows is seen at the first check, one check before it would be if loads are
    /// thought as noisy as half a per cent.
    #[test]
    fn what_is_counted_is_trusted_early() {
        let due = |noise: f64| {
            let mut trigger = Trigger::new(1.02, 0.0, noise);
            (1..40).find(|&k| {
                trigger.observe(32 * k, &[1.025, 0.975], &[1.0, 1.0]);
                // A check is every second interval.
                k % 2 == 0 && trigger.check(32 * k, 64).rebalances()
            })
        };
        assert_eq!((due(NOISE), due(0.005)), (Some(2), Some(4)));
    }

    /// What is saved until the next check must be more than that; and it is no more than two steps, however long the first took.
    #[test]
    fn the_first_exchange_tells_what_a_rebalance_costs() {
        let due = |every: u64, first_exchange: f64| {
            let mut balance = after_two_intervals(0.2, first_exchange);
            (balance.options.every, balance.next_check, balance.interval) = (every, 64, 1);
            balance.due(64)
        };
        // A step takes a tenth of a second, of which a fifth would be saved.
        assert!(due(4, 0.05) && !due(2, 0.05), "half of a step");
        assert!(due(7, 0.12) && !due(5, 0.12), "more than a step");
        assert!(due(11, 60.0) && !due(9, 60.0), "two steps");
    }
}
