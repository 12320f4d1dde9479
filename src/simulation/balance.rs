//! When the cells are shared out anew, and what came of it.

use crate::gpu::Device;
use crate::partition::Tree;
use crate::plan::Plan;
use crate::ranks::Communicator;
use crate::subdomain::{Subdomain, Tallies};

use super::SimulationError;
use super::decomposition::Decomposition;

/// What a rank had to do in the last step of an interval.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Load {
    /// Device time of the step, s; zero where the device does not time.
    pub seconds: f64,
    /// Ghosts included.
    pub particles: u64,
    /// Entries of the neighbour lists.
    pub candidates: u64,
    /// Particles that may meet a wall.
    pub walls: u64,
    /// Particles that it owns.
    pub owned: u64,
}

const LOAD_WORDS: usize = 5;

impl Load {
    pub fn new(seconds: f64, present: u32, own: &Tallies) -> Load {
        Load {
            seconds,
            particles: present.into(),
            candidates: own.counters.candidates.into(),
            walls: own.counters.near_walls.into(),
            owned: own.blocks.iter().map(|block| block.number).sum(),
        }
    }

    /// For a sum over ranks: this rank's words among zeros.
    pub fn to_words(self, comm: &dyn Communicator) -> Vec<u64> {
        let mut words = vec![0; LOAD_WORDS * comm.size()];
        let own = [(1e9 * self.seconds) as u64, self.particles, self.candidates, self.walls, self.owned];
        words[LOAD_WORDS * comm.rank()..][..LOAD_WORDS].copy_from_slice(&own);
        words
    }

    /// Takes every rank's load from the end of the sums.
    pub fn from_words(sums: &mut Vec<u64>, ranks: usize) -> Vec<Load> {
        let words = sums.split_off(sums.len().saturating_sub(LOAD_WORDS * ranks));
        let load = |w: &[u64]| Load {
            seconds: 1e-9 * w[0] as f64,
            particles: w[1],
            candidates: w[2],
            walls: w[3],
            owned: w[4],
        };
        words.chunks_exact(LOAD_WORDS).map(load).collect()
    }
}

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
    /// At pseudo-random times to pseudo-random cuts: to test that results do not change.
    Forced { seed: u64 },
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BalanceOptions {
    pub mode: BalanceMode,
}

impl BalanceOptions {
    pub fn at_start(&self) -> bool {
        self.mode != BalanceMode::Off
    }
}

/// A line of `balance.csv`.
#[derive(Debug, Clone, PartialEq)]
pub struct BalanceRecord {
    pub step: u64,
    pub time: f64,
    pub loads: Vec<Load>,
}

pub struct Balance {
    options: BalanceOptions,
    records: Vec<BalanceRecord>,
}

impl Balance {
    pub fn new(options: BalanceOptions, _comm: &dyn Communicator, _plan: &Plan) -> Balance {
        Balance { options, records: Vec::new() }
    }

    /// The loads of an interval that was read.
    pub fn take(&mut self, step: u64, time: f64, loads: Vec<Load>) {
        if !loads.is_empty() {
            self.records.push(BalanceRecord { step, time, loads });
        }
    }

    pub fn into_records(self) -> Vec<BalanceRecord> {
        self.records
    }

    /// Before an interval: shares the cells out anew where that is due. Collective.
    ///
    /// # Errors
    /// If a device or another rank fails.
    pub fn act(
        &mut self,
        step: u64,
        _dt: f64,
        device: &Device,
        subdomain: &mut Subdomain,
        comm: &dyn Communicator,
        decomposition: &mut Decomposition,
    ) -> Result<(), SimulationError> {
        match self.options.mode {
            BalanceMode::Forced { seed } => {
                let draw = crate::gas::philox4x32_10([step as u32, (step >> 32) as u32, 0, 0], [seed as u32, 1]);
                if step > 0 && draw[0] % 3 == 0 {
                    let share = |rank: u32| 0.2 + f64::from(draw[1 + rank as usize % 3] % 1000) / 1000.0;
                    let shares: Vec<f64> = (0..comm.size() as u32).map(share).collect();
                    decomposition.rebalance(device, subdomain, comm, [1, 1, 1], &shares)?;
                }
                Ok(())
            }
            BalanceMode::Dynamic => {
                if step > 0 {
                    decomposition.rebalance(device, subdomain, comm, [20, 1, 20], &vec![1.0; comm.size()])?;
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }
}

/// Fullest over mean.
pub fn imbalance(of: impl Iterator<Item = f64> + Clone) -> f64 {
    let ranks = of.clone().count() as f64;
    let sum: f64 = of.clone().sum();
    if sum > 0.0 { of.fold(0.0, f64::max) * ranks / sum } else { 1.0 }
}

#[allow(dead_code)]
fn _unused(_: &Tree) {}
