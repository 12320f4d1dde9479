//! What a bisection costs on this host, beside crate coupe's: `cargo bench -p comparisons --bench partition`.
//!
//! Nanoseconds of wall time per point, medians of a few runs, ours and coupe's in turn, both on all threads
//! (`RAYON_NUM_THREADS` limits coupe's, `taskset` both). Ours starts from cells of a 1024^3 grid; `histograms` is what
//! it spends in adding up planes and taking each point to its part, `cuts` what is left: on devices the former is
//! theirs. Coupe starts from the positions and cuts between points; its number of parts is a power of two.
//!
//! `-- 1000000 10000000` chooses the numbers of points.

use std::hint::black_box;
use std::time::Instant;

use corpuscle::partition::{Bisection, CellBox, Node, TOLERANCE, Tree, decompose};
use coupe::{Partition as _, Point3D};

const GRID: CellBox = CellBox { low: [0; 3], high: [1024; 3] };
const RUNS: usize = 3;
/// Coupe's tolerance per cut.
const COUPE_TOLERANCE: f64 = 0.01;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut sizes = Vec::new();
    for argument in std::env::args().skip(1).filter(|argument| argument != "--bench") {
        sizes.push(argument.parse()?);
    }
    if sizes.is_empty() {
        sizes = vec![1_000_000, 10_000_000];
    }
    let threads = std::thread::available_parallelism()?;
    println!("{threads} threads, grid of 1024^3 cells, clustered points of weight 1; ns per point, medians of {RUNS}");
    println!(
        "{:>10} {:>6} {:>9} {:>11} {:>8} {:>9} {:>9} {:>10} {:>10}",
        "points", "parts", "ours", "histograms", "cuts", "max/mean", "coupe", "max/mean", "coupe/ours"
    );
    for count in sizes {
        let positions = cloud(count);
        let cells: Vec<[u32; 3]> =
            positions.iter().map(|at| std::array::from_fn(|axis| (at[axis] * 1024.0) as u32)).collect();
        for parts in [2, 32, 384] {
            row(&positions, &cells, parts)?;
        }
    }
    Ok(())
}

fn row(positions: &[Point3D], cells: &[[u32; 3]], parts: usize) -> Result<(), Box<dyn std::error::Error>> {
    let shares = vec![1.0; parts];
    let per_point = |seconds: f64| 1e9 * seconds / cells.len() as f64;
    let (mut ours, mut theirs, mut cutting) = (Vec::new(), Vec::new(), Vec::new());
    let (mut even, mut coupe_even) = (0.0, 0.0);
    for _ in 0..RUNS {
        let start = Instant::now();
        let (tree, ids) = decompose(GRID, &shares, None, cells.len(), |at| (cells[at], 1))?;
        ours.push(start.elapsed().as_secs_f64());
        even = imbalance(ids.iter().map(|id| *id as usize), parts);
        cutting.push(seconds_of_cuts(&tree, &shares)?);
        if parts.is_power_of_two() {
            let (points, weights, mut ids) = (positions.to_vec(), vec![1.0_f64; cells.len()], vec![0; cells.len()]);
            let mut rcb =
                coupe::Rcb { iter_count: parts.ilog2() as usize, tolerance: COUPE_TOLERANCE, ..Default::default() };
            let start = Instant::now();
            rcb.partition(&mut ids, (points, weights))?;
            theirs.push(start.elapsed().as_secs_f64());
            coupe_even = imbalance(ids.into_iter(), parts);
        }
    }
    let (ours, cuts) = (median(ours), median(cutting));
    print!("{:>10} {parts:>6} {:>9.2}", cells.len(), per_point(ours));
    print!(" {:>11.2} {:>8.3} {even:>9.4}", per_point(ours - cuts), per_point(cuts));
    if theirs.is_empty() {
        println!(" {:>9} {:>10} {:>10}", "-", "-", "-");
    } else {
        let theirs = median(theirs);
        println!(" {:>9.2} {coupe_even:>10.4} {:>10.1}", per_point(theirs), theirs / ours);
    }
    Ok(())
}

/// What it takes to decide the cuts alone, on histograms that are there: of as many planes as those of the tree.
fn seconds_of_cuts(tree: &Tree, shares: &[f64]) -> Result<f64, Box<dyn std::error::Error>> {
    let start = Instant::now();
    let mut bisection = Bisection::new(tree.root(), shares, Some(tree), TOLERANCE)?;
    while !bisection.wanted().is_empty() {
        let histogram = vec![1; bisection.planes()];
        bisection.cut(&histogram)?;
    }
    let nodes = bisection.finish()?;
    black_box(matches!(nodes.nodes()[0], Node::Cut { .. }));
    Ok(start.elapsed().as_secs_f64())
}

fn imbalance(ids: impl Iterator<Item = usize>, parts: usize) -> f64 {
    let (mut counts, mut total) = (vec![0_u64; parts], 0);
    for id in ids {
        counts[id] += 1;
        total += 1;
    }
    counts.into_iter().max().unwrap_or(0) as f64 * parts as f64 / f64::from(total)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Half of the points anywhere in the unit cube, half of them nearer its corner.
fn cloud(count: usize) -> Vec<Point3D> {
    let mut state = 1_u64;
    let mut unit = move || {
        // Knuth's MMIX generator; its high bits are good enough to place points.
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut point = |at: usize| {
        let power = if at.is_multiple_of(2) { 1 } else { 2 };
        Point3D::new(unit().powi(power), unit().powi(power), unit().powi(power))
    };
    (0..count).map(&mut point).collect()
}
