//! The step: one named and timed phase a line. The names are those of the shaders, the timers, the phase
//! table at the end of a run and the docs.

use crate::gpu::{Device, TimedPass};
use crate::subdomain::{StepSlot, Subdomain};

/// What else a step does.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sampling {
    /// Count the collisions that the rounds lost.
    pub lost: bool,
    /// Add to the zones' averages.
    pub tally: bool,
}

pub fn step(
    subdomain: &Subdomain,
    device: &Device,
    pass: &mut TimedPass<'_>,
    slot: StepSlot,
    rounds: u32,
    sampling: Sampling,
) {
    subdomain.inject(device, pass, slot);
    subdomain.bin(device, pass, slot);
    subdomain.scan(device, pass);
    subdomain.sort(device, pass, slot);
    subdomain.neighbours(device, pass, slot);
    for round in 0..rounds {
        subdomain.choose(device, pass, slot, round);
        subdomain.settle(device, pass, slot, round);
    }
    if sampling.lost {
        subdomain.count_lost(device, pass, slot);
    }
    subdomain.advect(device, pass, slot);
    if sampling.tally {
        subdomain.tally(device, pass, slot);
    }
}
