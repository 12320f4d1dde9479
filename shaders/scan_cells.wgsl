//! uses: step.wgsl stretches.wgsl starts.wgsl
//! phase: scan
// Scan, part 3: where each cell's particles start, in place of how many they are.
//
// Reads `chunk_sums` and `stretch_sums`, of few stretches the sums themselves, of more what `scan_stretches` made of them; reads counts and writes
// starts in `cell_start`, by fours, up to a whole chunk; writes PRESENT. One thread per chunk. Where a vessel is thin in its box, or gas only here and there, most chunks
// have no particle: of these no count is read, but where threads do their chunks together (starts.gpu.wgsl).

var<uniform> step: Step;
var<storage, read_write> step_state: array<u32>;
var<storage, read> chunk_sums: array<vec4<u32>>;
var<storage, read_write> cell_start: array<vec4<u32>>;
var<storage, read> stretch_sums: array<vec4<u32>>;

const FOUR: vec4<u32> = vec4<u32>(0u, 1u, 2u, 3u);

@compute @workgroup_size(WORKGROUP)
fn scan_cells(thread: Thread) {
    let chunk = linear(thread);
    if (chunk > step.bins / CHUNK) {
        return;
    }
    // Of the stretches before its own, by fours; of many it is known.
    let stretch = chunk / WORKGROUP;
    let stretch_sum = stretch_sums[stretch / 4u];
    var before = stretch_sum[stretch % 4u];
    if (few_stretches()) {
        var earlier = select(vec4<u32>(0u), stretch_sum, FOUR < vec4<u32>(stretch % 4u));
        // bench: stretches before
        for (var four = 0u; four < stretch / 4u; four++) {
            earlier += stretch_sums[four];
        }
        before = earlier.x + earlier.y + earlier.z + earlier.w;
    }
    // Of the chunks before it in its stretch, by fours.
    let last = chunk / 4u;
    var sum = vec4<u32>(0u);
    // bench: chunks before
    for (var four = stretch * (WORKGROUP / 4u); four < last; four += 4u) {
        sum += chunk_sums[four];
        sum += select(vec4<u32>(0u), chunk_sums[four + 1u], four + 1u < last);
        sum += select(vec4<u32>(0u), chunk_sums[four + 2u], four + 2u < last);
        sum += select(vec4<u32>(0u), chunk_sums[four + 3u], four + 3u < last);
    }
    let among = chunk_sums[last];
    sum += select(vec4<u32>(0u), among, FOUR < vec4<u32>(chunk % 4u));
    before += sum.x + sum.y + sum.z + sum.w;
    let own = among[chunk % 4u];
    if (chunk == step.bins / CHUNK) {
        step_state[PRESENT] = before + own;
    }
    write_starts(thread, chunk, before, own);
}
