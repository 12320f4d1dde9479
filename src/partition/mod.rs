//! Which subdomain owns which cells: recursive coordinate bisection of the one global cell grid, what work
//! costs where, and when it pays to cut anew.
//!
//! - [`Bisection`] finds a [`Tree`] of cuts from histograms of the work per plane of cells, level by level; who sums
//!   the histograms (devices and ranks, [`bisect_shared`], or [`bisect`] on one host) is not its concern. No particle is gathered.
//! - [`CostModel`] turns measured device seconds into weights of the work and into the devices' shares.
//! - [`Trigger`] decides whether a rebalance pays.
//!
//! Everything here is a function of its inputs alone, in integers wherever a cut depends on it: ranks that hold the
//! same sums hold the same tree. No device, no messages, no physics.
//!
//! Source: M. J. Berger, S. H. Bokhari, A partitioning strategy for nonuniform problems on multiprocessors, IEEE
//! Trans. Comput. C-36 (1987) 570.

mod bisection;
mod cell_box;
mod cost;
mod host;
mod tree;
mod trend;
mod trigger;

pub use bisection::{Bisection, Slice};
pub use cell_box::CellBox;
pub use cost::{By, CostModel, IntegerWeights, Measurement, Work};
pub use host::{bisect, bisect_shared, decompose, moved};
pub use tree::{Node, Tree};
pub use trigger::{Decision, Trigger};

/// How much a kept cut may add to a part's weight over its target, in all levels together: a per cent, well under the
/// trigger's threshold and above what noise in the sums moves.
pub const TOLERANCE: f64 = 0.01;

/// Why there is no partition.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum PartitionError {
    #[error("a partition needs at least one part; no shares were given")]
    NoParts,
    #[error("the share of part {part} is {share}; a share is a positive number")]
    Share { part: usize, share: f64 },
    #[error("the tolerance of kept cuts is {0}; expected a number from 0 to 1")]
    Tolerance(f64),
    #[error("the grid has {cells} cells, too few for {parts} parts: each needs one; use fewer subdomains")]
    TooManyParts { parts: usize, cells: u64 },
    #[error("the cell box from {low:?} to {high:?} is empty: each low must be below its high")]
    EmptyBox { low: [u32; 3], high: [u32; 3] },
    #[error("the histogram has {found} planes; the open boxes have {expected}")]
    Histogram { found: usize, expected: usize },
    #[error("the weights of a box add up to more than 64 bits hold; scale them down")]
    Overflow,
    #[error("cell {cell:?} is outside the grid, {low:?} to {high:?}")]
    Outside { cell: [u32; 3], low: [u32; 3], high: [u32; 3] },
    #[error("the tree of cuts is malformed at node {node}: {fault}")]
    Tree { node: usize, fault: &'static str },
    #[error("the bisection is not finished: {open} boxes are yet to be cut")]
    Unfinished { open: usize },
}
