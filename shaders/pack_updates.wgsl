//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl lists.wgsl update.wgsl coarse.wgsl cap.wgsl nearness.wgsl halo.wgsl sendings.wgsl
//! phase: update
// Update, part 1: the particles that the rounds since the last exchange have changed, to every device
// that needs them as ghosts. (It may have others near its border, as newborns or as its own of the step before: no chain
// leads to those, so what becomes of them changes nothing.)
//
// Reads `changed`, `cells`, `midpoints`, `peers`, `cross_section_shares`; appends to `sendings` (and counts beyond the
// buffer's end: the host then makes it larger and packs again), adds to `peer_counts` and clears the mark in `marks`.
// One thread per entry of `changed`. The receiver finds the ghost by cell and id, so order does not matter.

var<uniform> step: Step;
var<storage, read> midpoints: array<u32>;
var<storage, read> cells: array<u32>;
var<storage, read_write> marks: array<u32>;
var<storage, read> changed: array<u32>;
var<storage, read_write> peer_counts: array<atomic<u32>>;

@compute @workgroup_size(WORKGROUP)
fn pack_updates(thread: Thread) {
    let entry = linear(thread);
    if (entry >= atomicLoad(&counters[LIST_CHANGED])) {
        return;
    }
    let s = changed[entry];
    marks[s] &= ~LISTED;
    let cell = cell_of(cells[s]);
    let reach = chain_reach(cell, step.depth);
    for (var p = 0u; p < step.near_peers; p++) {
        if (owns(peers[p], vec3<i32>(cell), i32(step.depth))
            && from_box2(midpoints[s], cell, peers[p].low, peers[p].high) < reach * reach) {
            let k = append(LIST_UPDATES);
            if (k < arrayLength(&sendings)) {
                sendings[k] = Sending(s, p, atomicAdd(&peer_counts[p], 1u));
            }
        }
    }
}
