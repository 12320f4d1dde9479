//! The binary tree of cuts: which part owns a cell.
//!
//! Invariants, checked by [`Tree::new`]: node 0 is the root; a child stands behind its parent; every node but the root
//! is the child of one; a cut lies inside its box, so no box is empty; the parts are the leaves, 0, 1, 2, ... from the
//! low side to the high. So the boxes of the parts tile the root.

use serde::{Deserialize, Serialize};

use super::{CellBox, PartitionError};

#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub enum Node {
    /// Cells with c[axis] < plane are below node `low`, the others below node `high`.
    Cut { axis: usize, plane: u32, low: usize, high: usize },
    /// A leaf: the cells of this part.
    Part(usize),
    /// A leaf of an unfinished tree: the slice of [`super::Bisection::wanted`] with this index. In no [`Tree`].
    Open(usize),
}

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(try_from = "Cuts", into = "Cuts")]
pub struct Tree {
    nodes: Vec<Node>,
    root: CellBox,
    boxes: Vec<CellBox>,
}

impl Tree {
    pub fn new(root: CellBox, nodes: Vec<Node>) -> Result<Tree, PartitionError> {
        root.check()?;
        let fault = |node, fault| PartitionError::Tree { node, fault };
        let (mut visited, mut boxes) = (0, Vec::new());
        // As children stand behind their parents, the walk ends; a node with two parents would be visited twice.
        let mut stack = vec![(0, root)];
        while let Some((at, extent)) = stack.pop() {
            visited += 1;
            match *nodes.get(at).ok_or(fault(at, "there is no such node"))? {
                _ if visited > nodes.len() => return Err(fault(at, "it is the child of two")),
                Node::Open(_) => return Err(fault(at, "its box is not cut yet")),
                Node::Part(part) if part != boxes.len() => return Err(fault(at, "its part is out of order")),
                Node::Part(_) => boxes.push(extent),
                Node::Cut { axis, plane, low, high } => {
                    if axis > 2 {
                        return Err(fault(at, "its axis is none of 0, 1, 2"));
                    }
                    if plane <= extent.low[axis] || extent.high[axis] <= plane {
                        return Err(fault(at, "its plane is not inside its box"));
                    }
                    if low <= at || high <= at || low == high {
                        return Err(fault(at, "its children must be two nodes behind it"));
                    }
                    let (below, above) = extent.split(axis, plane);
                    stack.extend([(high, above), (low, below)]);
                }
            }
        }
        if visited < nodes.len() {
            return Err(fault(visited, "there are more nodes than the cuts reach"));
        }
        Ok(Tree { nodes, root, boxes })
    }

    /// A single part that owns everything.
    pub fn whole(root: CellBox) -> Result<Tree, PartitionError> {
        Tree::new(root, vec![Node::Part(0)])
    }

    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    pub fn root(&self) -> CellBox {
        self.root
    }

    /// The box of each part.
    pub fn boxes(&self) -> &[CellBox] {
        &self.boxes
    }

    pub fn parts(&self) -> usize {
        self.boxes.len()
    }

    /// The part that owns a cell; of a cell outside the root, the part that the cuts would give it to.
    pub fn part_of(&self, cell: [u32; 3]) -> usize {
        let mut at = 0;
        loop {
            match self.nodes[at] {
                Node::Cut { axis, plane, low, high } => at = if cell[axis] < plane { low } else { high },
                Node::Part(part) | Node::Open(part) => return part,
            }
        }
    }

    /// The number of parts below each node.
    pub(super) fn parts_below(&self) -> Vec<usize> {
        let mut below = vec![1; self.nodes.len()];
        for (at, node) in self.nodes.iter().enumerate().rev() {
            if let Node::Cut { low, high, .. } = *node {
                below[at] = below[low] + below[high];
            }
        }
        below
    }
}

/// What is stored of a tree; it is checked again when it is read.
#[derive(Serialize, Deserialize)]
struct Cuts {
    root: CellBox,
    nodes: Vec<Node>,
}

impl From<Tree> for Cuts {
    fn from(tree: Tree) -> Cuts {
        Cuts { root: tree.root, nodes: tree.nodes }
    }
}

impl TryFrom<Cuts> for Tree {
    type Error = PartitionError;

    fn try_from(cuts: Cuts) -> Result<Tree, PartitionError> {
        Tree::new(cuts.root, cuts.nodes)
    }
}
