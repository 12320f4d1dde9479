//! uses: step.wgsl lists.wgsl list_shards.wgsl
//! phase: bin advect
// Empties, at the beginning of each step, the lists of the step before with their dispatches, and the sums of stretches of cells. (The cells
// are cleared by `clear_cells`.)
//
// Writes the lengths of the lists in `counters`, all of `dispatches`, `rechoose_dispatches` and `on_demand_dispatches`, and `stretch_sums`. One thread per
// list, and per stretch of cells.

var<storage, read_write> rechoose_dispatches: array<atomic<u32>>;
var<storage, read_write> on_demand_dispatches: array<atomic<u32>>;
var<storage, read_write> stretch_sums: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn reset(thread: Thread) {
    let k = linear(thread);
    if (k < LISTS) {
        atomicStore(&counters[k], 0u);
        empty_shards(k);
        atomicStore(&dispatches[3u * k], 0u);
        atomicStore(&dispatches[3u * k + 1u], 1u);
        atomicStore(&dispatches[3u * k + 2u], 1u);
        atomicStore(&rechoose_dispatches[3u * k], 0u);
        atomicStore(&rechoose_dispatches[3u * k + 1u], 1u);
        atomicStore(&rechoose_dispatches[3u * k + 2u], 1u);
        atomicStore(&on_demand_dispatches[3u * k], 0u);
        atomicStore(&on_demand_dispatches[3u * k + 1u], 1u);
        atomicStore(&on_demand_dispatches[3u * k + 2u], 1u);
    }
    if (k < arrayLength(&stretch_sums)) {
        stretch_sums[k] = 0u;
    }
}
