//! uses: step.wgsl
// Scan, part 3: where each cell's particles start, in place of how many they are.
//
// Reads `chunk_sums`; reads counts and writes starts in `cell_start` (one more than there are cells). One thread per chunk. Where
// a vessel is thin in its box, or gas only here and there, most chunks have no particle: of these no count is read.

override CHUNK: u32;

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(7) var<storage, read> chunk_sums: array<u32>;
@group(0) @binding(8) var<storage, read_write> cell_start: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn scan_cells(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let chunk = linear(id, groups);
    if (chunk * CHUNK >= step.bins) {
        return;
    }
    let begin = chunk * CHUNK;
    let end = min(begin + CHUNK, step.bins);
    var before = chunk_sums[chunk];
    var cell = begin;
    let filled = select(end, begin, chunk_sums[chunk + 1u] == before);
    for (; cell < filled; cell++) {
        let own = cell_start[cell];
        cell_start[cell] = before;
        before += own;
    }
    for (; cell < end; cell++) {
        cell_start[cell] = before;
    }
    if (begin < end && end == step.bins) {
        cell_start[end] = before;
    }
}
