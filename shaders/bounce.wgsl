//! uses: step.wgsl lists.wgsl bounced.wgsl
//! phase: advect
// Flies the particles that meet walls to the end of the step (bounced.wgsl).
//
// Reads `bouncing`, and what such a flight wants; writes what it changes. One thread per entry of `bouncing`, which writes its own particle;
// random numbers are keyed on (step, hit, id), and sums of integers do not depend on order.

var<uniform> step: Step;
var<storage, read> bouncing: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn bounce(thread: Thread) {
    let entry = linear(thread);
    if (entry >= atomicLoad(&counters[LIST_BOUNCE])) {
        return;
    }
    bounce_off(bouncing[entry], entry);
}
