//! How much the runs of a map take.

/// How much a map takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// Two values of each axis, known badly: to see that it works.
    Quick,
    /// What `docs/reference/limits.md` is made with.
    Usual,
    /// More values, more particles.
    Full,
}

/// Rounds of the runs, where the axis is another: the default of plans.
pub(crate) const ROUNDS: u32 = 8;
