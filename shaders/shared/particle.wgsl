// A particle's state. Within a step `position` is x0 of x(t) = x0 + v t, valid from its flight's start.

struct Particle {
    position: vec3<u32>,
    // Gas in the top 4 bits, below it a bit that is set inside of closed fabric, the id below.
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

// The same bytes in as few reads and writes as there are: position and tag; velocity and spin.
struct Packed {
    position_tag: vec4<u32>,
    motion: vec4<f32>,
}

fn particle_of(whole: Packed) -> Particle {
    return Particle(whole.position_tag.xyz, whole.position_tag.w, whole.motion.xyz, whole.motion.w);
}

fn packed_of(particle: Particle) -> Packed {
    return Packed(vec4<u32>(particle.position, particle.tag), vec4<f32>(particle.velocity, particle.spin));
}

// And a flight in one.
fn flight_of(whole: vec4<u32>) -> Flight {
    return Flight(bitcast<f32>(whole.x), bitcast<f32>(whole.y), whole.z, whole.w);
}

fn packed_flight(flight: Flight) -> vec4<u32> {
    return vec4<u32>(bitcast<u32>(flight.start), bitcast<u32>(flight.wall), flight.partner, flight.collisions);
}

const NOBODY: u32 = 0xffffffff;
const NEVER: f32 = 1e30;
const ID_MASK: u32 = 0x07ffffff;
const INSIDE: u32 = 0x08000000;

fn id_of(tag: u32) -> u32 {
    return tag & ID_MASK;
}

// Whether it is inside of closed fabric.
fn is_inside(tag: u32) -> bool {
    return (tag & INSIDE) != 0u;
}

fn gas_of(tag: u32) -> u32 {
    return tag >> 28u;
}
