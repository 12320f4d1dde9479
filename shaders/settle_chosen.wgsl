//! uses: step.wgsl local.wgsl lists.wgsl together.wgsl mutual.wgsl settled.wgsl
//! binds: rechoose_dispatches as dispatches
//! phase: settle
// Settle in one, of few particles (merged.wgsl): the pairs whose choices are mutual, and their collisions.
//
// Does what `match_pairs` and `settle` do one after the other, but for the list between. Reads `rechoose`, `choices`, and what a collision wants; writes what that changes,
// and in `rechoose` the list of the next round. One thread per particle that has just chosen. Pairs are disjoint and random numbers are keyed on (step, round, ids), so order does not matter.
// Meanwhile others collide, and of what they change the match asks nothing: they let particles choose in the next round, have
// collided with others, and keep their tags, which are written again as they were.

var<uniform> step: Step;
var<storage, read> stalled: array<u32>;

fn mark_of(s: u32) -> u32 {
    return atomicLoad(&marks[s]);
}

fn tag_of(s: u32) -> u32 {
    return sorted[s].position_tag.w;
}

// (Known only on the way: the same pipeline on one device as on several.)
fn among_others() -> bool {
    return true;
}

@compute @workgroup_size(WORKGROUP)
fn settle_chosen(thread: Thread) {
    let k = linear(thread);
    let s = listed_chooser(k);
    if (s == NOBODY || stalled[STALLED] > 0u) {
        return;
    }
    let mine = mutual(s);
    if (!mine.found) {
        return;
    }
    if (!mine.counted) {
        atomicAdd(&counters[FOREIGN], 1u);
    }
    _ = counted_up(step.round, 1u);
    if (counted_up(COLLISIONS_LOW, 1u) == 0xffffffffu) {
        atomicAdd(&counters[COLLISIONS_HIGH], 1u);
    }
    settle_pair(mine.pair, k);
}
