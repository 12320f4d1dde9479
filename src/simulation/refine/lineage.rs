//! Which parent has which children.
//!
//! A run of the refined scene has at a moment so many particles of each gas, with known ids: the initial ones by chamber
//! and gas, then newborns in order of entry. The parents of a gas, in order of id, share its ids in ascending order as
//! evenly as integers can: the i-th of N has those from i T / N to (i + 1) T / N of the T.

use crate::gas::Newborn;
use crate::plan::Plan;
use crate::subdomain::GpuParticle;

pub struct Lineage {
    /// By gas, ascending.
    ids: Vec<Vec<u32>>,
    /// Parents of each gas.
    parents: Vec<usize>,
    /// The how-manieth of its gas each parent is.
    ranks: Vec<u32>,
}

impl Lineage {
    /// `parents` are in order of id, of gases that the plan knows.
    pub fn new(parents: &[GpuParticle], plan: &Plan, newborns: &[Newborn]) -> Lineage {
        let gases = plan.gases.len();
        let mut ids = vec![Vec::new(); gases];
        let mut next = 0;
        for chamber in &plan.chambers {
            for (own, &count) in ids.iter_mut().zip(&chamber.particles) {
                own.extend(next..next + count as u32);
                next += count as u32;
            }
        }
        for newborn in newborns {
            ids[usize::from(newborn.particle.gas)].push(newborn.particle.id);
        }
        let mut counts = vec![0usize; gases];
        let rank = |parent: &GpuParticle| {
            let count = &mut counts[usize::from(parent.gas())];
            *count += 1;
            *count as u32 - 1
        };
        let ranks = parents.iter().map(rank).collect();
        Lineage { ids, parents: counts, ranks }
    }

    /// Ids of the children of a parent, by its index.
    pub fn children(&self, parent: usize, gas: u8) -> &[u32] {
        let (ids, parents) = (&self.ids[usize::from(gas)], self.parents[usize::from(gas)] as u128);
        let share = |rank: u32| (u128::from(rank) * ids.len() as u128 / parents) as usize;
        &ids[share(self.ranks[parent])..share(self.ranks[parent] + 1)]
    }

    pub fn total(&self) -> usize {
        self.ids.iter().map(Vec::len).sum()
    }

    /// A gas of which there are children and no parents, and how many.
    pub fn without_parents(&self) -> Option<(usize, u64)> {
        let gas = (0..self.ids.len()).find(|&gas| self.parents[gas] == 0 && !self.ids[gas].is_empty())?;
        Some((gas, self.ids[gas].len() as u64))
    }

    /// How many children are more, and how many are missing, than `times` for each parent.
    pub fn rounding(&self, times: u64) -> (u64, u64) {
        self.ids.iter().zip(&self.parents).fold((0, 0), |(added, dropped), (ids, &parents)| {
            let (there, even) = (ids.len() as u64, parents as u64 * times);
            (added + there.saturating_sub(even), dropped + even.saturating_sub(there))
        })
    }
}
