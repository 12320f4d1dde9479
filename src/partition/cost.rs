//! What work costs on the devices: weights of the cells and shares of the ranks, from measured device seconds.
//!
//! A rank's seconds in an interval are (c . x) / v: x its work ([`Work`]), c the seconds per unit of each feature, the
//! same for all, v the speed of its device. With the prior p (relative costs before anything is measured) and
//! u = p . x, each measurement is a row z = p x / u (what the prior gives to each feature, of sum 1) with target
//! t = v seconds / u; so noise in proportion to the seconds weighs alike, and none of it enters z. The fit minimises
//!
//! ```text
//! sum over rows of u / u_max (t - b . z)^2  +  RIDGE sum_j (b_j - mean t)^2,   b >= 0,   c = b p
//! ```
//!
//! where a row counts FORGET per interval of age. Where the device tells the seconds of the search for pairs apart, a
//! measurement is two rows: those seconds are of candidates and steps, the others of particles, wall tests, cells and steps.
//! (In one sum particles and candidates are hard to tell apart, as most particles have much the same number of them.)
//! The ridge holds what the rows cannot tell apart (a uniform gas) at
//! the prior. Seven unknowns have 128 sets of positive ones: the best is found by trying them.
//!
//! A speed is estimated apart: from the averaged logarithm of predicted over measured seconds, less the median of what
//! the speeds in force leave. It leaves 1 where it is off by more than both a dead band and five standard errors, so
//! that the noise of timers moves no cut; from then on it follows by two.
//!
//! Invariant: the state is a function of the measurements alone; ranks that observe the same hold the same.

use serde::{Deserialize, Serialize};

/// What is balanced.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub enum By {
    /// The number of particles, whatever they cost and on whatever device.
    Particles,
    /// The seconds.
    Cost,
}

/// What a rank did in an interval, each a sum over its steps. Particles include ghosts, cells those around the own ones.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
pub struct Work {
    pub particles: u64,
    /// Entries of the neighbour lists: candidates for collisions.
    pub candidates: u64,
    pub wall_tests: u64,
    /// Triangles of fabric in the cells of the particles, for each particle.
    pub sheet_tests: u64,
    /// Cells of the grid, with or without gas: they are counted, scanned and cleared.
    pub cells: u64,
    pub steps: u64,
}

/// What a rank did and the device seconds that it took.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
pub struct Measurement {
    pub work: Work,
    pub seconds: f64,
    /// Those of them that go with the candidates alone, where the device tells.
    pub pair_seconds: Option<f64>,
}

/// Weights for the histograms: of particles, which a kernel sums, and of cells. A particle of up to 2^17 candidates and triangles weighs less than 2^32,
/// and the sum over 2^30 particles less than 2^62.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct IntegerWeights {
    pub particle: u32,
    pub candidate: u32,
    pub wall: u32,
    pub sheet: u32,
    /// Of a cell, whatever is in it.
    pub cell: u32,
}

/// Particle, candidate, wall test, cell, step apart from the search for pairs, step of that search, triangle of fabric.
const FEATURES: usize = 7;
/// Costs before any are measured, relative to a particle.
const PRIOR: [f64; FEATURES] = [1.0, 0.1, 1.0, 0.01, 6_000.0, 4_000.0, 0.2];
const OF_PAIRS: [bool; FEATURES] = [false, true, false, false, false, true, false];
/// Squared noise of a measurement (0.15) over squared doubt about the prior (1), both relative.
const RIDGE: f64 = 0.02;
const FORGET: f64 = 0.95;
/// Smallest change of a speed, as a logarithm.
const DEAD_BAND: f64 = 0.05;
/// To tell a device from the others, and to follow one that has been told.
const TELL_ERRORS: f64 = 5.0;
const FOLLOW_ERRORS: f64 = 2.0;
/// Relative noise of a measurement, before any is learnt.
const NOISE: f64 = 0.2;
/// Intervals before a speed is judged.
const FEWEST: u32 = 10;
/// Of what a rank would have without a halo.
const LEAST_SHARE: f64 = 0.2;
/// The largest weight.
const WEIGHT_ONE: f64 = 16_384.0;

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct CostModel {
    by: By,
    /// Seconds per prior unit of each feature.
    scaled: [f64; FEATURES],
    ranks: Vec<Rank>,
}

