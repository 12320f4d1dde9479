//! uses: step.wgsl stretches.wgsl
//! phase: advect
// Clears the cells, where nobody asks any more where their particles start: the step that follows counts its particles there.
//
// Writes `cell_start`, by fours, up to a whole chunk. One thread per four fours; none writes what another does.

var<uniform> step: Step;
var<storage, read_write> cell_start: array<vec4<u32>>;

@compute @workgroup_size(WORKGROUP)
fn clear_cells(thread: Thread) {
    let fours = (step.bins / CHUNK + 1u) * (CHUNK / 4u);
    // Threads that run together write to fours that lie together.
    // bench: cleared
    for (var four = linear(thread); four < fours; four += groups_of(thread) * WORKGROUP) {
        cell_start[four] = vec4<u32>(0u);
    }
}
