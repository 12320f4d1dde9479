//! The counters of the registry, read once per step interval.

use super::registry::*;
use super::sizes::WORKGROUP;

/// Words that are read: all of them.
pub const WORDS: usize = COUNTER_WORDS as usize;
/// Entries for which a list in shards has room beyond the most that it may have: each shard's is a whole number of workgroups.
pub const FREE_ENTRIES: u64 = WORKGROUP as u64 * LIST_SHARDS as u64;

/// Places among which a list in shards has its entries, of which it has so many at most (`shaders/shared/sharded_lists.gpu.wgsl`).
pub const fn places_in_shards(most: u64) -> u64 {
    (most / FREE_ENTRIES + 1) * FREE_ENTRIES
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    pub collisions: u64,
    /// Pairs still mutually eligible after the last round of the sampled steps.
    pub lost: u32,
    /// Collisions of the sampled steps.
    pub sampled: u32,
    /// Entries of the tails of neighbour lists in a step that had no room for all; 0 if every step had.
    pub tails_wanted: u32,
    /// Particles seen outside the vessel, once per step.
    pub outside: u32,
    /// Quanta.
    pub overshoot: u32,
    /// Flights cut short after the last bounce, and at elastic fabric.
    pub truncated: u32,
    pub caught: u32,
    pub tally_overflow: u32,
    pub capacity_failed: u32,
    pub bounces: u32,
    /// Pairs parted by a wall where they would have met.
    pub blocked: u32,
    /// Particles whose owner, or who may need them as ghosts, was none of the peers: the interval must be run again with more peers.
    pub strays: u32,
    /// Collisions of pairs faster than the plan's fastest.
    pub fast_pairs: u32,
    /// Updates of ghosts that were not there.
    pub missing: u32,
    /// Particles that came from another owner.
    pub moved: u32,
    /// Of the last step: entries of all neighbour lists, and particles that may meet a wall.
    pub candidates: u32,
    pub near_walls: u32,
    /// Of these on this device those of ghosts.
    pub ghost_candidates: u32,
    pub ghost_walls: u32,
    /// Triangles of fabric in the cells of particles in the last step, for each particle; on this device those of ghosts.
    pub sheets: u32,
    pub ghost_sheets: u32,
    /// Threads whose loops the device ended too soon.
    pub cut_short: u32,
    /// With the method `half-turn`: particles that flew on, alone in their collision cell or group; groups that walls made; and particles that collided
    /// without a velocity gradient.
    pub free_flights: u32,
    pub cut_groups: u32,
    pub unfitted: u32,
    /// Entries of lists that found no place, and threads that were parted while they counted together.
    pub misplaced: u32,
    /// Of the last step on this device: particles that chose in each round, and behind the last that would have again.
    pub choosers: [u32; RECHOOSE_LISTS as usize],
}

impl Counters {
    pub fn from_words(words: &[u32; WORDS]) -> Counters {
        let word = |at: u32| words[at as usize];
        let two_words = |at: u32| u64::from(word(at)) | (u64::from(word(at + 1)) << 32);
        let in_cells: u64 = (0..COLLISION_COUNTS).map(|shard| two_words(CELL_COLLISIONS + 2 * shard)).sum();
        Counters {
            // Less those that another device counts.
            collisions: two_words(COLLISIONS_LOW) + in_cells - u64::from(word(FOREIGN)),
            lost: word(LOST),
            sampled: word(SAMPLED),
            tails_wanted: word(TAILS_WANTED),
            outside: word(OUTSIDE),
            overshoot: word(OVERSHOOT),
            truncated: word(TRUNCATED),
            caught: word(CAUGHT),
            tally_overflow: word(TALLY_OVERFLOW),
            capacity_failed: word(CAPACITY_FAILED),
            bounces: word(BOUNCES),
            blocked: word(BLOCKED),
            strays: word(STRAYS),
            missing: word(MISSING),
            moved: word(MOVED),
            fast_pairs: word(FAST_PAIRS),
            candidates: word(CANDIDATES),
            near_walls: word(LIST_NEAR_WALLS),
            ghost_candidates: word(GHOST_CANDIDATES),
            ghost_walls: word(GHOST_WALLS),
            sheets: word(SHEETS),
            ghost_sheets: word(GHOST_SHEETS),
            cut_short: word(CUT_SHORT),
            free_flights: word(FREE_FLIGHTS),
            cut_groups: word(CUT_GROUPS),
            unfitted: word(UNFITTED),
            misplaced: word(MISPLACED),
            choosers: std::array::from_fn(|round| {
                let list = LIST_RECHOOSE + round as u32;
                let shards = (0..LIST_SHARDS).map(|shard| word(LENGTHS_OF_SHARDS + shard * SHARD_WORDS + list));
                word(list) + shards.sum::<u32>()
            }),
        }
    }

    /// What ranks add up, but for the collisions, which have two words.
    pub(super) fn summed(&mut self) -> [&mut u32; 21] {
        [
            &mut self.lost,
            &mut self.sampled,
            &mut self.outside,
            &mut self.truncated,
            &mut self.caught,
            &mut self.tally_overflow,
            &mut self.capacity_failed,
            &mut self.bounces,
            &mut self.blocked,
            &mut self.strays,
            &mut self.missing,
            &mut self.moved,
            &mut self.fast_pairs,
            &mut self.candidates,
            &mut self.near_walls,
            &mut self.sheets,
            &mut self.cut_short,
            &mut self.misplaced,
            &mut self.free_flights,
            &mut self.cut_groups,
            &mut self.unfitted,
        ]
    }

    /// Of what ranks take the largest.
    pub(super) fn largest(&mut self) -> [&mut u32; 2] {
        [&mut self.tails_wanted, &mut self.overshoot]
    }
}