/// What is remembered of a rank's measurements, with forgetting.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
struct Rank {
    /// Sums over rows: weight, weight t (at speed 1), weight z z, weight z t (at speed 1).
    weight: f64,
    target: f64,
    squares: [[f64; FEATURES]; FEATURES],
    products: [f64; FEATURES],
    /// The logarithm of the speed in force.
    speed: f64,
    /// Mean and variance of the measured logarithm, the sum of the squared weights of the mean, and the number of rows.
    mean: f64,
    variance: f64,
    spread: f64,
    rows: u32,
}

impl CostModel {
    pub fn new(by: By, ranks: usize) -> CostModel {
        let rank = Rank {
            weight: 0.0,
            target: 0.0,
            squares: [[0.0; FEATURES]; FEATURES],
            products: [0.0; FEATURES],
            speed: 0.0,
            mean: 0.0,
            variance: NOISE * NOISE,
            spread: 0.0,
            rows: 0,
        };
        CostModel { by, scaled: [1.0; FEATURES], ranks: vec![rank; ranks] }
    }

    /// Takes in an interval: one measurement per rank, in order of rank. One without work or without a time is skipped.
    ///
    /// # Panics
    /// If the number of measurements is not that of the ranks.
    pub fn observe(&mut self, measurements: &[Measurement]) {
        assert_eq!(measurements.len(), self.ranks.len(), "one measurement per rank");
        let units = |of: &Measurement| of.work.units().iter().sum::<f64>();
        let valid = |of: &Measurement| of.seconds.is_finite() && of.seconds > 0.0 && units(of) > 0.0;
        let largest = measurements.iter().map(units).fold(0.0, f64::max);
        for (rank, of) in self.ranks.iter_mut().zip(measurements) {
            rank.forget();
            if valid(of) {
                for (features, seconds) in of.rows() {
                    let all: f64 = features.iter().sum();
                    if all > 0.0 {
                        rank.add_row(features.map(|unit| unit / all), seconds / all, all / largest);
                    }
                }
            }
        }
        self.fit();
        let mut ratios: Vec<(usize, f64)> = Vec::new();
        for (rank, of) in measurements.iter().enumerate().filter(|(_, of)| valid(of)) {
            // A factor of 20 either way is an accident, not a device.
            ratios.push((rank, libm::log(self.cost(&of.work) / of.seconds).clamp(-3.0, 3.0)));
        }
        // Without the speeds in force, so that known slow devices do not bias the median.
        let middle = median(ratios.iter().map(|&(rank, ratio)| ratio - self.ranks[rank].speed).collect());
        for (rank, ratio) in ratios {
            self.ranks[rank].judge_speed(ratio - middle);
        }
    }

    /// Seconds per particle, candidate, wall test, cell and step on a device of speed 1. Before anything is measured they
    /// are relative to a particle.
    pub fn coefficients(&self) -> [f64; 5] {
        let [particle, candidate, wall, cell, step, search, _] = self.all_coefficients();
        [particle, candidate, wall, cell, step + search]
    }

    /// The same per triangle of fabric.
    pub fn sheet_coefficient(&self) -> f64 {
        let [.., sheet] = self.all_coefficients();
        sheet
    }

    fn all_coefficients(&self) -> [f64; FEATURES] {
        std::array::from_fn(|k| self.scaled[k] * PRIOR[k])
    }

    /// The seconds that the work takes on a device of speed 1.
    pub fn cost(&self, work: &Work) -> f64 {
        work.units().iter().zip(&self.scaled).map(|(unit, scaled)| unit * scaled).sum()
    }

    /// The seconds that the work takes on the device of a rank.
    pub fn seconds(&self, rank: usize, work: &Work) -> f64 {
        self.cost(work) / libm::exp(self.ranks[rank].speed)
    }

