//! The step: one named and timed phase a line. The names are those of the shaders, the timers, the phase
//! table at the end of a run and the docs.

use crate::gpu::Recording;
use crate::simulation::error::SimulationError;
use crate::simulation::parallel::exchange::Exchange;
use crate::subdomain::{StepSlot, Subdomain};

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
    sampling: Sampling,
) -> Result<(), SimulationError> {
    subdomain.reset(rec);
    subdomain.list_fabric(rec, slot);
    subdomain.bin(rec, slot);
    exchange.particles(subdomain, rec, slot)?;
    subdomain.scan(rec, slot);
    subdomain.sort(rec, slot);
    subdomain.neighbours(rec, slot);
    subdomain.collide(rec, slot);
    let rounds = subdomain.rounds();
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
