//! The one table of random draws (docs/explanation/method.md, "Equal bits"): no two draws of a run share a key.
//!
//! Every draw is [`philox4x32_10`](super::philox4x32_10) of a counter under the key [`key`]`(seed, purpose)`
//! `= [seed bits 0..32, seed bits 32..56 << 8 | purpose]`. Counters by purpose:
//!
//! | purpose           | counter                                            | sampled by |
//! |-------------------|----------------------------------------------------|----------|
//! | `InitialPosition` | `[particle id, block, 0, 0]`                       | host     |
//! | `InitialState`    | `[particle id, block, 0, 0]`                       | host     |
//! | `Inflow`          | `[particle id, block, 0, 0]`                       | host     |
//! | `Collision`       | `[step, 2 round + block, lower id, higher id]`     | device   |
//! | `CellCollision`   | `[step, cell, 4 candidate + block, part]`           | device   |
//! | `RefinedPosition` | `[particle id, block, 0, 0]`                       | host     |
//! | `RefinedState`    | `[particle id, block, 0, 0]`                       | host     |
//! | `Wall`            | `[step, 32 hit + block, particle id, 0]`           | device   |
//!
//! `step` counts from the start of the run (32 bits). `block` counts the blocks of four words that one particle
//! or pair uses up, so the number of draws that a rejection method takes never shifts the draws of another.
//!
//! Candidates of a part of a cell count from 1; number 0 rounds how many there are.
//!
//! Host draws are f64 and go through crate `libm`: system mathematics libraries differ in the last bit.

use super::philox4x32_10;

/// What a draw is for; its number is part of the key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Purpose {
    InitialPosition = 1,
    InitialState = 2,
    Inflow = 3,
    /// Sampled on the device only: spin exchange and chirality of a pair.
    Collision = 4,
    /// Of the particles that a coarser state is split into; ids are those of the refined run.
    RefinedPosition = 5,
    RefinedState = 6,
    /// Sampled on the device only: whether a hit on a wall lets the particle out, and how it leaves the wall. `hit`
    /// counts those of the particle in the step, from 1.
    Wall = 7,
    /// Sampled on the device only: candidate pairs of a cell, and their collisions.
    CellCollision = 9,
}

/// The Philox key of a purpose; uses the lower 56 bits of the seed.
pub fn key(seed: u64, purpose: Purpose) -> [u32; 2] {
    [seed as u32, ((seed >> 32) as u32) << 8 | purpose as u32]
}

/// The successive draws of one particle for one purpose.
#[derive(Debug, Clone)]
pub struct Draws {
    key: [u32; 2],
    id: u32,
    block: u32,
    words: [u32; 4],
    /// Words of `words` already used, 4 when a new block is due.
    used: usize,
    spare_normal: Option<f64>,
}

impl Draws {
    pub fn new(seed: u64, purpose: Purpose, id: u32) -> Self {
        Self { key: key(seed, purpose), id, block: 0, words: [0; 4], used: 4, spare_normal: None }
    }

    /// Uniform in the open interval (0, 1): the odd multiples of 2^-53.
    pub fn uniform(&mut self) -> f64 {
        if self.used == 4 {
            self.words = philox4x32_10([self.id, self.block, 0, 0], self.key);
            self.block += 1;
            self.used = 0;
        }
        let bits = u64::from(self.words[self.used]) << 32 | u64::from(self.words[self.used + 1]);
        self.used += 2;
        ((bits >> 12) as f64 + 0.5) * (1.0 / (1u64 << 52) as f64)
    }

    /// Standard normal (Box and Muller 1958); the second of a pair is kept for the next call.
    pub fn normal(&mut self) -> f64 {
        if let Some(value) = self.spare_normal.take() {
            return value;
        }
        let radius = (-2.0 * libm::log(self.uniform())).sqrt();
        let angle = 2.0 * std::f64::consts::PI * self.uniform();
        self.spare_normal = Some(radius * libm::sin(angle));
        radius * libm::cos(angle)
    }

    /// Gamma variate of the given shape and unit scale; zero for shape 0 (Marsaglia and Tsang 2000, with
    /// their boost for shapes below one).
    pub fn gamma(&mut self, shape: f64) -> f64 {
        if shape <= 0.0 {
            return 0.0;
        }
        if shape < 1.0 {
            let boost = libm::pow(self.uniform(), 1.0 / shape);
            return self.gamma(shape + 1.0) * boost;
        }
        let d = shape - 1.0 / 3.0;
        let c = 1.0 / (9.0 * d).sqrt();
        loop {
            let x = self.normal();
            let root = 1.0 + c * x;
            if root <= 0.0 {
                continue;
            }
            let v = root * root * root;
            if libm::log(self.uniform()) < 0.5 * x * x + d - d * v + d * libm::log(v) {
                return d * v;
            }
        }
    }

