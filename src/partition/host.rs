//! Bisection on one host, from cells and their weights: for tests, first decompositions and emulation.

use super::tree::leaf;
use super::{Bisection, CellBox, Node, PartitionError, TOLERANCE, Tree};

/// The tree for the weights of `points`, cells with a weight each; a cell may come several times.
pub fn bisect(
    root: CellBox,
    shares: &[f64],
    previous: Option<&Tree>,
    points: impl Iterator<Item = ([u32; 3], u64)> + Clone,
) -> Result<Tree, PartitionError> {
    if let Some((cell, _)) = points.clone().find(|(cell, _)| !root.contains(*cell)) {
        return Err(PartitionError::Outside { cell, low: root.low, high: root.high });
    }
    let mut bisection = Bisection::new(root, shares, previous, TOLERANCE)?;
    while !bisection.wanted().is_empty() {
        let mut histogram = vec![0_u64; bisection.planes()];
        for (cell, weight) in points.clone() {
            if let Node::Open(slice) = bisection.partial_tree()[leaf(bisection.partial_tree(), cell)] {
                let slice = bisection.wanted()[slice];
                let plane = &mut histogram[slice.offset + (cell[slice.axis] - slice.extent.low[slice.axis]) as usize];
                *plane = plane.checked_add(weight).ok_or(PartitionError::Overflow)?;
            }
        }
        bisection.cut(&histogram)?;
    }
    bisection.finish()
}

/// The weight that changes its part: what a rebalance from one tree to the other sends.
pub fn moved(old: &Tree, new: &Tree, points: impl Iterator<Item = ([u32; 3], u64)>) -> u64 {
    points.filter(|(cell, _)| old.part_of(*cell) != new.part_of(*cell)).map(|(_, weight)| weight).sum()
}
