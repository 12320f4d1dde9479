//! uses: step.wgsl grid.wgsl particle.wgsl newborn.wgsl lists.wgsl gas.wgsl philox.wgsl modes.wgsl turns.wgsl
// The collisions of the particles of a cell, or of a group of them, all at once (the method `half-turn`).
//
// Of M particles of masses m, velocities v and places x the mean velocity U and the velocity gradient G that fits best (six particles and more)
// are kept. What is left, c = v - U - G y, y = x - X, is turned by half a turn about an axis n between the directions of the largest and the smallest stress,
// c' = 2 n (n.c) - c: most of the stress and of the heat flux change their sign, which a gas of a much smaller mean free path would do. The turn keeps
// sum m c, sum m c y and sum m c^2, so momentum, energy and angular momentum, and is its own inverse, so it keeps equilibrium.
//
// Energy goes between translation and spin along z = ln(translation/spin), turned about its value in equilibrium, z' = 2 z0 - z, with Metropolis'
// acceptance; now and then, and always in few particles or far from equilibrium, the share is drawn from its equilibrium, a beta distribution.
//
// A kernel that uses this says with `member` which particle is the k-th. Sums are in that order, relative to the first particle in place and velocity, and random
// numbers are keyed on the step, the cell of the first particle, and the group: the result is a function of the particles.
//
// f32: what rounding does to the energy goes into the one particle with the most spin, or where there is none, or too little, into the relative velocity of two
// that differ much. Spread over all it would be biased, since factors near one are. Six particles or seven have little beside their
// gradient, and where spin then stretches it a hundredfold, its rounding is stretched as well.

override SPIN: bool = true;
// The upper half of the key of these draws: seed and purpose, as SEED_HIGH.
override CELL_SEED_HIGH: u32;

var<uniform> step: Step;
var<uniform> gases: array<Gas, 16>;
var<storage, read_write> sorted: array<Packed>;

// Fewer particles have no fit of a gradient, and spin of equilibrium.
const LEAST_FITTED: u32 = 6;
// How often spin is drawn anew, and how often so few particles are turned at random, which may be the same ones step after step.
const DRAWN_ANEW: f32 = 0.05;
const TURNED_AT_RANDOM: f32 = 0.2;
// The determinant of the places' covariance over that of a round one, below which they lie in a plane.
const LEAST_DETERMINANT: f32 = 1e-4;
// Squares of standard deviations of z from equilibrium beyond which spin is drawn.
const FAR2: f32 = 16.0;
// What is turned over the whole kinetic energy, below which it is the rounding of velocities.
const LEAST_TURNED: f32 = 1e-12;
const JACOBI_ROTATIONS: u32 = 12;
const MOST_TRIES: u32 = 64;
// The third words of the counters of draws: one for decisions, one for turns at random, from GAMMAS on tries of the two gamma variates, and above
// MODES_OF_PARTICLE, where the second word is an id, for heat capacities.
const DECISIONS: u32 = 0;
const TURN: u32 = 1;
const GAMMAS: u32 = 2;
const MODE_OF_PARTICLE: u32 = 0x80000000;

struct Draws {
    cell: u32,
    group: u32,
}

fn drawn(key: Draws, word: u32) -> vec4<u32> {
    return philox(vec4<u32>(step.index, key.cell, word, key.group), vec2<u32>(SEED_LOW, CELL_SEED_HIGH));
}

// Half the internal degrees of freedom of a particle, 0 without spin; with a heat capacity that depends on the temperature those of a mode drawn
// with its weight h_K e^K / Gamma(nu0 + K) at the particle's own spin e.
fn half_freedom(tag: u32, spin: f32) -> f32 {
    let gas = gases[kind_of(tag)];
    if (!SPIN || gas.exchange == 0.0) {
        return 0.0;
    }
    if (CURVES) {
        let draw = philox(vec4<u32>(step.index, id_of(tag), MODE_OF_PARTICLE, 0u), vec2<u32>(SEED_LOW, CELL_SEED_HIGH));
        return mode_of_spin(gas_of(tag), spin, unit_interval(draw.x));
    }
    return 1.0 / gas.inverse_beta;
}

