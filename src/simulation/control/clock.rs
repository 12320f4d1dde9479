//! Simulated time in integer ticks of the smallest step of the ladder, so that sums of steps are exact
//! and the run ends exactly at its end time.

use serde::{Deserialize, Serialize};

use crate::plan::Plan;
use crate::simulation::control::state_error::RunStateError;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clock {
    now: u64,
    end: u64,
    levels: u32,
    /// s.
    end_time: f64,
    /// Steps done.
    pub steps: u64,
}

/// Where a clock stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ClockState {
    /// Of the smallest step.
    ticks: u64,
    /// Of this length is the whole run.
    end: u64,
    steps: u64,
}

impl Clock {
    pub fn new(plan: &Plan) -> Clock {
        let levels = plan.ladder_levels.max(1);
        let per_top = 1u64 << (levels - 1);
        let top_steps = (plan.end_time / plan.time_step).round().max(1.0) as u64;
        let end = top_steps * per_top;
        Clock { now: 0, end, levels, end_time: plan.end_time, steps: 0 }
    }

    /// A clock that starts in the middle of a run, at the tick nearest to this share of the simulated time.
    pub fn starting_at(plan: &Plan, progress: f64) -> Clock {
        let clock = Clock::new(plan);
        let ticks = (progress * clock.end as f64).round() as u64;
        Clock { now: ticks.min(clock.end), ..clock }
    }

    pub fn time(&self) -> f64 {
        self.seconds(self.now)
    }

    /// The ratio first: it is one at the end, where a sum of rounded ticks may miss the end time by a bit.
    fn seconds(&self, ticks: u64) -> f64 {
        self.end_time * (ticks as f64 / self.end as f64)
    }

    pub fn done(&self) -> bool {
        self.now >= self.end
    }

    pub fn state(&self) -> ClockState {
        ClockState { ticks: self.now, end: self.end, steps: self.steps }
    }

    /// # Errors
    /// If the state is that of another plan's clock.
    pub fn restore(&mut self, state: &ClockState) -> Result<(), RunStateError> {
        if state.end != self.end {
            return Err(RunStateError::differs("ticks of the run", state.end, self.end));
        }
        if state.ticks > state.end || state.steps > state.ticks {
            return Err(RunStateError::Impossible { what: "the clock is beyond its end" });
        }
        (self.now, self.steps) = (state.ticks, state.steps);
        Ok(())
    }

    fn ticks(&self, level: u32) -> u64 {
        1 << (self.levels - 1 - level.min(self.levels - 1))
    }

    /// Length of a step of this level, s.
    pub fn dt(&self, level: u32) -> f64 {
        self.seconds(self.ticks(level))
    }

    /// The level and number of steps of the next interval: as asked, or finer where the end is nearer
    /// than a step, and at most `most` steps.
    pub fn interval(&self, level: u32, most: u32) -> (u32, u32) {
        let left = self.end - self.now;
        let mut level = level.min(self.levels - 1);
        while self.ticks(level) > left && level + 1 < self.levels {
            level += 1;
        }
        let steps = (left / self.ticks(level)).min(u64::from(most));
        (level, steps as u32)
    }

    pub fn advance(&mut self, level: u32, steps: u32) {
        self.now += self.ticks(level) * u64::from(steps);
        self.steps += u64::from(steps);
    }

    /// The share of the simulated time that is done.
    pub fn progress(&self) -> f64 {
        self.now as f64 / self.end as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clock() -> Clock {
        Clock { now: 0, end: 10 * 8, levels: 4, end_time: 10.0e-6, steps: 0 }
    }

    /// Whatever levels are taken on the way, the clock stops at its end and not beyond.
    #[test]
    fn the_clock_ends_exactly() {
        for pattern in [[0, 3, 1, 2], [3, 3, 0, 0], [2, 0, 2, 1]] {
            let mut clock = clock();
            let mut turn = 0;
            while !clock.done() {
                let (level, steps) = clock.interval(pattern[turn % 4], 3);
                assert!(steps > 0);
                clock.advance(level, steps);
                turn += 1;
            }
            assert_eq!(clock.now, clock.end);
        }
    }

    /// A restored clock shows the same time to the bit, and that of another plan is refused.
    #[test]
    fn a_restored_clock_goes_on() {
        let mut cut = clock();
        cut.advance(0, 3);
        cut.advance(3, 5);
        let mut restored = clock();
        restored.restore(&cut.state()).unwrap();
        assert_eq!(restored, cut);
        let mut other = Clock { end: 160, ..clock() };
        assert!(other.restore(&cut.state()).is_err());
        assert!(restored.restore(&ClockState { ticks: 81, ..cut.state() }).is_err());
        assert_eq!(restored, cut);
    }

    /// A step longer than what is left is made finer, not cut.
    #[test]
    fn the_last_interval_is_finer() {
        let mut clock = clock();
        clock.advance(0, 9);
        clock.advance(2, 1);
        assert_eq!(clock.interval(0, 32), (1, 1));
    }
}
