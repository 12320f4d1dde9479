//! The imbalance of our cuts beside coupe's, an independent recursive coordinate bisection.

use corpuscle::partition::*;
use coupe::{Partition as _, Point3D};

use super::clouds::*;

/// For each part, the most by which its weight can exceed its target, as a factor, if every cut above it is the best
/// plane: the side's target and half the heavier plane at the cut, over the side's target.
pub fn granularity(tree: &Tree, shares: &[f64], points: &Points) -> Vec<f64> {
    fn walk(tree: &Tree, at: usize, shares: &[f64], points: &Points, bound: f64, into: &mut Vec<f64>) {
        let Node::Cut { axis, plane, low, high } = tree.nodes()[at] else { return into.push(bound) };
        let weight = |within: &dyn Fn(u32) -> bool| -> u64 {
            points.iter().filter(|(cell, _)| within(cell[axis])).map(|(_, weight)| weight).sum()
        };
        let half_plane = weight(&|c| c == plane).max(weight(&|c| c + 1 == plane)) as f64 / 2.0;
        let below = points.iter().copied().filter(|(cell, _)| cell[axis] < plane).collect();
        let above = points.iter().copied().filter(|(cell, _)| cell[axis] >= plane).collect();
        let count = parts_below(tree, low);
        let first = into.len();
        let share = |parts: &[f64]| parts.iter().sum::<f64>();
        let (low_share, high_share) = (share(&shares[first..first + count]), share(&shares[first + count..]));
        let total = weight(&|_| true) as f64 / (low_share + high_share);
        let more = |share: f64| bound * (1.0 + half_plane / (total * share));
        walk(tree, low, &shares[..first + count], &below, more(low_share), into);
        walk(tree, high, shares, &above, more(high_share), into);
    }
    fn parts_below(tree: &Tree, at: usize) -> usize {
        match tree.nodes()[at] {
            Node::Cut { low, high, .. } => parts_below(tree, low) + parts_below(tree, high),
            _ => 1,
        }
    }
    let mut bounds = Vec::new();
    walk(tree, 0, shares, points, 1.0, &mut bounds);
    bounds
}

fn imbalance(weights: &[u64]) -> f64 {
    *weights.iter().max().unwrap() as f64 * weights.len() as f64 / weights.iter().sum::<u64>() as f64
}

/// The imbalance of our parts is no worse than that of coupe's, which has the points where we have them: in cells, between which it
/// must cut as we do (to a tolerance of 0.1 % per cut).
#[test]
fn parts_are_as_even_as_coupes() {
    let root = grid([1024, 1024, 1024]);
    for cloud in [Cloud::Uniform, Cloud::Clustered, Cloud::Tank] {
        let positions = positions(cloud, 200_000, 11);
        let points = points(root, &positions, 1);
        for levels in [1, 3, 5, 7] {
            let parts = 1 << levels;
            let tree = bisect(root, &vec![1.0; parts], None, points.iter().copied()).unwrap();
            let ours = imbalance(&weights(&tree, &points));
            let mut ids = vec![0_usize; points.len()];
            let at: Vec<Point3D> = points.iter().map(|(cell, _)| Point3D::from(cell.map(f64::from))).collect();
            let mut rcb = coupe::Rcb { iter_count: levels, tolerance: 0.001, fast: false };
            rcb.partition(&mut ids, (at, vec![1.0_f64; points.len()])).unwrap();
            let mut theirs = vec![0; parts];
            ids.iter().for_each(|id| theirs[*id] += 1);
            let theirs = imbalance(&theirs);
            let plane = granularity(&tree, &vec![1.0; parts], &points).into_iter().fold(1.0, f64::max) - 1.0;
            println!("{cloud:?}, {parts} parts: ours {ours:.4}, coupe {theirs:.4}, granularity {plane:.4}");
            assert!(ours <= theirs, "{cloud:?}, {parts} parts: ours {ours}, coupe {theirs}");
            assert!(ours <= 1.0 + plane, "{cloud:?}, {parts} parts: ours {ours}, granularity {plane}");
        }
    }
}
