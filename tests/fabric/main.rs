//! Gas beside fabric whose nodes are told where to be: nothing passes it, and what it does to the gas is in the account.

#[path = "../whole_run/mod.rs"]
#[allow(dead_code, reason = "its scenes are all in files of their own")]
mod whole_run;

mod bags;
mod driven;
mod elastic;
mod fields;
mod flat;
mod neighbours;
mod open_sheets;
mod paddle;
mod parts;
mod refused;
mod scenes;
mod sheets;
mod vents;
mod walls;
