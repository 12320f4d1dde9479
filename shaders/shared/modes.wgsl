// Gases with a heat capacity that depends on the temperature (method.md, "Heat capacities"): at an exchange of the
// energy E a mode is sampled with weight h_K x^K / Gamma(nu0+K+2), x = E / k T_ref, and its beta is nu0 + K.

// Whether a gas has more than one mode. Else not a line more is compiled than constant heat capacities need.
override CURVES: bool = false;
// Modes of a gas, at most.
override MODES: u32 = 1;
// 1 / (k T_ref) for energies over the reference mass.
override INVERSE_THERMAL: f32 = 1.0;

// Of each gas, 32 apart: ln(h_K T_ref^K / Gamma(nu0+K+2)), K, 1/beta, 1/(beta+1). Modes that are not there have no weight.
// Then, from THERMAL_MODES on: ln(h_K T_ref^K), K, beta.
var<uniform> modes: array<vec4<f32>, 1024>;
const THERMAL_MODES: u32 = 512;

// The mode, of those from `first` on, that the uniform `draw` picks at an energy, exp(ln) k T_ref.
fn mode_at(first: u32, ln: f32, draw: f32) -> vec4<f32> {
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

// 1/beta and 1/(beta + 1) with which a particle of a gas exchanges the energy `sum`: its own, `constant`, or those of
// the mode that `pick` draws.
fn inverse_betas(gas: u32, constant: vec2<f32>, sum: f32, pick: u32) -> vec2<f32> {
    if (CURVES) {
        let ln = log(max(sum * INVERSE_THERMAL, 1e-30));
        return mode_at(gas * 32u, ln, unit_interval(pick)).zw;
    }
    return constant;
}

// The shape of the gamma distribution of e/kT in equilibrium at a temperature, `thermal` = kT over the reference mass: that
// of a constant heat capacity, or of the mode that `pick` draws with weight h_K T^K.
fn equilibrium_shape(gas: u32, inverse_beta: f32, thermal: f32, pick: u32) -> f32 {
    if (CURVES) {
        return mode_at(THERMAL_MODES + gas * 32u, log(thermal * INVERSE_THERMAL), unit_interval(pick)).z;
    }
    return 1.0 / inverse_beta;
}
