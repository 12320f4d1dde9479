//! uses: step.wgsl grid.wgsl particle.wgsl newborn.wgsl gas.wgsl counters.wgsl lists.wgsl walls.wgsl add64.wgsl
// Flies the particles that meet walls to the end of the step, off every wall on the way (specular).
//
// Reads `bouncing`, `sorted`, `flights` (without rounds of pairs `newborns`, without collisions `particles`) and the walls;
// writes `particles` and, where the scene has surfaces, the integer tally `sums`. One thread per entry of
// `bouncing`, which writes its own particle; sums of integers do not depend on order.

override COLLISIONS: bool = true;
override ROUNDS_OF_PAIRS: bool = true;
override ORIFICES: bool = true;
override SPIN: bool = true;
override SURFACES: bool = true;
// Bounces in one step after which a flight ends at the wall; such flights are counted.
override MOST_BOUNCES: u32 = 32;
// Impulse over reference mass to tally units.
override IMPULSE_SCALE: f32 = 1.0;

// Words of a surface's tally, two each: three impulse components, normal impulse, hits.
const SURFACE_WORDS: u32 = 10;

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(1) var<uniform> gases: array<Gas, 16>;
@group(0) @binding(2) var<storage, read_write> particles: array<Particle>;
@group(0) @binding(10) var<storage, read> sorted: array<Particle>;
@group(0) @binding(11) var<storage, read> flights: array<Flight>;
@group(0) @binding(17) var<storage, read_write> sums: array<atomic<u32>>;
@group(0) @binding(26) var<storage, read> bouncing: array<u32>;

fn tally_impulse(surface: u32, normal: vec3<f32>, impulse: vec3<f32>) {
    let scaled = vec4<f32>(impulse, -dot(impulse, normal)) * IMPULSE_SCALE;
    if (any(abs(scaled) >= vec4<f32>(1073741824.0))) {
        atomicAdd(&counters[TALLY_OVERFLOW], 1u);
        return;
    }
    let whole = vec4<i32>(round(scaled));
    for (var axis = 0u; axis < 4u; axis++) {
        let word = bitcast<u32>(whole[axis]);
        add64(surface * SURFACE_WORDS + 2u * axis, word, select(0u, 0xffffffffu, whole[axis] < 0));
    }
    add64(surface * SURFACE_WORDS + 8u, 1u, 0u);
}

@compute @workgroup_size(WORKGROUP)
fn bounce(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let entry = linear(id, groups);
    if (entry >= atomicLoad(&counters[LIST_BOUNCE])) {
        return;
    }
    let s = bouncing[entry];
    var particle: Particle;
    var time = 0.0;
    if (COLLISIONS) {
        particle = sorted[s];
    } else {
        particle = particles[s];
    }
    if (ROUNDS_OF_PAIRS) {
        time = flights[s].start;
    } else if (ORIFICES) {
        time = birth_time(id_of(particle.tag));
    }
    let gas = gases[gas_of(particle.tag)];
    var bounces = 0u;
    var end = step.dt;
    var overshoot = 0.0;
    loop {
        let hit = first_hit(particle.position, particle.velocity, time, step.dt);
        overshoot = max(overshoot, hit.overshoot);
        if (hit.triangle == NOBODY) {
            break;
        }
        if (bounces == MOST_BOUNCES) {
            atomicAdd(&counters[TRUNCATED], 1u);
            end = time;
            break;
        }
        bounces++;
        let triangle = triangles[hit.triangle];
        let old = particle.velocity;
        var turned = old - 2.0 * dot(old, triangle.normal) * triangle.normal;
        turned *= sqrt(dot(old, old) / dot(turned, turned));
        if (SPIN && gas.exchange > 0.0) {
            // What rounding took from the kinetic energy.
            particle.spin = max(particle.spin - 0.5 * gas.mass * dot(turned - old, turned + old), 0.0);
        }
        if (SURFACES && triangle.surface != NOBODY) {
            tally_impulse(triangle.surface, triangle.normal, gas.mass * (old - turned));
        }
        let place = shifted(particle.position, old * hit.time);
        particle.position = shifted(place, -turned * hit.time);
        particle.velocity = turned;
        time = hit.time;
    }
    atomicAdd(&counters[BOUNCES], bounces);
    if (overshoot > 0.0) {
        atomicMax(&counters[OVERSHOOT], u32(ceil(overshoot * QUANTA)));
    }
    particle.position = shifted(particle.position, particle.velocity * end);
    let cell = particle.position >> vec3<u32>(CELL_BITS);
    if (!in_grid(cell) || class_of(cell_index(cell)) == CLASS_SOLID) {
        atomicAdd(&counters[OUTSIDE], 1u);
    }
    particles[s] = particle;
}
