//! The imbalance of our cuts beside crate coupe's, an independent recursive coordinate bisection.

#[path = "../../tests/partition/clouds.rs"]
mod clouds;

use clouds::*;
use corpuscle::partition::bisect;
use coupe::{Partition as _, Point3D};

/// The imbalance of our parts is no worse than that of coupe's, which has the points where we have them: in cells, between which it
/// must cut as we do (to a tolerance of 0.1 % per cut).
#[test]
fn parts_are_as_even_as_coupes() {
    let root = grid([1024, 1024, 1024]);
    for cloud in [Cloud::Uniform, Cloud::Clustered, Cloud::Tank] {
        let points = points(root, &positions(cloud, 200_000, 11), 1);
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
            println!("{cloud:?}, {parts} parts: ours {ours:.4}, coupe {theirs:.4}");
            assert!(ours <= theirs, "{cloud:?}, {parts} parts: ours {ours}, coupe {theirs}");
        }
    }
}
