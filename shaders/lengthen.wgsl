//! uses: step.wgsl lists.wgsl counters.wgsl asked.wgsl search.wgsl
// The neighbour lists that are longer than DIRECT: each is searched once more, with a tail.
//
// Reads what the search does; reads and writes `neighbour_count`; writes `neighbours` and `counters`. One thread per entry of `long_lists`. Where a tail
// is, is a matter of the order of the threads; what is in it is not. If there is no room for all, the list keeps what it
// has, and the room that was wanted is kept for the host. A device alone is held (counters.wgsl): it leaves `sorted` as it is, from which the
// host goes on with more room. Among others, of whom one alone may be short of room, the interval is run again.

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(58) var<storage, read_write> long_lists: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn lengthen(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let late = HALO && step.ghosts == GHOSTS_ASKED;
    let stride = arrayLength(&neighbour_count);
    let entry = linear(id, groups);
    if (entry >= atomicLoad(&counters[select(LIST_LONG, LIST_LONG_LATE, late)])) {
        return;
    }
    let place = entry + select(0u, stride, late);
    let s = long_lists[place];
    if (s == NOBODY) {
        return;
    }
    // A pass over those that were asked later finds it done.
    long_lists[place] = NOBODY;
    let more = atomicLoad(&neighbour_count[s]) - (DIRECT - 1u);
    let begin = atomicAdd(&counters[LIST_TAILS], more);
    if (begin + more > arrayLength(&neighbours) - RECORD * stride) {
        atomicMax(&counters[TAILS_WANTED], begin + more);
        if (!HALO) {
            atomicStore(&counters[HELD], step.slot + 1u);
            atomicStore(&counters[HELD_PARTICLES], cell_start[step.bins]);
        }
        atomicStore(&neighbour_count[s], DIRECT);
        return;
    }
    let tail = RECORD * stride + begin - (DIRECT - 1u);
    _ = search(s, DIRECT - 1u, tail);
    tell_cut_short();
    neighbours[direct_entry(s, DIRECT - 1u)] = tail;
}
