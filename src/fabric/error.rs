//! What a membrane cannot be made from.

use crate::gpu::GpuError;

#[derive(Debug, thiserror::Error)]
pub enum MembraneError {
    #[error("{what}: found {found}, expected {expected}")]
    Number { what: String, found: String, expected: &'static str },
    #[error("node {node} at {place:?} m lies outside the grid")]
    Outside { node: usize, place: [f64; 3] },
    #[error("node {node} is free and has no mass: no triangle has it, and no mass was added")]
    NoMass { node: usize },
    #[error("triangle {triangle} names node {node}, of {nodes}")]
    NoNode { triangle: usize, node: u32, nodes: usize },
    #[error("triangle {triangle} names material {material}, of {materials}")]
    NoMaterial { triangle: usize, material: usize, materials: usize },
    #[error("there are {found} {what}, expected {expected}")]
    Count { what: &'static str, found: usize, expected: usize },
    #[error("a state of {found} nodes is none of this membrane of {expected}")]
    State { found: usize, expected: usize },
    #[error(transparent)]
    Device(#[from] GpuError),
}

/// A number that must hold.
pub(super) fn check(
    holds: bool,
    what: impl FnOnce() -> String,
    found: f64,
    expected: &'static str,
) -> Result<(), MembraneError> {
    if holds { Ok(()) } else { Err(MembraneError::Number { what: what(), found: found.to_string(), expected }) }
}
