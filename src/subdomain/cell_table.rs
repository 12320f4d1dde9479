//! The gas of the cells as the device sees it (`shaders/shared/cell_gas.wgsl`).

use crate::geometry::{CellGas, Grid};

use super::layout::{GpuPart, GpuStillGas};

/// The mark of a cell that walls part; below it the number of its parts (7 bits) and the first of them (24).
const DIVIDED: u32 = 1 << 31;
const MOST_PARTS: usize = 127;
const MOST_ENTRIES: usize = 1 << 24;

#[derive(Debug, Clone, PartialEq, Default)]
pub struct CellTable {
    pub volume: Vec<u32>,
    pub parts: Vec<GpuPart>,
    /// Cells that walls part.
    pub divided: u64,
    /// Of each cell what walls at rest leave where moving walls may come; empty where none moves.
    pub still: Vec<GpuStillGas>,
}

#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "walls part the gas of {cells} cells, more than the {limit} parts that a cell can name; take larger cells (fewer `particles`) or the method `closest-approach`"
)]
pub struct TooManyParts {
    cells: usize,
    limit: usize,
}

impl CellTable {
    /// # Errors
    /// If walls part more cells than can be named.
    pub fn new(gas: &CellGas, grid: &Grid) -> Result<CellTable, TooManyParts> {
        let mut table = CellTable { divided: gas.divided.len() as u64, ..CellTable::default() };
        table.volume = gas.volume.iter().map(|&volume| (volume as f32).to_bits()).collect();
        for (cell, parts) in &gas.divided {
            let count = parts.len().min(MOST_PARTS);
            if table.parts.len() + count > MOST_ENTRIES {
                return Err(TooManyParts { cells: gas.divided.len(), limit: MOST_ENTRIES });
            }
            table.volume[*cell] = DIVIDED | (count as u32) << 24 | table.parts.len() as u32;
            // A point of a cell of the grid is on the grid.
            table.parts.extend(parts[..count].iter().map(|part| GpuPart {
                place: grid.to_fixed(part.place).unwrap_or_default(),
                volume: part.volume as f32,
            }));
        }
        Ok(table)
    }

    /// For walls that move: `points` are those of `geometry::still_points`.
    pub fn moving(self, gas: &CellGas, points: &[[u32; 3]]) -> CellTable {
        let still = |(&points, &volume): (&[u32; 3], &f64)| GpuStillGas { points, volume: volume as f32 };
        CellTable { still: points.iter().zip(&gas.volume).map(still).collect(), ..self }
    }
}
