//! uses: thread.wgsl membrane.wgsl metric.wgsl
//! phase: membrane
// Moves each node by a step of the fabric: sums the forces of its triangles, takes its share of what the gas gave, and flies on.
//
// Central differences: v' = v + (sum of impulses)/m, x' = x + v' dt. Forces act for half the last step and half this one. The work of each
// impulse J is J.(v + v')/2: together they change the kinetic energy, exactly. What the gas gave in its last step, J in all, was given to nodes that flew at
// `seen`, J.seen in energy; each of the step's `substeps` here takes J/substeps. The ledger has the difference: J.seen less all of J/substeps.(v + v')/2.
// (Where they are smoothed, by J and `seen`: the sum over all nodes of the one smoothed with the other is the same either way.)
//
// Obstacles are rigid convex bodies, each behind all of its faces. A node whose flight would enter one ends on the face that it would enter
// through: that takes an impulse P along its normal, and with it friction takes up to mu P of the slip. One that is in it already comes no deeper
// behind the face that it is nearest to.
//
// Reads `element_forces`, `corners`, `node_constants`, `prescribed`, `obstacles`; reads and writes `membrane_nodes`, takes `given` in the first substep; writes
// `nodes`, where the gas sees them at the start and at the end of its step, and `node_velocities`, with which it sees them fly. One thread per node; its triangles are added in the order of `corners`.

var<uniform> substep: Substep;
var<uniform> membrane_step: MembraneStep;
var<storage, read> element_forces: array<ElementForces>;
// Of each node, one after the other: four times the triangle, and which of its corners.
var<storage, read> corners: array<u32>;
var<storage, read> node_constants: array<NodeConstants>;
// m/s, of nodes that are held, in one step of the gas after the other.
var<storage, read> prescribed: array<vec4<f32>>;
var<storage, read> obstacles: array<Obstacle>;
var<storage, read_write> membrane_nodes: array<MembraneNode>;
var<storage, read> given: array<vec4<f32>>;
var<storage, read_write> nodes: array<vec4<u32>>;
var<storage, read_write> node_velocities: array<vec4<f32>>;
var<storage, read_write> faults: array<atomic<u32>>;

struct NodeConstants {
    // kg.
    mass: f32,
    // 1: it moves with its prescribed velocity.
    held: u32,
    // Its triangles.
    first: u32,
    end: u32,
    // mu on obstacles, beside theirs.
    friction: f32,
}

// A face of a body.
struct Obstacle {
    // One that is on it at the start of the interval, quanta.
    place: vec3<u32>,
    // mu.
    friction: f32,
    // Towards the free side; 0: no face, nor any behind it.
    normal: vec3<f32>,
    pad: f32,
    // The same times 2^22: floats would round the heights of nodes far from the place by some quanta, and their velocities by that over a step.
    whole_normal: vec3<i32>,
    // 1: the last of its body.
    last: u32,
    // m/s.
    velocity: vec3<f32>,
    pad3: f32,
}

// Changes of a velocity, m/s.
struct Stopped {
    pushed: vec3<f32>,
    rubbed: vec3<f32>,
}

// How a flight meets a body, of whose faces some were seen.
struct Meeting {
    // A face that it stays before.
    apart: bool,
    // When it is behind all faces, over its time: from the last that it goes behind to the first that it comes out of.
    enters: f32,
    leaves: f32,
    // The face that it enters through; if it is behind all from the start, the one that it is least behind.
    face: u32,
    // Above that at the start, m.
    height: f32,
}

fn met_nothing() -> Meeting {
    return Meeting(false, -1.0, 2.0, 0u, -1e30);
}

fn met_face(seen: Meeting, face: u32, height: f32, end: f32) -> Meeting {
    var met = seen;
    let fraction = height / (height - end);
    if (height >= 0.0) {
        met.apart = met.apart || end >= 0.0;
        if (end < 0.0 && fraction > met.enters) {
            met.enters = fraction;
            met.face = face;
            met.height = height;
        }
    } else {
        if (end >= 0.0) {
            met.leaves = min(met.leaves, fraction);
        }
        if (met.enters < 0.0 && height > met.height) {
            met.face = face;
            met.height = height;
        }
    }
    return met;
}

fn stopped_by_obstacles(node: MembraneNode, velocity: vec3<f32>, friction: f32) -> Stopped {
    var found = Stopped();
    let time = f32(substep.slot) * membrane_step.gas_dt + f32(substep.substep) * membrane_step.dt;
    var met = met_nothing();
    for (var k = 0u; k < MOST_OBSTACLES; k += 1u) {
        let face = obstacles[k];
        if (all(face.normal == vec3<f32>(0.0))) {
            break;
        }
        let whole = dot64(bitcast<vec3<i32>>(node.place - face.place), face.whole_normal, vec2<u32>(0u));
        let quanta = whole / 4194304.0 + dot(node.remainder, face.normal);
        let height = membrane_step.quantum * quanta - time * dot(face.velocity, face.normal);
        let away = dot(velocity + found.pushed + found.rubbed - face.velocity, face.normal);
        met = met_face(met, k, height, height + away * membrane_step.dt);
        if (face.last == 1u) {
            if (!met.apart && met.enters <= met.leaves) {
                let stop = stopped_by_face(obstacles[met.face], met.height, velocity + found.pushed + found.rubbed, friction);
                found.pushed += stop.pushed;
                found.rubbed += stop.rubbed;
            }
            met = met_nothing();
        }
    }
    return found;
}

