//! Orders in which the initial particles may come.

use std::hash::{DefaultHasher, Hash, Hasher};

use corpuscle::subdomain::GpuParticle;

/// An order of the particles that depends on `salt` in no regular way.
pub fn shuffled<const SALT: u64>(particles: &mut [GpuParticle]) {
    particles.sort_by_key(|particle| {
        let mut hasher = DefaultHasher::new();
        (SALT, particle.id()).hash(&mut hasher);
        hasher.finish()
    });
}

pub fn reversed(particles: &mut [GpuParticle]) {
    particles.reverse();
}

/// No other order: two of the particles fly along x so fast that they cross tens of cells in a step.
pub fn with_fast_ones(particles: &mut [GpuParticle]) {
    for particle in particles.iter_mut().filter(|particle| matches!(particle.id(), 700 | 1900)) {
        particle.velocity = [if particle.id() == 700 { 8e4 } else { -8e4 }, 0.0, 0.0];
    }
}
