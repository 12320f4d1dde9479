//! What a run has done: averages and rows, the audit, guards, when vents open.

pub(super) mod audit;
pub(super) mod averages;
pub(super) mod guards;
pub(super) mod lists;
pub(super) mod phases;
pub(super) mod row;
pub(super) mod vent_watch;
