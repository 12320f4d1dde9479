//! uses: step.wgsl particle.wgsl lists.wgsl sendings.wgsl
//! phase: exchange
// Exchange, part 3: each particle to its place in the message to its peer.
//
// Reads `sendings`, `peer_starts`, `particles`; writes `outbox`. One thread per sending that found room.

var<uniform> step: Step;
var<storage, read> particles: array<Particle>;
var<storage, read_write> outbox: array<Particle>;
var<storage, read> peer_starts: array<u32>;

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
