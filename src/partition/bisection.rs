//! Level-synchronous recursive coordinate bisection from histograms.
//!
//! A level at a time: [`Bisection::wanted`] names the open boxes and the axis to cut each along, the caller adds up the
//! weight of every plane of theirs, [`Bisection::cut`] cuts them. A box of k parts becomes one of floor(k/2) and one of
//! ceil(k/2) parts, at the plane where the weight below is nearest its share of the whole, the lower plane of equals.
//! Where cells are so few that these would not fit, the next even split that fits is taken: a box always keeps at least
//! as many cells as parts.
//!
//! An old cut stays as long as the best one brings a part less than tolerance / levels of its target nearer to it: kept
//! cuts add about the tolerance to the imbalance at most, all levels together.
//!
//! Invariant: cuts are compared in exact integers (shares in 2^-32, products in 128 bits).

use super::tree::{Node, Tree};
use super::{CellBox, PartitionError};

/// Shares are integers of about this sum.
const SHARE_ONE: f64 = 4_294_967_296.0;
/// The tolerance is in units of one over this.
const TOLERANCE_ONE: f64 = 1_048_576.0;

/// A box that is to be cut, and where its planes stand in the histogram of the level.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Slice {
    pub extent: CellBox,
    pub axis: usize,
    /// The plane c of the axis is at `offset + (c - extent.low[axis])`.
    pub offset: usize,
    /// The open node of [`Bisection::partial_tree`].
    pub node: usize,
}

impl Slice {
    /// The number of planes.
    pub fn planes(&self) -> usize {
        self.extent.length(self.axis) as usize
    }
}

pub struct Bisection {
    root: CellBox,
    nodes: Vec<Node>,
    /// shares[p] is the sum of the shares of the parts before p.
    shares: Vec<u64>,
    tolerance: u128,
    /// The levels of a balanced tree: kept cuts divide the tolerance among them.
    levels: u32,
    previous: Option<Previous>,
    open: Vec<Open>,
    wanted: Vec<Slice>,
}

/// The tree in force, and the number of parts below each of its nodes.
struct Previous {
    tree: Tree,
    parts: Vec<usize>,
}

/// A box, and the parts that it is for: `parts` from the number `first` on.
struct Branch {
    extent: CellBox,
    first: usize,
    parts: usize,
    /// The node of the tree in force that was it.
    previous: Option<usize>,
}

/// What a box is going to be, but for the plane.
struct Open {
    first: usize,
    parts: usize,
    low_parts: usize,
    /// The first and last number of planes below the cut that leave both sides as many cells as parts.
    allowed: (u32, u32),
    /// The node of the tree in force whose cut this renews.
    previous: Option<usize>,
}

impl Bisection {
    /// `shares`: what each part is to have of the weight, in any unit. `previous`: the tree in force; it counts if it
    /// has the same root and number of parts. `tolerance`: usually [`super::TOLERANCE`].
    pub fn new(
        root: CellBox,
        shares: &[f64],
        previous: Option<&Tree>,
        tolerance: f64,
    ) -> Result<Bisection, PartitionError> {
        root.check()?;
        if !(0.0..=1.0).contains(&tolerance) {
            return Err(PartitionError::Tolerance(tolerance));
        }
        let parts = shares.len();
        if parts as u64 > root.cells() {
            return Err(PartitionError::TooManyParts { parts, cells: root.cells() });
        }
        let previous = previous.filter(|tree| tree.root() == root && tree.parts() == parts);
        let previous = previous.map(|tree| Previous { tree: tree.clone(), parts: tree.parts_below() });
        let mut bisection = Bisection {
            root,
            nodes: Vec::with_capacity(2 * parts),
            shares: cumulative(shares)?,
            tolerance: (tolerance * TOLERANCE_ONE).round() as u128,
            levels: parts.next_power_of_two().trailing_zeros().max(1),
            previous,
            open: Vec::new(),
            wanted: Vec::new(),
        };
        let before = bisection.previous.as_ref().map(|_| 0);
        bisection.nodes.push(Node::Open(0));
        bisection.settle(0, Branch { extent: root, first: 0, parts, previous: before });
        Ok(bisection)
    }

    pub fn root(&self) -> CellBox {
        self.root
    }

