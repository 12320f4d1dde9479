//! How far a profile of a tube may be from the exact solution: diffusion smears what is steep, and particles are counted.
//!
//! Layers widen as those of a gas of diffusivity D do, by a standard deviation of sqrt(2 D t); shocks steepen, so that theirs is
//! less. In a slice the smeared solution is off by mu, and counting scatters by s: the mean |difference| is that of a
//! normal variate, s sqrt(2/pi) exp(-mu^2/(2 s^2)) + mu erf(mu/(s sqrt 2)).

use std::f64::consts::PI;

use crate::gas::{Riemann, kinetics::HALF_TURN_VISCOSITY};

use super::tube::{BINS, Slice};
use super::waves::DIFFUSIVITY;

/// The diffusivities of half-turn: the density's by its diffusivity of heat, which layers between two gases have; the velocity, which varies in waves alone, by 4/3 of
/// its viscosity.
pub const OF_HALF_TURN: [f64; 2] = [DIFFUSIVITY, 4.0 / 3.0 * HALF_TURN_VISCOSITY];
/// Points in which a slice is looked at, and in a standard deviation of the smearing.
const POINTS: usize = 16;

/// Mean of |x| over a normal distribution.
fn folded(mean: f64, deviation: f64) -> f64 {
    if deviation == 0.0 {
        return mean.abs();
    }
    let z = mean.abs() / deviation;
    deviation * (2.0 / PI).sqrt() * (-0.5 * z * z).exp() + mean.abs() * libm::erf(z / 2f64.sqrt())
}

/// Density and momentum over those of a neighbourhood, weighted by a Gaussian of this standard deviation.
fn smeared(exact: &Riemann, x: f64, time: f64, deviation: f64) -> [f64; 2] {
    let reach = 4 * POINTS as i32;
    let (mut sums, mut weights) = ([0.0; 2], 0.0);
    for k in -reach..=reach {
        let away = f64::from(k) / POINTS as f64;
        let weight = (-0.5 * away * away).exp();
        let state = exact.at((x + away * deviation) / time);
        sums[0] += weight * state.density;
        sums[1] += weight * state.density * state.velocity;
        weights += weight;
    }
    sums.map(|sum| sum / weights)
}

/// The mean |difference| to expect of density and velocity at a time, if these have diffusivities of so many mean spacings times thermal
/// speeds of their place; `spacing`: of the left, over the tube's length. `profile` has the counting noise.
pub fn expected(exact: &Riemann, time: f64, diffusivities: [f64; 2], spacing: f64, profile: &[Slice]) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for slice in profile {
        let mut off = [0.0; 2];
        for k in 0..POINTS {
            let x = slice.x - 0.5 + ((k as f64 + 0.5) / POINTS as f64 - 0.5) / BINS as f64;
            let state = exact.at(x / time);
            if state.density <= 0.0 {
                continue;
            }
            let unit = spacing / state.density.cbrt() * (state.pressure / state.density).sqrt();
            let [of_density, of_velocity] =
                diffusivities.map(|diffusivity| smeared(exact, x, time, (2.0 * diffusivity * unit * time).sqrt()));
            off[0] += (of_density[0] - state.density) / POINTS as f64;
            off[1] += (of_velocity[1] / of_velocity[0] - state.velocity) / POINTS as f64;
        }
        (0..2).for_each(|k| sums[k] += folded(off[k], slice.scatter[k]) / profile.len() as f64);
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::super::tube::SOD;
    use super::*;

    /// Without a mean it is the noise's, without noise the mean's.
    #[test]
    fn noise_and_difference_add_up() {
        assert!((folded(0.0, 1.0) - (2.0 / PI).sqrt()).abs() < 1e-12);
        assert!((folded(-3.0, 1e-3) - 3.0).abs() < 1e-9 && (folded(-3.0, 0.0) - 3.0).abs() < 1e-12);
        // Known: mean .5, deviation 1.
        assert!((folded(0.5, 1.0) - 0.895_6).abs() < 1e-3);
    }

    /// Half-turn's diffusivities make of Sod's tube what the prototype has as the mean of 16 runs with 40,000 particles, .0125 in the density, of which
    /// a part is noise; of the velocity, .0235, somewhat more, since shocks steepen.
    #[test]
    fn sods_tube_is_smeared_as_much_as_it_was_found() {
        let exact = SOD.exact().unwrap();
        let left: f64 = 40_000.0 * 8.0 / 9.0 / (0.5 * SOD.width * SOD.width);
        let counted = (2.0 * 40_000.0 * 8.0 / 9.0 / BINS as f64).sqrt() * 4.0;
        let slice = |bin: usize| {
            let x = (bin as f64 + 0.5) / BINS as f64;
            let state = exact.at((x - 0.5) / SOD.end);
            let scatter = [state.density.sqrt() / counted, (state.pressure / state.density.powi(2)).sqrt() / counted];
            Slice { x, density: [0.0; 2], velocity: [0.0; 2], scatter }
        };
        let profile: Vec<Slice> = (0..BINS).map(slice).collect();
        let [density, velocity] = expected(&exact, SOD.end, OF_HALF_TURN, left.cbrt().recip(), &profile);
        assert!((density / 0.0125 - 1.0).abs() < 0.25, "{density}");
        assert!(velocity > 0.0235 && velocity < 1.5 * 0.0235, "{velocity}");
    }
}
