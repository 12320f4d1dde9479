//! Flow through a resolved hole between two chambers, from free flight over creeping flow to the continuum
//! (docs/explanation/method.md, "Openings").
//!
//! Coefficients are over the isentropic flow of the upstream gas at the pressure ratio Q down/up (choked below the critical
//! one). Between free flight and the continuum,
//!
//!   F(Kn, Q) = fm(Q) + (C(Q) - fm(Q)) w(Kn, Q)
//!
//! - fm: effusion both ways at one temperature, (1 - Q) / sqrt(2 pi) over the isentropic flow; at Q = 0 .583 for gamma 1.4;
//! - C: a thin orifice in the continuum, .84 at Q = 0 and .61 at Q = 1, linear between: within .03 of Perry's measurements (Trans.
//!   ASME 71, 1949) and of Jobson's theory (Proc. Inst. Mech. Eng. 169, 1955), both from memory;
//! - w at small differences (Q of .8 and more): (1 + x^-m)^(-1/m), m = 1.5, x = S / (C - fm), where S is creeping flow:
//!   Sampson's dp R / (3 pi mu) a unit of area (1891), S = s fm / Kn. S alone is Re / (12 pi) with Re = D u_isentropic(Q) / nu, so
//!   Kn and Re are two names of one thing. Of gas with nu = .783 lambda c0 s is .34; of the particles by whose kinetic lambda Kn is counted, which are
//!   1.31 times as viscous (section 2, f = .12), .26. m is measured: steady flow through a square hole at the end of this text;
//! - w into vacuum: by the table below, linear in ln Kn and on along its end slopes to 0 and 1;
//! - in between linear in Q.
//!
//! As Q goes to 1 the flow of any Kn above 0 becomes (1 + s/Kn) times that of free flight: in proportion to the difference of pressures,
//! so two chambers come to rest.
//!
//! What passes is a share k(Kn) = Kn / (Kn + 1/3) of effusion, each gas its own way and with 2 kT and its internal energy a molecule, and
//! the rest of F as a bulk flow: the upstream mixture with its enthalpy. k is what is left of effusion beside diffusion through the
//! hole, 4 D / (pi R) with D = 1.2 nu, and the share of effusion that the table into vacuum has, within .1.
//!
//! The length of Kn is the hole's radius. The prototype does not say. With the radius this solver finds
//! Cd .77 at Kn .1 (`tests/verification/orifice.rs`) against the table's .78; with the diameter the table would
//! ask for .78 at lambda = .2 radii, where kinetic theory has 1.2 times the effusion, Cd .70.
//!
//! The figures for Q = .8 are over the isentropic flow at that Q: over the choked one .18 at Kn 1 would be 1.54 times free flight, where
//! free flight and Sampson's creeping flow (.334/Kn of it) together are 1.33 times it. `corpuscle verify small-difference --full` finds .178
//! there, the prototype's .18, but .399 at Kn .1 with 120,000 particles, where the prototype has .29, and .389 with the method `cell`.
//! With 8000 it finds .293 +- .016: spheres that fill a third of the space are more viscous than their Kn says
//! ([`kinetics::viscosity_of_crowds`]).
//!
//! Steady flow between two reservoirs through a square hole, rigid spheres colliding in cells (a program of its own, gamma 5/3): Cd .417 +- .003 at
//! Q = .836 and .227 +- .005 at Q = .958 for Kn = .102 of their viscosity; the law, with s = .34, has .414 and .235. Steady flow out of
//! a chamber of 8 L that is filled through its other wall (20,000 particles, Kn .145): .32, .24, .20 at Q = .83, .90, .945; the law has .323, .246, .183.
//! What is averaged over a flow that dies down, as those at Q = .8 are, is that of smaller differences, with the inertia of the gas in the hole: by some .05
//! each, against each other.
//!
//! Assumptions: tables were measured at gamma 1.4 and give the same w at any gamma.