fn weight_of_mode(mode: vec4<f32>, ln: f32) -> f32 {
    // The table has Gamma(nu0 + K + 2).
    return mode.x + mode.y * ln - log(mode.z * mode.w);
}

fn mode_of_spin(gas: u32, spin: f32, draw: f32) -> f32 {
    let ln = log(max(spin * INVERSE_THERMAL, 1e-30));
    let first = gas * 32u;
    var most = -1e30;
    for (var k = 0u; k < MODES; k++) {
        most = max(most, weight_of_mode(modes[first + k], ln));
    }
    var total = 0.0;
    for (var k = 0u; k < MODES; k++) {
        total += exp(weight_of_mode(modes[first + k], ln) - most);
    }
    var left = draw * total;
    var found = modes[first].z;
    for (var k = 0u; k < MODES; k++) {
        let weight = exp(weight_of_mode(modes[first + k], ln) - most);
        if (weight > 0.0 && left >= 0.0) {
            found = modes[first + k].z;
        }
        left -= weight;
    }
    return 1.0 / found;
}

// From a place to another, in edges of a cell of the grid.
fn edges_between(a: vec3<u32>, b: vec3<u32>) -> vec3<f32> {
    return vec3<f32>(bitcast<vec3<i32>>(b - a)) / f32(1u << CELL_BITS);
}

// A symmetric matrix: its diagonal, and the elements xy, yz, zx.
struct Symmetric {
    diagonal: vec3<f32>,
    off: vec3<f32>,
}

fn plus_square(s: Symmetric, weight: f32, v: vec3<f32>) -> Symmetric {
    return Symmetric(s.diagonal + weight * v * v, s.off + weight * v * v.yzx);
}

fn times(s: Symmetric, v: vec3<f32>) -> vec3<f32> {
    return s.diagonal * v + vec3<f32>(s.off.x * v.y + s.off.z * v.z, s.off.x * v.x + s.off.y * v.z, s.off.z * v.x + s.off.y * v.y);
}

// The inverse times the determinant.
fn adjugate(s: Symmetric) -> Symmetric {
    let d = s.diagonal;
    let o = s.off;
    return Symmetric(
        vec3<f32>(d.y * d.z - o.y * o.y, d.z * d.x - o.z * o.z, d.x * d.y - o.x * o.x),
        vec3<f32>(o.z * o.y - o.x * d.z, o.x * o.z - o.y * d.x, o.y * o.x - o.z * d.y),
    );
}

fn determinant_of(s: Symmetric, adjoint: Symmetric) -> f32 {
    return dot(vec3<f32>(s.diagonal.x, s.off.x, s.off.z), vec3<f32>(adjoint.diagonal.x, adjoint.off.x, adjoint.off.z));
}

struct Axes {
    values: Symmetric,
    x: vec3<f32>,
    y: vec3<f32>,
    z: vec3<f32>,
}

// Rotates in the plane of the first two axes so that they are no longer coupled, and lets the axes take turns (Jacobi, 1846).
fn jacobi(axes: Axes) -> Axes {
    let d = axes.values.diagonal;
    let o = axes.values.off;
    let theta = (d.y - d.x) / (2.0 * o.x);
    let size = abs(theta);
    var tangent = 1.0 / (size + sqrt(size * size + 1.0));
    tangent = select(tangent, -tangent, theta < 0.0);
    // (Uncoupled already, or by so little that the quotient overflows.)
    if (o.x == 0.0 || !(size < 1e18)) {
        tangent = 0.0;
    }
    let cosine = 1.0 / sqrt(tangent * tangent + 1.0);
    let sine = tangent * cosine;
    let diagonal = vec3<f32>(d.x - tangent * o.x, d.y + tangent * o.x, d.z);
    let off = vec3<f32>(select(0.0, o.x, tangent == 0.0), sine * o.z + cosine * o.y, cosine * o.z - sine * o.y);
    let x = cosine * axes.x - sine * axes.y;
    let y = sine * axes.x + cosine * axes.y;
    return Axes(Symmetric(diagonal.yzx, off.yzx), y, axes.z, x);
}

