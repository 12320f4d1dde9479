//! The phases of a step: names as those of the shaders, the timers, the phase table at the end of a run and the docs.

use crate::subdomain::registry::PHASES;

/// The phases whose time goes with the entries of neighbour lists. (That of `collide`, which has none, goes with cells and particles
/// as well as with the pairs that are tried.)
pub const PAIR_PHASES: [&str; 3] = ["neighbours", "choose", "settle"];

/// In the first step of an interval.
pub const LOST: &str = "lost";

/// In some steps, of which the last of an interval is one.
pub const TALLY: &str = "tally";

/// In the last step of an interval.
pub const BLOCKS: &str = "blocks";

/// Where in a step a phase is.
pub fn order_of(phase: &str) -> usize {
    PHASES.iter().position(|&known| known == phase).unwrap_or(PHASES.len())
}

/// Whether a phase is once an interval, and so no part of a mean step.
pub fn once_an_interval(phase: &str) -> bool {
    [LOST, BLOCKS].contains(&phase)
}
