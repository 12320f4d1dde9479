//! uses: step.wgsl shares.wgsl counters.wgsl lists.wgsl emptied.wgsl held.wgsl stretches.wgsl starts_of_chunk.wgsl
// Scan in one, of few cells (merged.wgsl): where each cell's particles start, in place of how many they are; and on a device alone empties the lists of
// the step before.
//
// Reads counts and writes starts as `scan_cells` does; writes PRESENT. One workgroup; each thread takes one contiguous share, by fours.

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(65) var<storage, read_write> held: array<u32>;
@group(0) @binding(8) var<storage, read_write> cell_start: array<vec4<u32>>;
@group(0) @binding(66) var<storage, read_write> cell_counts: array<vec4<u32>>;

// Of a four at `four`, none from `end` on.
fn counts_before(four: u32, end: u32) -> vec4<u32> {
    return select(vec4<u32>(0u), counts_of(min(four, end - 1u)), four < end);
}

@compute @workgroup_size(SCAN_THREADS)
fn scan_merged(@builtin(local_invocation_index) thread: u32) {
    if (step.peers == 0u && thread < LISTS) {
        empty_done_list(thread);
    }
    // A whole chunk has the cell behind the last.
    let fours = (step.bins / CHUNK + 1u) * (CHUNK / 4u);
    let share = (fours + SCAN_THREADS - 1u) / SCAN_THREADS;
    let begin = min(thread * share, fours);
    let end = min(begin + share, fours);
    // Eight reads a turn: a GPU waits for each turn's.
    var sum = vec4<u32>(0u);
    for (var four = begin; four < end; four += 8u) {
        sum += counts_before(four, end) + counts_before(four + 1u, end) + counts_before(four + 2u, end) + counts_before(four + 3u, end);
        sum += counts_before(four + 4u, end) + counts_before(four + 5u, end) + counts_before(four + 6u, end) + counts_before(four + 7u, end);
    }
    shares[thread] = sum.x + sum.y + sum.z + sum.w;
    workgroupBarrier();
    var before = shares_before(thread);
    if (thread == SCAN_THREADS - 1u) {
        held[PRESENT] = before + shares[thread];
    }
    for (var four = begin; four < end; four += 4u) {
        // (All are read before any is written.)
        let counts0 = counts_before(four, end);
        let counts1 = counts_before(four + 1u, end);
        let counts2 = counts_before(four + 2u, end);
        let counts3 = counts_before(four + 3u, end);
        let starts0 = starts_of(counts0, before);
        let starts1 = starts_of(counts1, starts0.next);
        let starts2 = starts_of(counts2, starts1.next);
        let starts3 = starts_of(counts3, starts2.next);
        put_starts(four, starts0.starts);
        if (four + 1u < end) {
            put_starts(four + 1u, starts1.starts);
        }
        if (four + 2u < end) {
            put_starts(four + 2u, starts2.starts);
        }
        if (four + 3u < end) {
            put_starts(four + 3u, starts3.starts);
        }
        before = starts3.next;
    }
}
