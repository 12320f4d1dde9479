//! uses: step.wgsl grid.wgsl particle.wgsl newborn.wgsl gas.wgsl lists.wgsl walls.wgsl add64.wgsl philox.wgsl modes.wgsl surface_models.wgsl binned.wgsl
//! binds: surface_sums as sums
//! phase: advect
// Flies the particles that meet walls to the end of the step, off every wall on the way: as off a mirror, or
// as the wall's surface model has it, diffusely with the temperature of the wall or with their speed, or out through a
// vent, of fabric to its other side. A wall that moves does so in its own frame; the work that it does on the gas is m V . (v' - v), V its velocity.
// Elastic fabric recoils besides.
//
// Reads `bouncing`, `sorted` and in `particles` the flights (without rounds of pairs `newborns`, without collisions
// `particles`), the walls, `surface_models`, `vents` and `zones`; writes `particles` (NOBODY for one that has left), counts it in
// its cell as `advect` does, and writes the integer tallies `sums`: of the surfaces, the surface models, the vents and the
// moving walls that the scene has. One thread per entry of `bouncing`, which writes its own particle; random numbers are
// keyed on (step, hit, id), and sums of integers do not depend on order.

override ROUNDS_OF_PAIRS: bool = true;
override SPIN: bool = true;
override SURFACES: bool = true;
override SURFACE_MODELS: bool = true;
override VENTS: bool = true;
// The scene has elastic fabric, whose nodes take the impulses of hits.
override MEMBRANE: bool = false;
// They see its nodes fly with smoothed velocities.
override SMOOTHED: bool = false;
// Bounces in one step after which a flight ends at the wall; such flights are counted.
override MOST_BOUNCES: u32 = 32;
// Hits on elastic fabric after which a flight ends there as well: they move its nodes in the next step only, so that a particle caught between two
// sheets that touch would throw them apart with many times its momentum.
const MOST_PUSHES: u32 = 6u;
// A particle has at most this part of the mass with which fabric recoils: a heavier one would fly on through the place of its hit.
const HEAVIEST: f32 = 0.5;
// Impulse over reference mass to tally units.
override IMPULSE_SCALE: f32 = 1.0;

// Energy over reference mass to tally units.
override ENERGY_SCALE: f32 = 1.0;
// Where the tallies of surface models and vents start in `sums`.
override SURFACE_MODELS_AT: u32 = 0;
override VENTS_AT: u32 = 0;
// And where those of moving walls do, and that of what fabric took in recoiling.
override WORKS_AT: u32 = 0;
override RECOIL_AT: u32 = 0;
// There are copies of all of these, each of so many words, that workgroups take in turn, and the host adds up: a GPU does atomic operations on
// one word, or on its neighbours, one after the other.
override COPIES: u32 = 1;
override COPY_WORDS: u32 = 0;

const ENERGY_RANGE: f32 = 4.29e9;

var<uniform> step: Step;
var<uniform> gases: array<Gas, 16>;
var<storage, read> step_state: array<u32>;
var<storage, read_write> particles: array<Packed>;
var<storage, read> sorted: array<Packed>;
var<storage, read> bouncing: array<u32>;
var<storage, read_write> sums: array<atomic<u32>>;
// The impulse of the step on each node of elastic fabric, over the reference mass, in units of tallies (src/fabric/).
var<storage, read_write> node_impulses: array<atomic<u32>>;
// m/s.
var<storage, read> node_velocities: array<vec4<f32>>;

// Where the copy of this thread's workgroup starts.
var<private> copy: u32;

fn tally_impulse(surface: u32, normal: vec3<f32>, impulse: vec3<f32>) {
    let scaled = vec4<f32>(impulse, -dot(impulse, normal)) * IMPULSE_SCALE;
    if (any(abs(scaled) >= vec4<f32>(1073741824.0))) {
        atomicAdd(&counters[TALLY_OVERFLOW], 1u);
        return;
    }
    let whole = vec4<i32>(round(scaled));
    for (var axis = 0u; axis < 4u; axis++) {
        let word = bitcast<u32>(whole[axis]);
        add64(copy + surface * SURFACE_WORDS + SURFACE_IMPULSE + 2u * axis, word, select(0u, 0xffffffffu, whole[axis] < 0));
    }
    add64(copy + surface * SURFACE_WORDS + SURFACE_HITS, 1u, 0u);
}

// The velocity with which the surface throws a particle back.
fn velocity_of(wall: Struck, v: vec3<f32>) -> vec3<f32> {
    if (!(MEMBRANE && SMOOTHED) || wall.sheet == NOBODY) {
        return wall.velocity;
    }
    let sheet = fabric[wall.sheet];
    let smoothed = node_velocities[sheet.a].xyz * wall.weights.x
        + node_velocities[sheet.b].xyz * wall.weights.y
        + node_velocities[sheet.c].xyz * wall.weights.z;
    // (Seen so, it may fly off already.)
    return select(wall.velocity, smoothed, dot(v - smoothed, wall.normal) < 0.0);
}

