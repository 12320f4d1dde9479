// Spin exchange after Larsen and Borgnakke (specification, section 3), of any method of collision.
//
// A particle that exchanges takes e' = E Beta(beta, 2) of E = relative kinetic energy + its spin, beta = zeta/2; the
// other then does from what is left. A gas with a heat capacity that depends on the temperature has modes: with x =
// E / k T_ref one is drawn with weight h_K x^K / Gamma(nu0+K+2), and its beta is nu0 + K ("cp(T)").

// Whether a gas has more than one mode. Else not a line more is compiled than constant heat capacities need.
override CURVES: bool = false;
// Modes of a gas, at most.
override MODES: u32 = 1;
// 1 / (k T_ref) for energies over the reference mass.
override INVERSE_THERMAL: f32 = 1.0;

// Of each gas, 32 apart: ln(h_K T_ref^K / Gamma(nu0+K+2)), K, 1/beta, 1/(beta+1). Modes that are not there have no weight.
@group(0) @binding(50) var<uniform> modes: array<vec4<f32>, 512>;

// The mode that the uniform `draw` picks at the energy `sum`.
fn mode_at(gas: u32, sum: f32, draw: f32) -> vec4<f32> {
    let ln = log(max(sum * INVERSE_THERMAL, 1e-30));
    let first = gas * 32u;
    var most = -1e30;
    for (var k = 0u; k < MODES; k++) {
        most = max(most, modes[first + k].x + modes[first + k].y * ln);
    }
    var total = 0.0;
    for (var k = 0u; k < MODES; k++) {
        total += exp(modes[first + k].x + modes[first + k].y * ln - most);
    }
    var left = draw * total;
    var found = modes[first];
    for (var k = 0u; k < MODES; k++) {
        let weight = exp(modes[first + k].x + modes[first + k].y * ln - most);
        if (weight > 0.0 && left >= 0.0) {
            found = modes[first + k];
        }
        left -= weight;
    }
    return found;
}

// The spin after an exchange of the energy `sum` by a particle of a gas; `pick` picks its mode.
fn exchanged(gas: u32, sum: f32, a: u32, b: u32, pick: u32) -> f32 {
    var inverse_beta = gases[gas].inverse_beta;
    var inverse_beta1 = gases[gas].inverse_beta1;
    if (CURVES) {
        let mode = mode_at(gas, sum, unit_interval(pick));
        inverse_beta = mode.z;
        inverse_beta1 = mode.w;
    }
    let share = pow(unit_interval(a), inverse_beta) * pow(unit_interval(b), inverse_beta1);
    return min(sum * share, sum);
}

struct Exchange {
    spin_i: f32,
    spin_j: f32,
    // Relative kinetic energy.
    energy: f32,
}

// i, then j, from the relative kinetic energy `energy` of the pair, with the words of two draws. The top bit of
// `draw2.z` is not used.
fn exchange_spins(i: Particle, j: Particle, energy: f32, draw: vec4<u32>, draw2: vec4<u32>) -> Exchange {
    var outcome = Exchange(i.spin, j.spin, energy);
    let gas_i = gas_of(i.tag);
    if (unit_interval(draw.x) < gases[gas_i].exchange) {
        let sum = outcome.energy + i.spin;
        outcome.spin_i = exchanged(gas_i, sum, draw.y, draw.z, draw2.w);
        outcome.energy = sum - outcome.spin_i;
    }
    let gas_j = gas_of(j.tag);
    if (unit_interval(draw.w) < gases[gas_j].exchange) {
        let sum = outcome.energy + j.spin;
        outcome.spin_j = exchanged(gas_j, sum, draw2.x, draw2.y, draw2.z << 1u);
        outcome.energy = sum - outcome.spin_j;
    }
    return outcome;
}