// A rotation: a unit quaternion, its last component the real one.
fn rotated(v: vec3<f32>, rotation: vec4<f32>) -> vec3<f32> {
    let twice = 2.0 * cross(rotation.xyz, v);
    return v + rotation.w * twice + cross(rotation.xyz, twice);
}

// Uniform over all rotations (Shoemake, 1992).
fn any_rotation(draw: vec4<u32>) -> vec4<f32> {
    let u = unit_interval(draw.x);
    let a = 6.2831853 * unit_interval(draw.y);
    let b = 6.2831853 * unit_interval(draw.z);
    let q = vec4<f32>(sqrt(1.0 - u) * vec2<f32>(sin(a), cos(a)), sqrt(u) * vec2<f32>(sin(b), cos(b)));
    return q / length(q);
}

// The half turn for a stress and a heat flux.
fn half_turn_of(stress: Symmetric, flux: vec3<f32>) -> vec4<f32> {
    var axes = Axes(stress, vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(0.0, 0.0, 1.0));
    for (var k = 0u; k < JACOBI_ROTATIONS; k++) {
        axes = jacobi(axes);
    }
    let values = axes.values.diagonal;
    var largest = axes.x;
    var smallest = axes.x;
    var most = values.x;
    var least = values.x;
    if (values.y > most) {
        most = values.y;
        largest = axes.y;
    }
    if (values.z > most) {
        most = values.z;
        largest = axes.z;
    }
    if (values.y <= least) {
        least = values.y;
        smallest = axes.y;
    }
    if (values.z <= least) {
        smallest = axes.z;
    }
    let n = largest - select(-smallest, smallest, dot(flux, largest) * dot(flux, smallest) >= 0.0);
    return vec4<f32>(n / length(n), 0.0);
}

// A variate of the gamma distribution of this shape (Marsaglia and Tsang, 2000), from tries of these draws on.
fn gamma(shape: f32, key: Draws, first: u32) -> f32 {
    let raised = shape < 1.0;
    let d = select(shape, shape + 1.0, raised) - 0.33333334;
    let c = 1.0 / sqrt(9.0 * d);
    var found = d;
    for (var k = 0u; k < MOST_TRIES; k++) {
        let draw = drawn(key, first + 2u * k);
        let normal = sqrt(-2.0 * log(unit_interval(draw.x))) * cos(6.2831853 * unit_interval(draw.y));
        let root = 1.0 + c * normal;
        let v = root * root * root;
        if (root > 0.0 && log(unit_interval(draw.z)) < 0.5 * normal * normal + d * (1.0 - v + log(v))) {
            found = d * v;
            if (raised) {
                found *= pow(unit_interval(draw.w), 1.0 / shape);
            }
            break;
        }
    }
    return found;
}

// ln(1 + e^z).
fn softplus(z: f32) -> f32 {
    return max(z, 0.0) + log(1.0 + exp(-abs(z)));
}

// The share of the translation after the exchange with spin; `a` and `b`: half the degrees of freedom of either.
fn share_of_translation(translation: f32, spin: f32, a: f32, b: f32, few: bool, key: Draws) -> f32 {
    let draw = drawn(key, DECISIONS);
    let before = translation / (translation + spin);
    let z = log(translation / max(spin, 1e-30 * translation));
    let equilibrium = log(a / b);
    let away = z - equilibrium;
    // (Where one has no energy at all, too.)
    if (few || unit_interval(draw.x) < DRAWN_ANEW || !(away * away <= FAR2 * (1.0 / a + 1.0 / b))) {
        let x = gamma(a, key, GAMMAS);
        return x / (x + gamma(b, key, GAMMAS + 1u));
    }
    let turned = equilibrium - away;
    let ln = a * (softplus(-z) - softplus(-turned)) + b * (softplus(z) - softplus(turned));
    return select(before, 1.0 / (1.0 + exp(-turned)), log(unit_interval(draw.y)) < ln);
}

// What is kept of the particles: their mean velocity beyond that of the first, and the gradient of the velocity, by components, about the middle of
// their places, in edges of a cell from the first.
struct Fit {
    origin: vec3<u32>,
    middle: vec3<f32>,
    reference: vec3<f32>,
    mean: vec3<f32>,
    x: vec3<f32>,
    y: vec3<f32>,
    z: vec3<f32>,
}

