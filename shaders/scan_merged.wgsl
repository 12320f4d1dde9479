//! uses: step.wgsl workgroup_sums.wgsl stretches.wgsl starts_of_chunk.wgsl
//! phase: scan
// Scan in one, of few cells (merged.wgsl): where each cell's particles start, in place of how many they are.
//
// Reads counts and writes starts as `scan_cells` does; writes PRESENT. One workgroup; each thread takes one contiguous share, by fours.

var<uniform> step: Step;
var<storage, read_write> step_state: array<u32>;
var<storage, read_write> cell_start: array<vec4<u32>>;

@compute @workgroup_size(SCAN_THREADS)
fn scan_merged(@builtin(local_invocation_index) thread: u32) {
    // A whole chunk has the cell behind the last, and chunks are whole eights of fours.
    let eights = (step.bins / CHUNK + 1u) * (CHUNK / 32u);
    let share = (eights + SCAN_THREADS - 1u) / SCAN_THREADS;
    let begin = 8u * min(thread * share, eights);
    let end = 8u * min((thread + 1u) * share, eights);
    // Eight reads a turn: a GPU waits for each turn's.
    var sum = vec4<u32>(0u);
    // bench: counted
    for (var four = begin; four < end; four += 8u) {
        sum += cell_start[four] + cell_start[four + 1u] + cell_start[four + 2u] + cell_start[four + 3u];
        sum += cell_start[four + 4u] + cell_start[four + 5u] + cell_start[four + 6u] + cell_start[four + 7u];
    }
    workgroup_sums[thread] = sum.x + sum.y + sum.z + sum.w;
    workgroupBarrier();
    let before = sums_before(thread);
    if (thread == SCAN_THREADS - 1u) {
        step_state[PRESENT] = before + workgroup_sums[thread];
    }
    write_starts_of_fours(begin, end, before);
}
