// A particle's state. Within a step `position` is x0 of x(t) = x0 + v t, valid from its flight's start.

struct Particle {
    position: vec3<u32>,
    // Gas in the top 4 bits, id below.
    tag: u32,
    velocity: vec3<f32>,
    // Internal energy over the reference mass, (m/s)^2.
    spin: f32,
}

// What a particle has gone through in this step.
struct Flight {
    // The time from which x0 + v t holds, s from the start of the step.
    start: f32,
    // Time of its next wall hit, or NEVER.
    wall: f32,
    // Tag of the last partner in this step, or NOBODY.
    partner: u32,
    // Collisions in this step in the lower half; in the upper half see cap.wgsl.
    collisions: u32,
}

const NOBODY: u32 = 0xffffffff;
const NEVER: f32 = 1e30;
const ID_MASK: u32 = 0x0fffffff;

fn id_of(tag: u32) -> u32 {
    return tag & ID_MASK;
}

fn gas_of(tag: u32) -> u32 {
    return tag >> 28u;
}
