//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl gas.wgsl lists.wgsl touch.wgsl touch_neighbours.wgsl philox.wgsl spin.wgsl walls.wgsl cap.wgsl neighbour_list.wgsl listed.wgsl
//! binds: rechoose_dispatches as dispatches
//! phase: settle
// Settle, part 2: the collisions of this round.
//
// Closest-approach collision (docs/explanation/method.md, "Collisions"): the relative velocity is turned by chi with
// cos(chi/2) = b/sigma, perpendicular to the miss vector, so that the virial r . g' is zero. Rigid spheres are thrown
// back along the line of their centres.
//
// Reads `pairs`, `choices`, the lists of neighbours behind the flights; reads and writes `sorted`, `flights` and `marks`,
// and appends the particles that this may make choose otherwise to `rechoose`, and those that other
// devices must be told of to `changed`. One thread per pair. Pairs are
// disjoint and random numbers are keyed on (step, round, ids), so order does not matter.

// Rigid spheres, the method `hard-sphere`.
override RIGID: bool = false;

// The square of the relative speed of the plan's fastest pairs, (m/s)^2.
override FASTEST2: f32;

var<uniform> step: Step;
var<storage, read> choices: array<vec2<u32>>;
var<storage, read> pairs: array<vec2<u32>>;
var<storage, read_write> sorted: array<Packed>;
var<storage, read_write> flights: array<vec4<u32>>;
var<storage, read_write> changed: array<u32>;

// A unit vector perpendicular to the unit vector u.
fn perpendicular(u: vec3<f32>) -> vec3<f32> {
    let axis = select(vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(1.0, 0.0, 0.0), abs(u.x) < 0.6);
    return normalize(cross(axis, u));
}

// The new relative velocity of rigid spheres with `r` between their centres and relative velocity `g`: the part of its
// direction along r is turned back.
fn thrown_back(r: vec3<f32>, g: vec3<f32>, speed: f32) -> vec3<f32> {
    let r2 = dot(r, r);
    // Two at one place have no line of centres.
    let back = select(-g, g - (2.0 * dot(g, r) / max(r2, 1e-30)) * r, r2 > 0.0);
    let old_speed = length(g);
    if (speed == old_speed) {
        return back;
    }
    return (speed / old_speed) * back;
}

// The new relative velocity of a pair with the square `sigma2` of its diameter, miss vector `miss` (r at the closest
// approach) and relative velocity `g`, at the relative speed `speed`; a bit of `side` says on which side they pass.
fn turned(sigma2: f32, miss: vec3<f32>, g: vec3<f32>, speed: f32, side: u32) -> vec3<f32> {
    let along = g / length(g);
    let across = miss - along * dot(miss, along);
    let b2 = clamp(dot(across, across) / sigma2, 0.0, 1.0);
    var turn = perpendicular(along);
    if (b2 > 1e-12) {
        turn = normalize(cross(across, along));
    }
    if ((side & 0x80000000u) != 0u) {
        turn = -turn;
    }
    let cosine = 2.0 * b2 - 1.0;
    let sine = 2.0 * sqrt(b2 * (1.0 - b2));
    return speed * (cosine * along + sine * turn);
}

// Notes a particle that other devices have as a ghost.
fn tell(s: u32) {
    if ((atomicLoad(&marks[s]) & (SHARED | LISTED)) == SHARED) {
        // (Others may let it choose meanwhile.)
        atomicOr(&marks[s], LISTED);
        changed[append(LIST_CHANGED)] = s;
    }
}

fn is_own(s: u32) -> bool {
    return (atomicLoad(&marks[s]) & LAYER) == 0u;
}

