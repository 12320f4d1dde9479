//! Bisection on hosts, from cells and their weights: for the first cuts of a run, tests and emulation.
//!
//! A level is one pass over the points, by several threads: each point goes on from its box of the last level to that
//! of this one and adds to the histogram there. No point is moved, no grid is stored.

use std::num::NonZero;
use std::thread;

use super::{Bisection, CellBox, Node, PartitionError, TOLERANCE, Tree};

/// Fewer points than this are not worth a thread more.
const POINTS_PER_THREAD: usize = 1 << 16;

/// The tree for the weights of `points`, cells with a weight each; a cell may come several times.
pub fn bisect(
    root: CellBox,
    shares: &[f64],
    previous: Option<&Tree>,
    points: impl Iterator<Item = ([u32; 3], u64)> + Clone,
) -> Result<Tree, PartitionError> {
    let points: Vec<_> = points.collect();
    Ok(decompose(root, shares, previous, points.len(), |at| points[at])?.0)
}

/// The same of points that are spread over ranks: all find the tree of all points. `sum` adds up histograms over the
/// ranks, and is called by all of them equally often.
///
/// # Errors
/// As [`bisect`], or what `sum` fails with.
pub fn bisect_shared<E: From<PartitionError>>(
    root: CellBox,
    shares: &[f64],
    own: &[[u32; 3]],
    sum: impl FnMut(Vec<u64>) -> Result<Vec<u64>, E>,
) -> Result<Tree, E> {
    let bisection = Bisection::new(root, shares, None, TOLERANCE)?;
    Ok(levels(bisection, own.len(), |at| (own[at], 1), sum)?.0)
}

/// The tree for the weights of points 0..count, and the part of each. `point` gives the cell and the weight of one.
pub fn decompose(
    root: CellBox,
    shares: &[f64],
    previous: Option<&Tree>,
    count: usize,
    point: impl Fn(usize) -> ([u32; 3], u64) + Sync,
) -> Result<(Tree, Vec<u32>), PartitionError> {
    levels(Bisection::new(root, shares, previous, TOLERANCE)?, count, point, Ok)
}

fn levels<E: From<PartitionError>>(
    mut bisection: Bisection,
    count: usize,
    point: impl Fn(usize) -> ([u32; 3], u64) + Sync,
    mut sum: impl FnMut(Vec<u64>) -> Result<Vec<u64>, E>,
) -> Result<(Tree, Vec<u32>), E> {
    let threads = thread::available_parallelism().map_or(1, NonZero::get);
    let size = count.div_ceil(threads).max(POINTS_PER_THREAD);
    check(bisection.root(), count, size, &point)?;
    let mut places = vec![0_u32; count];
    let mut level = Level::first(&bisection);
    loop {
        let histogram = level.pass(&mut places, size, &point);
        if bisection.wanted().is_empty() {
            return Ok((bisection.finish()?, places));
        }
        let before = bisection.wanted().to_vec();
        bisection.cut(&sum(histogram)?)?;
        level = Level::next(&bisection, before.iter().map(|slice| slice.node));
    }
}

/// The weight that changes its part: what a rebalance from one tree to the other sends.
pub fn moved(old: &Tree, new: &Tree, points: impl Iterator<Item = ([u32; 3], u64)>) -> u64 {
    points.filter(|(cell, _)| old.part_of(*cell) != new.part_of(*cell)).map(|(_, weight)| weight).sum()
}

/// Whether all points are in the grid, and their weights add up to 64 bits.
fn check(
    root: CellBox,
    count: usize,
    size: usize,
    point: &(impl Fn(usize) -> ([u32; 3], u64) + Sync),
) -> Result<(), PartitionError> {
    let sum_of = |from: usize| {
        (from..count.min(from + size)).try_fold(0_u64, |sum, at| {
            let (cell, weight) = point(at);
            if !root.contains(cell) {
                return Err(PartitionError::Outside { cell, low: root.low, high: root.high });
            }
            sum.checked_add(weight).ok_or(PartitionError::Overflow)
        })
    };
    let sums = in_threads((0..count).step_by(size).map(|from| move || sum_of(from)));
    sums.into_iter().try_fold(0_u64, |sum, part| sum.checked_add(part?).ok_or(PartitionError::Overflow))?;
    Ok(())
}

