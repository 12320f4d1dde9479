//! A box of cells of the global grid.

use serde::{Deserialize, Serialize};

use super::PartitionError;

/// The cells c with low <= c < high on each axis.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct CellBox {
    pub low: [u32; 3],
    pub high: [u32; 3],
}

impl CellBox {
    pub fn contains(&self, cell: [u32; 3]) -> bool {
        (0..3).all(|axis| self.low[axis] <= cell[axis] && cell[axis] < self.high[axis])
    }

    /// The number of cells; saturates where 64 bits do not hold it.
    pub fn cells(&self) -> u64 {
        (0..3).fold(1, |product: u64, axis| product.saturating_mul(self.length(axis).into()))
    }

    /// The number of cells along an axis.
    pub fn length(&self, axis: usize) -> u32 {
        self.high[axis].saturating_sub(self.low[axis])
    }

    /// The number of cells in a plane across an axis; saturates like [`CellBox::cells`].
    pub fn plane_cells(&self, axis: usize) -> u64 {
        u64::from(self.length((axis + 1) % 3)).saturating_mul(self.length((axis + 2) % 3).into())
    }

    /// The axis with the most cells, the first of equals.
    pub fn longest_axis(&self) -> usize {
        (0..3).rev().max_by_key(|&axis| self.length(axis)).unwrap_or(0)
    }

    pub fn intersects(&self, other: &CellBox) -> bool {
        (0..3).all(|axis| self.low[axis].max(other.low[axis]) < self.high[axis].min(other.high[axis]))
    }

    /// How many layers of cells lie between two boxes, on the axis where that is most: 0 if they overlap or touch, be
    /// it at a corner. So some cell of one is within n cells (Chebyshev distance) of the other exactly if gap < n.
    pub fn gap(&self, other: &CellBox) -> u32 {
        let between = |axis: usize| {
            let (from, to) = (self.high[axis].min(other.high[axis]), self.low[axis].max(other.low[axis]));
            to.saturating_sub(from)
        };
        between(0).max(between(1)).max(between(2))
    }

    /// The boxes below and above a plane: cells with c[axis] < plane, and the others.
    pub fn split(&self, axis: usize, plane: u32) -> (CellBox, CellBox) {
        let (mut below, mut above) = (*self, *self);
        below.high[axis] = plane;
        above.low[axis] = plane;
        (below, above)
    }

    pub(super) fn check(&self) -> Result<(), PartitionError> {
        if (0..3).all(|axis| self.low[axis] < self.high[axis]) {
            return Ok(());
        }
        Err(PartitionError::EmptyBox { low: self.low, high: self.high })
    }
}
