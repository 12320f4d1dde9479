// What a step leaves for the kernels behind it, each of whose threads reads it: other words than the counters, which are counted up meanwhile.

// On a device alone, whose lists had too little room: one more than the place of the step in its interval, after whose search nothing
// changes until the host has made room; and how many particles are in `sorted` then. The host alone clears them.
const HELD: u32 = 0;
const HELD_PARTICLES: u32 = 1;
// The particles that are in cells.
const PRESENT: u32 = 2;
// On a device alone that sorts its particles how many steps the interval has, else 0; from the host. Here, and not in a uniform: where branches
// ask uniforms alone, Mesa's lavapipe of 22.3 makes a kernel for their values, and some kernels (`advect` was one) anew at each dispatch.
const INTERVAL: u32 = 3;