/// What one pass needs of the tree. A point's place is the index of its open box, or, once it is in a finished one,
/// its part and the bit [`DONE`].
struct Level {
    /// Of each open box of the last level: axis, plane, and the places below and above.
    cuts: Vec<(usize, u32, [u32; 2])>,
    /// Of each open box of this level: axis, and what to add to a coordinate for its plane in the histogram.
    slices: Vec<(usize, usize)>,
    planes: usize,
}

const DONE: u32 = 1 << 31;

impl Level {
    /// All points are in the root: a cut above all of it.
    fn first(bisection: &Bisection) -> Level {
        let place = place(bisection.partial_tree()[0]);
        Level { cuts: vec![(0, u32::MAX, [place, place])], ..Level::next(bisection, std::iter::empty()) }
    }

    /// `nodes`: those that were open before the last cut.
    fn next(bisection: &Bisection, nodes: impl Iterator<Item = usize>) -> Level {
        let tree = bisection.partial_tree();
        let cut = |node: usize| match tree[node] {
            Node::Cut { axis, plane, low, high } => (axis, plane, [place(tree[low]), place(tree[high])]),
            leaf => (0, u32::MAX, [place(leaf); 2]),
        };
        let slice =
            |slice: &super::Slice| (slice.axis, slice.offset.wrapping_sub(slice.extent.low[slice.axis] as usize));
        Level {
            cuts: nodes.map(cut).collect(),
            slices: bisection.wanted().iter().map(slice).collect(),
            planes: bisection.planes(),
        }
    }

    /// Takes all points to their places of this level; returns the histogram.
    fn pass(&self, places: &mut [u32], size: usize, point: &(impl Fn(usize) -> ([u32; 3], u64) + Sync)) -> Vec<u64> {
        let chunks = places.chunks_mut(size).enumerate();
        let sums = in_threads(chunks.map(|(chunk, places)| move || self.pass_chunk(places, chunk * size, point)));
        let mut histogram = vec![0; self.planes];
        for part in sums {
            histogram.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
        }
        histogram
    }

    fn pass_chunk(&self, places: &mut [u32], first: usize, point: &impl Fn(usize) -> ([u32; 3], u64)) -> Vec<u64> {
        let mut histogram = vec![0; self.planes];
        for (at, place) in places.iter_mut().enumerate() {
            if *place & DONE != 0 {
                continue;
            }
            let (cell, weight) = point(first + at);
            let (axis, plane, next) = self.cuts[*place as usize];
            *place = next[usize::from(cell[axis] >= plane)];
            if let Some(&(axis, shift)) = self.slices.get(*place as usize) {
                histogram[shift.wrapping_add(cell[axis] as usize)] += weight;
            }
        }
        if self.slices.is_empty() {
            places.iter_mut().for_each(|place| *place &= !DONE);
        }
        histogram
    }
}

fn place(leaf: Node) -> u32 {
    match leaf {
        Node::Open(slice) => slice as u32,
        Node::Part(part) => part as u32 | DONE,
        Node::Cut { .. } => DONE,
    }
}

/// Runs each task on a thread of its own, the first on this one; the results in order.
fn in_threads<T: Send>(mut tasks: impl Iterator<Item = impl FnOnce() -> T + Send>) -> Vec<T> {
    let Some(first) = tasks.next() else { return Vec::new() };
    thread::scope(|scope| {
        let others: Vec<_> = tasks.map(|task| scope.spawn(task)).collect();
        let mut results = vec![first()];
        for other in others {
            results.push(other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
        results
    })
}
