//! uses: step.wgsl local.wgsl particle.wgsl lists.wgsl on_demand.wgsl chooser.wgsl mutual.wgsl
//! phase: settle lost
// Settle, part 1: the pairs whose choices are mutual.
//
// Reads `choices`, `sorted`, `marks`; writes `pairs` (indices, lower id first) and their count in `counters`.
// One thread per particle that has just chosen. The pairs are disjoint, so their order in the list does not matter. In the
// extra round that counts lost events the pairs are only counted.

// Rounds of the plan: the round of this number is the extra one.
override ROUNDS: u32;

var<uniform> step: Step;
var<storage, read> stalled: array<u32>;
var<storage, read> sorted: array<Particle>;
var<storage, read_write> pairs: array<vec2<u32>>;
var<storage, read> marks: array<u32>;

fn mark_of(s: u32) -> u32 {
    return marks[s];
}

fn tag_of(s: u32) -> u32 {
    return sorted[s].tag;
}

fn among_others() -> bool {
    return HALO;
}

@compute @workgroup_size(WORKGROUP)
fn match_pairs(thread: Thread) {
    let s = chooser(linear(thread));
    if (s == NOBODY || stalled[STALLED] > 0u) {
        return;
    }
    let mine = mutual(s);
    if (!mine.found) {
        return;
    }
    if (step.round < ROUNDS) {
        if (!mine.counted) {
            atomicAdd(&counters[FOREIGN], 1u);
        }
        let number = entries_from(step.round, 1u, linear(thread), step.total / 2u);
        pairs[entry_place(number, step.round, linear(thread), step.total / 2u)] = mine.pair;
    } else if (mine.counted) {
        atomicAdd(&counters[step.round], 1u);
    }
}