// Adds to one component of a node's impulse.
fn push_node(word: u32, units: i32) {
    let low = bitcast<u32>(units);
    let old = atomicAdd(&node_impulses[word], low);
    let high = select(0u, 0xffffffffu, units < 0) + select(0u, 1u, old + low < old);
    if (high != 0u) {
        atomicAdd(&node_impulses[word + 1u], high);
    }
}

// Shares an impulse (over the reference mass) out among the nodes of a triangle of fabric.
fn push_nodes(wall: Struck, impulse: vec3<f32>) {
    let sheet = fabric[wall.sheet];
    let corners = array<u32, 3>(sheet.a, sheet.b, sheet.c);
    for (var k = 0u; k < 3u; k++) {
        let scaled = impulse * wall.weights[k] * IMPULSE_SCALE;
        if (any(abs(scaled) >= vec3<f32>(1073741824.0))) {
            atomicAdd(&counters[TALLY_OVERFLOW], 1u);
            return;
        }
        let whole = vec3<i32>(round(scaled));
        for (var axis = 0u; axis < 3u; axis++) {
            push_node(corners[k] * NODE_IMPULSE_WORDS + 2u * axis, whole[axis]);
        }
    }
}

// Adds an energy (over the reference mass), and what the tallies of the zones to come will miss of it.
fn tally_energy(slot: u32, energy: f32) {
    let scaled = round(energy * ENERGY_SCALE);
    if (!(abs(scaled) < ENERGY_RANGE)) {
        atomicAdd(&counters[TALLY_OVERFLOW], 1u);
        return;
    }
    let size = u32(abs(scaled));
    if (size == 0u) {
        return;
    }
    var once = vec2<u32>(size, 0u);
    var left = vec2<u32>(size * step.tallies_left, multiply_high(size, step.tallies_left));
    if (scaled < 0.0) {
        once = negated(once);
        left = negated(left);
    }
    add64(copy + slot + WALL_ENERGY, once.x, once.y);
    if ((left.x | left.y) != 0u) {
        add64(copy + slot + WALL_TALLIED, left.x, left.y);
    }
}

fn energy_of(particle: Particle, mass: f32) -> f32 {
    return 0.5 * mass * dot(particle.velocity, particle.velocity) + particle.spin;
}

// Whether a particle that hits vent `v` at a speed passes it, which is tallied.
fn leaves(v: u32, particle: Particle, mass: f32, speed: f32, word: u32) -> bool {
    let slot = VENTS_AT + vents[v].index * VENT_WORDS;
    let probability = vents[v].beta * mass * speed;
    add64(copy + slot + VENT_HITS, 1u, 0u);
    if (probability > 1.0) {
        add64(copy + slot + VENT_CLIPPED, 1u, 0u);
    }
    if (unit_interval(word) >= probability) {
        return false;
    }
    tally_energy(slot, energy_of(particle, mass));
    atomicAdd(&sums[copy + slot + VENT_LEFT + gas_of(particle.tag)], 1u);
    return true;
}