use std::f64::consts::PI;
use std::sync::LazyLock;

use super::{Species, kinetics, thermo};
use crate::scene::{GAS_CONSTANT, Mixture};

/// Discharge coefficient of a thin orifice into vacuum in the continuum (method.md, "Openings").
pub const CONTINUUM_COEFFICIENT: f64 = 0.84;
/// By small differences of pressure: pi / (pi + 2), the contraction of a free jet (Kirchhoff 1869).
const INCOMPRESSIBLE_COEFFICIENT: f64 = 0.61;
/// Cd of free flight through a hole, and of a thin orifice in the continuum, over choked isentropic flow (method.md,
/// "Openings").
pub const COEFFICIENT_LIMITS: [f64; 2] = [0.583, CONTINUUM_COEFFICIENT];
/// (Kn, Cd) into vacuum, over choked flow.
/// The prototype, whose figures are good to .02, has none between .3 and 10: those at 3 and 1 are [`published`], which `corpuscle
/// verify orifice --full` meets within its noise.
const VACUUM: [[f64; 2]; 6] = [[10.0, 0.60], [3.0, 0.6025], [1.0, 0.6385], [0.3, 0.71], [0.1, 0.78], [0.05, 0.83]];
/// From this pressure ratio on a difference is small.
pub(super) const SMALL_DIFFERENCE: f64 = 0.8;
/// s: creeping flow times Kn over free flight.
const CREEPING: f64 = 0.26;
/// m: how sharply creeping flow turns into the continuum's.
const SHARPNESS: f64 = 1.5;
/// Kn at which half of the effusion is left.
const HALF_EFFUSION: f64 = 1.0 / 3.0;

/// Flow of a monatomic gas through a thin circular orifice into vacuum over that of free flight, against the rarefaction
/// parameter `sqrt(pi) / (2 Kn)`: direct simulations by Sharipov (J. Fluid Mech. 518, 2004; Varoutis, Valougeorgis and Sharipov, J.
/// Vac. Sci. Technol. A 27, 2009, length 0), from memory, as the prototype's .84 is.
const ORIFICE: [(f64, f64); 9] = [
    (0.1, 1.014),
    (0.5, 1.068),
    (1.0, 1.129),
    (2.0, 1.221),
    (5.0, 1.374),
    (10.0, 1.463),
    (20.0, 1.508),
    (50.0, 1.528),
    (100.0, 1.534),
];
const MEASURED_GAMMA: f64 = 1.4;
/// 1 - Q below which the isentropic flow, ~ sqrt(1 - Q), is replaced by its chord, so that two chambers
/// come to rest instead of ringing about equal pressure also where no particles make the flow creep.
pub(super) const CHORD: f64 = 1e-4;

/// The prototype's figure for this Knudsen number, if it is one of its four.
pub fn specified(knudsen: f64) -> Option<f64> {
    let of_table = VACUUM.iter().find(|[kn, _]| *kn == knudsen && !BETWEEN.contains(kn))?;
    Some(of_table[1])
}

/// Discharge coefficient of a gas of gamma 1.4 into vacuum, between the entries of the table.
pub fn coefficient_into_vacuum(knudsen: f64) -> f64 {
    flux(MEASURED_GAMMA, knudsen, 0.0) / isentropic(MEASURED_GAMMA, 0.0)
}

/// Discharge coefficient of a thin orifice in the continuum at a ratio Q of pressures, over the isentropic flow there.
pub fn continuum_coefficient(ratio: f64) -> f64 {
    CONTINUUM_COEFFICIENT + (INCOMPRESSIBLE_COEFFICIENT - CONTINUUM_COEFFICIENT) * ratio.clamp(0.0, 1.0)
}