    /// The open boxes of this level; none when all is cut.
    pub fn wanted(&self) -> &[Slice] {
        &self.wanted
    }

    /// The number of planes in the histogram of this level.
    pub fn planes(&self) -> usize {
        self.wanted.last().map_or(0, |slice| slice.offset + slice.planes())
    }

    /// Adds the weight of the cells, each the same, to the histogram of this level.
    pub fn add_cells(&self, weight: u32, histogram: &mut [u64]) {
        for slice in &self.wanted {
            let plane = u64::from(weight) * slice.extent.plane_cells(slice.axis);
            let planes = histogram.iter_mut().skip(slice.offset).take(slice.planes());
            planes.for_each(|sum| *sum = sum.saturating_add(plane));
        }
    }

    /// The cuts so far; an open box is [`Node::Open`] with its index in [`Bisection::wanted`].
    pub fn partial_tree(&self) -> &[Node] {
        &self.nodes
    }

    /// Cuts the open boxes: `histogram` has the summed weight of each of their planes, where the slices say.
    pub fn cut(&mut self, histogram: &[u64]) -> Result<(), PartitionError> {
        if histogram.len() != self.planes() {
            return Err(PartitionError::Histogram { found: histogram.len(), expected: self.planes() });
        }
        let (wanted, open) = (std::mem::take(&mut self.wanted), std::mem::take(&mut self.open));
        for (slice, open) in wanted.iter().zip(&open) {
            let plane = self.plane(slice, open, &histogram[slice.offset..][..slice.planes()])?;
            let (below, above) = slice.extent.split(slice.axis, plane);
            let low = self.nodes.len();
            self.nodes[slice.node] = Node::Cut { axis: slice.axis, plane, low, high: low + 1 };
            self.nodes.extend([Node::Open(0), Node::Open(0)]);
            let (old_low, old_high) = match self.old_cut(open.previous) {
                Some(cut) => (Some(cut.low), Some(cut.high)),
                None => (None, None),
            };
            let (first, parts) = (open.first, open.low_parts);
            self.settle(low, Branch { extent: below, first, parts, previous: old_low });
            let (first, parts) = (open.first + open.low_parts, open.parts - open.low_parts);
            self.settle(low + 1, Branch { extent: above, first, parts, previous: old_high });
        }
        Ok(())
    }

    /// The tree, when nothing is wanted any more.
    pub fn finish(self) -> Result<Tree, PartitionError> {
        if !self.wanted.is_empty() {
            return Err(PartitionError::Unfinished { open: self.wanted.len() });
        }
        Tree::new(self.root, self.nodes)
    }

    /// Makes a new node a part, or puts it among the open ones.
    fn settle(&mut self, node: usize, branch: Branch) {
        let Branch { extent, first, parts, .. } = branch;
        if parts == 1 {
            self.nodes[node] = Node::Part(first);
            return;
        }
        let (axis, open) = self.direction(&branch);
        self.nodes[node] = Node::Open(self.wanted.len());
        self.wanted.push(Slice { extent, axis, offset: self.planes(), node });
        self.open.push(open);
    }

    /// The axis and what is on either side. Those of the old cut while the box is along its axis no shorter than 0.7 of
    /// the longest.
    fn direction(&self, branch: &Branch) -> (usize, Open) {
        let &Branch { ref extent, first, parts, previous } = branch;
        let way = |axis: usize, low_parts: usize, previous: Option<usize>| {
            let allowed = allowed(extent, axis, low_parts, parts - low_parts)?;
            Some((axis, Open { first, parts, low_parts, allowed, previous }))
        };
        let longest = extent.length(extent.longest_axis());
        if let Some(old) = self.old_cut(previous) {
            let long = 10 * u64::from(extent.length(old.axis)) >= 7 * u64::from(longest);
            let kept = long.then(|| way(old.axis, old.low_parts, previous));
            if let Some(kept) = kept.flatten() {
                return kept;
            }
        }
        let mut axes = [0, 1, 2];
        axes.sort_by_key(|&axis| std::cmp::Reverse(extent.length(axis)));
        for low_parts in self.splits(first, parts) {
            for axis in axes {
                if let Some(way) = way(axis, low_parts, None) {
                    return way;
                }
            }
        }
        unreachable!("a box with as many cells as parts has a split: whole planes of one part a cell")
    }

