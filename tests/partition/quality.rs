//! The imbalance of our cuts beside what the planes between cells allow. (`comparisons/` has it beside another bisection's.)

use corpuscle::partition::*;

use super::clouds::*;

/// For each part, the most by which its weight can exceed its target, as a factor, if every cut above it is the best
/// plane: the side's target and half the heavier plane at the cut, over the side's target.
pub fn granularity(tree: &Tree, shares: &[f64], points: &Points) -> Vec<f64> {
    // Bounds of the parts below a node, of which the shares are these.
    fn walk(tree: &Tree, at: usize, shares: &[f64], points: &Points, bound: f64) -> Vec<f64> {
        let Node::Cut { axis, plane, low, high } = tree.nodes()[at] else { return vec![bound] };
        let weight = |within: &dyn Fn(u32) -> bool| -> u64 {
            points.iter().filter(|(cell, _)| within(cell[axis])).map(|(_, weight)| weight).sum()
        };
        let half_plane = weight(&|c| c == plane).max(weight(&|c| c + 1 == plane)) as f64 / 2.0;
        let below = points.iter().copied().filter(|(cell, _)| cell[axis] < plane).collect();
        let above = points.iter().copied().filter(|(cell, _)| cell[axis] >= plane).collect();
        let count = parts_below(tree, low);
        let share = |parts: &[f64]| parts.iter().sum::<f64>();
        let (low_share, high_share) = (share(&shares[..count]), share(&shares[count..]));
        let total = weight(&|_| true) as f64 / (low_share + high_share);
        let more = |share: f64| bound * (1.0 + half_plane / (total * share));
        let mut bounds = walk(tree, low, &shares[..count], &below, more(low_share));
        bounds.extend(walk(tree, high, &shares[count..], &above, more(high_share)));
        bounds
    }
    fn parts_below(tree: &Tree, at: usize) -> usize {
        match tree.nodes()[at] {
            Node::Cut { low, high, .. } => parts_below(tree, low) + parts_below(tree, high),
            _ => 1,
        }
    }
    walk(tree, 0, shares, points, 1.0)
}

/// No part exceeds its share by more than the best planes can keep.
#[test]
fn parts_are_as_even_as_planes_allow() {
    let root = grid([1024, 1024, 1024]);
    for cloud in [Cloud::Uniform, Cloud::Clustered, Cloud::Tank] {
        let points = points(root, &positions(cloud, 200_000, 11), 1);
        for parts in [2, 8, 32, 128] {
            let shares = vec![1.0; parts];
            let tree = bisect(root, &shares, None, points.iter().copied()).unwrap();
            let ours = imbalance(&weights(&tree, &points));
            let plane = granularity(&tree, &shares, &points).into_iter().fold(1.0, f64::max) - 1.0;
            println!("{cloud:?}, {parts} parts: {ours:.4}, granularity {plane:.4}");
            assert!(ours <= 1.0 + plane, "{cloud:?}, {parts} parts: {ours}, granularity {plane}");
        }
    }
}
