//! What the steps of a run took, gathered from its ranks.

use std::time::Duration;

use crate::output::{PhaseTiming, RankTiming, Timing};
use crate::ranks::{Communicator, RankError};
use crate::simulation::Outcome;

/// At rank 0. Collective: the others call [`of_ranks`].
pub fn of(comm: &dyn Communicator, outcome: &Outcome, set_up: Duration) -> Result<Timing, RankError> {
    Ok(Timing {
        stepping_seconds: outcome.stepping_seconds,
        set_up_seconds: set_up.as_secs_f64(),
        steps: outcome.steps,
        particle_steps: outcome.particle_steps,
        ranks: of_ranks(comm, outcome)?,
        phases: outcome
            .phases
            .rows
            .iter()
            .map(|(name, device_seconds, dispatches)| PhaseTiming {
                name: name.clone(),
                device_seconds: *device_seconds,
                dispatches: *dispatches,
            })
            .collect(),
    })
}

/// By rank, at rank 0. Collective.
pub fn of_ranks(comm: &dyn Communicator, outcome: &Outcome) -> Result<Vec<RankTiming>, RankError> {
    let traffic = &outcome.traffic;
    let own = [
        traffic.device_seconds.to_bits(),
        traffic.waiting_seconds.to_bits(),
        traffic.rebalancing_seconds.to_bits(),
        traffic.messages,
        traffic.bytes,
        traffic.present,
    ];
    let gathered = comm.gather(bytemuck::cast_slice(&own).to_vec())?.unwrap_or_default();
    let rank = |bytes: Vec<u8>| {
        let words: Vec<u64> = bytemuck::pod_collect_to_vec(&bytes);
        RankTiming {
            device_seconds: f64::from_bits(words[0]),
            waiting_seconds: f64::from_bits(words[1]),
            rebalancing_seconds: f64::from_bits(words[2]),
            messages: words[3],
            bytes: words[4],
            particle_steps: words[5],
        }
    };
    Ok(gathered.into_iter().map(rank).collect())
}
