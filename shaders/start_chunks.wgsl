//! uses: step.wgsl
// Scan of many cells: the sums of the chunks become their exclusive prefix sums, and the sum of all stands behind them.
//
// Reads `stretch_sums`; reads and writes `chunk_sums`. One thread per stretch.

override CHUNK: u32;

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(7) var<storage, read_write> chunk_sums: array<u32>;
@group(0) @binding(29) var<storage, read> stretch_sums: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn start_chunks(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let stretch = linear(id, groups);
    let chunks = step.bins / CHUNK + 1u;
    let begin = stretch * CHUNK;
    if (begin >= chunks) {
        return;
    }
    let end = min(begin + CHUNK, chunks);
    var before = stretch_sums[stretch];
    for (var k = begin; k < end; k++) {
        let own = chunk_sums[k];
        chunk_sums[k] = before;
        before += own;
    }
    if (end == chunks) {
        chunk_sums[chunks] = before;
    }
}
