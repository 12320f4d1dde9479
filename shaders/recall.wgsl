//! uses: step.wgsl particle.wgsl newborn.wgsl
//! phase: lists
// Puts the particles back as they were before a step that was stalled after its search (STALLED), on a device alone.
//
// Reads `sorted`; writes `particles`, where those that entered in this step leave dead slots: they enter again. One thread per
// particle, which writes its own slot.

var<uniform> step: Step;
var<storage, read_write> particles: array<Packed>;
var<storage, read> sorted: array<Packed>;

@compute @workgroup_size(WORKGROUP)
fn recall(thread: Thread) {
    let k = linear(thread);
    if (k >= step.total) {
        return;
    }
    var particle = sorted[k];
    if (is_newborn(id_of(particle.position_tag.w))) {
        particle.position_tag.w = NOBODY;
    }
    particles[k] = particle;
}
