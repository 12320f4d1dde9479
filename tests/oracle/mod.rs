//! A small independent reference of the corpuscular method in f64 and plain loops, for tests only.
//!
//! It follows docs/explanation/method.md and takes no code from `src`. Test binaries include it
//! with `#[path = "../oracle/mod.rs"] mod oracle;` and each uses its own part.

pub mod cells;
pub mod collision;
pub mod half_turn;
pub mod pairing;
pub mod random;
pub mod simulation;
pub mod vector;
pub mod walls;
