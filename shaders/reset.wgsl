//! uses: step.wgsl lists.wgsl emptied.wgsl
//! binds: cell_counts as cell_start
//! phase: bin advect
// Empties the lists, and the cells, whatever is in them: before the first step of an interval, and among other devices before each. The other steps
// begin with what `scan_sums` and `advect` have emptied, and of cells `choose`, `scan_cells` or a clear.
//
// Writes the lengths of the lists in `counters`, all of `dispatches`, `rechoose_dispatches` and `on_demand_dispatches`, and as many words of `cell_start` and
// `stretch_sums` as it has threads for. One thread per list, and per FOURS fours of cells and stretch of cells.

// Fours of cells that a thread empties.
const FOURS: u32 = 4;

var<storage, read_write> cell_start: array<vec4<u32>>;
var<storage, read_write> stretch_sums: array<u32>;
var<storage, read_write> on_demand_dispatches: array<atomic<u32>>;

@compute @workgroup_size(WORKGROUP)
fn reset(thread: Thread) {
    let k = linear(thread);
    let lane = lane_of(thread);
    if (k < LISTS) {
        empty_list(k);
        empty_shards(k);
        atomicStore(&on_demand_dispatches[3u * k], 0u);
        atomicStore(&on_demand_dispatches[3u * k + 1u], 1u);
        atomicStore(&on_demand_dispatches[3u * k + 2u], 1u);
    }
    // Threads that run together write to fours that lie together.
    var four = FOURS * (k - lane) + lane;
    for (var turn = 0u; turn < FOURS; turn++) {
        if (four < arrayLength(&cell_start)) {
            cell_start[four] = vec4<u32>(0u);
        }
        four += WORKGROUP;
    }
    if (k < arrayLength(&stretch_sums)) {
        stretch_sums[k] = 0u;
    }
}
