//! uses: step.wgsl lists.wgsl advected.wgsl bounced.wgsl
//! phase: advect
// All flights in one, of few particles (merged.wgsl): what `advect` does, and at once, in place of the list between, what `bounce` does.
//
// Reads and writes what these do, but for `bouncing`. One thread per particle, which writes its own slot, and for what else `advect` has threads; sums are of integers, so order does not matter.

var<uniform> step: Step;

fn meet_walls(s: u32) {
    bounce_off(s, s);
}

@compute @workgroup_size(WORKGROUP)
fn fly(thread: Thread) {
    advect_slot(linear(thread));
}
