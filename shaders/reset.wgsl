//! uses: step.wgsl lists.wgsl
// Empties the lists of the step before.
//
// Writes the first LISTS words of `counters` and all of `dispatches`, `rechoose_dispatches` and `asked_dispatches`.
// One thread per list.

@group(0) @binding(30) var<storage, read_write> rechoose_dispatches: array<atomic<u32>>;
@group(0) @binding(43) var<storage, read_write> asked_dispatches: array<atomic<u32>>;

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
}
