//! An interval whose tallies are taken in.

use crate::subdomain::GpuVent;

/// When and how an interval was tallied.
#[derive(Debug, Clone, Copy)]
pub struct Window<'a> {
    /// Its start and end, s.
    pub span: [f64; 2],
    pub samples: u32,
    /// The mean ones of the chambers where walls move, m3.
    pub volumes: &'a [f64],
    /// What the device had of the vents.
    pub vents: &'a [GpuVent],
    /// Where the nodes of fabric are at its end, m; not asked for where no vent is on fabric.
    pub nodes: &'a [[f64; 3]],
}
