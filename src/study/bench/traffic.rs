//! The bytes that the phases of a step must move, counted from their buffers.
//!
//! Each element that a phase reads or writes counts once, however often its threads come back to it: what a cache that
//! forgets nothing within a phase would leave. An element is a whole struct, also where only some of its fields are
//! wanted: memory moves lines. So bytes over time are no more than what really moves, and their share of the
//! copy's rate says how far a phase is from being bound by memory. Walls (some kilobytes) and tallies are left out.

use crate::scene::Method;
use crate::subdomain::{GpuFlight, GpuNewborn, GpuParticle};

const PARTICLE: f64 = size_of::<GpuParticle>() as f64;
const FLIGHT: f64 = size_of::<GpuFlight>() as f64;
const NEWBORN: f64 = size_of::<GpuNewborn>() as f64;
const WORD: f64 = 4.0;

/// What a run did in its steps, summed over them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Work {
    pub steps: f64,
    pub particle_steps: f64,
    /// Cells times steps.
    pub cell_steps: f64,
    /// Entries of the neighbour lists.
    pub candidates: f64,
    pub newborns: f64,
    pub collisions: f64,
    pub bounces: f64,
    /// Steps that were tallied, and zones that were.
    pub tallies: f64,
    pub zones: f64,
    /// Intervals.
    pub intervals: f64,
}

/// Bytes of a phase over the run; `None` of one that is not counted.
pub fn bytes(phase: &str, method: Method, work: &Work) -> Option<f64> {
    let Work { particle_steps: n, cell_steps: cells, candidates, collisions, .. } = *work;
    let rounds = method.has_rounds();
    // With a particle: at most so many.
    let filled = cells.min(n);
    Some(match phase {
        "inject" => work.newborns * (NEWBORN + PARTICLE),
        // State in; cell and place in the cell out; the cells' counters.
        "bin" => n * (PARTICLE + 2.0 * WORD) + filled * 2.0 * WORD,
        // Counters in, and the starts out in their place; where there are particles the counters again. (They are cleared outside of
        // the phases.)
        "scan" => cells * 2.0 * WORD,
        // scatter: bins and id in, slots out; order: cell and slots in, state in and out.
        "sort" => {
            let order = n * (2.0 * WORD + 2.0 * PARTICLE) + filled * WORD;
            // Cell, layer, flight, middle, mark of the rounds and length of the list.
            let of_rounds = if rounds { n * (FLIGHT + 5.0 * WORD) } else { 0.0 };
            n * 4.0 * WORD + filled * WORD + order + of_rounds
        }
        // Middle, cell, layer and state in; lengths of the lists in and out; the lists, and that nobody has chosen, out. (The few lists
        // that are longer than eight are sought twice.)
        "neighbours" => n * (7.0 * WORD + PARTICLE) + filled * WORD + candidates * WORD,
        // States and flights in and choices out, of those alone that do collide: how many more may is not counted.
        "choose" => collisions * 2.0 * (3.0 * WORD + PARTICLE + FLIGHT),
        // Choices in, pairs out; states and flights of those that collide in and out.
        "settle" => collisions * (6.0 * WORD + 4.0 * (PARTICLE + FLIGHT)),
        // States of the cell in, those that collide out.
        "collide" => n * PARTICLE + cells * WORD + collisions * 2.0 * PARTICLE,
        // State in and out; flight where there is one.
        "advect" => n * (2.0 * PARTICLE + if rounds { FLIGHT } else { 0.0 }) + work.bounces * 2.0 * PARTICLE,
        // Every zone of a tallied step, and the blocks of each interval, read all states.
        "tally" => n / work.steps.max(1.0) * PARTICLE * work.tallies * work.zones,
        "blocks" => n / work.steps.max(1.0) * PARTICLE * work.intervals,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Free flight reads and writes each state once: the 64 bytes of the specification, section 7.
    #[test]
    fn free_flight_moves_each_state_in_and_out() {
        let work = Work { steps: 10.0, particle_steps: 1000.0, ..Work::default() };
        assert_eq!(bytes("advect", Method::None, &work), Some(64_000.0));
        assert_eq!(bytes("exchange", Method::None, &work), None);
    }

    /// More candidates are more bytes where they are listed, and nowhere else.
    #[test]
    fn candidates_count_where_they_are_listed() {
        let few = Work { steps: 1.0, particle_steps: 100.0, candidates: 500.0, ..Work::default() };
        let more = Work { candidates: 600.0, ..few };
        for phase in ["bin", "scan", "sort", "neighbours", "choose", "settle", "advect", "tally", "blocks"] {
            let [a, b] = [&few, &more].map(|work| bytes(phase, Method::ClosestApproach, work).unwrap());
            let listed = phase == "neighbours";
            assert_eq!(b - a, if listed { 400.0 } else { 0.0 }, "{phase}");
        }
    }
}
