//! uses: step.wgsl lists.wgsl bounced.wgsl
// Flies the particles that meet walls to the end of the step (bounced.wgsl).
//
// Reads `bouncing`, and what such a flight wants; writes what it changes. One thread per entry of `bouncing`, which writes its own particle;
// random numbers are keyed on (step, hit, id), and sums of integers do not depend on order.

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(26) var<storage, read> bouncing: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn bounce(thread: Thread) {
    let entry = linear(thread);
    if (entry >= atomicLoad(&counters[bounces_of(step.slot)])) {
        return;
    }
    bounce_off(bouncing[entry], entry);
}
