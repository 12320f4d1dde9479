//! uses: step.wgsl counters.wgsl lists.wgsl
// Empties the lists of the step before. On a device that is held (counters.wgsl) this and all later steps of the interval have nobody: their
// parameters are zero.
//
// Writes the first LISTS words of `counters` and all of `dispatches`, `rechoose_dispatches` and `asked_dispatches`; of a device
// that is held `step_words`, the parameters of all steps. One thread per list.

@group(0) @binding(30) var<storage, read_write> rechoose_dispatches: array<atomic<u32>>;
@group(0) @binding(43) var<storage, read_write> asked_dispatches: array<atomic<u32>>;
@group(0) @binding(59) var<storage, read_write> step_words: array<u32>;

@compute @workgroup_size(LISTS)
fn reset(@builtin(local_invocation_index) list: u32) {
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
