//! One collision of the closest-approach method (docs/explanation/method.md, "Collisions").

use super::random::{philox, unit_interval};
use super::vector::{Vector, along, cross, dot, minus, norm, scaled, unit};

/// Internal degrees of freedom and exchange probability of a gas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gas {
    pub mass: f64,
    /// zeta.
    pub degrees: f64,
    /// P of section 3.
    pub exchange: f64,
    /// Of a heat capacity that depends on the temperature (else none): (weight h_K / Gamma(nu0 + K + 2), K, nu0 + K)
    /// for energies in units of kT_ref.
    pub modes: &'static [[f64; 3]],
}

impl Gas {
    /// With P from the collision number Z: P = (1 - sqrt(1 - 2 a P0)) / a.
    pub fn with_collision_number(mass: f64, degrees: f64, z: f64) -> Gas {
        let a = degrees / (degrees + 4.0);
        let p0 = (1.0 + degrees / 4.0) / z;
        let exchange = if degrees > 0.0 { (1.0 - (1.0 - 2.0 * a * p0).sqrt()) / a } else { 0.0 };
        Gas { mass, degrees, exchange, modes: &[] }
    }
}

/// A particle within a step: at x0 + v t from `start` on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    pub id: u32,
    pub gas: usize,
    pub x0: Vector,
    pub v: Vector,
    pub spin: f64,
    pub start: f64,
    /// Time of the next wall hit, or infinity.
    pub wall: f64,
    /// Id of the last partner in this step.
    pub partner: Option<u32>,
}

/// The random numbers of one collision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Draws {
    /// Of the lower id, then of the higher: whether it exchanges, U1, U2.
    pub exchange: [[f64; 3]; 2],
    /// Which mode, of both.
    pub pick: [f64; 2],
    /// s = -1.
    pub left: bool,
}

impl Draws {
    /// Those of the device: two blocks per collision, keyed on (step, round, lower id, higher id).
    pub fn of(step: u32, round: u32, ids: [u32; 2], key: [u32; 2]) -> Draws {
        let first = philox([step, 2 * round, ids[0], ids[1]], key);
        let second = philox([step, 2 * round + 1, ids[0], ids[1]], key);
        Draws {
            exchange: [
                [first[0], first[1], first[2]].map(unit_interval),
                [first[3], second[0], second[1]].map(unit_interval),
            ],
            pick: [second[3], second[2] << 1].map(unit_interval),
            left: second[2] >> 31 == 1,
        }
    }
}

/// Time of the closest approach of x0_i + v_i t and x0_j + v_j t, and the miss vector there; none for equal
/// velocities. `image` is added to j's position (periodic boxes).
pub fn closest_approach(i: &Body, j: &Body, image: Vector) -> Option<(f64, Vector)> {
    let r = along(minus(j.x0, i.x0), image, 1.0);
    let g = minus(j.v, i.v);
    let g2 = dot(g, g);
    (g2 > 0.0).then(|| {
        let time = -dot(r, g) / g2;
        (time, along(r, g, time))
    })
}

/// Rule 3: the time of the collision of i (lower id) and j in a step of length `dt`, if they may have one.
pub fn meeting(i: &Body, j: &Body, image: Vector, diameter: f64, dt: f64) -> Option<f64> {
    let (time, miss) = closest_approach(i, j, image)?;
    let in_time = time >= i.start.max(j.start) && time < dt.min(i.wall).min(j.wall);
    let just_collided = i.partner == Some(j.id) && j.partner == Some(i.id);
    (in_time && norm(miss) < diameter && !just_collided).then_some(time)
}

/// e' = E U1^(1/beta) U2^(1/(beta+1)): the spin energy after an exchange of the energy E.
pub fn exchanged(energy: f64, degrees: f64, u: [f64; 2]) -> f64 {
    let beta = 0.5 * degrees;
    energy * u[0].powf(1.0 / beta) * u[1].powf(1.0 / (beta + 1.0))
}

/// nu0 + K of the mode that a draw picks at the energy E over kT_ref: weights h_K E^K / Gamma(nu0 + K + 2).
pub fn picked(energy: f64, modes: &[[f64; 3]], draw: f64) -> f64 {
    let weight = |[weight, power, _]: &[f64; 3]| weight * energy.powf(*power);
    let mut left = draw * modes.iter().map(weight).sum::<f64>();
    for mode in modes {
        left -= weight(mode);
        if left < 0.0 {
            return mode[2];
        }
    }
    modes[modes.len() - 1][2]
}

/// Where j is seen from i, when the two meet, and how large they are.
#[derive(Debug, Clone, Copy)]
pub struct Meeting {
    pub image: Vector,
    pub time: f64,
    pub diameter: f64,
}

/// Rules 5 and 6: i (lower id) and j after their collision. Returns the virial r . (g' - g) over
/// |r| |g|, which the method makes zero.
pub fn collide(i: &mut Body, j: &mut Body, meeting: Meeting, gases: &[Gas], draws: &Draws) -> f64 {
    let Meeting { image, time, diameter } = meeting;
    let g = minus(j.v, i.v);
    let miss = along(along(minus(j.x0, i.x0), image, 1.0), g, time);
    let (mass_i, mass_j) = (gases[i.gas].mass, gases[j.gas].mass);
    let reduced = mass_i * mass_j / (mass_i + mass_j);
    let before = 0.5 * reduced * dot(g, g);
    let mut relative = before;
    for ((body, [choice, u1, u2]), pick) in [&mut *i, &mut *j].into_iter().zip(draws.exchange).zip(draws.pick) {
        let gas = gases[body.gas];
        if gas.degrees > 0.0 && choice < gas.exchange {
            let sum = relative + body.spin;
            let degrees = if gas.modes.is_empty() { gas.degrees } else { 2.0 * picked(sum, gas.modes, pick) };
            body.spin = exchanged(sum, degrees, [u1, u2]);
            relative = sum - body.spin;
        }
    }
    let speed = (2.0 * relative / reduced).sqrt();
    let turned = scaled(turn(miss, g, diameter, draws.left), speed);
    let change = minus(turned, g);
    let (dv_i, dv_j) = (scaled(change, -reduced / mass_i), scaled(change, reduced / mass_j));
    for (body, dv) in [(i, dv_i), (j, dv_j)] {
        body.v = along(body.v, dv, 1.0);
        body.x0 = along(body.x0, dv, -time);
        body.start = time;
    }
    let scale = norm(miss) * norm(g);
    if scale > 0.0 { dot(miss, change) / scale } else { 0.0 }
}

/// The direction of g': cos(chi) ghat +- sin(chi) (rhat x ghat), cos(chi/2) = b/sigma.
pub fn turn(miss: Vector, g: Vector, diameter: f64, left: bool) -> Vector {
    let ghat = unit(g);
    let b = norm(miss) / diameter;
    let side = if b > 1e-12 {
        unit(cross(miss, ghat))
    } else {
        // Head on: chi is pi, and any perpendicular does.
        unit(cross(ghat, if ghat[0].abs() < 0.5 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] }))
    };
    let cosine = 2.0 * b * b - 1.0;
    let sine = 2.0 * b * (1.0 - b * b).max(0.0).sqrt();
    along(scaled(ghat, cosine), side, if left { -sine } else { sine })
}