fn stopped_by_face(face: Obstacle, height: f32, velocity: vec3<f32>, friction: f32) -> Stopped {
    let relative = velocity - face.velocity;
    let away = dot(relative, face.normal);
    let push = -max(height, 0.0) / membrane_step.dt - away;
    if (push <= 0.0) {
        return Stopped();
    }
    let slip = relative - away * face.normal;
    let speed = length(slip);
    let most = (face.friction + friction) * push;
    let rubbed = select(vec3<f32>(0.0), slip * (min(speed, most) / speed), speed > 0.0);
    return Stopped(push * face.normal, -rubbed);
}

// Kahan's sum.
fn added(sum: vec2<f32>, more: f32) -> vec2<f32> {
    let less = more - sum.y;
    let total = sum.x + less;
    return vec2<f32>(total, (total - sum.x) - less);
}

struct Forces {
    strain: vec3<f32>,
    damping: vec3<f32>,
    pressure: vec3<f32>,
    // J.
    relaxed: f32,
}

fn forces_on(constants: NodeConstants) -> Forces {
    var sum = Forces();
    for (var at = constants.first; at < constants.end; at += 1u) {
        let corner = corners[at];
        let forces = element_forces[corner >> 2u];
        switch (corner & 3u) {
            case 1u: {
                sum.strain += forces.second;
                sum.damping += forces.damped_second;
            }
            case 2u: {
                sum.strain += forces.third;
                sum.damping += forces.damped_third;
            }
            default: {
                sum.strain -= forces.second + forces.third;
                sum.damping -= forces.damped_second + forces.damped_third;
            }
        }
        sum.pressure += forces.pressed;
        sum.relaxed += forces.relaxed / 3.0;
    }
    return sum;
}

@compute @workgroup_size(WORKGROUP)
fn move_nodes(thread: Thread) {
    let k = linear(thread);
    if (k >= membrane_step.nodes) {
        return;
    }
    var node = membrane_nodes[k];
    let constants = node_constants[k];
    let mass = constants.mass;
    let here = substep.slot * membrane_step.nodes + k;
    if (substep.substep == 0u) {
        let whole = given[k].xyz;
        node.given = whole / f32(membrane_step.substeps);
        node.work[WORK_LEDGER] = added(node.work[WORK_LEDGER], dot(whole, node.seen));
        nodes[here] = vec4<u32>(node.place, 0u);
    }

    let kick = 0.5 * (node.dt + membrane_step.dt);
    let forces = forces_on(constants);
    let strain = kick * forces.strain;
    let damping = kick * (forces.damping - (mass * membrane_step.drag) * node.velocity);
    let pressure = kick * forces.pressure;
    let weight = (kick * mass) * membrane_step.gravity;
    let sum = strain + damping + pressure + weight + node.given;
    let row = min(substep.slot, membrane_step.prescribed_steps - 1u);
    var velocity = prescribed[row * membrane_step.nodes + k].xyz;
    var stopped = Stopped();
    if (constants.held == 0u) {
        velocity = node.velocity + sum / mass;
        stopped = stopped_by_obstacles(node, velocity, constants.friction);
        velocity += stopped.pushed + stopped.rubbed;
    }
    let mean = 0.5 * (node.velocity + velocity);
    node.work[WORK_DAMPING] = added(node.work[WORK_DAMPING], dot(damping, mean));
    node.work[WORK_PRESSURE] = added(node.work[WORK_PRESSURE], dot(pressure, mean));
    node.work[WORK_GRAVITY] = added(node.work[WORK_GRAVITY], dot(weight, mean));
    node.work[WORK_OBSTACLES] = added(node.work[WORK_OBSTACLES], mass * dot(stopped.pushed, mean));
    node.work[WORK_FRICTION] = added(node.work[WORK_FRICTION], mass * dot(stopped.rubbed, mean));
    node.work[WORK_REFERENCE] = added(node.work[WORK_REFERENCE], forces.relaxed);
    let gas = dot(node.given, mean);
    node.work[WORK_GAS] = added(node.work[WORK_GAS], gas);
    node.work[WORK_LEDGER] = added(node.work[WORK_LEDGER], -gas);
    if (constants.held == 1u) {
        let hold = mass * (velocity - node.velocity) - sum;
        node.work[WORK_HOLDS] = added(node.work[WORK_HOLDS], dot(hold, mean));
    }

    // Below 2^30 quanta the next place has no second reading.
    let flown = node.remainder + (membrane_step.dt * membrane_step.quanta) * velocity;
    let quanta = round(flown);
    let sound = all(abs(quanta) < vec3<f32>(1073741824.0));
    let next = bitcast<vec3<u32>>(bitcast<vec3<i32>>(node.place) + vec3<i32>(select(vec3<f32>(0.0), quanta, vec3<bool>(sound))));
    if (sound && all(next < membrane_step.limit)) {
        node.place = next;
        node.remainder = flown - quanta;
    } else {
        atomicAdd(&faults[0], 1u);
    }
    node.velocity = velocity;
    node.dt = membrane_step.dt;
    if (substep.substep + 1u == membrane_step.substeps) {
        let start = nodes[here].xyz;
        node.seen = vec3<f32>(bitcast<vec3<i32>>(node.place - start)) * (membrane_step.quantum / membrane_step.gas_dt);
        node_velocities[k] = vec4<f32>(node.seen, 0.0);
        nodes[here + membrane_step.nodes] = vec4<u32>(node.place, 0u);
    }
    membrane_nodes[k] = node;
}
