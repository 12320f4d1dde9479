//! What the user asked for: a TOML file becomes a validated [`Scene`] in SI units.

mod types;

pub use types::*;
