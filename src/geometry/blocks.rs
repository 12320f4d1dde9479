//! Gas volume of coarse blocks of cells, for densities and local tallies.
//!
//! Each row of blocks along x is crossed by a Fibonacci lattice of lines (987 points: rank-1, so that also a
//! wall parallel to a coordinate plane cuts off a fraction good to 1/1974), exact along x. What the lines miss
//! of the vessel's volume goes to the cut blocks in proportion: a block wholly in the gas keeps its own.

use super::sampling::map;
use super::{Grid, Vessel};

/// Consecutive Fibonacci numbers.
const LINES: u32 = 987;
const GENERATOR: u32 = 610;

/// Gas volume (m3) of each block of 2^`log2_cells` cells per axis, x fastest, `grid.blocks(log2_cells)` of
/// them. The sum is `vessel.gas_volume()`.
pub fn block_volumes(vessel: &Vessel, grid: &Grid, log2_cells: u32) -> Vec<f64> {
    let [nx, ny, nz] = grid.blocks(log2_cells).map(|n| n as usize);
    let edge = grid.cell * f64::from(1u32 << log2_cells);
    let rows = map(ny * nz, |row, line| {
        let corner = [(row % ny) as f64, (row / ny) as f64];
        let mut lengths = vec![0.0; nx];
        for i in 0..LINES {
            let offset = [i, i * GENERATOR % LINES].map(|k| (f64::from(k) + 0.5) / f64::from(LINES));
            let [y, z] = std::array::from_fn(|a| grid.origin[a + 1] + (corner[a] + offset[a]) * edge);
            vessel.gas_along(y, z, line);
            for &(from, to) in &line.gas {
                share(&mut lengths, (from - grid.origin[0]) / edge, (to - grid.origin[0]) / edge);
            }
        }
        lengths
    });
    let whole = edge * edge * edge;
    let mut volumes: Vec<f64> = rows.concat().iter().map(|length| whole * length / f64::from(LINES)).collect();
    let is_full = |v: f64| v > whole * (1.0 - 1e-9);
    let full: f64 = volumes.iter().filter(|v| is_full(**v)).sum();
    let cut: f64 = volumes.iter().filter(|v| !is_full(**v)).sum();
    if cut > 0.0 {
        let correction = (vessel.gas_volume() - full) / cut;
        volumes.iter_mut().filter(|v| !is_full(**v)).for_each(|v| *v *= correction);
    }
    volumes
}

/// Adds the length of from..to (in blocks) within each block.
fn share(lengths: &mut [f64], from: f64, to: f64) {
    let last = lengths.len() - 1;
    let (first, end) = ((from.max(0.0) as usize).min(last), (to.max(0.0) as usize).min(last));
    for (block, length) in lengths.iter_mut().enumerate().take(end + 1).skip(first) {
        *length += (to.min((block + 1) as f64) - from.max(block as f64)).max(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::tests::{hollow_box, tank};

    #[test]
    fn blocks_add_up_to_the_vessel_and_each_is_right() {
        let vessel = Vessel::build(&[tank([0.4, 0.3, 0.2]), hollow_box([0.1; 3], [0.2, 0.15, 0.15], 0.01)]).unwrap();
        let grid = Grid::around(vessel.bounds.0, vessel.bounds.1, 0.0071).unwrap();
        let volumes = block_volumes(&vessel, &grid, 2);
        let blocks = grid.blocks(2);
        assert_eq!(volumes.len(), blocks.iter().product::<u32>() as usize);
        let total: f64 = volumes.iter().sum();
        assert!((total / vessel.gas_volume() - 1.0).abs() < 1e-12, "{total}");
        // Every block against the product of intervals, minus the shell.
        let edge = 4.0 * grid.cell;
        let overlap = |min: [f64; 3], low: [f64; 3], high: [f64; 3]| -> f64 {
            (0..3).map(|a| (high[a].min(min[a] + edge) - low[a].max(min[a])).max(0.0)).product()
        };
        let mut worst = 0.0f64;
        for (k, &volume) in volumes.iter().enumerate() {
            let (nx, ny) = (blocks[0] as usize, blocks[1] as usize);
            let index = [k % nx, k / nx % ny, k / nx / ny];
            let min = std::array::from_fn(|a| grid.origin[a] + index[a] as f64 * edge);
            let right = overlap(min, [0.0; 3], [0.4, 0.3, 0.2]) - overlap(min, [0.09; 3], [0.21, 0.16, 0.16])
                + overlap(min, [0.1; 3], [0.2, 0.15, 0.15]);
            worst = worst.max((volume - right).abs() / edge.powi(3));
        }
        // A corner of a wall in a block: the discrepancy of the lattice, about log(987) / 987 / 2.
        assert!(worst < 3.5e-3, "{worst}");
        // The check sees blocks of the wrong size.
        let coarse = block_volumes(&vessel, &grid, 3);
        assert!(coarse.len() < volumes.len() && (coarse[0] - volumes[0]).abs() > 1e-7);
    }

    #[test]
    fn an_interval_is_shared_among_its_blocks() {
        let mut lengths = [0.0; 4];
        share(&mut lengths, 0.25, 2.5);
        assert_eq!(lengths, [0.75, 1.0, 0.5, 0.0]);
        share(&mut lengths, -3.0, 9.0);
        assert_eq!(lengths, [1.75, 2.0, 1.5, 1.0]);
    }
}
