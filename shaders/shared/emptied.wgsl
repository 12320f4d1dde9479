//! uses: list_parts.wgsl
// Lists as they are before the first entry, for those who empty them.

@group(0) @binding(30) var<storage, read_write> rechoose_dispatches: array<atomic<u32>>;

fn empty_list(list: u32) {
    atomicStore(&counters[list], 0u);
    atomicStore(&dispatches[3u * list], 0u);
    atomicStore(&dispatches[3u * list + 1u], 1u);
    atomicStore(&dispatches[3u * list + 2u], 1u);
    atomicStore(&rechoose_dispatches[3u * list], 0u);
    atomicStore(&rechoose_dispatches[3u * list + 1u], 1u);
    atomicStore(&rechoose_dispatches[3u * list + 2u], 1u);
}
