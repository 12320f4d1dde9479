//! The counters of `shaders/shared/counters.wgsl`, read once per step interval.

use super::constants::WORKGROUP;

/// Words that are read: all of them.
pub const WORDS: usize = PARTS_OF_LISTS + PART_WORDS * LIST_PARTS;
/// Collisions in cells, in so many parts of two words.
const CELL_COLLISIONS: usize = 53;
const COLLISION_COUNTS: usize = 32;
/// The lengths of lists that are in parts (`shaders/shared/parted_lists.gpu.wgsl`), each part's so far behind those before.
pub const PARTS_OF_LISTS: usize = 128;
pub const PART_WORDS: usize = 64;
pub const LIST_PARTS: usize = 16;
/// Entries for which a list in parts has room beyond the most that it may have: each part's is a whole number of workgroups.
pub const FREE_ENTRIES: u64 = WORKGROUP as u64 * LIST_PARTS as u64;
/// The words of the lists of a step (`shaders/shared/lists.wgsl`), of which the host reads these.
pub const LISTS: usize = 32;
pub const NEAR_WALLS: usize = 9;
/// The lists of those that choose, by round, of a device that has them in one part.
const RECHOOSE: usize = 16;
pub const MOST_ROUNDS: usize = 10;
pub const BORDER: usize = 12;
pub const CHANGED: usize = 13;
pub const OUTBOX: usize = 14;
pub const UPDATES: usize = 15;
pub const DROPPED: usize = 31;
/// Entries of the tails of neighbour lists in a step.
pub const TAILS: usize = 29;
pub const TAILS_WANTED: usize = 36;

/// Places among which a list in parts has its entries, of which it has so many at most (`shaders/shared/parted_lists.gpu.wgsl`).
pub const fn places_in_parts(most: u64) -> u64 {
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
    pub truncated: u32,
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
    /// Threads whose loops the device ended too soon.
    pub cut_short: u32,
    /// Entries of lists that found no place, and threads that were parted while they counted together.
    pub misplaced: u32,
    /// Of the last step on this device: particles that chose in each round, and behind the last that would have again.
    pub choosers: [u32; MOST_ROUNDS],
}

impl Counters {
    pub fn from_words(words: &[u32; WORDS]) -> Counters {
        let two_words = |words: &[u32]| u64::from(words[0]) | (u64::from(words[1]) << 32);
        let in_cells: u64 =
            words[CELL_COLLISIONS..CELL_COLLISIONS + 2 * COLLISION_COUNTS].chunks_exact(2).map(two_words).sum();
        Counters {
            // Less those that another device counts.
            collisions: two_words(&words[32..34]) + in_cells - u64::from(words[44]),
            lost: words[34],
            sampled: words[35],
            tails_wanted: words[TAILS_WANTED],
            outside: words[37],
            overshoot: words[38],
            truncated: words[39],
            tally_overflow: words[40],
            capacity_failed: words[41],
            bounces: words[42],
            blocked: words[43],
            strays: words[45],
            missing: words[46],
            moved: words[48],
            fast_pairs: words[49],
            candidates: words[47],
            near_walls: words[NEAR_WALLS],
            ghost_candidates: words[50],
            ghost_walls: words[51],
            cut_short: words[52],
            misplaced: words[117],
            choosers: std::array::from_fn(|round| {
                let parts = words[PARTS_OF_LISTS..].chunks_exact(PART_WORDS).map(|part| part[RECHOOSE + round]);
                words[RECHOOSE + round] + parts.sum::<u32>()
            }),
        }
    }

    /// What ranks add up, but for the collisions, which have two words.
    pub(super) fn summed(&mut self) -> [&mut u32; 16] {
        [
            &mut self.lost,
            &mut self.sampled,
            &mut self.outside,
            &mut self.truncated,
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
            &mut self.cut_short,
            &mut self.misplaced,
        ]
    }

    /// Of what ranks take the largest.
    pub(super) fn largest(&mut self) -> [&mut u32; 2] {
        [&mut self.tails_wanted, &mut self.overshoot]
    }
}
