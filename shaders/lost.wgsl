//! phase: lost
// Adds the pairs that the extra round found, and those settled in this step, to the lost-event tally.
//
// Reads and writes `counters`. One thread.

override ROUNDS: u32;

var<storage, read_write> counters: array<atomic<u32>>;

@compute @workgroup_size(1)
fn lost() {
    atomicAdd(&counters[LOST], atomicLoad(&counters[LIST_PAIRS + ROUNDS]));
    for (var round = 0u; round < ROUNDS; round++) {
        atomicAdd(&counters[SAMPLED], atomicLoad(&counters[LIST_PAIRS + round]));
    }
    // The sampled step is the first since the last read.
    atomicSub(&counters[SAMPLED], atomicLoad(&counters[FOREIGN]));
}
