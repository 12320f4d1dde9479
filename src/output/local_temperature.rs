//! The temperature of the gas about each particle.
//!
//! A particle alone has none. All particles are of equally many moles, so that N of them with molar masses M and velocities
//! v have the translational temperature T = sum M (v - V)^2 / (3 R (N - 1)), V the velocity of their mass. They are those of
//! the smallest cube about the particle, of cubes that halve each other, with at least [`LEAST`] of them; T scatters by
//! sqrt(2 / (3 N)), a tenth.

/// Particles of a cube.
const LEAST: usize = 64;
/// Halvings of the cube around all of them.
const DEEPEST: u32 = 6;
/// J/(mol K).
const GAS_CONSTANT: f64 = 8.314_462_618_153_24;

/// What a cube's particles add up to.
#[derive(Clone, Copy, Default)]
struct Sums {
    count: f64,
    mass: f64,
    momentum: [f64; 3],
    /// Mass times square of the velocity.
    energy: f64,
}

impl Sums {
    fn temperature(&self) -> f64 {
        let square: f64 = self.momentum.iter().map(|momentum| momentum * momentum).sum();
        let thermal = (self.energy - square / self.mass).max(0.0);
        thermal / (3.0 * GAS_CONSTANT * (self.count - 1.0).max(1.0))
    }
}

/// K, of each particle: place (m), velocity (m/s) and molar mass (kg/mol).
pub fn local_temperatures(particles: &[([f64; 3], [f32; 3], f64)]) -> Vec<f64> {
    let far = [f64::INFINITY; 3];
    let (low, high) = particles.iter().fold((far, far.map(|x| -x)), |(low, high), (place, ..)| {
        let at = |k: usize| (low[k].min(place[k]), high[k].max(place[k]));
        (std::array::from_fn(|k| at(k).0), std::array::from_fn(|k| at(k).1))
    });
    let edge = (0..3).map(|k| high[k] - low[k]).fold(f64::MIN_POSITIVE, f64::max);
    let mut temperatures = vec![0.0; particles.len()];
    let mut open: Vec<usize> = (0..particles.len()).collect();
    for halvings in (0..=DEEPEST).rev() {
        let across = 1usize << halvings;
        let cube = |place: &[f64; 3]| {
            let at = |k: usize| (((place[k] - low[k]) / edge * across as f64) as usize).min(across - 1);
            (at(2) * across + at(1)) * across + at(0)
        };
        let mut cubes = vec![Sums::default(); across.pow(3)];
        for (place, velocity, mass) in particles {
            let velocity = velocity.map(f64::from);
            let sums = &mut cubes[cube(place)];
            sums.count += 1.0;
            sums.mass += mass;
            sums.momentum = std::array::from_fn(|k| sums.momentum[k] + mass * velocity[k]);
            sums.energy += mass * velocity.iter().map(|part| part * part).sum::<f64>();
        }
        open.retain(|&particle| {
            let sums = &cubes[cube(&particles[particle].0)];
            let enough = sums.count >= LEAST as f64 || halvings == 0;
            if enough {
                temperatures[particle] = sums.temperature();
            }
            !enough
        });
    }
    temperatures
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A gas in two halves: 300 K at rest, and 900 K with a wind of 200 m/s; each particle of a grid has one of six velocities
    /// along the axes whose squares are as large as those of the gas.
    #[test]
    fn each_half_has_its_temperature() {
        const MOLAR_MASS: f64 = 0.028;
        let side = 24;
        let mut particles = Vec::new();
        for k in 0..side * side * side {
            let place = [k % side, k / side % side, k / side / side].map(|i| (f64::from(i) + 0.5) / f64::from(side));
            let (kelvin, wind) = if place[0] < 0.5 { (300.0, 0.0) } else { (900.0, 200.0) };
            let speed = (3.0 * GAS_CONSTANT * kelvin / MOLAR_MASS).sqrt();
            let mut velocity = [0.0; 3];
            let turn = k * 7 % 6;
            velocity[(turn / 2) as usize] = if turn % 2 == 0 { speed as f32 } else { -speed as f32 };
            velocity[0] += wind as f32;
            particles.push((place, velocity, MOLAR_MASS));
        }
        let found = local_temperatures(&particles);
        for ((place, ..), kelvin) in particles.iter().zip(&found) {
            let expected = if place[0] < 0.5 { 300.0 } else { 900.0 };
            assert!((kelvin / expected - 1.0).abs() < 0.1, "{place:?}: {kelvin}");
        }
        assert!(local_temperatures(&[]).is_empty());
        assert_eq!(local_temperatures(&[([0.0; 3], [5.0; 3], 0.028)]), [0.0]);
    }
}
