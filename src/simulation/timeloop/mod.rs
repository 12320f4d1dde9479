//! The run of a rank: set-up, steps in intervals, what is read of them late, rows, snapshots and checkpoints.

pub(super) mod collect;
pub(super) mod elastic_fabric;
pub(super) mod handover;
pub(super) mod host_setup;
pub(super) mod inspect;
pub(super) mod interrupt;
pub(super) mod meter;
pub(super) mod observer;
pub(super) mod run;
pub(super) mod schedule;
pub(super) mod setup;
pub(super) mod simulation;
pub(super) mod snapshots;
pub(super) mod step;
pub(super) mod submit;
