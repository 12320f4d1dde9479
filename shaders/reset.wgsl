//! uses: step.wgsl counters.wgsl lists.wgsl
// Empties the lists of the step before, and the cells. On a device that is held (counters.wgsl) this and all later steps of the interval have
// nobody: their parameters are zero.
//
// Writes the first LISTS words of `counters`, all of `dispatches`, `rechoose_dispatches` and `asked_dispatches`, and as many words of `cell_start` and
// `stretch_sums` as it has threads for; of a device that is held `step_words`, the parameters of all steps. One thread per list, and per
// FOURS fours of cells and stretch of cells.

// Fours of cells that a thread empties.
const FOURS: u32 = 4;

@group(0) @binding(8) var<storage, read_write> cell_start: array<vec4<u32>>;
@group(0) @binding(29) var<storage, read_write> stretch_sums: array<u32>;
@group(0) @binding(30) var<storage, read_write> rechoose_dispatches: array<atomic<u32>>;
@group(0) @binding(43) var<storage, read_write> asked_dispatches: array<atomic<u32>>;
@group(0) @binding(59) var<storage, read_write> step_words: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn reset(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let thread = linear(id, groups);
    if (thread < LISTS) {
        empty_list(thread);
    }
    // Threads that run together write to fours that lie together.
    var four = FOURS * (thread - lane) + lane;
    for (var k = 0u; k < FOURS; k++) {
        if (four < arrayLength(&cell_start)) {
            cell_start[four] = vec4<u32>(0u);
        }
        four += WORKGROUP;
    }
    if (thread < arrayLength(&stretch_sums)) {
        stretch_sums[thread] = 0u;
    }
}

fn empty_list(list: u32) {
    atomicStore(&counters[list], 0u);
    atomicStore(&dispatches[3u * list], 0u);
    atomicStore(&dispatches[3u * list + 1u], 1u);
    atomicStore(&dispatches[3u * list + 2u], 1u);
    atomicStore(&rechoose_dispatches[3u * list], 0u);
    atomicStore(&rechoose_dispatches[3u * list + 1u], 1u);
    atomicStore(&rechoose_dispatches[3u * list + 2u], 1u);
    atomicStore(&asked_dispatches[3u * list], 0u);
    atomicStore(&asked_dispatches[3u * list + 1u], 1u);
    atomicStore(&asked_dispatches[3u * list + 2u], 1u);
    if (atomicLoad(&counters[HELD]) > 0u) {
        for (var word = list; word < arrayLength(&step_words); word += LISTS) {
            step_words[word] = 0u;
        }
    }
}
