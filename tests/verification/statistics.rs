//! Means with their standard errors.

pub use corpuscle::study::verify::statistics::*;
