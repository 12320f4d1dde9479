//! uses: lists.wgsl list_shards.wgsl
// Lists as they are before the first entry, for those who empty them.

var<storage, read_write> rechoose_dispatches: array<atomic<u32>>;

fn empty_list(list: u32) {
    atomicStore(&counters[list], 0u);
    atomicStore(&dispatches[3u * list], 0u);
    atomicStore(&dispatches[3u * list + 1u], 1u);
    atomicStore(&dispatches[3u * list + 2u], 1u);
    atomicStore(&rechoose_dispatches[3u * list], 0u);
    atomicStore(&rechoose_dispatches[3u * list + 1u], 1u);
    atomicStore(&rechoose_dispatches[3u * list + 2u], 1u);
}

// Of those of a step that is done, all but the ones that `bin` and `advect` have to do with: the share of a thread of LISTS.
fn empty_done_list(list: u32) {
    if (list != LIST_BOUNCE && list != LIST_BOUNCE_ODD && list != COUNT_DROPPED) {
        empty_list(list);
    }
    empty_shards(list);
}
