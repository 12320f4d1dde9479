//! What a refinement did.

/// What a refinement did.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RefineReport {
    /// s.
    pub time: f64,
    pub parents: u64,
    pub particles: u64,
    /// Children more and less than `times` the parents, summed over the gases.
    pub added: u64,
    pub dropped: u64,
    /// Groups of neighbours that keep their momentum and energy.
    pub groups: u64,
    /// Children that found no place around their parent and stay at its own.
    pub at_parent: u64,
    /// The worst group's, after rounding to what is stored: of momentum over sqrt(2 mass energy), and of energy.
    pub momentum_error: f64,
    pub energy_error: f64,
}
