//! What a run on so many devices would take, from subdomains that were measured alone.
//!
//! Of a step, over the subdomains r of a state:
//!
//! ```text
//! work      = max_r (c_p particles_r + c_c candidates_r + c_w walls_r + c_f sheets_r + c_s cells_r) / u
//! time      = max_r own_r  +  max_r (stages_r latency + messages_r overhead + bytes_r / bandwidth)
//! GPU time  = max_r work_r x (time per unit) + passes x (time per pass)
//!             + max_r (stages_r (latency + wait) + messages_r overhead + bytes_r / bandwidth)
//! ```
//!
//! c are the device seconds per particle, candidate, wall test, triangle of fabric and cell, fitted to all subdomains of the sweep together with
//! a constant per step, which is left out: so work is what sharing out can win or lose. The unit u is the work of the
//! mean particle, so that work counts particles, ghosts among them. States count by the steps of the run that they
//! stand for. Only own_r, the counts and the messages are measured; network and GPU are assumed.

use crate::partition::{By, CostModel, Measurement, Work};

use super::Strategy;
use super::emulation::{Emulated, Share};

/// What messages cost, as assumed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Network {
    /// s, of an exchange with all neighbours.
    pub latency: f64,
    /// s, of each message in it besides.
    pub overhead: f64,
    /// Bytes per second of one device.
    pub bandwidth: f64,
}

/// A GPU, as assumed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gpu {
    /// s per unit of work.
    pub unit: f64,
    /// s per pass, whatever is in it.
    pub pass: f64,
    /// s until the host knows that the device is done, of each exchange.
    pub wait: f64,
}

/// Device seconds per particle, candidate, wall test and cell, and what they count in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Costs {
    pub particle: f64,
    pub candidate: f64,
    pub wall: f64,
    pub sheet: f64,
    pub cell: f64,
    /// Per step, whatever is in it.
    pub step: f64,
    /// Of the mean particle.
    pub unit: f64,
}

impl Costs {
    /// Fitted to the device times of all these; where there are none, those that are assumed before any is measured.
    pub fn fit<'a>(shares: impl Iterator<Item = &'a Share>) -> Costs {
        let shares: Vec<&Share> = shares.filter(|share| share.particles > 0.0).collect();
        let measurement = |share: &&Share| Measurement {
            work: work_of(share),
            seconds: share.device_seconds,
            pair_seconds: share.pair_seconds,
        };
        let measurements: Vec<Measurement> = shares.iter().map(measurement).collect();
        // Each is a row of its own in one fit: nothing is forgotten, and no device counts as slower than another.
        let mut model = CostModel::new(By::Cost, measurements.len().max(1));
        if !measurements.is_empty() {
            model.observe(&measurements);
        }
        let [particle, candidate, wall, cell, step] = model.coefficients();
        let mut costs = Costs { particle, candidate, wall, sheet: model.sheet_coefficient(), cell, step, unit: 1.0 };
        let particles: f64 = shares.iter().map(|share| share.particles).sum();
        let all: f64 = shares.iter().map(|share| costs.of(share)).sum();
        if all > 0.0 {
            costs.unit = all / particles;
        }
        costs
    }

    /// s, or whatever the coefficients are in.
    fn of(&self, share: &Share) -> f64 {
        self.particle * share.particles
            + self.candidate * share.candidates
            + self.wall * share.walls
            + self.sheet * share.sheets
            + self.cell * share.cells
    }

    /// In units.
    pub fn work(&self, share: &Share) -> f64 {
        self.of(share) / self.unit
    }
}

fn work_of(share: &Share) -> Work {
    Work {
        particles: share.particles.round() as u64,
        candidates: share.candidates.round() as u64,
        wall_tests: share.walls.round() as u64,
        sheet_tests: share.sheets.round() as u64,
        cells: share.cells.round() as u64,
        steps: 1,
    }
}

