//! uses: step.wgsl
// Scan, part 3: where each cell's particles start, in place of how many they are.
//
// Reads `chunk_sums`; reads counts and writes starts in `cell_start`, by fours, up to the one with the cell behind the last. One
// thread per chunk. Where a vessel is thin in its box, or gas only here and there, most chunks have no particle: of these no
// count is read.

override CHUNK: u32;

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(7) var<storage, read> chunk_sums: array<u32>;
@group(0) @binding(8) var<storage, read_write> cell_start: array<vec4<u32>>;

@compute @workgroup_size(WORKGROUP)
fn scan_cells(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let chunk = linear(id, groups);
    let begin = chunk * (CHUNK / 4u);
    let fours = step.bins / 4u + 1u;
    if (begin >= fours) {
        return;
    }
    let end = min(begin + CHUNK / 4u, fours);
    var before = chunk_sums[chunk];
    var four = begin;
    let filled = select(end, begin, chunk_sums[chunk + 1u] == before);
    for (; four < filled; four++) {
        let own = cell_start[four];
        let two = own.x + own.y;
        let three = two + own.z;
        cell_start[four] = before + vec4<u32>(0u, own.x, two, three);
        before += three + own.w;
    }
    for (; four < end; four++) {
        cell_start[four] = vec4<u32>(before);
    }
}