    /// The speeds of the ranks' devices, of mean 1.
    pub fn speeds(&self) -> Vec<f64> {
        let speeds: Vec<f64> = self.ranks.iter().map(|rank| libm::exp(rank.speed)).collect();
        let mean = speeds.iter().sum::<f64>() / speeds.len() as f64;
        speeds.iter().map(|speed| speed / mean).collect()
    }

    /// What each rank is to have of the weight, of mean 1: by cost in proportion to its speed, by particles the same.
    pub fn shares(&self) -> Vec<f64> {
        match self.by {
            By::Particles => vec![1.0; self.ranks.len()],
            By::Cost => self.speeds(),
        }
    }

    /// As [`CostModel::shares`], less for a rank with a larger halo: its ghosts and cells cost it time, but are weighed
    /// where they are owned. `loads`: what each rank did, and what of it was its halo's, without steps. With own weight w, cost of
    /// the halo h and speed v all times (w + h)/v are to be the same: w = v t - h.
    ///
    /// # Panics
    /// If the number of loads is not that of the ranks.
    pub fn shares_beside_halos(&self, loads: &[(Work, Work)]) -> Vec<f64> {
        assert_eq!(loads.len(), self.ranks.len(), "one load per rank");
        let speeds = self.shares();
        let [.., step] = self.coefficients();
        let all: f64 = loads.iter().map(|(work, _)| self.cost(work) - step * work.steps as f64).sum();
        if self.by == By::Particles || all <= 0.0 {
            return speeds;
        }
        let count = loads.len() as f64;
        let time = all / count;
        let wanted = speeds.iter().zip(loads).map(|(speed, (_, halo))| {
            // A rank with hardly anything but ghosts keeps a part.
            (speed * time - self.cost(halo)).max(LEAST_SHARE * speed * time)
        });
        let wanted: Vec<f64> = wanted.collect();
        let mean = wanted.iter().sum::<f64>() / count;
        wanted.iter().map(|share| share / mean).collect()
    }

    /// The weights in fixed point: the largest is 2^14, or, by particles, a particle is 1.
    pub fn weights(&self) -> IntegerWeights {
        if self.by == By::Particles {
            return IntegerWeights { particle: 1, candidate: 0, wall: 0, sheet: 0, cell: 0 };
        }
        let [mut particle, mut candidate, mut wall, mut cell, _, _, mut sheet] = self.all_coefficients();
        if particle.max(candidate).max(wall).max(sheet) <= 0.0 {
            [particle, candidate, wall, cell, _, _, sheet] = PRIOR;
        }
        let largest = particle.max(candidate).max(wall).max(sheet);
        let scale = WEIGHT_ONE / largest;
        let integer = |cost: f64| (cost * scale).round() as u32;
        // Each particle weighs something: it takes memory, and a box of free ones is not empty.
        IntegerWeights {
            particle: integer(particle).max(1),
            candidate: integer(candidate),
            wall: integer(wall),
            sheet: integer(sheet),
            // Boxes are to follow the gas, whatever a fit to little gas says.
            cell: integer(cell.min(largest)),
        }
    }

    fn fit(&mut self) {
        let (mut weight, mut target) = (0.0, 0.0);
        let (mut squares, mut products) = ([[0.0; FEATURES]; FEATURES], [0.0; FEATURES]);
        for rank in &self.ranks {
            let speed = libm::exp(rank.speed);
            weight += rank.weight;
            target += rank.target * speed;
            products.iter_mut().zip(rank.products).for_each(|(sum, product)| *sum += product * speed);
            let entries = squares.iter_mut().flatten().zip(rank.squares.iter().flatten());
            entries.for_each(|(sum, square)| *sum += square);
        }
        if weight <= 0.0 {
            return;
        }
        for feature in 0..FEATURES {
            squares[feature][feature] += RIDGE;
            products[feature] += RIDGE * target / weight;
        }
        self.scaled = non_negative(&squares, &products);
    }
}

impl Rank {
    fn forget(&mut self) {
        self.weight *= FORGET;
        self.target *= FORGET;
        self.products = self.products.map(|sum| sum * FORGET);
        self.squares = self.squares.map(|row| row.map(|sum| sum * FORGET));
    }

