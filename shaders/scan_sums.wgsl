//! uses: step.wgsl stretches.wgsl
//! phase: scan
// Scan, part 1: how many particles each chunk of cells has, and each stretch.
//
// Reads `cell_counts`, by fours; writes `chunk_sums`, and adds to `stretch_sums` (zero before). One thread per chunk. The cell
// behind the last, and those up to a whole chunk, are counted as ones without particles.

var<uniform> step: Step;
var<storage, read_write> chunk_sums: array<u32>;
var<storage, read> cell_counts: array<vec4<u32>>;
var<storage, read_write> stretch_sums: array<atomic<u32>>;

@compute @workgroup_size(WORKGROUP)
fn scan_sums(thread: Thread) {
    let chunk = linear(thread);
    if (chunk > step.bins / CHUNK) {
        return;
    }
    let begin = chunk * (CHUNK / 4u);
    var sum = vec4<u32>(0u);
    // Eight reads a turn: a GPU waits for each turn's.
    // bench: counted
    for (var four = begin; four < begin + CHUNK / 4u; four += 8u) {
        sum += cell_counts[four] + cell_counts[four + 1u] + cell_counts[four + 2u] + cell_counts[four + 3u];
        sum += cell_counts[four + 4u] + cell_counts[four + 5u] + cell_counts[four + 6u] + cell_counts[four + 7u];
    }
    let all = sum.x + sum.y + sum.z + sum.w;
    chunk_sums[chunk] = all;
    if (all > 0u) {
        atomicAdd(&stretch_sums[chunk / WORKGROUP], all);
    }
}
