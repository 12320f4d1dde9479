use std::ops::Range;

use corpuscle::partition::*;
use proptest::prelude::*;

use super::clouds::*;

/// The deviation of a cut from its target, in weight: of the points in the box, those below `plane`.
fn deviation(extent: &CellBox, axis: usize, plane: u32, fraction: f64, points: &Points) -> f64 {
    let inside = points.iter().filter(|(cell, _)| extent.contains(*cell));
    let (mut below, mut total) = (0, 0);
    for (cell, weight) in inside {
        total += weight;
        below += if cell[axis] < plane { *weight } else { 0 };
    }
    (below as f64 - fraction * total as f64).abs()
}

/// A cut's box, axis and plane, and the parts below and above it.
type Cut = (CellBox, usize, u32, Range<usize>, Range<usize>);

fn cuts(tree: &Tree) -> Vec<Cut> {
    fn walk(tree: &Tree, at: usize, extent: CellBox, first: usize, into: &mut Vec<Cut>) -> usize {
        let Node::Cut { axis, plane, low, high } = tree.nodes()[at] else { return first + 1 };
        let (below, above) = extent.split(axis, plane);
        let middle = walk(tree, low, below, first, into);
        let end = walk(tree, high, above, middle, into);
        into.push((extent, axis, plane, first..middle, middle..end));
        end
    }
    let mut found = Vec::new();
    walk(tree, 0, tree.root(), 0, &mut found);
    found
}

fn assert_tiles(tree: &Tree) {
    let boxes = tree.boxes();
    assert!(boxes.iter().all(|extent| extent.cells() > 0), "no part is empty");
    assert_eq!(boxes.iter().map(CellBox::cells).sum::<u64>(), tree.root().cells(), "the boxes fill the root");
    for (part, extent) in boxes.iter().enumerate() {
        assert!(boxes[..part].iter().all(|other| !other.intersects(extent)), "the boxes do not overlap");
        let last = extent.high.map(|high| high - 1);
        assert_eq!((tree.part_of(extent.low), tree.part_of(last)), (part, part), "a box's cells are its part's");
    }
}

