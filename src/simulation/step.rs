//! The step: one named and timed phase a line. The names are those of the shaders, the timers, the phase
//! table at the end of a run and the docs.

use crate::gpu::Recording;
use crate::subdomain::{StepSlot, Subdomain};

use super::SimulationError;
use super::exchange::Exchange;

/// The phases whose time goes with the entries of neighbour lists. (That of `collide`, which has none, goes with cells and particles
/// as well as with the pairs that are tried.)
pub const PAIR_PHASES: [&str; 3] = ["neighbours", "choose", "settle"];

/// In the order of a step; `lost` and `blocks` are once an interval.
const PHASES: [&str; 13] = [
    "bin",
    "exchange",
    "scan",
    "sort",
    "neighbours",
    "collide",
    "update",
    "choose",
    "settle",
    LOST,
    "advect",
    TALLY,
    BLOCKS,
];
/// In the first step of an interval.
pub const LOST: &str = "lost";
/// In some steps, of which the last of an interval is one.
pub const TALLY: &str = "tally";
/// In the last step of an interval.
pub const BLOCKS: &str = "blocks";

/// Where in a step a phase is.
pub fn place(phase: &str) -> usize {
    PHASES.iter().position(|&known| known == phase).unwrap_or(PHASES.len())
}

/// Whether a phase is once an interval, and so no part of a mean step.
pub fn once_an_interval(phase: &str) -> bool {
    [LOST, BLOCKS].contains(&phase)
}

/// What else a step does.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sampling {
    /// Count the collisions that the rounds lost.
    pub lost: bool,
    /// Add to the zones' averages.
    pub tally: bool,
}

/// # Errors
/// If a device or another rank fails.
pub fn step(
    subdomain: &mut Subdomain,
    exchange: &mut Exchange<'_>,
    rec: &mut Recording<'_>,
    slot: &mut StepSlot,
    rounds: u32,
    sampling: Sampling,
) -> Result<(), SimulationError> {
    subdomain.reset(rec);
    subdomain.bin(rec, slot);
    exchange.particles(subdomain, rec, slot)?;
    subdomain.scan(rec, slot);
    subdomain.sort(rec, slot);
    subdomain.neighbours(rec, slot);
    subdomain.collide(rec, slot);
    for round in 0..rounds {
        exchange.updates(subdomain, rec, slot, round)?;
        subdomain.choose(rec, slot, round);
        subdomain.settle(rec, slot, round);
    }
    if sampling.lost {
        exchange.updates(subdomain, rec, slot, rounds)?;
        subdomain.count_lost(rec, slot);
    }
    subdomain.clear_cells(rec, slot);
    subdomain.advect(rec, slot);
    if sampling.tally {
        subdomain.tally(rec, slot);
    }
    Ok(())
}