    /// pdf ~ v exp(-(v - drift)^2 / 2) for v > 0, drift >= 0: the normal speed, in units of sqrt(kT/m), of
    /// the molecules that cross a plane out of a gas drifting through it.
    ///
    /// The density divided by that of a unit normal around its mode w = (drift + sqrt(drift^2 + 4))/2 is
    /// v/w exp(1 - v/w) <= 1 (since w - drift = 1/w), which is the probability of acceptance.
    pub fn drifting_flux_speed(&mut self, drift: f64) -> f64 {
        let mode = 0.5 * (drift + (drift * drift + 4.0).sqrt());
        loop {
            let speed = mode + self.normal();
            let ratio = speed / mode;
            if ratio > 0.0 && self.uniform() < ratio * libm::exp(1.0 - ratio) {
                return speed;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT: u32 = 200_000;
    const PURPOSES: [Purpose; 8] = [
        Purpose::InitialPosition,
        Purpose::InitialState,
        Purpose::Inflow,
        Purpose::Collision,
        Purpose::RefinedPosition,
        Purpose::RefinedState,
        Purpose::Wall,
        Purpose::CellCollision,
    ];

    /// Mean and second moment over `COUNT` particles, one draw each, with the standard errors of both.
    fn moments(draw: impl Fn(&mut Draws) -> f64) -> [[f64; 2]; 2] {
        let mut sum = [0.0; 4];
        for id in 0..COUNT {
            let value = draw(&mut Draws::new(7, Purpose::InitialState, id));
            for (power, sum) in (1..).zip(&mut sum) {
                *sum += value.powi(power) / f64::from(COUNT);
            }
        }
        let error = |mean: f64, square: f64| ((square - mean * mean) / f64::from(COUNT)).sqrt();
        [[sum[0], error(sum[0], sum[1])], [sum[1], error(sum[1], sum[3])]]
    }

    fn agree(moments: [[f64; 2]; 2], expected: [f64; 2]) -> bool {
        moments.iter().zip(expected).all(|([value, error], expected)| (value - expected).abs() < 4.5 * error)
    }

    #[test]
    fn uniforms_have_the_moments_of_the_unit_interval() {
        let found = moments(Draws::uniform);
        assert!(agree(found, [0.5, 1.0 / 3.0]), "{found:?}");
        assert!(!agree(found, [0.505, 1.0 / 3.0]), "the check must see one per cent");
    }

    #[test]
    fn normals_have_zero_mean_and_unit_variance() {
        assert!(agree(moments(Draws::normal), [0.0, 1.0]));
        let second = moments(|draws| {
            draws.normal();
            draws.normal()
        });
        assert!(agree(second, [0.0, 1.0]));
        assert!(!agree(second, [0.0, 1.02]));
    }

    #[test]
    fn gamma_has_mean_a_and_second_moment_a_a_plus_one() {
        for shape in [0.05, 0.5, 1.0, 1.5, 2.5, 12.0] {
            let found = moments(|draws| draws.gamma(shape));
            assert!(agree(found, [shape, shape * (shape + 1.0)]), "shape {shape}: {found:?}");
        }
        assert!(!agree(moments(|draws| draws.gamma(1.5)), [1.52, 3.8]));
        assert_eq!(Draws::new(1, Purpose::Inflow, 0).gamma(0.0), 0.0);
    }

    /// Flux Maxwellian at rest: <v> = sqrt(pi/2), <v^2> = 2. With drift s: moments by quadrature.
    #[test]
    fn flux_speeds_follow_their_density() {
        let rest = moments(|draws| draws.drifting_flux_speed(0.0));
        assert!(agree(rest, [(std::f64::consts::PI / 2.0).sqrt(), 2.0]), "{rest:?}");
        for drift in [0.7, 3.0] {
            let integral = |power: i32| -> f64 {
                let step = 1e-4;
                (1..150_000)
                    .map(|i| f64::from(i) * step)
                    .map(|v| v.powi(power) * (-0.5 * (v - drift) * (v - drift)).exp())
                    .sum()
            };
            let expected = [integral(2) / integral(1), integral(3) / integral(1)];
            let found = moments(|draws| draws.drifting_flux_speed(drift));
            assert!(agree(found, expected), "drift {drift}: {found:?} {expected:?}");
            assert!(!agree(rest, expected));
        }
    }

    #[test]
    fn no_two_draws_share_a_key() {
        let mut seen = std::collections::BTreeSet::new();
        for seed in [0, 1, 1 << 32, (1 << 56) - 1] {
            for purpose in PURPOSES {
                for id in [0, 1, u32::MAX] {
                    let mut draws = Draws::new(seed, purpose, id);
                    for _ in 0..8 {
                        let value = draws.uniform();
                        assert!(value > 0.0 && value < 1.0);
                        assert!(seen.insert(value.to_bits()));
                    }
                }
            }
        }
        // The check can fail: the same three arguments give the same draws.
        assert!(!seen.insert(Draws::new(0, Purpose::Inflow, 0).uniform().to_bits()));
    }
}
