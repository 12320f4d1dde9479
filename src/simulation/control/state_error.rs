//! Why the state of a run cannot be taken up.

use crate::gas::InflowStateError;

/// Why a state cannot be taken up.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RunStateError {
    #[error("the state is of another run: it has {found} {what}, the plan has {expected}")]
    Differs { what: &'static str, found: u64, expected: u64 },
    #[error("the state is of no run: {what}")]
    Impossible { what: &'static str },
    #[error("the state is of another run: {0}")]
    Inflow(#[from] InflowStateError),
}

impl RunStateError {
    pub fn differs(what: &'static str, found: impl Into<u64>, expected: impl Into<u64>) -> RunStateError {
        RunStateError::Differs { what, found: found.into(), expected: expected.into() }
    }
}
