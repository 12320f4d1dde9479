//! uses: particle.wgsl gas.wgsl philox.wgsl modes.wgsl
// What a collision does to the two particles beyond turning them: spin exchange (Larsen-Borgnakke,
// specification, section 3), i before j, i the lower id; new velocities about the common centre of mass; and what
// rounding does to the pair's energy goes into spin.

override SPIN: bool = true;

@group(0) @binding(1) var<uniform> gases: array<Gas, 16>;

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

// The pair with its relative velocity changed by `change` and these spins. Positions stay.
fn deflected(before_i: Particle, before_j: Particle, mu: f32, change: vec3<f32>, after: Exchanged) -> Pair {
    var i = before_i;
    var j = before_j;
    let mass_i = gases[kind_of(i.tag)].mass;
    let mass_j = gases[kind_of(j.tag)].mass;
    i.velocity = before_i.velocity - (mu / mass_i) * change;
    j.velocity = before_j.velocity + (mu / mass_j) * change;
    if (SPIN) {
        // The kinetic energy that the rounded velocities really gained, against what the spins gave.
        let gained = 0.5 * mass_i * dot(i.velocity - before_i.velocity, i.velocity + before_i.velocity)
            + 0.5 * mass_j * dot(j.velocity - before_j.velocity, j.velocity + before_j.velocity);
        let residual = (i.spin - after.spin_i) + (j.spin - after.spin_j) - gained;
        i.spin = after.spin_i;
        j.spin = after.spin_j;
        if (gases[kind_of(i.tag)].exchange > 0.0 && i.spin + residual >= 0.0) {
            i.spin += residual;
        } else if (gases[kind_of(j.tag)].exchange > 0.0 && j.spin + residual >= 0.0) {
            j.spin += residual;
        }
    }
    return Pair(i, j);
}
