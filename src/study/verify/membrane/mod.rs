//! Membranes alone, without gas: on the device, as a run moves them.
//!
//! The fabric is that of airbags, but where the literature has another. Shapes at rest are found by kinetic damping: all nodes stop
//! wherever the energy of motion has passed a peak.

pub mod moving;
pub mod shapes;
pub mod sheet;
pub mod stretched;
