//! Means with their standard errors.

#[allow(unused_imports, reason = "for the tests that need them")]
pub use corpuscle::study::verify::statistics::*;
