//! uses: step.wgsl
// Scan of many cells, in place of part 2: sums of stretches of as many chunks as a chunk has cells.
//
// Reads `chunk_sums`; writes `stretch_sums`. One thread per stretch.

override CHUNK: u32;

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(7) var<storage, read> chunk_sums: array<u32>;
@group(0) @binding(29) var<storage, read_write> stretch_sums: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn sum_stretches(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let stretch = linear(id, groups);
    let chunks = step.bins / CHUNK + 1u;
    let begin = stretch * CHUNK;
    if (begin >= chunks) {
        return;
    }
    let end = min(begin + CHUNK, chunks);
    var sum = 0u;
    for (var k = begin; k < end; k++) {
        sum += chunk_sums[k];
    }
    stretch_sums[stretch] = sum;
}
