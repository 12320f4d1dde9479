// Lists of rare work: a kernel that meets it appends, and one that does it is dispatched over exactly
// the list. (On a device that executes untaken branches under a mask, rare heavy branches would cost
// every thread.) The order of a list depends on the order of the threads; entries are independent.
// Their numbers are in src/subdomain/registry.rs.

// Workgroups per dimension of an indirect dispatch.
const GROUP_LIMIT: u32 = 65535;

var<storage, read_write> counters: array<atomic<u32>>;
var<storage, read_write> dispatches: array<atomic<u32>>;

// (A kernel dispatched over one list may append to another, so `settle`, which is dispatched over pairs, `pack`, over
// the border, and `order`, `neighbours` and `receive`, whose lists are dispatched like those that choose, are given the buffer `rechoose_dispatches` by this name, and `choose` the buffer `on_demand_dispatches`.)
//
// Makes sure that a list's dispatch has this workgroup.
fn cover(list: u32, group: u32) {
    atomicMax(&dispatches[3u * list], min(group + 1u, GROUP_LIMIT));
    atomicMax(&dispatches[3u * list + 1u], group / GROUP_LIMIT + 1u);
}

// The place of a new entry, which the list's dispatch covers.
fn append(list: u32) -> u32 {
    let k = atomicAdd(&counters[list], 1u);
    if (k % WORKGROUP == 0u) {
        cover(list, k / WORKGROUP);
    }
    return k;
}

// The same for a list whose entries have a workgroup each.
fn append_group(list: u32) -> u32 {
    let k = atomicAdd(&counters[list], 1u);
    cover(list, k);
    return k;
}
