//! uses: particle.wgsl
// What particles that fly are read from and written to.

override ROUNDS_OF_PAIRS: bool = true;
override VENTS: bool = true;

@group(0) @binding(2) var<storage, read_write> particles: array<Packed>;
@group(0) @binding(10) var<storage, read> sorted: array<Packed>;
@group(0) @binding(65) var<storage, read> held: array<u32>;
