//! uses: step.wgsl
// Scan, part 1: sums of the counts of each chunk of cells.
//
// Reads the counts in `cell_start`; writes `chunk_sums`. One thread per chunk: few barriers, and sums of integers do
// not depend on order.

override CHUNK: u32;

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(7) var<storage, read_write> chunk_sums: array<u32>;
@group(0) @binding(8) var<storage, read> cell_start: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn scan_sums(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let chunk = linear(id, groups);
    if (chunk * CHUNK >= step.bins) {
        return;
    }
    let begin = chunk * CHUNK;
    let end = min(begin + CHUNK, step.bins);
    var sum = 0u;
    for (var cell = begin; cell < end; cell++) {
        sum += cell_start[cell];
    }
    chunk_sums[chunk] = sum;
}
