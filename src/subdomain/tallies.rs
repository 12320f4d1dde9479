//! What a device measured in one step interval, decoded from its integer tallies.

use super::buffers::TallyWords;
use super::constants::Patches;
use super::counters::{self, Counters};
use super::registry::*;

/// The tallies of the walls, of which there are copies (`shaders/bounce.wgsl`). All are numbers of two words, but for the
/// counts of particles that left through vents, a word each: two of them add up like one number, since there are fewer than 2^32 particles.
fn sum_of_copies(copies: &[u32], patches: Patches) -> Vec<u32> {
    let mut sums = vec![0; patches.words()];
    for copy in copies.chunks_exact(patches.copy_words()) {
        for (sum, own) in sums.chunks_exact_mut(2).zip(copy.chunks_exact(2)) {
            let both = long(sum, 0).wrapping_add(long(own, 0));
            sum.copy_from_slice(&[both as u32, (both >> 32) as u32]);
        }
    }
    sums
}

/// Sums over the particles of one gas in one zone and over the tallies of an interval, in tally units.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ZoneSum {
    pub number: i64,
    pub velocity: [i64; 3],
    pub kinetic: i64,
    pub spin: i64,
}

/// What a patch of wall received in an interval, in tally units over the reference mass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SurfaceSum {
    pub impulse: [i64; 3],
    /// Along the wall's inward normal, summed without sign: what makes pressure.
    pub normal: i64,
    pub hits: i64,
}

/// What a surface model took in an interval, in tally units over the reference mass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SurfaceModelSum {
    pub energy: i64,
    /// Each part of it times the tallies of the zones that followed in the interval.
    pub tallied: i64,
}

