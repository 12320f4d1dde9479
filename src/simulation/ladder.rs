//! The step size follows the state (specification, section 9): a ladder of powers of two, changed only
//! between intervals, from integer tallies, so that the collision limit x = dt n pi sigma^2 gbar holds
//! for all but a small share of the particles, and |v| dt <= cell for 99.9 % of them.

use serde::{Deserialize, Serialize};

use super::run_state::StateError;
use crate::plan::Plan;
use crate::scene::Method;
use crate::subdomain::{BlockSum, Scales};

/// Share of the particles that may be in blocks beyond the collision limit: local peaks of a few noisy
/// blocks do not set the step of all.
const TAIL: f64 = 0.02;
/// Share that may cross more than a cell in a step.
const FAST_TAIL: f64 = 1e-3;
/// A longer step is taken only with this much room, so that the level does not flutter.
const ROOM: f64 = 0.9;
/// The volume of a block with less gas volume than this share of a full one is too uncertain for a density of
/// its own: all such blocks count as one, so that the gas of a vessel thinner than a block counts too.
const LEAST_VOLUME: f64 = 0.05;

pub struct Ladder {
    level: u32,
    levels: u32,
    /// sigma^2 pi sqrt(16 / (pi m_lightest / m_ref)): rate = this x n x sqrt(kT/m_ref).
    rate: f64,
    limit: f64,
    top: f64,
    energy_unit: f64,
    /// Gas volume of each block, m3.
    volumes: Vec<f64>,
    full: f64,
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

/// What the state asks of the step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Demand {
    /// x at the top of the ladder, for the densest and hottest but the tail.
    pub collision: f64,
    /// Coarsest level at which few enough particles cross more than a cell.
    pub fast_level: u32,
}

/// Where on its ladder the step is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct LadderState {
    pub level: u32,
    levels: u32,
}

impl Ladder {
    pub fn new(plan: &Plan, volumes: Vec<f64>) -> Ladder {
        let scales = Scales::new(plan);
        let lightest = plan.gases.iter().map(|gas| gas.molar_mass).fold(f64::INFINITY, f64::min);
        let heaviest = scales.reference_mass / plan.moles_per_particle;
        let pi = std::f64::consts::PI;
        let block_edge = plan.grid.cell * f64::from(1u32 << plan.block_cells_log2);
        Ladder {
            level: 0,
            levels: plan.ladder_levels,
            rate: if plan.method == Method::None {
                0.0
            } else {
                plan.diameter * plan.diameter * pi * (16.0 / pi * heaviest / lightest).sqrt()
            },
            limit: plan.collision_limit,
            top: plan.time_step,
            energy_unit: scales.block_energy,
            volumes,
            full: block_edge.powi(3),
        }
    }

    pub fn level(&self) -> u32 {
        self.level
    }

    pub fn state(&self) -> LadderState {
        LadderState { level: self.level, levels: self.levels }
    }

    /// # Errors
    /// If the state is that of another plan's ladder.
    pub fn restore(&mut self, state: &LadderState) -> Result<(), StateError> {
        if state.levels != self.levels {
            return Err(StateError::differs("levels of the ladder", state.levels, self.levels));
        }
        if state.level > 0 && state.level >= state.levels {
            return Err(StateError::Impossible { what: "the step is below the ladder" });
        }
        self.level = state.level;
        Ok(())
    }

    /// Collisions per particle and second in gas of this volume, m3.
    fn collision_rate(&self, gas: &BlockSum, volume: f64) -> f64 {
        let number = gas.number as f64;
        let kt = 2.0 / 3.0 * gas.energy as f64 / self.energy_unit / number;
        // Less one standard error: the noise of small blocks is no peak.
        self.rate * (number - number.sqrt()) / volume * kt.sqrt()
    }