prop_compose! {
    fn any_case()(
        low in prop::array::uniform3(0_u32..5),
        size in prop::array::uniform3(1_u32..12),
        seed in any::<u64>(),
        count in 0_usize..300,
        shares in prop::collection::vec(1_u32..5, 1..40),
    ) -> (CellBox, Vec<f64>, Points) {
        let root = CellBox { low, high: std::array::from_fn(|axis| low[axis] + size[axis]) };
        let parts = shares.len().min(root.cells() as usize);
        let shares = shares[..parts].iter().map(|share| f64::from(*share)).collect();
        let mut random = Random(seed);
        let points = positions(Cloud::Uniform, count, seed).iter().map(|at| {
            let near = at.map(|x| x * x);
            (points(root, &[near], 1)[0].0, random.bits() % 7)
        }).collect();
        (root, shares, points)
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    /// Whatever the weights, shares and number of parts, the boxes of the parts tile the root and none is empty, and
    /// each part's points are those that `decompose` gives it.
    #[test]
    fn the_boxes_tile_the_root((root, shares, points) in any_case()) {
        let (tree, parts) = decompose(root, &shares, None, points.len(), |at| points[at]).unwrap();
        prop_assert_eq!(tree.parts(), shares.len());
        assert_tiles(&tree);
        for ((cell, _), part) in points.iter().zip(parts) {
            prop_assert_eq!(tree.part_of(*cell), part as usize);
        }
    }

    /// No other plane that leaves both sides as many cells as parts is nearer to the target share, and none as near is
    /// lower.
    #[test]
    fn every_cut_is_the_best_plane((root, shares, points) in any_case()) {
        let tree = bisect(root, &shares, None, points.iter().copied()).unwrap();
        for (extent, axis, plane, below, above) in cuts(&tree) {
            let total: u64 = points.iter().filter(|(cell, _)| extent.contains(*cell)).map(|(_, weight)| weight).sum();
            let share = |parts: Range<usize>| shares[parts].iter().sum::<f64>();
            let fraction = share(below.clone()) / (share(below.clone()) + share(above.clone()));
            // Shares are rounded to 2^-32.
            let rounding = total as f64 * 1e-8;
            let off = deviation(&extent, axis, plane, fraction, &points);
            for other in extent.low[axis] + 1..extent.high[axis] {
                let (low, high) = extent.split(axis, other);
                if low.cells() < below.len() as u64 || high.cells() < above.len() as u64 || total == 0 {
                    continue;
                }
                let other_off = deviation(&extent, axis, other, fraction, &points);
                prop_assert!(off <= other_off + rounding);
                prop_assert!(other >= plane || other_off > off - rounding);
            }
        }
    }

    /// The order of the points and how they are divided among ranks does not matter: the tree is that of the sums.
    #[test]
    fn the_same_sums_give_the_same_tree((root, shares, points) in any_case()) {
        let tree = bisect(root, &shares, None, points.iter().copied()).unwrap();
        let reversed = bisect(root, &shares, None, points.iter().rev().copied()).unwrap();
        let single = points.iter().flat_map(|(cell, weight)| (0..*weight).map(|_| (*cell, 1)));
        prop_assert_eq!(&tree, &reversed);
        prop_assert_eq!(&tree, &bisect(root, &shares, None, single).unwrap());
        let text = serde_json::to_string(&tree).unwrap();
        prop_assert_eq!(tree, serde_json::from_str::<Tree>(&text).unwrap());
    }

    /// With the tree of the same weights in force, nothing moves.
    #[test]
    fn the_same_weights_move_nothing((root, shares, points) in any_case()) {
        let tree = bisect(root, &shares, None, points.iter().copied()).unwrap();
        let again = bisect(root, &shares, Some(&tree), points.iter().copied()).unwrap();
        prop_assert_eq!(moved(&tree, &again, points.iter().copied()), 0);
        prop_assert_eq!(tree, again);
    }

    /// The gap of two boxes is one less than the least Chebyshev distance of their cells, or 0 if they share cells.
    #[test]
    fn the_gap_counts_the_layers_between(
        a in prop::array::uniform3(0_u32..6), b in prop::array::uniform3(0_u32..6),
        a_size in prop::array::uniform3(1_u32..4), b_size in prop::array::uniform3(1_u32..4),
    ) {
        let a = CellBox { low: a, high: std::array::from_fn(|axis| a[axis] + a_size[axis]) };
        let b = CellBox { low: b, high: std::array::from_fn(|axis| b[axis] + b_size[axis]) };
        let cells = |of: CellBox| {
            (of.low[0]..of.high[0]).flat_map(move |x| {
                (of.low[1]..of.high[1]).flat_map(move |y| (of.low[2]..of.high[2]).map(move |z| [x, y, z]))
            })
        };
        let apart = |a: [u32; 3], b: [u32; 3]| (0..3).map(|axis| a[axis].abs_diff(b[axis])).max().unwrap();
        let least = cells(a).flat_map(|one| cells(b).map(move |other| apart(one, other))).min().unwrap();
        prop_assert_eq!(a.gap(&b), least.saturating_sub(1));
        prop_assert_eq!(a.intersects(&b), least == 0);
    }
}

/// A part's weight is off its share by no more than half a plane of each cut above it.
#[test]
fn parts_have_their_shares_to_half_a_plane_per_cut() {
    let root = grid([300, 200, 250]);
    for cloud in [Cloud::Uniform, Cloud::Clustered, Cloud::Tank] {
        let points = points(root, &positions(cloud, 60_000, 5), 3);
        for parts in [1_usize, 2, 3, 7, 12, 384] {
            for unequal in [false, true] {
                let shares: Vec<f64> =
                    (0..parts).map(|part| if unequal && part % 3 == 0 { 2.0 } else { 1.0 }).collect();
                let tree = bisect(root, &shares, None, points.iter().copied()).unwrap();
                assert_tiles(&tree);
                let bounds = super::quality::granularity(&tree, &shares, &points);
                let whole: f64 = shares.iter().sum();
                for (part, weight) in weights(&tree, &points).into_iter().enumerate() {
                    let target = shares[part] / whole * 180_000.0;
                    assert!(weight as f64 <= target * bounds[part] + 1e-3, "{cloud:?} {parts}: {weight} for {target}");
                }
            }
        }
    }
}

/// After a small change of the load the tree in force moves far less than a fresh one, and is within its tolerance.
/// At 384 parts, of 500 points each, the change in a part is well above the tolerance: some cuts must move.
#[test]
fn old_cuts_stay_under_small_changes() {
    let root = grid([200, 180, 600]);
    for parts in [2, 7, 32, 384] {
        let shares = vec![1.0; parts];
        let before = points(root, &positions(Cloud::Tank, 200_000, 1), 1);
        let old = bisect(root, &shares, None, before.iter().copied()).unwrap();
        // Another sample of nearly the same gas: one in fifty points is elsewhere.
        let mut after = before.clone();
        for (point, new) in after.iter_mut().step_by(50).zip(points(root, &positions(Cloud::Uniform, 4_000, 2), 1)) {
            *point = new;
        }
        let fresh = bisect(root, &shares, None, after.iter().copied()).unwrap();
        let kept = bisect(root, &shares, Some(&old), after.iter().copied()).unwrap();
        let move_to = |tree: &Tree| moved(&old, tree, after.iter().copied());
        assert!(move_to(&fresh) > 0);
        let fraction = if parts == 384 { 0.6 } else { 0.25 };
        assert!(
            move_to(&kept) as f64 <= fraction * move_to(&fresh) as f64,
            "{parts}: {} of {}",
            move_to(&kept),
            move_to(&fresh)
        );
        let most = |tree: &Tree| weights(tree, &after).into_iter().max().unwrap() as f64 * parts as f64 / 200_000.0;
        let excess = most(&kept) - most(&fresh);
        println!(
            "{parts} parts: moved {} against {}, imbalance {:.4} against {:.4}",
            move_to(&kept),
            move_to(&fresh),
            most(&kept),
            most(&fresh)
        );
        assert!(excess < 1.5 * TOLERANCE, "{parts}: {excess}");
    }
}

/// Cells that weigh something have the cuts of as many points, one in each.
#[test]
fn cells_weigh_as_a_point_in_each() {
    let root = grid([20, 14, 9]);
    let gas = points(root, &positions(Cloud::Clustered, 3_000, 4), 5);
    for parts in [2, 5, 16] {
        let shares = vec![1.0; parts];
        let mut bisection = Bisection::new(root, &shares, None, TOLERANCE).unwrap();
        while !bisection.wanted().is_empty() {
            let mut planes = vec![0; bisection.planes()];
            for slice in bisection.wanted() {
                for (cell, weight) in gas.iter().filter(|(cell, _)| slice.extent.contains(*cell)) {
                    planes[slice.offset + (cell[slice.axis] - slice.extent.low[slice.axis]) as usize] += weight;
                }
            }
            bisection.add_cells(7, &mut planes);
            bisection.cut(&planes).unwrap();
        }
        let [x, y, z] = [0, 1, 2].map(|axis| root.low[axis]..root.high[axis]);
        let cells = z.flat_map(|z| y.clone().map(move |y| (y, z)));
        let cells = cells.flat_map(|(y, z)| x.clone().map(move |x| ([x, y, z], 7)));
        let tree = bisect(root, &shares, None, gas.iter().copied().chain(cells)).unwrap();
        assert_eq!(bisection.finish().unwrap(), tree, "{parts} parts");
        assert_ne!(tree, bisect(root, &shares, None, gas.iter().copied()).unwrap(), "{parts} parts: they do weigh");
    }
}

/// Without weight the shares are those of space.
#[test]
fn an_empty_grid_is_cut_by_volume() {
    let tree = bisect(grid([12, 4, 4]), &[1.0, 2.0, 3.0], None, std::iter::empty()).unwrap();
    let cells: Vec<u64> = tree.boxes().iter().map(CellBox::cells).collect();
    assert_eq!(cells, [32, 64, 96]);
}

/// As many parts as cells gives each one cell, also where halves would not fit.
#[test]
fn there_may_be_as_many_parts_as_cells() {
    for size in [[3, 3, 1], [5, 1, 1], [3, 5, 7], [1, 1, 384]] {
        let parts = size.iter().product::<u32>() as usize;
        let tree = bisect(grid(size), &vec![1.0; parts], None, [([0; 3], 9)].into_iter()).unwrap();
        assert!(tree.boxes().iter().all(|extent| extent.cells() == 1));
    }
}

/// The axis is that of the most cells; an old one stays down to 0.7 of it.
#[test]
fn the_axis_follows_the_longest_and_keeps_the_old() {
    let axis = |root: CellBox, previous: Option<&Tree>| {
        let bisection = Bisection::new(root, &[1.0, 1.0], previous, TOLERANCE).unwrap();
        bisection.wanted()[0].axis
    };
    let cut_along_y = |root| {
        Tree::new(root, vec![Node::Cut { axis: 1, plane: 5, low: 1, high: 2 }, Node::Part(0), Node::Part(1)]).unwrap()
    };
    let (near, far) = (grid([10, 7, 3]), grid([10, 6, 3]));
    assert_eq!(axis(near, None), 0);
    assert_eq!(axis(near, Some(&cut_along_y(near))), 1);
    assert_eq!(axis(far, Some(&cut_along_y(far))), 0);
}

/// What cannot be is refused with the reason.
#[test]
fn impossible_partitions_are_refused() {
    let root = grid([2, 2, 2]);
    let error = |shares: &[f64]| bisect(root, shares, None, std::iter::empty()).unwrap_err().to_string();
    assert!(error(&[]).contains("at least one part"));
    assert!(error(&[1.0; 9]).contains("8 cells, too few for 9 parts"));
    assert!(error(&[1.0, 0.0]).contains("share of part 1 is 0"));
    assert!(error(&[1.0, f64::NAN]).contains("share of part 1 is NaN"));
    let outside = bisect(root, &[1.0], None, [([0, 2, 0], 1)].into_iter()).unwrap_err();
    assert!(matches!(outside, PartitionError::Outside { cell: [0, 2, 0], .. }));
    let heavy = [([0; 3], u64::MAX), ([1; 3], 1)];
    assert_eq!(bisect(root, &[1.0], None, heavy.into_iter()).unwrap_err(), PartitionError::Overflow);
    assert!(matches!(Tree::whole(grid([0, 1, 1])), Err(PartitionError::EmptyBox { .. })));
    let mut bisection = Bisection::new(root, &[1.0; 2], None, TOLERANCE).unwrap();
    assert_eq!(bisection.cut(&[1]), Err(PartitionError::Histogram { found: 1, expected: 2 }));
    assert_eq!(bisection.finish(), Err(PartitionError::Unfinished { open: 1 }));
}

/// A tree that is read is checked.
#[test]
fn malformed_trees_are_refused() {
    let cut = |plane, low, high| Node::Cut { axis: 0, plane, low, high };
    let bad = [
        vec![],
        vec![Node::Part(1)],
        vec![Node::Open(0)],
        vec![Node::Part(0), Node::Part(1)],
        vec![cut(0, 1, 2), Node::Part(0), Node::Part(1)],
        vec![cut(4, 1, 2), Node::Part(0), Node::Part(1)],
        vec![cut(2, 1, 1), Node::Part(0)],
        vec![cut(2, 1, 0), Node::Part(0)],
        vec![cut(2, 1, 3), Node::Part(0), Node::Part(1)],
        vec![cut(2, 2, 1), Node::Part(0), Node::Part(1)],
        vec![cut(2, 1, 2), cut(1, 2, 3), Node::Part(0), Node::Part(1)],
        vec![Node::Cut { axis: 3, plane: 2, low: 1, high: 2 }, Node::Part(0), Node::Part(1)],
    ];
    for nodes in bad {
        assert!(matches!(Tree::new(grid([4, 4, 4]), nodes.clone()), Err(PartitionError::Tree { .. })), "{nodes:?}");
    }
    assert!(Tree::new(grid([4, 4, 4]), vec![cut(2, 1, 2), Node::Part(0), Node::Part(1)]).is_ok());
}