    fn add_row(&mut self, z: [f64; FEATURES], target: f64, weight: f64) {
        self.weight += weight;
        self.target += weight * target;
        for row in 0..FEATURES {
            self.products[row] += weight * z[row] * target;
            for column in 0..FEATURES {
                self.squares[row][column] += weight * z[row] * z[column];
            }
        }
    }

    fn judge_speed(&mut self, measured: f64) {
        self.rows = self.rows.saturating_add(1);
        // A plain mean at first, then with forgetting.
        let part = (1.0 / f64::from(self.rows)).max(1.0 - FORGET);
        let off = measured - self.mean;
        self.mean += part * off;
        self.variance += (1.0 - FORGET) * (off * off - self.variance);
        self.spread = (1.0 - part) * (1.0 - part) * self.spread + part * part;
        if self.rows < FEWEST {
            return;
        }
        let error = (self.variance * self.spread).sqrt();
        let told = self.speed != 0.0;
        if told && self.mean.abs() < DEAD_BAND {
            self.speed = 0.0;
        } else if (self.mean - self.speed).abs() > DEAD_BAND.max(if told { FOLLOW_ERRORS } else { TELL_ERRORS } * error)
        {
            self.speed = self.mean;
        }
    }
}

impl Work {
    /// By the prior, of each feature.
    fn units(&self) -> [f64; FEATURES] {
        let Work { particles, candidates, wall_tests, sheet_tests, cells, steps } = *self;
        let counts = [particles, candidates, wall_tests, cells, steps, steps, sheet_tests];
        std::array::from_fn(|feature| counts[feature] as f64 * PRIOR[feature])
    }
}

impl Measurement {
    /// Features and the seconds that they took together.
    fn rows(&self) -> Vec<([f64; FEATURES], f64)> {
        let units = self.work.units();
        let only = |of_pairs: bool| std::array::from_fn(|k| if OF_PAIRS[k] == of_pairs { units[k] } else { 0.0 });
        match self.pair_seconds.filter(|pairs| (0.0..=self.seconds).contains(pairs)) {
            None => vec![(units, self.seconds)],
            Some(pairs) => vec![(only(false), self.seconds - pairs), (only(true), pairs)],
        }
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    match values.len() {
        0 => 0.0,
        count => (values[(count - 1) / 2] + values[count / 2]) / 2.0,
    }
}

/// The b >= 0 that minimises b . A b / 2 - r . b, for a positive definite A: the best among the minima with each set of
/// b's entries free and the others zero.
fn non_negative(matrix: &[[f64; FEATURES]; FEATURES], right: &[f64; FEATURES]) -> [f64; FEATURES] {
    let mut best = ([0.0; FEATURES], 0.0);
    for set in 1_u32..1 << FEATURES {
        let solution = solve(matrix, right, set);
        if solution.iter().any(|entry| *entry < 0.0) {
            continue;
        }
        // At the minimum of a set the value is -r . b / 2.
        let value: f64 = -solution.iter().zip(right).map(|(entry, right)| entry * right).sum::<f64>();
        if value < best.1 {
            best = (solution, value);
        }
    }
    best.0
}

/// Solves A b = r for the entries in `set`, the others being zero: elimination, without pivots as A is positive
/// definite.
fn solve(matrix: &[[f64; FEATURES]; FEATURES], right: &[f64; FEATURES], set: u32) -> [f64; FEATURES] {
    let free = |feature: usize| set >> feature & 1 == 1;
    let (mut left, mut right) = (*matrix, *right);
    for pivot in (0..FEATURES).filter(|&feature| free(feature)) {
        for row in (pivot + 1..FEATURES).filter(|&feature| free(feature)) {
            let factor = left[row][pivot] / left[pivot][pivot];
            right[row] -= factor * right[pivot];
            let above = left[pivot];
            left[row].iter_mut().zip(above).for_each(|(entry, above)| *entry -= factor * above);
        }
    }
    let mut solution = [0.0; FEATURES];
    for row in (0..FEATURES).rev().filter(|&feature| free(feature)) {
        let known: f64 = (row + 1..FEATURES).map(|column| left[row][column] * solution[column]).sum();
        solution[row] = (right[row] - known) / left[row][row];
    }
    solution
}
