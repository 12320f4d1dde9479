//! uses: step.wgsl local.wgsl counters.wgsl lists.wgsl settled.wgsl
// Settle, part 2: the collisions of this round (settled.wgsl).
//
// Reads `pairs`, and what a collision wants; writes what that changes. One thread per pair. Pairs are
// disjoint and random numbers are keyed on (step, round, ids), so order does not matter.

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(15) var<storage, read> choices: array<vec2<u32>>;
@group(0) @binding(16) var<storage, read> pairs: array<vec2<u32>>;

@compute @workgroup_size(WORKGROUP)
fn settle(thread: Thread) {
    let k = linear(thread);
    let number = number_in_part(k);
    let count = entries_in_part(k, step.round, step.total / 2u);
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
