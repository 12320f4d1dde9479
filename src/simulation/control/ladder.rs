//! Step size and collision diameters follow the state. The step (method.md, "What the plan decides, and why"): a ladder of powers of two,
//! changed only between intervals, from integer tallies, so that the collision limit x = dt n pi sigma^2 gbar holds
//! for all but a small share of the particles, and |v| dt <= cell for 99.9 % of them.

use serde::{Deserialize, Serialize};

use super::local_gas::{BlockGas, Part};
use crate::plan::{FAST_TAIL, LADDER_TAIL, Plan};
use crate::simulation::control::state_error::RunStateError;
use crate::subdomain::BlockSum;

/// Share of the collisions that may be of pairs faster than the plan's fastest: twice what 6 sqrt(kT/m) leaves in gas at
/// the highest temperature of the plan, (1 + x) e^-x of the flux of pairs at x = m g^2 / (4 kT) = 9.
const FAST_PAIRS: f64 = 2.5e-3;
/// A longer step is taken only with this much room, so that the level does not flutter.
const ROOM: f64 = 0.9;

pub struct Ladder {
    level: u32,
    levels: u32,
    limit: f64,
    top: f64,
    gas: BlockGas,
    /// Pairs are faster than planned for.
    hot: bool,
    /// What is left of the cross-section in each block; empty without a cap.
    shares: Vec<u32>,
}

#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "the gas needs a step of {needed:.3e} s, below the ladder's smallest of {smallest:.3e} s: it is {ratio:.0} times denser or hotter than planned for"
)]
pub struct LadderError {
    pub needed: f64,
    pub smallest: f64,
    pub ratio: f64,
}

/// What the state asks of the step and of the diameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Demand {
    /// x at the top of the ladder, for the densest and hottest but the tail.
    pub collision: f64,
    /// Coarsest level at which few enough particles cross more than a cell.
    pub fast_level: u32,
    /// Whether more pairs than planned for are faster than its fastest.
    pub hot: bool,
    /// What is to be left of the cross-section in each block, in `FULL_SHARE`ths; empty without a cap.
    pub shares: Vec<u32>,
}

/// Where on its ladder the step is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LadderState {
    pub level: u32,
    levels: u32,
    hot: bool,
    shares: Vec<u32>,
}

impl Ladder {
    pub fn new(plan: &Plan, volumes: Vec<f64>) -> Ladder {
        Ladder {
            level: 0,
            levels: plan.ladder_levels,
            limit: plan.collision_limit,
            top: plan.time_step,
            gas: BlockGas::new(plan, volumes),
            hot: false,
            shares: Vec::new(),
        }
    }

    pub fn level(&self) -> u32 {
        self.level
    }

    /// By how many halvings less the fastest pairs fly in a step of this level than in the longest: none while pairs are
    /// faster than planned for.
    pub fn halvings(&self, level: u32) -> u32 {
        if self.hot { 0 } else { level }
    }

    /// What is left of the cross-section in each block, in `FULL_SHARE`ths; empty without a cap.
    pub fn shares(&self) -> &[u32] {
        &self.shares
    }

    pub fn state(&self) -> LadderState {
        LadderState { level: self.level, levels: self.levels, hot: self.hot, shares: self.shares.clone() }
    }

    /// # Errors
    /// If the state is that of another plan's ladder.
    pub fn restore(&mut self, state: &LadderState) -> Result<(), RunStateError> {
        if state.levels != self.levels {
            return Err(RunStateError::differs("levels of the ladder", state.levels, self.levels));
        }
        if state.level > 0 && state.level >= state.levels {
            return Err(RunStateError::Impossible { what: "the step is below the ladder" });
        }
        self.check(&state.shares)?;
        self.level = state.level;
        self.hot = state.hot;
        self.shares.clone_from(&state.shares);
        Ok(())
    }

    /// # Errors
    /// If these are the shares of another plan's blocks.
    pub fn check(&self, shares: &[u32]) -> Result<(), RunStateError> {
        let (found, expected) = (shares.len() as u64, self.gas.entries() as u64);
        if found == expected { Ok(()) } else { Err(RunStateError::differs("blocks with a diameter", found, expected)) }
    }

    /// What a measured state asks for; `met` are the collisions of the interval, and those of them of fast pairs.
    pub fn demand(&self, blocks: &[BlockSum], fast: &[u32], met: [u64; 2]) -> Demand {
        let total: u64 = blocks.iter().map(|block| block.number).sum();
        let shares = self.gas.shares(blocks);
        let rate = rate_beyond(&mut self.gas.parts(blocks, &shares), LADDER_TAIL * total as f64);
        let allowed = FAST_TAIL * total as f64;
        let fast_level = fast.iter().position(|&count| f64::from(count) <= allowed).unwrap_or(fast.len());
        let [met, met_fast] = met;
        let hot = met_fast as f64 > FAST_PAIRS * met as f64;
        Demand { collision: rate * self.top, fast_level: fast_level as u32, hot, shares }
    }

