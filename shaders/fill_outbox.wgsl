//! uses: step.wgsl particle.wgsl lists.wgsl sendings.wgsl
// Exchange, part 3: each particle to its place in the message to its peer.
//
// Reads `sendings`, `peer_starts`, `particles`; writes `outbox`. One thread per sending that found room.

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(2) var<storage, read> particles: array<Particle>;
@group(0) @binding(35) var<storage, read_write> outbox: array<Particle>;
@group(0) @binding(57) var<storage, read> peer_starts: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn fill_outbox(thread: Thread) {
    let k = linear(thread);
    if (k >= min(atomicLoad(&counters[LIST_OUTBOX]), arrayLength(&sendings))) {
        return;
    }
    let place = peer_starts[sendings[k].peer] + sendings[k].place;
    if (place < arrayLength(&outbox)) {
        outbox[place] = particles[sendings[k].index];
    }
}
