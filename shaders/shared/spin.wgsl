//! uses: particle.wgsl gas.wgsl philox.wgsl modes.wgsl
// What a collision does to the two particles beyond turning them: spin exchange (Larsen-Borgnakke,
// method.md, "Spin exchange"), i before j, i the lower id; new velocities about the common centre of mass; and what
// rounding does to the pair's energy goes into spin.

override SPIN: bool = true;

var<uniform> gases: array<Gas, 16>;

// The relative speed and the spins after the exchange.
struct Exchanged {
    speed: f32,
    spin_i: f32,
    spin_j: f32,
}

// `draw`: one word to decide for i, two for its share, one to decide for j; `draw2`: two for j's share; `pick`: one
// each for the modes of i and j.
fn exchanged(i: Particle, j: Particle, mu: f32, speed: f32, draw: vec4<u32>, draw2: vec2<u32>, pick: vec2<u32>) -> Exchanged {
    var after = Exchanged(speed, i.spin, j.spin);
    if (SPIN) {
        let before = 0.5 * mu * speed * speed;
        var energy = before;
        let gas_i = gases[kind_of(i.tag)];
        if (unit_interval(draw.x) < gas_i.exchange) {
            let sum = energy + i.spin;
            let own = vec2<f32>(gas_i.inverse_beta, gas_i.inverse_beta1);
            let betas = inverse_betas(gas_of(i.tag), own, sum, pick.x);
            let share = pow(unit_interval(draw.y), betas.x) * pow(unit_interval(draw.z), betas.y);
            after.spin_i = min(sum * share, sum);
            energy = sum - after.spin_i;
        }
        let gas_j = gases[kind_of(j.tag)];
        if (unit_interval(draw.w) < gas_j.exchange) {
            let sum = energy + j.spin;
            let own = vec2<f32>(gas_j.inverse_beta, gas_j.inverse_beta1);
            let betas = inverse_betas(gas_of(j.tag), own, sum, pick.y);
            let share = pow(unit_interval(draw2.x), betas.x) * pow(unit_interval(draw2.y), betas.y);
            after.spin_j = min(sum * share, sum);
            energy = sum - after.spin_j;
        }
        if (energy != before) {
            after.speed = sqrt(2.0 * energy / mu);
        }
    }
    return after;
}

struct Pair {
    i: Particle,
    j: Particle,
}

// How much of a change of the relative velocity each of two gases takes, mu/m_i and mu/m_j, 16 apart: of i the upper
// twelve bits and the rest of it, of j the same. One word's rounding has a sign that every collision of two gases repeats,
// and the two shares would not sum up to one: energy would grow or fall as collisions go on.
var<uniform> mass_shares: array<vec4<f32>, 256>;

fn shares_of(tag_i: u32, tag_j: u32) -> vec4<f32> {
    if (GASES == 1u) {
        return vec4<f32>(0.5, 0.0, 0.5, 0.0);
    }
    return mass_shares[16u * gas_of(tag_i) + gas_of(tag_j)];
}

// The pair with its relative velocity changed by `change` and these spins. Positions stay.
//
// What rounding would take from the energy of a pair, or give it, goes into spin; where neither gas has spin, into the
// scale of the relative velocity, before it is shared out.
fn deflected(before_i: Particle, before_j: Particle, change: vec3<f32>, after: Exchanged) -> Pair {
    var i = before_i;
    var j = before_j;
    let gas_i = gases[kind_of(i.tag)];
    let gas_j = gases[kind_of(j.tag)];
    let has_spin = SPIN && (gas_i.exchange > 0.0 || gas_j.exchange > 0.0);
    let share = shares_of(i.tag, j.tag);
    var small_i = share.y * change;
    var small_j = share.w * change;
    if (!has_spin) {
        let g = before_j.velocity - before_i.velocity;
        let turned_g = g + change;
        // The difference of their squares, which should be zero.
        let excess = dot(change, turned_g + g);
        let correction = (0.5 * excess / max(dot(turned_g, turned_g), 1e-30)) * turned_g;
        small_i -= share.x * correction;
        small_j -= share.z * correction;
    }
    i.velocity = before_i.velocity - (share.x * change + small_i);
    j.velocity = before_j.velocity + (share.z * change + small_j);
    if (has_spin) {
        // The kinetic energy that the rounded velocities really gained, against what the spins gave.
        let gained = 0.5 * gas_i.mass * dot(i.velocity - before_i.velocity, i.velocity + before_i.velocity)
            + 0.5 * gas_j.mass * dot(j.velocity - before_j.velocity, j.velocity + before_j.velocity);
        let residual = (i.spin - after.spin_i) + (j.spin - after.spin_j) - gained;
        i.spin = after.spin_i;
        j.spin = after.spin_j;
        if (gas_i.exchange > 0.0 && i.spin + residual >= 0.0) {
            i.spin += residual;
        } else if (gas_j.exchange > 0.0 && j.spin + residual >= 0.0) {
            j.spin += residual;
        }
    }
    return Pair(i, j);
}
