//! Clouds of points on a grid, from a small generator of our own so that they never change.

use corpuscle::partition::CellBox;

pub type Points = Vec<([u32; 3], u64)>;

/// SplitMix64.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Of mean 0 and variance 1, by Box and Muller.
    pub fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.unit()).ln()).sqrt() * (std::f64::consts::TAU * self.unit()).cos()
    }
}

#[derive(Clone, Copy, Debug)]
pub enum Cloud {
    Uniform,
    /// Four dense clusters and a thin rest.
    Clustered,
    /// A long cylinder, ten times as dense near one end.
    Tank,
}

pub fn grid(cells: [u32; 3]) -> CellBox {
    CellBox { low: [0; 3], high: cells }
}

/// Coordinates in [0, 1).
pub fn positions(cloud: Cloud, count: usize, seed: u64) -> Vec<[f64; 3]> {
    let mut random = Random(seed);
    let inside = |at: &[f64; 3]| at.iter().all(|x| (0.0..1.0).contains(x));
    let mut positions = Vec::with_capacity(count);
    while positions.len() < count {
        let mut at: [f64; 3] = std::array::from_fn(|_| random.unit());
        match cloud {
            Cloud::Uniform => {}
            Cloud::Clustered if random.unit() < 0.1 => {}
            Cloud::Clustered => {
                let centre =
                    [[0.2, 0.2, 0.3], [0.7, 0.3, 0.6], [0.4, 0.8, 0.5], [0.9, 0.9, 0.9]][(random.bits() % 4) as usize];
                at = centre.map(|x| x + 0.05 * random.normal());
            }
            Cloud::Tank => {
                if random.unit() < 0.5 {
                    at[2] *= 0.1;
                }
                if (at[0] - 0.5).powi(2) + (at[1] - 0.5).powi(2) > 0.25 {
                    continue;
                }
            }
        }
        if inside(&at) {
            positions.push(at);
        }
    }
    positions
}

/// The cells of the positions, each of the same weight.
pub fn points(root: CellBox, positions: &[[f64; 3]], weight: u64) -> Points {
    let cell =
        |at: &[f64; 3]| std::array::from_fn(|axis| root.low[axis] + (at[axis] * f64::from(root.length(axis))) as u32);
    positions.iter().map(|at| (cell(at), weight)).collect()
}

pub fn weights(tree: &corpuscle::partition::Tree, points: &Points) -> Vec<u64> {
    let mut weights = vec![0; tree.parts()];
    points.iter().for_each(|(cell, weight)| weights[tree.part_of(*cell)] += weight);
    weights
}

/// The fullest part over the mean.
pub fn imbalance(weights: &[u64]) -> f64 {
    *weights.iter().max().unwrap() as f64 * weights.len() as f64 / weights.iter().sum::<u64>() as f64
}