// What the gradient adds to the mean velocity at a place.
fn flow_at(fit: Fit, place: vec3<u32>) -> vec3<f32> {
    let away = edges_between(fit.origin, place) - fit.middle;
    return vec3<f32>(dot(fit.x, away), dot(fit.y, away), dot(fit.z, away));
}

// The mass of a particle, over the reference mass.
fn mass_of(tag: u32) -> f32 {
    return gases[kind_of(tag)].mass;
}

// The collisions of the `count` particles from `begin` on; those that enter in this step are not among them.
fn relax(begin: u32, count: u32, group: u32) {
    var key = Draws(0u, group);
    var origin = vec3<u32>(0u);
    var reference = vec3<f32>(0.0);
    var number = 0u;
    var mass = 0.0;
    var momentum = vec3<f32>(0.0);
    var moment = vec3<f32>(0.0);
    var places = Symmetric(vec3<f32>(0.0), vec3<f32>(0.0));
    var flow_x = vec3<f32>(0.0);
    var flow_y = vec3<f32>(0.0);
    var flow_z = vec3<f32>(0.0);
    var spin = 0.0;
    var freedom = 0.0;
    var k = 0u;
    // bench: member
    for (; k < count; k++) {
        let s = member(begin, k);
        let place = sorted[s].position_tag;
        if (is_newborn(id_of(place.w))) {
            continue;
        }
        let motion = sorted[s].motion;
        if (number == 0u) {
            origin = place.xyz;
            reference = motion.xyz;
            key.cell = cell_index(nearest_cell(origin));
        }
        number++;
        let m = mass_of(place.w);
        let x = edges_between(origin, place.xyz);
        let v = motion.xyz - reference;
        mass += m;
        momentum += m * v;
        moment += m * x;
        places = plus_square(places, m, x);
        flow_x += m * v.x * x;
        flow_y += m * v.y * x;
        flow_z += m * v.z * x;
        if (SPIN) {
            spin += motion.w;
            freedom += half_freedom(place.w, motion.w);
        }
    }
    through(k, count);
    if (number < 2u) {
        atomicAdd(&counters[FREE_FLIGHTS], number);
        return;
    }
    let mean = momentum / mass;
    let middle = moment / mass;
    places = plus_square(places, -mass, middle);
    let adjoint = adjugate(places);
    let determinant = determinant_of(places, adjoint);
    let third = (places.diagonal.x + places.diagonal.y + places.diagonal.z) / 3.0;
    let fitted = number >= LEAST_FITTED && determinant > LEAST_DETERMINANT * third * third * third;
    var fit = Fit(origin, middle, reference, mean, vec3<f32>(0.0), vec3<f32>(0.0), vec3<f32>(0.0));
    // bench: fitted
    if (fitted) {
        fit.x = times(adjoint, flow_x - momentum.x * middle) / determinant;
        fit.y = times(adjoint, flow_y - momentum.y * middle) / determinant;
        fit.z = times(adjoint, flow_z - momentum.z * middle) / determinant;
    } else {
        atomicAdd(&counters[UNFITTED], number);
    }
    // Twice the energy of all, of what is turned, the stress and the heat flux of that.
    var whole = 0.0;
    var twice = 0.0;
    var stress = Symmetric(vec3<f32>(0.0), vec3<f32>(0.0));
    var flux = vec3<f32>(0.0);
    // bench: member
    for (k = 0u; k < count; k++) {
        let s = member(begin, k);
        let place = sorted[s].position_tag;
        if (is_newborn(id_of(place.w))) {
            continue;
        }
        let motion = sorted[s].motion;
        let m = mass_of(place.w);
        let flow = flow_at(fit, place.xyz);
        let c = ((motion.xyz - fit.reference) - fit.mean) - flow;
        let own = m * dot(c, c);
        whole += m * dot(motion.xyz, motion.xyz);
        twice += own;
        stress = plus_square(stress, m, c);
        flux += (own + 2.0 * motion.w) * c;
    }
    // All have one velocity, or differ by rounding: nothing to turn, and no direction for what spin might give. (It would stretch the
    // difference beyond all bounds.)
    if (!(twice > LEAST_TURNED * whole)) {
        return;
    }
    let few = number < LEAST_FITTED;
    var rotation: vec4<f32>;
    let draw = drawn(key, TURN);
    let at_random = number == 2u || (few && unit_interval(draw.w) < TURNED_AT_RANDOM);
    // bench: turned
    if (!at_random) {
        rotation = half_turn_of(Symmetric(stress.diagonal / twice, stress.off / twice), flux);
    } else {
        rotation = any_rotation(draw);
    }
    var stretch = 1.0;
    var spun = 1.0;
    // Where no particle has spin yet: of each half degree of freedom.
    var given = 0.0;
    let has_spin = SPIN && freedom > 0.0;
    // bench: spin
    if (has_spin) {
        let translation = 0.5 * twice;
        let all = translation + spin;
        let a = 1.5 * f32(number - select(1u, 4u, fitted));
        let share = share_of_translation(translation, spin, a, freedom, few, key);
        stretch = sqrt(share * all / translation);
        let rest = (1.0 - share) * all;
        if (spin > 0.0) {
            spun = rest / spin;
        } else {
            given = rest / freedom;
        }
    }
    // What rounding adds to the energy.
    var excess = 0.0;
    var fullest = NOBODY;
    var most_spin = -1.0;
    var fastest = NOBODY;
    var most_speed2 = -1.0;
    // bench: member
    for (k = 0u; k < count; k++) {
        let s = member(begin, k);
        let place = sorted[s].position_tag;
        if (is_newborn(id_of(place.w))) {
            continue;
        }
        let motion = sorted[s].motion;
        let m = mass_of(place.w);
        let flow = flow_at(fit, place.xyz);
        let c = ((motion.xyz - fit.reference) - fit.mean) - flow;
        let velocity = reference + (mean + (flow + stretch * rotated(c, rotation)));
        var own_spin = motion.w;
        if (has_spin) {
            own_spin = spun * own_spin;
            if (given > 0.0) {
                own_spin = given * half_freedom(place.w, 0.0);
            }
        }
        excess += 0.5 * m * dot(velocity - motion.xyz, velocity + motion.xyz) + (own_spin - motion.w);
        sorted[s].motion = vec4<f32>(velocity, own_spin);
        if (own_spin > most_spin) {
            most_spin = own_spin;
            fullest = s;
        }
        let away = velocity - (reference + mean);
        if (dot(away, away) > most_speed2) {
            most_speed2 = dot(away, away);
            fastest = s;
        }
    }
    var rest = excess;
    if (has_spin) {
        // (Where little spin is left beside hot translation it may not have that much.)
        rest = max(excess - most_spin, 0.0);
        sorted[fullest].motion.w = max(most_spin - excess, 0.0);
    }
    if (rest != 0.0) {
        correct(begin, count, fastest, rest);
    }
}

// Takes this energy from a particle and that which differs most from it in velocity, along the difference.
fn correct(begin: u32, count: u32, one: u32, excess: f32) {
    let v = sorted[one].motion.xyz;
    var other = NOBODY;
    var most = 0.0;
    for (var k = 0u; k < count; k++) {
        let s = member(begin, k);
        if (is_newborn(id_of(sorted[s].position_tag.w))) {
            continue;
        }
        let away = sorted[s].motion.xyz - v;
        if (dot(away, away) > most) {
            most = dot(away, away);
            other = s;
        }
    }
    if (other == NOBODY) {
        return;
    }
    let m = mass_of(sorted[one].position_tag.w);
    let n = mass_of(sorted[other].position_tag.w);
    let mu = m * n / (m + n);
    let g = sorted[other].motion.xyz - v;
    // mu g^2 / 2 becomes less by the excess; of the factor of g what is not one.
    let taken = min(2.0 * excess / (mu * most), 1.0);
    let change = (-mu * taken / (1.0 + sqrt(1.0 - taken))) * g;
    sorted[one].motion = vec4<f32>(v - change / m, sorted[one].motion.w);
    sorted[other].motion = vec4<f32>(sorted[other].motion.xyz + change / n, sorted[other].motion.w);
}