    /// What a measured state asks for.
    pub fn demand(&self, blocks: &[BlockSum], fast: &[u32]) -> Demand {
        let total: u64 = blocks.iter().map(|block| block.number).sum();
        let mut rates = Vec::with_capacity(blocks.len());
        let (mut slivers, mut slivers_volume) = (BlockSum { number: 0, energy: 0 }, 0.0);
        for (block, &volume) in blocks.iter().zip(&self.volumes) {
            if volume > LEAST_VOLUME * self.full {
                if block.number > 0 {
                    rates.push((self.collision_rate(block, volume), block.number));
                }
            } else {
                // Empty ones too: with the few particles of a sliver, those that chance filled are too dense.
                slivers.number += block.number;
                slivers.energy += block.energy;
                slivers_volume += volume;
            }
        }
        if slivers.number > 0 && slivers_volume > 0.0 {
            rates.push((self.collision_rate(&slivers, slivers_volume), slivers.number));
        }
        rates.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut beyond = 0;
        let mut rate = 0.0;
        for (candidate, number) in rates {
            rate = candidate;
            beyond += number;
            if beyond as f64 > TAIL * total as f64 {
                break;
            }
        }
        let allowed = FAST_TAIL * total as f64;
        let fast_level = fast.iter().position(|&count| f64::from(count) <= allowed).unwrap_or(fast.len());
        Demand { collision: rate * self.top, fast_level: fast_level as u32 }
    }

    /// Takes the level that the demand asks for: finer at once, coarser by one level and with room.
    ///
    /// # Errors
    /// If it is below the ladder.
    pub fn follow(&mut self, demand: Demand) -> Result<u32, LadderError> {
        let level_for = |limit: f64| {
            // Halving is exact; a logarithm would depend on the system's library.
            let mut collision = demand.collision;
            let mut level = 0;
            while collision > limit && level < 64 {
                collision *= 0.5;
                level += 1;
            }
            level
        };
        let needed = level_for(self.limit).max(demand.fast_level);
        if needed >= self.levels {
            let smallest = self.top / f64::from(1u32 << (self.levels - 1));
            let ratio = demand.collision / self.limit / f64::from(1u32 << (self.levels - 1));
            return Err(LadderError { needed: self.top / 2f64.powi(needed as i32), smallest, ratio: ratio.max(1.0) });
        }
        if needed > self.level {
            self.level = needed;
        } else {
            let roomy = level_for(self.limit * ROOM).max(demand.fast_level);
            if roomy < self.level {
                self.level -= 1;
            }
        }
        Ok(self.level)
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

#[cfg(test)]
mod tests {
    use super::*;

    fn ladder(volumes: Vec<f64>) -> Ladder {
        Ladder { level: 0, levels: 12, rate: 1.0, limit: 0.3, top: 1.0, energy_unit: 1.0, volumes, full: 1.0 }
    }

    /// kT = 1.
    fn block(number: u64) -> BlockSum {
        BlockSum { number, energy: 3 * number / 2 }
    }

    #[test]
    fn a_restored_ladder_is_at_its_level() {
        let mut cut = ladder(vec![1.0]);
        cut.follow(Demand { collision: 1.0, fast_level: 0 }).unwrap();
        let mut restored = ladder(vec![1.0]);
        assert_ne!(restored.level(), cut.level());
        restored.restore(&cut.state()).unwrap();
        assert_eq!(restored.level(), cut.level());
        assert!(restored.restore(&LadderState { level: 12, levels: 12 }).is_err());
        assert!(restored.restore(&LadderState { level: 1, levels: 3 }).is_err());
        assert_eq!(restored.level(), cut.level());
    }

    #[test]
    fn gas_in_slivers_counts_as_a_whole() {
        let demand = |volumes: &[f64], numbers: &[u64]| {
            let blocks: Vec<BlockSum> = numbers.iter().map(|&number| block(number)).collect();
            ladder(volumes.to_vec()).demand(&blocks, &[0]).collision
        };
        // A vessel thinner than a block: its density is that of all its blocks, however they share the volume.
        let surely = |number: f64| number - number.sqrt();
        assert_eq!(demand(&[0.01, 0.03], &[60, 20]), surely(80.0) / 0.04);
        assert_eq!(demand(&[0.0, 0.04], &[60, 20]), surely(80.0) / 0.04);
        assert_eq!(demand(&[0.01, 0.03], &[80, 0]), surely(80.0) / 0.04);
        // A few particles in a sliver do not set the step of all.
        assert_eq!(demand(&[1.0, 1e-6], &[1000, 2]), surely(1000.0));
        assert_eq!(demand(&[1.0, 1e-6], &[0, 0]), 0.0);
    }
}
