//! Corpuscle: the corpuscular particle method for gas in tanks and airbags, on GPUs.
//!
//! `ARCHITECTURE.md` maps the folders; each module's head says what it is for.

pub mod cli;
pub mod fabric;
pub mod gas;
pub mod geometry;
pub mod gpu;
pub mod output;
pub mod partition;
pub mod plan;
pub mod ranks;
pub mod scene;
pub mod simulation;
pub mod study;
pub mod subdomain;