@compute @workgroup_size(WORKGROUP)
fn bounce(thread: Thread) {
    let entry = linear(thread);
    if (entry >= atomicLoad(&counters[LIST_BOUNCE])) {
        return;
    }
    let s = bouncing[entry];
    copy = (entry / WORKGROUP) % COPIES * COPY_WORDS;
    var particle: Particle;
    var time = 0.0;
    if (COLLISIONS) {
        particle = particle_of(sorted[s]);
    } else {
        particle = particle_of(particles[s]);
    }
    if (ROUNDS_OF_PAIRS) {
        // Where the particle will be.
        time = bitcast<f32>(particles[s].position_tag.x);
    } else {
        time = birth_time(id_of(particle.tag));
    }
    let gas = gases[kind_of(particle.tag)];
    var bounces = 0u;
    var pushes = 0u;
    var end = step.dt;
    // Velocity of the surface that was hit last.
    var going = vec3<f32>(0.0);
    var overshoot = 0.0;
    var ended = false;
    // bench: hit
    loop {
        let hit = first_hit(particle.position, particle.velocity, time, step.dt, is_inside(particle.tag));
        overshoot = max(overshoot, hit.overshoot);
        // bench: last
        if (hit.triangle == NOBODY) {
            ended = true;
            break;
        }
        if (bounces == MOST_BOUNCES || pushes == MOST_PUSHES) {
            if (bounces == MOST_BOUNCES) {
                atomicAdd(&counters[TRUNCATED], 1u);
            } else {
                atomicAdd(&counters[CAUGHT], 1u);
            }
            end = time;
            ended = true;
            break;
        }
        bounces++;
        let old = particle.velocity;
        let wall = struck(hit, particle.position, old, time, is_inside(particle.tag));
        going = wall.velocity;
        let carried = velocity_of(wall, old);
        // In the frame of the wall.
        let relative = old - carried;
        var turned = relative - 2.0 * dot(relative, wall.normal) * wall.normal;
        var kept = true;
        if (SURFACE_MODELS && wall.surface_model != NOBODY) {
            let where_hit = shifted(particle.position, old, hit.time);
            let model = surface_model_at(wall.surface_model, where_hit, wall.normal, is_inside(particle.tag));
            let surface_model = surface_models[model];
            let draw = wall_draw(particle.tag, bounces, 0u);
            if (VENTS) {
                let v = vent_at(surface_model, where_hit);
                if (v != NOBODY && leaves(v, particle, gas.mass, -dot(relative, wall.normal), draw.x)) {
                    if (FABRIC && vents[v].passes != 0u) {
                        // To the other side of the sheet, as far from it.
                        let beyond = shifted(where_hit, wall.normal, wall.lift - 2.0 * SHEET_GAP);
                        particle.position = shifted(beyond, -old, hit.time);
                        // (What is beside an open sheet is inside of nothing.)
                        particle.tag ^= select(0u, INSIDE, fabric[wall.sheet].closed != 0u);
                        time = hit.time;
                        continue;
                    }
                    if (SURFACES && wall.surface != NOBODY) {
                        tally_impulse(wall.surface, wall.normal, gas.mass * old);
                    }
                    particle.tag = NOBODY;
                    ended = true;
                    break;
                }
            }
            let chance = unit_interval(draw.y);
            if (chance < surface_model.accommodation) {
                kept = false;
                let away = emitted(wall.normal, surface_model.thermal / gas.mass, particle.tag, bounces, draw.z);
                turned = away;
                var spin = 0.0;
                if (SPIN && gas.exchange > 0.0) {
                    let shape = equilibrium_shape(gas_of(particle.tag), gas.inverse_beta, surface_model.thermal, draw.w);
                    spin = surface_model.thermal * gamma_variate(shape, particle.tag, bounces);
                }
                let kinetic = 0.5 * gas.mass * dot(relative - away, relative + away);
                tally_energy(SURFACE_MODELS_AT + model * SURFACE_MODEL_WORDS, kinetic + (particle.spin - spin));
                particle.spin = spin;
            } else if (chance - surface_model.accommodation < surface_model.friction * (1.0 - surface_model.accommodation)) {
                turned = scattered(wall.normal, particle.tag, bounces, draw.z);
            }
        }
        if (kept) {
            // Its speed, in the frame of the wall.
            turned *= sqrt(dot(relative, relative) / dot(turned, turned));
        }
        turned += carried;
        var recoil = 0.0;
        if (MEMBRANE && wall.sheet != NOBODY) {
            // Fabric of mass M recoils: it takes 1/(1 + m/M) of the impulse, and with it P^2/2M from the gas.
            let share = 1.0 / (1.0 + min(gas.mass * fabric[wall.sheet].recoil, HEAVIEST));
            let change = turned - old;
            recoil = 0.5 * gas.mass * (1.0 - share) * dot(change, 2.0 * relative + (1.0 + share) * change);
            turned = old + share * change;
            tally_energy(RECOIL_AT, recoil);
        }
        var work = 0.0;
        if ((MOVING || FABRIC) && wall.work != NOBODY) {
            work = gas.mass * dot(carried, turned - old);
            tally_energy(WORKS_AT + wall.work * SURFACE_MODEL_WORDS, -work);
        }
        work -= recoil;
        if (SPIN && kept && gas.exchange > 0.0) {
            // What rounding took from the kinetic energy.
            particle.spin = max(particle.spin - (0.5 * gas.mass * dot(turned - old, turned + old) - work), 0.0);
        }
        if (SURFACES && wall.surface != NOBODY) {
            tally_impulse(wall.surface, wall.normal, gas.mass * (old - turned));
        }
        if (MEMBRANE && wall.sheet != NOBODY) {
            push_nodes(wall, gas.mass * (old - turned));
            pushes++;
        }
        var place = shifted(particle.position, old, hit.time);
        if (FABRIC && wall.lift > 0.0) {
            place = shifted(place, wall.normal, wall.lift);
        }
        particle.position = shifted(place, -turned, hit.time);
        particle.velocity = turned;
        time = hit.time;
    }
    cut_short = cut_short || !ended;
    atomicAdd(&counters[BOUNCES], bounces);
    tell_cut_short();
    if (FABRIC && beyond_lists) {
        atomicAdd(&counters[STRAYS], 1u);
    }
    if (overshoot > 0.0) {
        atomicMax(&counters[OVERSHOOT], u32(ceil(overshoot * QUANTA)));
    }
    if (VENTS && particle.tag == NOBODY) {
        particles[s].position_tag.w = NOBODY;
        if (bins_next()) {
            bin_nobody(s);
        }
        return;
    }
    particle.position = shifted(particle.position, particle.velocity, end);
    if ((MOVING || FABRIC) && end < step.dt) {
        // A flight that was cut short ends at its wall, which goes on.
        particle.position = shifted(particle.position, going, step.dt - end);
    }
    let cell = particle.position >> vec3<u32>(CELL_BITS);
    if (!in_grid(cell) || class_of(cell_index(cell)) == CLASS_SOLID) {
        atomicAdd(&counters[OUTSIDE], 1u);
    }
    particles[s] = packed_of(particle);
    if (bins_next()) {
        bin_next(s, particle.position, particle.velocity);
    }
}