/// The same against the pressure before the orifice less that behind, Pa, as a vent's `discharge_by_pressure`.
pub fn continuum_by_excess(behind: f64) -> Vec<[f64; 2]> {
    if behind <= 0.0 {
        return vec![[0.0, CONTINUUM_COEFFICIENT]];
    }
    const RATIOS: [f64; 13] = [1.0, 0.95, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0.05, 0.01];
    RATIOS.iter().map(|&ratio| [behind * (1.0 / ratio - 1.0), continuum_coefficient(ratio)]).collect()
}

/// The Knudsen numbers in the table that the prototype does not have.
pub const BETWEEN: [f64; 2] = [1.0, 3.0];

/// Discharge coefficient of a gas of gamma 1.4 into vacuum by published simulations: its flow rises from free flight to the continuum as
/// that of a monatomic gas does, between the limits of its own. Linear in logarithms between the entries.
pub fn published(knudsen: f64) -> f64 {
    let rarefaction = std::f64::consts::PI.sqrt() / (2.0 * knudsen);
    let last = ORIFICE.len() - 1;
    let k = ORIFICE[..last].iter().rposition(|entry| entry.0 <= rarefaction).unwrap_or(0);
    let [(x0, y0), (x1, y1)] = [ORIFICE[k], ORIFICE[k + 1]];
    let part = (rarefaction / x0).ln() / (x1 / x0).ln();
    let risen = (y0 - 1.0) * ((y1 - 1.0) / (y0 - 1.0)).powf(part) / (ORIFICE[last].1 - 1.0);
    let [free, continuum] = COEFFICIENT_LIMITS;
    free + (continuum - free) * risen.min(1.0)
}

/// The gas on one side of a hole.
#[derive(Debug, Clone, Copy)]
pub struct Side<'a> {
    /// Of each gas.
    pub moles: &'a [f64],
    /// m3.
    pub volume: f64,
    /// K.
    pub temperature: f64,
}

impl Side<'_> {
    pub fn pressure(&self) -> f64 {
        self.moles.iter().sum::<f64>() * GAS_CONSTANT * self.temperature / self.volume
    }
}

/// Flow per area from `a` to `b` at the Knudsen number `knudsen`: adds to `moles` each gas's mol/(m2 s) and
/// returns the energy, W/m2; negative from `b` to `a`.
pub fn exchange(gases: &[Species], a: Side, b: Side, knudsen: f64, moles: &mut [f64]) -> f64 {
    let (pa, pb) = (a.pressure(), b.pressure());
    let (up, sign) = if pa >= pb { (a, 1.0) } else { (b, -1.0) };
    let high = pa.max(pb);
    if high <= 0.0 {
        return 0.0;
    }
    let ratio = pa.min(pb).max(0.0) / high;
    let effusing = effusing(knudsen);
    let mut energy = 0.0;
    for (side, sign) in [(a, 1.0), (b, -1.0)] {
        for ((gas, &amount), moles) in gases.iter().zip(side.moles).zip(&mut *moles) {
            let speed = kinetics::mean_speed(kinetics::thermal_square(side.temperature, gas.molar_mass));
            let flow = sign * effusing * 0.25 * speed * amount / side.volume;
            *moles += flow;
            energy += flow * 0.5 * (4.0 + gas.spin_energy_dof(side.temperature)) * GAS_CONSTANT * side.temperature;
        }
    }
    let total: f64 = up.moles.iter().sum();
    let mixture = Mixture(up.moles.iter().map(|amount| amount / total).enumerate().collect());
    let gamma = thermo::heat_capacity_ratio(&mixture, gases, up.temperature);
    let unit = high / (thermo::molar_mass(&mixture, gases) * GAS_CONSTANT * up.temperature).sqrt();
    let bulk = sign * unit * (flux(gamma, knudsen, ratio) - effusing * effusion(ratio));
    for &(gas, fraction) in &mixture.0 {
        moles[gas] += bulk * fraction;
        energy += gases[gas].enthalpy(bulk * fraction, up.temperature);
    }
    energy
}