@compute @workgroup_size(WORKGROUP)
fn settle(thread: Thread) {
    let k = linear(thread);
    let number = number_in_shard(k);
    let count = entries_in_shard(k, step.round, step.total / 2u);
    if (number >= count) {
        return;
    }
    if (number == 0u) {
        tell_entries(step.round, count);
        let old = atomicAdd(&counters[COLLISIONS_LOW], count);
        if (old + count < old) {
            atomicAdd(&counters[COLLISIONS_HIGH], 1u);
        }
    }
    let pair = pairs[k];
    let time = bitcast<f32>(choices[pair.x].y);
    var i = particle_of(sorted[pair.x]);
    var j = particle_of(sorted[pair.y]);
    let flight_i = flight_of(flights[2u * pair.x]);
    let flight_j = flight_of(flights[2u * pair.y]);
    let listed_i = neighbour_count[pair.x];
    let listed_j = neighbour_count[pair.y];
    let direct_i = direct_of(pair.x);
    let direct_j = direct_of(pair.y);
    let mass_i = gases[kind_of(i.tag)].mass;
    let mass_j = gases[kind_of(j.tag)].mass;
    let mu = mass_i * mass_j / (mass_i + mass_j);
    let g = j.velocity - i.velocity;
    let miss = between(i.position, j.position) + g * time;
    // Neighbours are screened where the step starts; here, where the pair would meet. A pair that a wall
    // parts passes on as if it had collided, so that its particles choose others in the next round.
    let place_i = shifted(i.position, i.velocity, time);
    let apart = may_part(nearest_cell(place_i))
        && blocked(place_i, shifted(j.position, j.velocity, time), time);
    tell(pair.x);
    tell(pair.y);
    if (apart) {
        // Whom either met before may meet it again.
        touch(pair.x, k);
        touch(pair.y, k);
    }
    // All whose choice this can change must choose again, whether they collided or not: the choices are a function of the
    // state alone, whoever else is asked to choose. (The two are in each other's lists.)
    touch_neighbours(listed_i, direct_i, listed_j, direct_j, k);
    if (apart) {
        flights[2u * pair.x].z = j.tag;
        flights[2u * pair.y].z = i.tag;
        if (is_own(pair.x)) {
            atomicAdd(&counters[BLOCKED], 1u);
        }
        tell_cut_short();
        return;
    }
    if (dot(g, g) > FASTEST2 && is_own(pair.x)) {
        atomicAdd(&counters[FAST_PAIRS], 1u);
    }
    let key = vec2<u32>(SEED_LOW, SEED_HIGH);
    let ids = vec2<u32>(id_of(i.tag), id_of(j.tag));
    let draw2 = philox(vec4<u32>(step.index, step.round * 2u + 1u, ids), key);
    var draw = vec4<u32>(0u);
    if (SPIN) {
        draw = philox(vec4<u32>(step.index, step.round * 2u, ids), key);
    }
    // The sides take the top bit of the third word.
    let exchange = exchanged(i, j, mu, length(g), draw, draw2.xy, vec2<u32>(draw2.w, draw2.z << 1u));
    var relative: vec3<f32>;
    if (RIGID) {
        relative = thrown_back(miss, g, exchange.speed);
    } else {
        relative = turned(diameter2(flight_i, flight_j), miss, g, exchange.speed, draw2.z);
    }
    let old_i = i.velocity;
    let old_j = j.velocity;
    let after = deflected(i, j, relative - g, exchange);
    i = after.i;
    j = after.j;
    i.position = shifted(i.position, old_i - i.velocity, time);
    j.position = shifted(j.position, old_j - j.velocity, time);
    sorted[pair.x] = packed_of(i);
    sorted[pair.y] = packed_of(j);
    let wall_i = wall_time(i, time, step.dt);
    let wall_j = wall_time(j, time, step.dt);
    flights[2u * pair.x] = packed_flight(Flight(time, wall_i, j.tag, flight_i.collisions + 1u));
    flights[2u * pair.y] = packed_flight(Flight(time, wall_j, i.tag, flight_j.collisions + 1u));
    if (wall_i < step.dt) {
        atomicOr(&marks[pair.x], TURNED_TO_WALL);
    }
    if (wall_j < step.dt) {
        atomicOr(&marks[pair.y], TURNED_TO_WALL);
    }
    tell_cut_short();
}
