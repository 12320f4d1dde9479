//! Kinetic theory and thermodynamics on the host, f64 throughout.

/// One particle on the host, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Particle {
    /// Unique and dense: 0.. over the whole run, initial gas first, then inflow in order of entry.
    pub id: u32,
    /// Gas index.
    pub gas: u8,
    pub position: [f64; 3],
    pub velocity: [f64; 3],
    /// J, of the whole particle (a particle is `moles_per_particle` moles).
    pub spin_energy: f64,
}
