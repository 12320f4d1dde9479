// A membrane: nodes on the lattice of positions, and triangles of constant strain between them. A step of the gas has some steps of fabric.

struct MembraneStep {
    // Of the fabric, and of the gas, s.
    dt: f32,
    gas_dt: f32,
    // m, and its inverse.
    quantum: f32,
    quanta: f32,
    // m/s2.
    gravity: vec3<f32>,
    // Of all nodes, 1/s: for shapes at rest.
    drag: f32,
    // Where nodes may be, quanta.
    limit: vec3<u32>,
    nodes: u32,
    elements: u32,
    // Steps of fabric in one of gas.
    substeps: u32,
    // kg m/s.
    impulse_unit: f32,
    // Steps of gas that have velocities of held nodes of their own; the last of them is that of all later ones.
    prescribed_steps: u32,
}

// Which step of the gas in its interval, and which of the fabric in that.
struct Substep {
    slot: u32,
    substep: u32,
}

// A node between two steps: its place is that of the moment, its velocity that of the half step before.
struct MembraneNode {
    // Quanta.
    place: vec3<u32>,
    // Its last step, s; 0 before the first.
    dt: f32,
    // Where it is beside the lattice place, quanta.
    remainder: vec3<f32>,
    pad: f32,
    velocity: vec3<f32>,
    pad2: f32,
    // What a step of fabric takes of what the gas gave, kg m/s.
    given: vec3<f32>,
    pad3: f32,
    // With which the gas saw it fly in its last step, m/s.
    seen: vec3<f32>,
    pad4: f32,
    // Energies, J, and what their sums are too large by.
    work: array<vec2<f32>, 9>,
    pad5: vec2<f32>,
}

struct Element {
    nodes: vec3<u32>,
    elastic: u32,
    // Of the second corner's and the third's share of a place, in the axes of the fibre, 1/m.
    second: vec2<f32>,
    third: vec2<f32>,
    // Minus the squares of its reference's edges from the first corner (second, third) and minus their product, quanta^2.
    second2: vec2<u32>,
    third2: vec2<u32>,
    second_third: vec2<u32>,
    // Of its fabric, m3.
    volume: f32,
    // Of stress by rate of strain, Pa s.
    viscosity: f32,
    // What presses it along its normal, Pa.
    pressure: f32,
    pad: u32,
    pad2: u32,
    pad3: u32,
}

// N. The first corner has minus the sum of those of the others.
struct ElementForces {
    // Of strain: on the second corner; on the third.
    second: vec3<f32>,
    // Its energy of strain, J.
    energy: f32,
    third: vec3<f32>,
    // SLACK, WRINKLED or TAUT.
    state: u32,
    // Of damping.
    damped_second: vec3<f32>,
    // What the change of its reference does on strain, J.
    relaxed: f32,
    damped_third: vec3<f32>,
    pad2: u32,
    // Of pressure, on each corner.
    pressed: vec3<f32>,
    pad3: u32,
}
