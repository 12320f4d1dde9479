//! uses: step.wgsl particle.wgsl newborn.wgsl lists.wgsl turns.wgsl spin.wgsl
// The collisions of the method `cell` in one part of a cell (direct simulation Monte Carlo without a time
// counter, docs/explanation/method.md, "Collisions").
//
// Of the N particles of a part of volume V, floor(N (N-1) / 2  pi sigma^2 g_max dt / V + U) candidate pairs are
// drawn; each collides with the probability g / g_max and goes off in a random direction. g_max = 2 max |v - u|, u
// the mean velocity, bounds every relative speed. Where spin exchange makes a particle faster than that, the rest of
// the candidates becomes more numerous in proportion, and so less often accepted.
//
// A kernel that uses this says with `member` which particle is the k-th of the part, by id, and with `hidden`
// whether a wall parts a pair. One thread does the whole part, candidate after candidate, and draws are keyed on
// (step, cell, candidate, part): the result is a function of the set of particles.

// pi sigma^2, m2.
override CROSS_SECTION: f32;
// The upper half of the key of these draws: seed and purpose, as SEED_HIGH.
override CELL_SEED_HIGH: u32;

var<uniform> step: Step;
var<storage, read> cell_start: array<u32>;
var<storage, read_write> sorted: array<Packed>;

// More candidates than this in one part (only at volumes that mean nothing) are counted as lost, and left out. Fewer than any device ends
// a loop after (turns.wgsl).
const MOST_CANDIDATES: f32 = 32768.0;

fn at_most(wanted: f32) -> u32 {
    if (wanted > MOST_CANDIDATES) {
        atomicAdd(&counters[LOST], u32(min(wanted - MOST_CANDIDATES, 1e9)));
    }
    return u32(clamp(wanted, 0.0, MOST_CANDIDATES));
}

// A unit vector, uniform on the sphere.
fn direction(word: u32, word2: u32) -> vec3<f32> {
    let up = 2.0 * unit_interval(word) - 1.0;
    let share = unit_interval(word2);
    let angle = 6.2831853 * share;
    // Some length from 1 to 2, not one that is 1 but for the rounding of sine and cosine: next to 1 roots and quotients
    // are rounded to one side, which over many collisions is a drift of the energy.
    let d = (1.0 + share) * vec3<f32>(sqrt(1.0 - up * up) * vec2<f32>(cos(angle), sin(angle)), up);
    return d / length(d);
}

// The mean velocity of a part's members, and the square of the largest difference from it.
struct Bulk {
    mean: vec3<f32>,
    farthest2: f32,
}

fn bulk_of(begin: u32, count: u32, part: u32) -> Bulk {
    var bulk = Bulk(vec3<f32>(0.0), 0.0);
    // bench: member
    for (var k = 0u; k < count; k++) {
        bulk.mean += sorted[member(begin, k, part)].motion.xyz;
    }
    bulk.mean /= f32(count);
    var k = 0u;
    // bench: member
    for (; k < count; k++) {
        let away = sorted[member(begin, k, part)].motion.xyz - bulk.mean;
        bulk.farthest2 = max(bulk.farthest2, dot(away, away));
    }
    through(k, count);
    return bulk;
}

struct Collided {
    candidates: u32,
    collisions: u32,
}

// The collisions of the `count` members, two at least, of a part of this volume, m3, from `begin` on.
fn collide_members(begin: u32, count: u32, bulk: Bulk, volume: f32, cell: u32, part: u32) -> Collided {
    let key = vec2<u32>(SEED_LOW, CELL_SEED_HIGH);
    let mean = bulk.mean;
    // (A little more than the bound, for its rounding.)
    var bound = 2.000002 * sqrt(bulk.farthest2);
    let pairs = 0.5 * f32(count) * f32(count - 1u);
    let first = philox(vec4<u32>(step.index, cell, 0u, part), key);
    var candidates = at_most(pairs * (CROSS_SECTION * bound * step.dt / volume) + unit_interval(first.x));
    var done = Collided(0u, 0u);
    // bench: candidate pair
    while (done.candidates < candidates) {
        done.candidates++;
        let draw = philox(vec4<u32>(step.index, cell, 4u * done.candidates, part), key);
        let one = multiply_high(draw.x, count);
        var other = multiply_high(draw.y, count - 1u);
        other += select(0u, 1u, other >= one);
        // By id, as the members are.
        let s = member(begin, min(one, other), part);
        let t = member(begin, max(one, other), part);
        let motion_i = sorted[s].motion;
        let motion_j = sorted[t].motion;
        let g = motion_j.xyz - motion_i.xyz;
        let speed = length(g);
        if (unit_interval(draw.z) * bound >= speed) {
            continue;
        }
        done.collisions++;
        if (hidden(s, t)) {
            // Counted as the other methods do: as a pair that met, and was parted.
            atomicAdd(&counters[BLOCKED], 1u);
            continue;
        }
        let draw2 = philox(vec4<u32>(step.index, cell, 4u * done.candidates + 1u, part), key);
        // A collision changes no place.
        let i = Particle(vec3<u32>(0u), sorted[s].position_tag.w, motion_i.xyz, motion_i.w);
        let j = Particle(vec3<u32>(0u), sorted[t].position_tag.w, motion_j.xyz, motion_j.w);
        let mass_i = gases[kind_of(i.tag)].mass;
        let mass_j = gases[kind_of(j.tag)].mass;
        let mu = mass_i * mass_j / (mass_i + mass_j);
        var draw3 = vec4<u32>(0u);
        if (SPIN) {
            draw3 = philox(vec4<u32>(step.index, cell, 4u * done.candidates + 2u, part), key);
        }
        var pick = vec2<u32>(0u);
        if (CURVES) {
            pick = philox(vec4<u32>(step.index, cell, 4u * done.candidates + 3u, part), key).xy;
        }
        let exchange = exchanged(i, j, mu, speed, draw3, draw2.zw, pick);
        let relative = exchange.speed * direction(draw2.x, draw2.y);
        let after = deflected(i, j, relative - g, exchange);
        sorted[s].motion = vec4<f32>(after.i.velocity, after.i.spin);
        sorted[t].motion = vec4<f32>(after.j.velocity, after.j.spin);
        let new_bound = 2.000002 * max(length(after.i.velocity - mean), length(after.j.velocity - mean));
        if (new_bound > bound) {
            let rest = f32(candidates - done.candidates) * (new_bound / bound);
            candidates = done.candidates + at_most(rest + unit_interval(draw.w));
            bound = new_bound;
        }
    }
    through(done.candidates, candidates);
    return done;
}

fn count_collisions(number: u32, cell: u32) {
    if (number > 0u) {
        let low = CELL_COLLISIONS + 2u * (cell % COLLISION_COUNTS);
        let old = atomicAdd(&counters[low], number);
        if (old + number < old) {
            atomicAdd(&counters[low + 1u], 1u);
        }
    }
}
