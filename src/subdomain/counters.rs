//! The counters of `shaders/shared/counters.wgsl`, read once per step interval.

/// Words of the buffer.
pub const WORDS: usize = 45;
/// Words that are cleared after each read: all but the particle count.
pub const CLEARED: usize = 44;
/// The word that counts the particles on the device.
pub const PARTICLES: usize = 44;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    pub collisions: u64,
    /// Pairs still mutually eligible after the last round of the sampled steps.
    pub lost: u32,
    /// Collisions of the sampled steps.
    pub sampled: u32,
    /// The longest neighbour list that did not fit; 0 if all did.
    pub most_neighbours: u32,
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
    pub particles: u32,
}

impl Counters {
    pub fn from_words(words: &[u32; WORDS]) -> Counters {
        Counters {
            collisions: u64::from(words[32]) | (u64::from(words[33]) << 32),
            lost: words[34],
            sampled: words[35],
            most_neighbours: words[36],
            outside: words[37],
            overshoot: words[38],
            truncated: words[39],
            tally_overflow: words[40],
            capacity_failed: words[41],
            bounces: words[42],
            blocked: words[43],
            particles: words[PARTICLES],
        }
    }
}