/// What left through a vent in an interval; energies as those of a surface_model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct VentSum {
    pub energy: i64,
    pub tallied: i64,
    /// Particles that hit its place.
    pub hits: i64,
    /// Those of them whose probability of passing was more than one.
    pub clipped: i64,
    /// Particles of each gas.
    pub left: [i64; 16],
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct BlockSum {
    pub number: u64,
    pub energy: u64,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Tallies {
    pub counters: Counters,
    /// Zone-major, then gas.
    pub zones: Vec<ZoneSum>,
    pub surfaces: Vec<SurfaceSum>,
    pub surface_models: Vec<SurfaceModelSum>,
    pub vents: Vec<VentSum>,
    /// What passed each vent to other gas; empty if none leads there.
    pub passages: Vec<VentSum>,
    /// The work that the gas did on each wall that moves.
    pub works: Vec<SurfaceModelSum>,
    pub blocks: Vec<BlockSum>,
    /// Particles that would cross more than a cell in a step of each level of the ladder.
    pub fast: Vec<u32>,
}

fn long(words: &[u32], index: u32) -> u64 {
    u64::from(words[index as usize]) | (u64::from(words[index as usize + 1]) << 32)
}

fn signed(words: &[u32], index: u32) -> i64 {
    long(words, index).cast_signed()
}

impl Tallies {
    /// From the counters, zones, surfaces and blocks in this order.
    pub fn decode(words: &[u32], sizes: TallyWords, patches: Patches, blocks: usize) -> Tallies {
        let mut counter_words = [0; counters::WORDS];
        counter_words.copy_from_slice(&words[..counters::WORDS]);
        let rest = &words[counters::WORDS..];
        let (zones, rest) = rest.split_at(sizes.zones);
        let (copies, rest) = rest.split_at(sizes.surfaces);
        let walls = sum_of_copies(copies, patches);
        let [surface_models_at, vents_at, works_at] = patches.ends();
        let (surfaces, surface_models) = (&walls[..surface_models_at], &walls[surface_models_at..vents_at]);
        let (vents, works) = (&walls[vents_at..works_at], &walls[works_at..]);
        let taken = |words: &[u32]| -> Vec<SurfaceModelSum> {
            let sum = |w: &[u32]| SurfaceModelSum { energy: signed(w, WALL_ENERGY), tallied: signed(w, WALL_TALLIED) };
            words.chunks_exact(SURFACE_MODEL_WORDS as usize).map(sum).collect()
        };
        let passed = |words: &[u32]| -> Vec<VentSum> {
            let sum = |w: &[u32]| VentSum {
                energy: signed(w, WALL_ENERGY),
                tallied: signed(w, WALL_TALLIED),
                hits: signed(w, VENT_HITS),
                clipped: signed(w, VENT_CLIPPED),
                left: std::array::from_fn(|gas| i64::from(w[VENT_LEFT as usize + gas])),
            };
            words.chunks_exact(VENT_WORDS as usize).map(sum).collect()
        };
        let vents_end = patches.vents * VENT_WORDS as usize;
        let block_words = &rest[..sizes.blocks];
        Tallies {
            counters: Counters::from_words(&counter_words),
            zones: zones
                .chunks_exact(ZONE_WORDS as usize)
                .map(|w| ZoneSum {
                    number: signed(w, ZONE_NUMBER),
                    velocity: std::array::from_fn(|axis| signed(w, ZONE_VELOCITY + 2 * axis as u32)),
                    kinetic: signed(w, ZONE_KINETIC),
                    spin: signed(w, ZONE_SPIN),
                })
                .collect(),
            surfaces: surfaces
                .chunks_exact(SURFACE_WORDS as usize)
                .map(|w| SurfaceSum {
                    impulse: std::array::from_fn(|axis| signed(w, SURFACE_IMPULSE + 2 * axis as u32)),
                    normal: signed(w, SURFACE_NORMAL),
                    hits: signed(w, SURFACE_HITS),
                })
                .collect(),
            surface_models: taken(surface_models),
            works: taken(works),
            vents: passed(&vents[..vents_end]),
            passages: passed(&vents[vents_end..]),
            blocks: block_words[..blocks * BLOCK_WORDS as usize]
                .chunks_exact(BLOCK_WORDS as usize)
                .map(|w| BlockSum { number: long(w, BLOCK_NUMBER), energy: long(w, BLOCK_ENERGY) })
                .collect(),
            fast: block_words[blocks * BLOCK_WORDS as usize..].to_vec(),
        }
    }
}

impl Tallies {
    /// What ranks add up, and of what they take the largest.
    pub fn to_words(&self) -> (Vec<u64>, Vec<u64>) {
        let mut own = self.clone();
        let mut sums = vec![own.counters.collisions];
        sums.extend(own.counters.summed().map(|count| u64::from(*count)));
        sums.extend(own.signed().map(|sum| sum.cast_unsigned()));
        sums.extend(own.blocks.iter().flat_map(|block| [block.number, block.energy]));
        sums.extend(own.fast.iter().map(|&count| u64::from(count)));
        (sums, own.counters.largest().map(|count| u64::from(*count)).to_vec())
    }

    /// The tallies of all ranks, in the shape of this rank's, from the words' sums and maxima; `None` if the
    /// words are not of this shape.
    pub fn from_words(&self, sums: &[u64], maxima: &[u64]) -> Option<Tallies> {
        let mut sums = sums.iter().copied();
        let count = |word: u64| u32::try_from(word).unwrap_or(u32::MAX);
        let mut all = self.clone();
        all.counters.collisions = sums.next()?;
        for word in all.counters.summed() {
            *word = count(sums.next()?);
        }
        for (word, &most) in all.counters.largest().into_iter().zip(maxima.get(..2)?) {
            *word = count(most);
        }
        for word in all.signed() {
            *word = sums.next()?.cast_signed();
        }
        for block in &mut all.blocks {
            (block.number, block.energy) = (sums.next()?, sums.next()?);
        }
        for fast in &mut all.fast {
            *fast = count(sums.next()?);
        }
        sums.next().is_none().then_some(all)
    }

    /// With those of the steps before in the same interval, which had another read. What they wanted is had, and what is of the last step alone
    /// is of this one's. `None` if they are not of this shape.
    pub fn and_before(&self, earlier: &Tallies) -> Option<Tallies> {
        let mut earlier = earlier.clone();
        let Counters { tails_wanted, candidates, near_walls, .. } = &mut earlier.counters;
        (*tails_wanted, *candidates, *near_walls) = (0, 0, 0);
        let (mut sums, mut maxima) = self.to_words();
        let (more, most) = earlier.to_words();
        if more.len() != sums.len() {
            return None;
        }
        sums.iter_mut().zip(more).for_each(|(sum, more)| *sum = sum.wrapping_add(more));
        maxima.iter_mut().zip(most).for_each(|(maximum, most)| *maximum = most.max(*maximum));
        self.from_words(&sums, &maxima)
    }

    /// The sums of zones, surfaces, surface models, vents and moving walls.
    fn signed(&mut self) -> impl Iterator<Item = &mut i64> {
        let zones = self.zones.iter_mut().flat_map(|zone| {
            let ZoneSum { number, velocity: [x, y, z], kinetic, spin } = zone;
            [number, x, y, z, kinetic, spin]
        });
        let surfaces = self.surfaces.iter_mut().flat_map(|surface| {
            let SurfaceSum { impulse: [x, y, z], normal, hits } = surface;
            [x, y, z, normal, hits]
        });
        let surface_models = self
            .surface_models
            .iter_mut()
            .flat_map(|surface_model| [&mut surface_model.energy, &mut surface_model.tallied]);
        let vents = self.vents.iter_mut().chain(&mut self.passages).flat_map(|vent| {
            let VentSum { energy, tallied, hits, clipped, left } = vent;
            [energy, tallied, hits, clipped].into_iter().chain(left)
        });
        let works = self.works.iter_mut().flat_map(|work| [&mut work.energy, &mut work.tallied]);
        zones.chain(surfaces).chain(surface_models).chain(vents).chain(works)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Low words carry into high ones, negative numbers are added as such, and what lies between the copies is not read.
    #[test]
    fn copies_add_up_as_numbers_of_two_words() {
        let patches = Patches { surfaces: 1, ..Patches::default() };
        let numbers = [[i64::from(u32::MAX), 3], [-5, -7], [1 << 40, 4]];
        let copy = |own: [i64; 2]| {
            let mut words: Vec<u32> =
                own.iter().flat_map(|n| [n.cast_unsigned() as u32, (n.cast_unsigned() >> 32) as u32]).collect();
            words.resize(patches.words(), 0);
            words.resize(patches.copy_words(), 9);
            words
        };
        let sums = sum_of_copies(&numbers.map(copy).concat(), patches);
        assert_eq!(sums.len(), patches.words());
        assert_eq!([signed(&sums, 0), signed(&sums, 2)], [i64::from(u32::MAX) - 5 + (1 << 40), 0]);
    }
}
