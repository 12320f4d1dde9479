//! uses: step.wgsl
// Scan, part 1: sums of the counts of each chunk of cells.
//
// Reads the counts in `cell_start`, by fours; writes `chunk_sums`. One thread per chunk: few barriers, and sums of integers do
// not depend on order. The cell behind the last is counted as one without particles, up to a whole four.

override CHUNK: u32;

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(7) var<storage, read_write> chunk_sums: array<u32>;
@group(0) @binding(8) var<storage, read> cell_start: array<vec4<u32>>;

@compute @workgroup_size(WORKGROUP)
fn scan_sums(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let chunk = linear(id, groups);
    let begin = chunk * (CHUNK / 4u);
    let fours = step.bins / 4u + 1u;
    if (begin >= fours) {
        return;
    }
    let end = min(begin + CHUNK / 4u, fours);
    var sum = vec4<u32>(0u);
    for (var four = begin; four < end; four++) {
        sum += cell_start[four];
    }
    chunk_sums[chunk] = sum.x + sum.y + sum.z + sum.w;
}
