//! The bytes that the phases of a step must move, counted from their buffers.
//!
//! Each element that the kernels of a phase read counts once, and each that they write once, however often their threads come back to
//! it, and also where one kernel reads what another of the phase has written: what a cache that forgets nothing within a phase would
//! leave. (What chooses and settles is so in each round.) An element is a whole struct, also where only some of its fields are
//! wanted: memory moves lines. So bytes over time are no more than what really moves, and their share of the
//! copy's rate says how far a phase is from being bound by memory. Walls, classes of cells, lists of rare work and tallies are left out.

use crate::scene::Method;
use crate::subdomain::registry::LISTS;
use crate::subdomain::{GpuFlight, GpuNewborn, GpuParticle, STRETCH};

use super::collision_cells::CollisionCells;
use super::work::{CHUNK, Work};

const PARTICLE: f64 = size_of::<GpuParticle>() as f64;
const FLIGHT: f64 = size_of::<GpuFlight>() as f64;
const NEWBORN: f64 = size_of::<GpuNewborn>() as f64;
/// The length of a list, and three dispatches over it of three words each (`shaders/reset.wgsl`).
const WORDS_OF_A_LIST: f64 = 10.0;
const WORD: f64 = 4.0;

/// Bytes of a phase over the run; `None` of one that is not counted.
pub fn bytes(phase: &str, method: Method, work: &Work) -> Option<f64> {
    let Work { particle_steps: n, cell_steps: cells, filled, candidates, collisions, .. } = *work;
    let rounds = method.has_rounds();
    let present = n / work.steps.max(1.0);
    let entries = candidates / n.max(1.0);
    // Its entry among those that choose, the length of its list and its entries, state and flight in; its choice out. (Whom it
    // looks at is not counted: most of these choose too, or are next to such.)
    let choice = (2.0 + entries) * WORD + PARTICLE + FLIGHT + 2.0 * WORD;
    // Its entry and its choice in.
    let matched = 3.0 * WORD;
    let entered = work.newborns * NEWBORN;
    if method == Method::HalfTurn {
        match phase {
            // State, cell and place in it, and where the cell starts in; state out; the ids of a cell out, and in.
            "sort" => return Some(n * (2.0 * PARTICLE + 4.0 * WORD) + filled * WORD),
            // Where the cells start; the first and the end of a collision cell out, and in; its states in and out.
            "collide" => {
                let CollisionCells { number, members, .. } = work.collision_cells;
                return Some(cells * WORD + number * 4.0 * WORD + members * 2.0 * PARTICLE);
            }
            _ => {}
        }
    }
    Some(match phase {
        // Counts in, and the starts out in their place; sums of stretches of cells out.
        "scan" => cells * (2.0 + 1.0 / CHUNK as f64) * WORD,
        // State, cell and place in it, and where the cell starts in; state out; of the method `cell` the slots of crowded cells, and
        // where threads put these in order their entries.
        "sort" => {
            // Cell, layer and marks, middle and length of the list.
            let listed = if work.by_threads { 2.0 } else { 1.0 };
            let of_rounds = if rounds { 4.0 * WORD + if work.capped { FLIGHT } else { 0.0 } } else { 0.0 };
            n * (PARTICLE + 2.0 * WORD + PARTICLE + of_rounds)
                + (filled + if rounds { 0.0 } else { listed * work.crowded }) * WORD
        }
        // Middle and cell in, where the cells start, a flight (that sort leaves where diameters are capped, then in)
        // out; of those with neighbours the state in and the length of
        // the list in and out; the lists out; of those that may collide their mark in and out, and their entry.
        "neighbours" => {
            let of_listed = PARTICLE + 2.0 * WORD;
            n * (2.0 * WORD + FLIGHT)
                + filled * WORD
                + work.listed * of_listed
                + candidates * WORD
                + work.first_choosers * 3.0 * WORD
        }
        // The lists and their dispatches, and the sums of stretches of cells, are emptied.
        "bin" => (WORDS_OF_A_LIST * f64::from(LISTS) * work.steps + cells / STRETCH as f64) * WORD,
        "choose" => work.choosers * choice,
        // Of all that have chosen; pairs out; of those that collide states and flights in and out, layers, and lengths and entries of lists in.
        "settle" => {
            let collided = 2.0 * WORD + 4.0 * (PARTICLE + FLIGHT) + 2.0 * (2.0 + entries) * WORD;
            work.choosers * matched + collisions * collided
        }
        "lost" => work.lost_choosers * (choice + matched),
        // Where the cells start; of cells with two or more their volume and their states in; those that collide out; of crowded ones
        // slots in, and the order out, but where they lie in it.
        "collide" => {
            let ordered = if work.by_threads { 0.0 } else { 2.0 };
            cells * WORD
                + work.shared * WORD
                + work.gathered * PARTICLE
                + ordered * work.crowded * WORD
                + (2.0 * collisions).min(work.gathered) * PARTICLE
        }
        // State in and out; with rounds the marks, and the flights of those that may meet a wall; newborns from where they waited. With collisions the cells
        // cleared, cell and place in it out, and the cells' counters in and out, for the step that follows.
        "advect" => {
            let binned = if method == Method::None { 0.0 } else { (n + filled) * 2.0 * WORD + cells * WORD };
            n * (2.0 * PARTICLE + if rounds { WORD } else { 0.0 })
                + if rounds { work.near_walls * FLIGHT } else { 0.0 }
                + binned
                + entered
        }
        // The states, once for all zones.
        "tally" => present * PARTICLE * work.tallies,
        "blocks" => present * PARTICLE * work.intervals,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Free flight reads and writes each state once: the 64 bytes of docs/reference/performance.md.
    #[test]
    fn free_flight_moves_each_state_in_and_out() {
        let work = Work { steps: 10.0, particle_steps: 1000.0, bounces: 7.0, ..Work::default() };
        assert_eq!(bytes("advect", Method::None, &work), Some(64_000.0));
        assert_eq!(bytes("exchange", Method::None, &work), None);
    }

    /// Entries are bytes where lists are written and read, and nowhere else.
    #[test]
    fn candidates_count_where_they_are_listed() {
        let few = Work {
            steps: 1.0,
            particle_steps: 100.0,
            candidates: 500.0,
            choosers: 20.0,
            lost_choosers: 2.0,
            collisions: 5.0,
            ..Work::default()
        };
        let more = Work { candidates: 600.0, ..few };
        let phases = ["scan", "sort", "choose", "settle", "lost", "advect", "tally", "blocks"];
        for phase in phases {
            let [a, b] = [&few, &more].map(|work| bytes(phase, Method::ClosestApproach, work).unwrap());
            // One more for each particle.
            let read = match phase {
                "choose" => 20.0,
                "settle" => 2.0 * 5.0,
                "lost" => 2.0,
                _ => 0.0,
            };
            assert_eq!(b - a, 4.0 * read, "{phase}");
        }
        let [a, b] = [&few, &more].map(|work| bytes("neighbours", Method::ClosestApproach, work).unwrap());
        assert_eq!(b - a, 400.0);
    }

    /// What each particle costs, as `docs/reference/performance.md` has it.
    #[test]
    fn the_floor_is_that_of_the_documents() {
        let work =
            Work { steps: 1.0, particle_steps: 1.0, tallies: 1.0, zones: 3.0, intervals: 1.0, ..Work::default() };
        let floor = |phase, method| bytes(phase, method, &work).unwrap();
        let [rounds, cell] = [Method::ClosestApproach, Method::Cell];
        assert_eq!([floor("sort", rounds), floor("sort", cell)], [88.0, 72.0]);
        assert_eq!(floor("neighbours", rounds), 24.0);
        let capped = Work { capped: true, ..work };
        assert_eq!(["sort", "neighbours"].map(|phase| bytes(phase, rounds, &capped)), [104.0, 24.0].map(Some));
        assert_eq!([rounds, cell, Method::None].map(|method| floor("advect", method)), [76.0, 72.0, 64.0]);
        assert_eq!(["tally", "blocks"].map(|phase| floor(phase, cell)), [32.0, 32.0]);
        let cells = Work { cell_steps: 64.0, ..Work::default() };
        let found = [rounds, cell].map(|method| bytes("scan", method, &cells));
        assert_eq!(found, [64.0 * 8.0 + 4.0; 2].map(Some));
        let cleared = [rounds, cell].map(|method| bytes("advect", method, &cells));
        assert_eq!(cleared, [Some(64.0 * 4.0); 2]);
        let entered = Work { newborns: 2.0, ..Work::default() };
        let moved = [rounds, cell, Method::None];
        assert_eq!(moved.map(|method| bytes("advect", method, &entered)), [Some(96.0); 3]);
        let chosen = Work { particle_steps: 1.0, choosers: 1.0, lost_choosers: 1.0, ..Work::default() };
        assert_eq!(
            ["choose", "settle", "lost"].map(|phase| bytes(phase, rounds, &chosen)),
            [64.0, 12.0, 76.0].map(Some)
        );
        let collided = Work { particle_steps: 1.0, collisions: 1.0, ..Work::default() };
        assert_eq!(bytes("settle", rounds, &collided), Some(8.0 + 192.0 + 16.0));
        let scanned = Work { cell_steps: 64.0, ..Work::default() };
        assert_eq!(bytes("scan", rounds, &scanned), Some(516.0));
        let crowded = Work { crowded: 1.0, ..Work::default() };
        assert_eq!(["sort", "collide"].map(|phase| bytes(phase, cell, &crowded)), [4.0, 8.0].map(Some));
        assert_eq!(bytes("sort", rounds, &crowded), Some(0.0));
        let half_turn = Method::HalfTurn;
        assert_eq!(["sort", "advect"].map(|phase| floor(phase, half_turn)), [80.0, 72.0]);
        let divided = CollisionCells { number: 1.0, members: 14.0, ..CollisionCells::default() };
        let divided = Work { cell_steps: 8.0, collision_cells: divided, ..Work::default() };
        assert_eq!(bytes("collide", half_turn, &divided), Some(32.0 + 16.0 + 14.0 * 64.0));
        let by_threads = Work { by_threads: true, ..crowded };
        assert_eq!(["sort", "collide"].map(|phase| bytes(phase, cell, &by_threads)), [8.0, 0.0].map(Some));
    }
}
