//! The ranks of a run: its first particles, who has which cells, what they send to each other, and the balance of their work.

pub(super) mod balance;
pub(super) mod decomposition;
pub(super) mod exchange;
pub(super) mod halo_tuner;
pub(super) mod initial_particles;
pub(super) mod load;
