//! uses: particle.wgsl
// What particles that fly are read from and written to.

override ROUNDS_OF_PAIRS: bool = true;
override VENTS: bool = true;

var<storage, read_write> particles: array<Packed>;
var<storage, read> sorted: array<Packed>;
var<storage, read> stalled: array<u32>;
var<storage, read> step_state: array<u32>;