/// A step on so many devices, the mean of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    pub devices: usize,
    pub strategy: Strategy,
    /// Steps of the run.
    pub steps: f64,
    /// On all devices together.
    pub particles: f64,
    /// Of the fullest subdomain; `None` on one device, which counts nothing. In particles, and in units of work.
    pub owned: Option<f64>,
    pub work: Option<f64>,
    /// Ghosts per owned particle, over all subdomains.
    pub halo: Option<f64>,
    /// Fullest over mean.
    pub owned_imbalance: Option<f64>,
    pub work_imbalance: Option<f64>,
    /// Largest fullest over mean by weight right after a rebalance.
    pub after: Option<f64>,
    /// s: of the slowest subdomain alone, of the messages, and both.
    pub own: f64,
    pub messages: f64,
    pub time: f64,
    /// s, on the assumed GPU.
    pub gpu: Option<f64>,
}

/// The mean step of the states, each for so many steps of the run. None of the states: `None`.
pub fn point(
    states: &[(f64, &Emulated)],
    particles: f64,
    costs: &Costs,
    network: &Network,
    gpu: &Gpu,
) -> Option<Point> {
    let steps: f64 = states.iter().map(|(steps, _)| steps).sum();
    let (_, first) = states.first()?;
    let mean = |of: &dyn Fn(&Emulated) -> f64| states.iter().map(|(k, state)| k * of(state)).sum::<f64>() / steps;
    let counted = states.iter().all(|(_, state)| state.shares.iter().any(|share| share.particles > 0.0));
    let counts = |of: &dyn Fn(&Emulated) -> f64| counted.then(|| mean(of));
    let owned = |state: &Emulated| most(state, |share| share.owned);
    let work = |state: &Emulated| most(state, |share| costs.work(share));
    let sum = |state: &Emulated, of: &dyn Fn(&Share) -> f64| state.shares.iter().map(of).sum::<f64>();
    let per_device = |state: &Emulated, of: &dyn Fn(&Share) -> f64| sum(state, of) / state.shares.len() as f64;
    let sent = |state: &Emulated, wait: f64| {
        let of = |share: &Share| {
            share.stages * (network.latency + wait)
                + share.messages * network.overhead
                + share.bytes / network.bandwidth
        };
        most(state, of)
    };
    let own = mean(&|state| most(state, |share| share.own_seconds));
    let messages = mean(&|state| sent(state, 0.0));
    // Ratios of means over the run, as its times are sums over the run.
    let over_mean = |most: Option<f64>, of: &dyn Fn(&Share) -> f64| {
        most.map(|most| most / mean(&|state: &Emulated| per_device(state, of)))
    };
    let (owned, work) = (counts(&owned), counts(&work));
    Some(Point {
        devices: first.shares.len(),
        strategy: first.strategy,
        steps,
        particles,
        owned,
        work,
        halo: counts(&|state| sum(state, &|share| share.particles))
            .zip(counts(&|state| sum(state, &|share| share.owned)))
            .map(|(all, owned)| all / owned - 1.0),
        owned_imbalance: over_mean(owned, &|share| share.owned),
        work_imbalance: over_mean(work, &|share| costs.work(share)),
        after: states.iter().filter_map(|(_, state)| state.after).reduce(f64::max),
        own,
        messages,
        time: own + messages,
        gpu: counts(&|state| {
            gpu.unit * most(state, |share| costs.work(share)) + gpu.pass * state.passes + sent(state, gpu.wait)
        }),
    })
}

