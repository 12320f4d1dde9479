//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl counters.wgsl lists.wgsl update.wgsl coarse.wgsl cap.wgsl nearness.wgsl halo.wgsl
// Exchange, part 1: particles to every device that owns their cell or needs them as ghosts.
//
// Reads `border`, `particles`, `peers`, `shares`; writes `outbox` and `outbox_peer` and counts them (also beyond the
// buffers' end: the host then makes them larger and packs again). One thread per entry of `border`. The
// order of what is sent depends on the order of the threads; the receiver sorts.

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(2) var<storage, read> particles: array<Particle>;
@group(0) @binding(33) var<storage, read> border: array<vec2<u32>>;
@group(0) @binding(35) var<storage, read_write> outbox: array<Particle>;
@group(0) @binding(36) var<storage, read_write> outbox_peer: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn pack(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let entry = linear(id, groups);
    if (entry >= atomicLoad(&counters[LIST_BORDER])) {
        return;
    }
    let cell = global_cell(border[entry].y);
    let place = vec3<i32>(cell);
    let particle = particles[border[entry].x];
    let middle = packed(shifted(particle.position, particle.velocity * (0.5 * step.dt)));
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
            if (!own && from_box2(middle, cell, peers[p].low, peers[p].high) >= reach * reach) {
                continue;
            }
            let k = atomicAdd(&counters[COUNT_OUTBOX], 1u);
            if (k < arrayLength(&outbox_peer)) {
                outbox[k] = particle;
                outbox_peer[k] = p;
            }
        }
    }
    if (!owned) {
        atomicAdd(&counters[STRAYS], 1u);
    }
}
