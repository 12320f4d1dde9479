//! uses: step.wgsl grid.wgsl midpoint.wgsl local.wgsl particle.wgsl lists.wgsl update.wgsl coarse.wgsl cap.wgsl nearness.wgsl halo.wgsl sendings.wgsl
//! binds: rechoose_dispatches as dispatches
//! phase: exchange
// Exchange, part 1: which particles go to which devices: to every one that owns their cell or needs them as ghosts.
//
// Reads `border`, `particles`, `peers`, `cross_section_shares`; appends to `sendings` (and counts beyond the
// buffer's end: the host then makes it larger and packs again) and adds to `peer_counts`. One thread per entry of
// `border`. The order of what is sent depends on the order of the threads; the receiver sorts.

var<uniform> step: Step;
var<storage, read> particles: array<Particle>;
var<storage, read> border: array<vec2<u32>>;
var<storage, read_write> peer_counts: array<atomic<u32>>;

@compute @workgroup_size(WORKGROUP)
fn pack(thread: Thread) {
    let entry = linear(thread);
    if (entry >= atomicLoad(&counters[LIST_BORDER])) {
        return;
    }
    let cell = global_cell(border[entry].y);
    // Boxes of tiles are those of the lattice that begins with the grid.
    let place = vec3<i32>(cell - shift_of(step.lattice));
    let index = border[entry].x;
    let particle = particles[index];
    let midpoint = packed(midpoint_of(particle.position, particle.velocity));
    var reach = 0;
    if (step.depth > 0u) {
        // With room to spare: whoever is brought up to date later has been sent here.
        reach = chain_reach(cell, step.depth) + 2;
    }
    var owned = in_box(cell, step.own_low, step.own_high);
    for (var p = 0u; p < step.peers; p++) {
        if (owns(peers[p], place, i32(step.depth))) {
            let own = owns(peers[p], place, 0);
            owned = owned || own;
            if (!own && from_box2(midpoint, cell, peers[p].low, peers[p].high) >= reach * reach) {
                continue;
            }
            let k = append(LIST_OUTBOX);
            if (k < arrayLength(&sendings)) {
                sendings[k] = Sending(index, p, atomicAdd(&peer_counts[p], 1u));
            }
        }
    }
    // Who is farther away than particles are thought to fly may be needed as a ghost by one that is no peer.
    if (!owned || (step.flight > 0u && layer_of(cell) > step.flight)) {
        atomicAdd(&counters[STRAYS], 1u);
    }
}
