//! What a device alone needs for a plan: the sizes of the buffers that grow with the particles and with the cells.

use crate::plan::Plan;
use crate::scene::Method;

use super::buffers::{bytes_per_bin, bytes_per_particle};
use super::layout::GpuStillGas;

/// Bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Memory {
    /// Of each particle, with room for neighbour lists as most gas wants it.
    pub per_particle: f64,
    /// Of each cell of the grid: that of the sort, that of the walls, and its volume for collisions within it.
    pub per_cell: f64,
    /// Were all particles there at once that ever enter.
    pub all: f64,
}

/// Its class, and its share of how many cells before sixteen are near walls; whether a wall may part the gas there: bytes of a cell
/// (`DomainBuffers`). Eight more of each cell near walls, their lists and sets of planes are not counted.
const WALLS_OF_A_CELL: f64 = 8.0 / 16.0 + 1.0 / 8.0;
/// What walls at rest leave of it, and its place in the list of those that moving walls touch.
const MOVED_OF_A_CELL: f64 = size_of::<GpuStillGas>() as f64 + 4.0;

impl Memory {
    /// Perhaps with walls that move; `None` of a plan that no device runs.
    pub fn of(plan: &Plan, moving: bool) -> Option<Memory> {
        if plan.method == Method::ControlVolume {
            return None;
        }
        let collisions = plan.method != Method::None;
        let per_particle = bytes_per_particle(collisions, plan.method.has_rounds());
        let sort = if collisions { bytes_per_bin() } else { 0.0 };
        let volume = match plan.method {
            Method::Cell if moving => 4.0 + MOVED_OF_A_CELL,
            Method::Cell => 4.0,
            _ => 0.0,
        };
        let per_cell = sort + volume + WALLS_OF_A_CELL;
        let cells = plan.grid.cell_count() as f64;
        Some(Memory { per_particle, per_cell, all: plan.particles as f64 * per_particle + cells * per_cell })
    }
}
