//! uses: step.wgsl lists.wgsl emptied.wgsl stretches.wgsl emptying.wgsl
//! binds: cell_counts as cell_start
//! phase: scan
// Scan, part 1: how many particles each chunk of cells has, and each stretch; and on a device alone empties the lists of the step before.
//
// Reads the counts in `cell_start`, the buffer that `bin` counts in, by fours; writes `chunk_sums`, and adds to `stretch_sums` (zero before). One thread per chunk. The cell
// behind the last, and those up to a whole chunk, are counted as ones without particles. Of the lists those are left that `bin` and `advect` have to do with.

var<uniform> step: Step;
var<storage, read_write> chunk_sums: array<u32>;
var<storage, read> cell_start: array<vec4<u32>>;
var<storage, read_write> stretch_sums: array<atomic<u32>>;

@compute @workgroup_size(WORKGROUP)
fn scan_sums(thread: Thread) {
    let chunk = linear(thread);
    if (step.peers == 0u && chunk < LISTS) {
        empty_done_list(chunk);
        // The first of `choose` has at least so many threads, which empty the cells: 64 of them each.
        if (chunk == LIST_RECHOOSE && choose_empties()) {
            atomicStore(&rechoose_dispatches[3u * chunk], min(step.bins / (CHUNK * WORKGROUP) + 1u, GROUP_LIMIT));
        }
    }
    if (chunk > step.bins / CHUNK) {
        return;
    }
    let begin = chunk * (CHUNK / 4u);
    var sum = vec4<u32>(0u);
    // Eight reads a turn: a GPU waits for each turn's.
    for (var four = begin; four < begin + CHUNK / 4u; four += 8u) {
        sum += cell_start[four] + cell_start[four + 1u] + cell_start[four + 2u] + cell_start[four + 3u];
        sum += cell_start[four + 4u] + cell_start[four + 5u] + cell_start[four + 6u] + cell_start[four + 7u];
    }
    let all = sum.x + sum.y + sum.z + sum.w;
    chunk_sums[chunk] = all;
    if (all > 0u) {
        atomicAdd(&stretch_sums[chunk / WORKGROUP], all);
    }
}
