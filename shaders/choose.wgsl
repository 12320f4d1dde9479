//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl lists.wgsl asked.wgsl chooser.wgsl cap.wgsl
// Each particle picks its earliest possible collision: at the closest approach, or, of rigid spheres, where they touch
// or at once if they overlap and approach (specification, section 2).
//
// Reads `sorted`, `flights`, the lists of `neighbours`; writes `choices` (partner's index or NOBODY, time).
// One thread per particle in the first round, per entry of `rechoose` in later ones: only a particle that
// collided, or whose neighbour did, can choose otherwise than before. Ghosts that wait until they are asked (asked.wgsl)
// choose nobody, and are appended to `asked` when they are; a second pass is over those. The choice is the minimum over (time, partner id), so it does not depend on
// the order of the candidates; both particles of a pair evaluate it with the lower id first, in the one
// place below, so that they agree to the last bit.

// Rigid spheres, the method `hard-sphere`.
override RIGID: bool = false;

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(10) var<storage, read> sorted: array<Particle>;
@group(0) @binding(11) var<storage, read> flights: array<Flight>;
@group(0) @binding(13) var<storage, read> neighbours: array<u32>;
@group(0) @binding(14) var<storage, read> neighbour_count: array<u32>;
@group(0) @binding(15) var<storage, read_write> choices: array<vec2<u32>>;

@group(0) @binding(32) var<storage, read_write> layers: array<atomic<u32>>;

@compute @workgroup_size(WORKGROUP)
fn choose(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let s = chooser(linear(id, groups));
    if (s == NOBODY) {
        return;
    }
    if (step.ghosts == GHOSTS_WAIT && waits(atomicLoad(&layers[s]) & LAYER)) {
        if (step.round == 0u) {
            choices[s] = vec2<u32>(NOBODY, 0u);
        }
        return;
    }
    var best = vec2<u32>(NOBODY, 0u);
    var best_time = NEVER;
    var best_id = NOBODY;
    let listed = neighbour_count[s];
    let own = sorted[s];
    let own_flight = flights[s];
    let own_id = id_of(own.tag);
    let stride = arrayLength(&neighbour_count);
    for (var k = 0u; k < listed; k++) {
        let j = neighbours[k * stride + s];
        let other = sorted[j];
        let other_flight = flights[j];
        let other_id = id_of(other.tag);
        let first = own_id < other_id;
        let r = select(-1.0, 1.0, first) * between(own.position, other.position);
        let g = select(-1.0, 1.0, first) * (other.velocity - own.velocity);
        let g2 = dot(g, g);
        if (g2 == 0.0) {
            continue;
        }
        var time = -dot(r, g) / g2;
        let earliest = max(own_flight.start, other_flight.start);
        let latest = min(step.dt, min(own_flight.wall, other_flight.wall));
        if (!RIGID && !(time >= earliest && time < latest)) {
            continue;
        }
        let miss = r + g * time;
        let inside = diameter2(own_flight, other_flight) - dot(miss, miss);
        if (inside <= 0.0) {
            continue;
        }
        if (RIGID) {
            // Apart from the closest approach on they only move apart.
            let approach = time;
            time = max(approach - sqrt(inside / g2), earliest);
            if (!(approach > earliest && time < latest)) {
                continue;
            }
        }
        if (own_flight.partner == other.tag && other_flight.partner == own.tag) {
            continue;
        }
        if (time > best_time || (time == best_time && other_id >= best_id)) {
            continue;
        }
        best = vec2<u32>(j, bitcast<u32>(time));
        best_time = time;
        best_id = other_id;
    }
    choices[s] = best;
    if (step.ghosts == GHOSTS_WAIT && best.x != NOBODY && waits(atomicLoad(&layers[best.x]) & LAYER)) {
        if ((atomicOr(&layers[best.x], ASKED) & ASKED) == 0u) {
            asked[append(LIST_ASKED)] = best.x;
        }
    }
}
