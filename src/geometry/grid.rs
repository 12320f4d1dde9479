//! The one global cell grid and the fixed-point positions that live on it (docs/explanation/method.md, "Equal bits").
//!
//! A position is three u32, in quanta of `cell / 2^cell_bits` from `origin`, the same on every axis.
//! The cell of a position is `position >> cell_bits`: integer arithmetic, equal on every device.
//! All positions lie below 2^31, so that differences fit an i32. The outermost layer of cells on every
//! side holds no gas, so that a search of 27 cells needs no bounds checks.

#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Grid {
    /// m, the corner of cell (0, 0, 0).
    pub origin: [f64; 3],
    /// Edge of a cell, m.
    pub cell: f64,
    /// Cells per axis, border layer included.
    pub cells: [u32; 3],
    pub cell_bits: u32,
}

#[derive(Debug, Clone, thiserror::Error, PartialEq)]
pub enum GridError {
    #[error("the cell edge must be positive and finite, found {0} m")]
    CellSize(f64),
    #[error(
        "the walls span {cells} cells of {cell:.3e} m along one axis; at most {limit} fit a 32-bit position with the required resolution"
    )]
    TooManyCells { cells: f64, cell: f64, limit: u32 },
}

impl Grid {
    /// The largest number of cells per axis: leaves 2^16 quanta per cell.
    pub const MAX_CELLS: u32 = 1 << 15;

    /// The grid of cells of edge `cell` (m) around the box `min`..`max` (m), with one border layer.
    pub fn around(min: [f64; 3], max: [f64; 3], cell: f64) -> Result<Grid, GridError> {
        if !(cell.is_finite() && cell > 0.0) {
            return Err(GridError::CellSize(cell));
        }
        let mut cells = [0u32; 3];
        let mut origin = [0.0; 3];
        for axis in 0..3 {
            let extent = max[axis] - min[axis];
            // Gas may touch the faces of the box: half a cell of slack on either side keeps it off the border layer.
            let inner = (extent / cell).floor() + 1.0;
            if !(inner.is_finite() && inner + 2.0 <= f64::from(Self::MAX_CELLS)) {
                return Err(GridError::TooManyCells { cells: inner, cell, limit: Self::MAX_CELLS - 2 });
            }
            cells[axis] = inner as u32 + 2;
            origin[axis] = min[axis] - 0.5 * (f64::from(cells[axis]) * cell - extent);
        }
        let most = cells.iter().copied().max().unwrap_or(3);
        let index_bits = 32 - (most - 1).leading_zeros();
        Ok(Grid { origin, cell, cells, cell_bits: 31 - index_bits })
    }

    /// Metres per quantum.
    pub fn quantum(&self) -> f64 {
        self.cell / f64::from(1u32 << self.cell_bits)
    }

    pub fn cell_count(&self) -> usize {
        self.cells.iter().map(|&n| n as usize).product()
    }

    /// The nearest fixed-point position, or `None` outside the grid.
    pub fn to_fixed(&self, position: [f64; 3]) -> Option<[u32; 3]> {
        let mut fixed = [0; 3];
        for axis in 0..3 {
            let quanta = ((position[axis] - self.origin[axis]) / self.quantum()).round();
            let limit = f64::from(self.cells[axis]) * f64::from(1u32 << self.cell_bits);
            if !(quanta >= 0.0 && quanta < limit) {
                return None;
            }
            fixed[axis] = quanta as u32;
        }
        Some(fixed)
    }

    pub fn to_metres(&self, fixed: [u32; 3]) -> [f64; 3] {
        let quantum = self.quantum();
        std::array::from_fn(|axis| self.origin[axis] + f64::from(fixed[axis]) * quantum)
    }

    /// x fastest: the three cells of an x-row are neighbours in memory.
    pub fn cell_index(&self, cell: [u32; 3]) -> usize {
        (cell[2] as usize * self.cells[1] as usize + cell[1] as usize) * self.cells[0] as usize + cell[0] as usize
    }

    /// Blocks of 2^`log2_cells` cells per axis; the last of an axis may reach beyond the grid.
    pub fn blocks(&self, log2_cells: u32) -> [u32; 3] {
        self.cells.map(|n| n.div_ceil(1 << log2_cells))
    }

    pub fn cell_of(&self, fixed: [u32; 3]) -> [u32; 3] {
        fixed.map(|p| p >> self.cell_bits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn positions_in_the_box_round_to_half_a_quantum_and_stay_off_the_border(
            min in prop::array::uniform3(-1e3..1e3f64),
            size in prop::array::uniform3(0.0..2.0f64),
            cell in 0.01..0.5f64,
            at in prop::array::uniform3(0.0..=1.0f64),
        ) {
            let max = std::array::from_fn(|a| min[a] + size[a]);
            let grid = Grid::around(min, max, cell).unwrap();
            let position: [f64; 3] = std::array::from_fn(|a| min[a] + at[a] * size[a]);
            let fixed = grid.to_fixed(position).unwrap();
            let back = grid.to_metres(fixed);
            for a in 0..3 {
                // Rounding of f64 at 1e3 m is some 1e-13 m.
                prop_assert!((back[a] - position[a]).abs() <= 0.5 * grid.quantum() + 1e-12);
                let index = grid.cell_of(fixed)[a];
                prop_assert!(fixed[a] < 1 << 31 && index > 0 && index < grid.cells[a] - 1);
                prop_assert_eq!(grid.blocks(2)[a], grid.cells[a].div_ceil(4));
            }
            prop_assert!(grid.to_fixed([f64::NAN, back[1], back[2]]).is_none());
            prop_assert!(grid.to_fixed(max.map(|m| m + 3.0 * cell)).is_none());
        }
    }

    #[test]
    fn cells_that_cannot_be_are_refused() {
        assert_eq!(Grid::around([0.0; 3], [1.0; 3], 0.0), Err(GridError::CellSize(0.0)));
        assert!(matches!(Grid::around([0.0; 3], [1.0; 3], 1e-5), Err(GridError::TooManyCells { .. })));
    }
}
