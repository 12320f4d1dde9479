//! uses: step.wgsl local.wgsl lists.wgsl settled.wgsl
//! binds: rechoose_dispatches as dispatches
//! phase: settle
// Settle, part 2: the collisions of this round (settled.wgsl).
//
// Reads `pairs`, and what a collision wants; writes what that changes. One thread per pair. Pairs are
// disjoint and random numbers are keyed on (step, round, ids), so order does not matter.

var<uniform> step: Step;
var<storage, read> choices: array<vec2<u32>>;
var<storage, read> pairs: array<vec2<u32>>;

@compute @workgroup_size(WORKGROUP)
fn settle(thread: Thread) {
    let k = linear(thread);
    let number = number_in_shard(k);
    let count = entries_in_shard(k, step.round, step.total / 2u);
    if (number >= count) {
        return;
    }
    if (number == 0u) {
        tell_entries(step.round, count);
        let old = atomicAdd(&counters[COLLISIONS_LOW], count);
        if (old + count < old) {
            atomicAdd(&counters[COLLISIONS_HIGH], 1u);
        }
    }
    settle_pair(pairs[k], k);
}