fn most(state: &Emulated, of: impl Fn(&Share) -> f64) -> f64 {
    state.shares.iter().map(of).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn share(particles: f64, own_seconds: f64, bytes: f64) -> Share {
        Share { owned: 0.8 * particles, particles, own_seconds, stages: 3.0, messages: 6.0, bytes, ..Share::default() }
    }

    fn emulated(shares: Vec<Share>) -> Emulated {
        Emulated { strategy: Strategy::Dynamic, shares, passes: 20.0, after: Some(1.02) }
    }

    const COSTS: Costs =
        Costs { particle: 2e-6, candidate: 0.0, wall: 0.0, sheet: 0.0, cell: 0.0, step: 0.0, unit: 2e-6 };
    const NETWORK: Network = Network { latency: 1e-3, overhead: 1e-4, bandwidth: 1e6 };
    const GPU: Gpu = Gpu { unit: 1e-6, pass: 1e-5, wait: 1e-4 };

    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-12 * expected.abs(), "{found} {expected}");
    }

    /// The slowest subdomain, and the subdomain with the costliest messages: not the same one here.
    #[test]
    fn a_step_takes_the_slowest_subdomain_and_the_costliest_messages() {
        let state = emulated(vec![share(1000.0, 0.5, 1000.0), share(3000.0, 0.25, 4000.0)]);
        let point = point(&[(10.0, &state)], 4000.0, &COSTS, &NETWORK, &GPU).unwrap();
        close(point.own, 0.5);
        close(point.messages, 3e-3 + 6e-4 + 4e-3);
        close(point.time, 0.5076);
        close(point.work.unwrap(), 3000.0);
        close(point.owned.unwrap(), 2400.0);
        close(point.work_imbalance.unwrap(), 1.5);
        close(point.halo.unwrap(), 0.25);
        close(point.gpu.unwrap(), 3e-3 + 2e-4 + 3.0 * 1.1e-3 + 6e-4 + 4e-3);
    }

    #[test]
    fn states_count_by_the_steps_that_they_stand_for() {
        let (long, short) = (emulated(vec![share(100.0, 0.1, 0.0)]), emulated(vec![share(500.0, 0.9, 0.0)]));
        let point = point(&[(30.0, &long), (10.0, &short)], 100.0, &COSTS, &NETWORK, &GPU).unwrap();
        close(point.own, 0.3);
        close(point.work.unwrap(), 200.0);
        close(point.steps, 40.0);
        assert!(super::point(&[], 0.0, &COSTS, &NETWORK, &GPU).is_none());
    }

    #[test]
    fn a_device_alone_counts_nothing_and_has_its_time() {
        let alone = emulated(vec![Share { own_seconds: 0.5, ..Share::default() }]);
        let point = point(&[(1.0, &alone)], 1.0, &COSTS, &NETWORK, &GPU).unwrap();
        assert_eq!((point.work, point.owned, point.gpu, point.time), (None, None, None, 0.5));
    }

    /// Device times that follow a law give the law back, and its constant is not in the work.
    #[test]
    fn costs_are_those_of_the_device_times() {
        /// Candidates and cells for each particle.
        const OF_GAS: [(f64, f64); 4] = [(1.0, 200.0), (1.0, 2.0), (8.0, 20.0), (30.0, 1.0)];
        let sizes = [1e3, 3e3, 1e4, 4e4, 1e5, 2e5];
        let measured = |candidates: f64, around: f64, k: f64| {
            let (particles, candidates, walls, cells) = (k, candidates * k, 0.05 * k.sqrt(), around * k);
            let device_seconds = 1e-4 + 1e-7 * particles + 1e-8 * candidates + 1e-7 * walls + 1e-9 * cells;
            Share { particles, candidates, walls, cells, device_seconds, ..Share::default() }
        };
        let shares: Vec<Share> =
            sizes.iter().flat_map(|&k| OF_GAS.map(|(candidates, around)| measured(candidates, around, k))).collect();
        let costs = Costs::fit(shares.iter());
        for share in shares.iter().filter(|share| share.particles >= 1e4) {
            let law = share.device_seconds - 1e-4;
            let found = costs.work(share) * costs.unit;
            assert!((found - law).abs() < 0.15 * law, "{found} {law} {costs:?}");
        }
        let untimed: Vec<Share> = shares.iter().map(|share| Share { device_seconds: 0.0, ..*share }).collect();
        let prior = Costs::fit(untimed.iter());
        assert!(prior.particle == 1.0 && prior.unit > 1.0, "{prior:?}");
    }
}
