//! What the part that all subdomains of a device share is made from.

use crate::plan::Plan;

use super::cell_table::CellTable;
use super::constants::Patches;
use super::fabric::Fabric;
use super::layout::GpuZone;
use super::walls::Walls;

/// What a domain is made from.
pub struct DomainInput<'a> {
    pub plan: &'a Plan,
    pub walls: &'a Walls,
    /// The surfaces that deform.
    pub fabric: &'a Fabric,
    /// The gas of each cell, for collisions within cells.
    pub cells: &'a CellTable,
    /// Zone 0 is everything, then the chambers, then the probes.
    pub zones: &'a [GpuZone],
    /// What parts zones inside of closed fabric, numbered behind the zones.
    pub planes: &'a [GpuZone],
    pub patches: Patches,
    /// Entries of the table of vents.
    pub vent_entries: usize,
    /// Whether other subdomains own particles too.
    pub among_others: bool,
    pub kernels: KernelChoice,
}

/// Which kernels a domain has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KernelChoice {
    /// For what the scene has.
    Fitting,
    /// The same with all numbers of the scene compiled in.
    Fixed,
    /// For what the scene lacks too.
    AllFeatures,
}
