//! uses: grid.wgsl

// Where a particle is in the middle of the step if nothing happens to it, as `bin` has it with rounds of pairs.
fn midpoint_of(position: vec3<u32>, velocity: vec3<f32>) -> vec3<u32> {
    return shifted(position, velocity, 0.5 * step.dt);
}