/// Mass flux over p sqrt(M / (R T)) of the upstream gas, both sides at one temperature: F times the isentropic one.
fn flux(gamma: f64, knudsen: f64, ratio: f64) -> f64 {
    if ratio >= 1.0 {
        return 0.0;
    }
    let free = effusion(ratio);
    free + (continuum_coefficient(ratio) * isentropic(gamma, ratio) - free) * continuum_share(gamma, knudsen, ratio)
}

/// (1 - Q) / sqrt(2 pi): net effusion at one temperature, in the same unit.
fn effusion(ratio: f64) -> f64 {
    (1.0 - ratio) / (2.0 * PI).sqrt()
}

/// k(Kn).
fn effusing(knudsen: f64) -> f64 {
    if knudsen.is_finite() { knudsen / (knudsen + HALF_EFFUSION) } else { 1.0 }
}

/// Isentropic mass flux over p sqrt(M / (R T)) of the upstream gas, at the ratio Q of pressures; equal to
/// molar flux over p / sqrt(M R T).
pub fn isentropic(gamma: f64, ratio: f64) -> f64 {
    let critical = libm::pow(2.0 / (gamma + 1.0), gamma / (gamma - 1.0));
    let flux = |q: f64| {
        let difference = libm::pow(q, 2.0 / gamma) - libm::pow(q, (gamma + 1.0) / gamma);
        (2.0 * gamma / (gamma - 1.0) * difference.max(0.0)).sqrt()
    };
    if 1.0 - ratio < CHORD { flux(1.0 - CHORD) * (1.0 - ratio) / CHORD } else { flux(ratio.max(critical)) }
}

/// The kinetic limit over choked flow for equal temperatures, fm(Q).
fn kinetic_coefficient(gamma: f64, ratio: f64) -> f64 {
    effusion(ratio) / isentropic(gamma, 0.0)
}

/// A figure of the table as a share of the continuum.
struct Point {
    knudsen: f64,
    /// ln Kn.
    log: f64,
    share: f64,
}

/// The table [`VACUUM`].
static POINTS: LazyLock<Vec<Point>> = LazyLock::new(|| {
    let kinetic = kinetic_coefficient(MEASURED_GAMMA, 0.0);
    let share = |cd: f64| (cd - kinetic) / (CONTINUUM_COEFFICIENT - kinetic);
    VACUUM.iter().map(|&[knudsen, cd]| Point { knudsen, log: libm::log(knudsen), share: share(cd) }).collect()
});

/// w(Kn, Q), in 0..=1; `ratio` below 1.
fn continuum_share(gamma: f64, knudsen: f64, ratio: f64) -> f64 {
    let slow = share_of_slow(gamma, knudsen, ratio.max(SMALL_DIFFERENCE));
    if ratio >= SMALL_DIFFERENCE {
        return slow;
    }
    let vacuum = share_between(&POINTS, knudsen, libm::log(knudsen));
    vacuum + (slow - vacuum) * ratio / SMALL_DIFFERENCE
}

/// w at small differences: as creeping flow, up to what a continuum has more than free flight.
fn share_of_slow(gamma: f64, knudsen: f64, ratio: f64) -> f64 {
    let free = effusion(ratio);
    let creeping = CREEPING * free / knudsen / (continuum_coefficient(ratio) * isentropic(gamma, ratio) - free);
    libm::pow(1.0 + libm::pow(creeping, -SHARPNESS), -1.0 / SHARPNESS)
}

fn share_between(points: &[Point], knudsen: f64, log: f64) -> f64 {
    // Knudsen numbers fall along the table; the end pieces serve beyond it.
    let after = points.iter().position(|point| point.knudsen <= knudsen).unwrap_or(points.len());
    let piece = after.clamp(1, points.len() - 1);
    let [before, after] = [&points[piece - 1], &points[piece]];
    let risen = (after.share - before.share) * (log - before.log) / (after.log - before.log);
    (before.share + risen).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests;
