//! What the prototype of `half-turn` found in Sod's tube.

/// Particles, seeds, and mean |difference| of density and velocity: the mean of single runs, and of the mean over the seeds.
pub type Row = (u64, u64, [[f64; 2]; 2]);
pub const TUBES: [Row; 4] = [
    (10_000, 32, [[0.0364, 0.075], [0.0185, 0.033]]),
    (20_000, 8, [[0.0255, 0.054], [0.0158, 0.030]]),
    (40_000, 16, [[0.0199, 0.041], [0.0125, 0.0235]]),
    (160_000, 4, [[0.0131, 0.0255], [0.0104, 0.021]]),
];

/// The figures of single runs with so many particles.
pub fn single(particles: u64) -> Option<[f64; 2]> {
    TUBES.iter().find(|row| row.0 == particles).map(|row| row.2[0])
}