    /// The numbers of parts below a cut, the most even first; of equals the one whose share is nearer to half.
    fn splits(&self, first: usize, parts: usize) -> impl Iterator<Item = usize> {
        let (small, large) = (parts / 2, parts - parts / 2);
        let share = |from: usize, count: usize| self.shares[from + count] - self.shares[from];
        let whole = share(first, parts);
        let off_half = |low: usize| (2 * share(first, low)).abs_diff(whole);
        let large_first = off_half(large) < off_half(small);
        (0..small).flat_map(move |step| {
            let (fewer, more) = (small - step, large + step);
            if large_first { [more, fewer] } else { [fewer, more] }
        })
    }

    /// The plane to cut at.
    fn plane(&self, slice: &Slice, open: &Open, weights: &[u64]) -> Result<u32, PartitionError> {
        let total = weights.iter().try_fold(0_u64, |sum, &weight| sum.checked_add(weight));
        let total = total.ok_or(PartitionError::Overflow)?;
        if total == 0 {
            return self.plane(slice, open, &vec![1; weights.len()]);
        }
        let share = |from: usize, to: usize| u128::from(self.shares[to] - self.shares[from]);
        let middle = open.first + open.low_parts;
        let (low_share, high_share) = (share(open.first, middle), share(middle, open.first + open.parts));
        let (whole, target) = (low_share + high_share, u128::from(total) * low_share);
        let (from, to) = open.allowed;
        let old = self.old_cut(open.previous).map(|cut| cut.plane);
        let (mut below, mut best, mut best_off, mut old_off) = (0_u64, from, u128::MAX, None);
        for at in 1..=to {
            below += weights[at as usize - 1];
            if at < from {
                continue;
            }
            let off = (u128::from(below) * whole).abs_diff(target);
            if off < best_off {
                (best, best_off) = (at, off);
            }
            if Some(slice.extent.low[slice.axis] + at) == old {
                old_off = Some((at, off));
            }
        }
        let allowance = self.tolerance * u128::from(total) * low_share.min(high_share);
        let near = |off: u128| (off - best_off) * u128::from(self.levels) * TOLERANCE_ONE as u128 <= allowance;
        let at = old_off.filter(|&(_, off)| near(off)).map_or(best, |(at, _)| at);
        Ok(slice.extent.low[slice.axis] + at)
    }

    fn old_cut(&self, node: Option<usize>) -> Option<OldCut> {
        let previous = self.previous.as_ref()?;
        match previous.tree.nodes()[node?] {
            Node::Cut { axis, plane, low, high } => {
                Some(OldCut { axis, plane, low, high, low_parts: previous.parts[low] })
            }
            _ => None,
        }
    }
}

struct OldCut {
    axis: usize,
    plane: u32,
    low: usize,
    high: usize,
    low_parts: usize,
}

/// The range of [`Open::allowed`]; none if there is none along this axis.
fn allowed(extent: &CellBox, axis: usize, low_parts: usize, high_parts: usize) -> Option<(u32, u32)> {
    let planes = |parts: usize| (parts as u64).div_ceil(extent.plane_cells(axis));
    let last = u64::from(extent.length(axis)).checked_sub(planes(high_parts))?;
    (planes(low_parts) <= last).then_some((planes(low_parts) as u32, last as u32))
}

/// Running sums of the shares as integers. Each share is rounded alone: equal ones stay equal.
fn cumulative(shares: &[f64]) -> Result<Vec<u64>, PartitionError> {
    if shares.is_empty() {
        return Err(PartitionError::NoParts);
    }
    if let Some(part) = shares.iter().position(|share| !(share.is_finite() && *share > 0.0)) {
        return Err(PartitionError::Share { part, share: shares[part] });
    }
    let largest = shares.iter().copied().fold(0.0, f64::max);
    let total: f64 = shares.iter().map(|share| share / largest).sum();
    let mut sums = vec![0];
    for share in shares {
        let integer = (share / largest / total * SHARE_ONE).round().max(1.0) as u64;
        sums.push(sums[sums.len() - 1] + integer);
    }
    Ok(sums)
}