    /// Takes the diameters that the demand asks for, and the level too: finer at once, coarser by one level and with
    /// room.
    ///
    /// # Errors
    /// If it is below the ladder.
    pub fn follow(&mut self, demand: Demand) -> Result<u32, LadderError> {
        let Demand { collision, fast_level, hot, shares } = demand;
        self.shares = shares;
        self.hot = hot;
        let level_for = |limit: f64| {
            // Halving is exact; a logarithm would depend on the system's library.
            let mut collision = collision;
            let mut level = 0;
            while collision > limit && level < 64 {
                collision *= 0.5;
                level += 1;
            }
            level
        };
        let needed = level_for(self.limit).max(fast_level);
        if needed >= self.levels {
            let smallest = self.top / f64::from(1u32 << (self.levels - 1));
            let ratio = collision / self.limit / f64::from(1u32 << (self.levels - 1));
            return Err(LadderError { needed: self.top / 2f64.powi(needed as i32), smallest, ratio: ratio.max(1.0) });
        }
        if needed > self.level {
            self.level = needed;
        } else {
            let roomy = level_for(self.limit * ROOM).max(fast_level);
            if roomy < self.level {
                self.level -= 1;
            }
        }
        Ok(self.level)
    }

    /// Takes the diameters alone.
    pub fn hold(&mut self, demand: Demand) {
        self.shares = demand.shares;
        self.hot = demand.hot;
    }

    /// The level of the start of a run: that of the demand, without hysteresis.
    ///
    /// # Errors
    /// If it is below the ladder.
    pub fn start(&mut self, demand: Demand) -> Result<u32, LadderError> {
        self.level = 0;
        self.follow(demand)
    }
}

/// The highest rate that, with all higher ones, is that of more than so many particles, or the least of all. (There are as many parts as blocks, each
/// interval: they are not sorted for it.)
fn rate_beyond(parts: &mut [Part], tail: f64) -> f64 {
    let (mut open, mut beyond, mut rate) = (parts, 0, 0.0);
    while !open.is_empty() {
        let (higher, middle, lower) = open.select_nth_unstable_by(open.len() / 2, |a, b| b.rate.total_cmp(&a.rate));
        let among = higher.iter().map(|part| part.number).sum::<u64>();
        if (beyond + among) as f64 > tail {
            open = higher;
            continue;
        }
        rate = middle.rate;
        beyond += among + middle.number;
        if beyond as f64 > tail {
            break;
        }
        open = lower;
    }
    rate
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::simulation::control::local_gas::tests::{block, block_gas};

    fn ladder(volumes: Vec<f64>) -> Ladder {
        Ladder { level: 0, levels: 12, limit: 0.3, top: 1.0, gas: block_gas(volumes), hot: false, shares: Vec::new() }
    }

    fn demand(collision: f64) -> Demand {
        Demand { collision, fast_level: 0, hot: false, shares: Vec::new() }
    }

    #[test]
    fn a_restored_ladder_is_at_its_level() {
        let mut cut = ladder(vec![1.0]);
        cut.follow(demand(1.0)).unwrap();
        let mut restored = ladder(vec![1.0]);
        assert_ne!(restored.level(), cut.level());
        restored.restore(&cut.state()).unwrap();
        assert_eq!(restored.level(), cut.level());
        assert!(restored.restore(&LadderState { level: 12, ..cut.state() }).is_err());
        assert!(restored.restore(&LadderState { levels: 3, ..cut.state() }).is_err());
        assert!(restored.restore(&LadderState { shares: vec![1], ..cut.state() }).is_err());
        assert!(restored.check(&[1]).is_err() && restored.check(&[]).is_ok());
        assert_eq!(restored.level(), cut.level());
    }

    /// A step that density asks for reaches less, but not while pairs are faster than planned for.
    #[test]
    fn the_fastest_pairs_fly_less_in_shorter_steps() {
        let mut ladder = ladder(vec![1.0]);
        let asked = |met| ladder.demand(&[block(10)], &[0], met).hot;
        assert_eq!([[0, 0], [10_000, 25], [10_000, 26]].map(asked), [false, false, true]);
        ladder.follow(demand(1.0)).unwrap();
        assert_eq!([ladder.level(), ladder.halvings(2), ladder.halvings(0)], [2, 2, 0]);
        ladder.follow(Demand { hot: true, ..demand(1.0) }).unwrap();
        assert_eq!(ladder.halvings(2), 0);
        let mut restored = self::ladder(vec![1.0]);
        restored.restore(&ladder.state()).unwrap();
        assert_eq!(restored.halvings(2), 0);
        restored.hold(demand(1.0));
        assert_eq!(restored.halvings(2), 2);
    }

    /// A few particles in a sliver do not set the step of all, nor does what is empty.
    #[test]
    fn the_tail_does_not_count() {
        let collision = |numbers: [u64; 2]| {
            let blocks = numbers.map(block);
            ladder(vec![1.0, 1e-6]).demand(&blocks, &[0], [0; 2]).collision
        };
        assert_eq!(collision([1000, 2]), 1000.0 - 1000f64.sqrt());
        assert_eq!(collision([0, 0]), 0.0);
    }

    proptest! {
        /// Also among equal rates, with parts without particles, and where all together are not beyond the tail.
        #[test]
        fn the_rate_beyond_the_tail_is_that_of_sorted_parts(
            parts in prop::collection::vec((0u32..40, 0u64..9), 0..200),
            tail in prop_oneof![Just(0.0), 0.0..20.0, 0.0..1500.0],
        ) {
            let part = |(rate, number)| Part { rate: f64::from(rate), number };
            let mut parts: Vec<Part> = parts.into_iter().map(part).collect();
            let mut sorted = parts.clone();
            sorted.sort_by(|a, b| b.rate.total_cmp(&a.rate));
            let (mut beyond, mut expected) = (0, 0.0);
            for part in &sorted {
                expected = part.rate;
                beyond += part.number;
                if beyond as f64 > tail {
                    break;
                }
            }
            prop_assert_eq!(rate_beyond(&mut parts, tail), expected);
        }
    }
}
