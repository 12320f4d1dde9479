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
