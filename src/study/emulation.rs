//! Counts of devices that the machine lacks: so many subdomains in one process, one at a time on one device, each
//! measured alone.
//!
//! A state is measured as it is: a few steps of it in short intervals, by the cuts of the start or by cuts made for
//! the state. Nothing here changes a result of the steps.

use crate::gpu::Device;
use crate::partition::By;
use crate::ranks::{Communicator, Pace, in_process};
use crate::simulation::RowObserver;
use crate::simulation::{
    BalanceMode, BalanceOptions, BalanceRecord, HaloOptions, Model, Observer, Options, RunState, Setup, Simulation,
    SimulationError,
};

use super::stopwatch::{Event, Lap, Stopwatch, laps};
use super::{Strategy, StudyError};

/// A moment of a run.
pub struct State<'a> {
    pub name: String,
    /// Its plan's `steps_per_interval` is the length of the intervals that are measured.
    pub model: &'a Model,
    pub setup: &'a Setup,
    /// What the run has done by then; `None` at its start.
    pub run: Option<&'a RunState>,
    /// Steps of the run that it stands for.
    pub steps: f64,
}

/// What measures states, and how.
pub struct Emulator<'a> {
    pub device: &'a Device,
    /// Intervals that are measured, after those that bring the state about.
    pub intervals: usize,
    pub by: By,
    pub halo: HaloOptions,
}

/// A step of one subdomain, measured alone.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Share {
    pub owned: f64,
    /// Ghosts included.
    pub particles: f64,
    /// Entries of the neighbour lists.
    pub candidates: f64,
    /// Particles that may meet a wall.
    pub walls: f64,
    /// Triangles of fabric in the cells of its particles, for each particle.
    pub sheets: f64,
    /// Cells of the grid, those of the halo included.
    pub cells: f64,
    /// Time of its passes on the device; zero where the device does not time.
    pub device_seconds: f64,
    /// Those of them that go with the candidates alone, where the device tells.
    pub pair_seconds: Option<f64>,
    /// All its own time: device and host.
    pub own_seconds: f64,
    /// Exchanges, messages sent in them, and their bytes.
    pub stages: f64,
    pub messages: f64,
    pub bytes: f64,
}

/// A state shared out.
#[derive(Debug, Clone, PartialEq)]
pub struct Emulated {
    pub strategy: Strategy,
    pub shares: Vec<Share>,
    /// Passes of a step.
    pub passes: f64,
    /// Fullest over mean by weight after the last rebalance.
    pub after: Option<f64>,
}

/// Rebalances before a measurement: the second knows the costs better, and each the halos that cuts like its own have.
const REBALANCES: u32 = 4;
/// Intervals until a rebalance's first loads are read, and until the cuts are those asked for.
const LATE: usize = 2;

impl Emulator<'_> {
    /// # Errors
    /// If the device fails, or there are more subdomains than cells.
    pub fn emulate(&self, state: &State<'_>, devices: usize, strategy: Strategy) -> Result<Emulated, StudyError> {
        let (mode, settling) = match strategy {
            Strategy::Off => (BalanceMode::Off, LATE),
            Strategy::Initial => (BalanceMode::Initial, LATE),
            Strategy::Dynamic => (BalanceMode::AtOnce { times: REBALANCES }, LATE * (REBALANCES as usize + 1)),
        };
        let balance = BalanceOptions { mode, by: self.by, ..BalanceOptions::default() };
        let options = Options { balance, halo: self.halo, discard_particles: true, ..Options::default() };
        let intervals = settling + self.intervals;
        let mut ranks = Vec::new();
        for rank in in_process(devices, Pace::OneAtATime, |comm: &dyn Communicator| {
            let done = self.one(state, comm, options, intervals);
            if let Err(error) = &done {
                comm.fail(&error.to_string(), 1);
            }
            done
        })? {
            ranks.push(rank?);
        }
        let steps = state.model.plan.steps_per_interval as usize;
        shared_out(&ranks, strategy, steps, settling).ok_or_else(|| StudyError::TooShort { state: state.name.clone() })
    }

    /// One rank.
    fn one(
        &self,
        state: &State<'_>,
        comm: &dyn Communicator,
        options: Options<'_>,
        intervals: usize,
    ) -> Result<Watched, SimulationError> {
        let watch = Stopwatch::new(comm);
        let mut records = Records::default();
        let outcome = {
            let mut simulation = Simulation::among(state.model, self.device, state.setup, &watch, options)?;
            if let Some(run) = state.run {
                simulation = simulation.resume(run)?;
            }
            simulation.begin(&mut records)?;
            for _ in 0..intervals {
                watch.mark();
                if !simulation.advance(&mut records)? {
                    break;
                }
            }
            // What follows is no interval's.
            watch.mark();
            simulation.finish(&mut records)?
        };
        let passes = outcome.phases.rows.iter().map(|(_, _, count)| count).sum::<u64>() as f64;
        Ok(Watched { events: watch.events(), balance: records.0, passes: passes / outcome.steps.max(1) as f64 })
    }
}

/// What a rank has seen.
struct Watched {
    events: Vec<Event>,
    balance: Vec<BalanceRecord>,
    passes: f64,
}

/// What the ranks had to do in each interval.
#[derive(Default)]
struct Records(Vec<BalanceRecord>);

impl RowObserver for Records {}

impl Observer for Records {
    fn balance(&mut self, record: &BalanceRecord) -> Result<(), SimulationError> {
        self.0.push(record.clone());
        Ok(())
    }
}

/// `None` if no interval was as it should be.
fn shared_out(ranks: &[Watched], strategy: Strategy, steps: usize, settling: usize) -> Option<Emulated> {
    let records = &ranks[0].balance;
    let last = records.iter().rposition(|record| record.rebalanced.is_some());
    // In the interval of a rebalance particles come home.
    let first = settling.max(last.map_or(0, |at| at + 1));
    let mut shares = Vec::with_capacity(ranks.len());
    for (rank, seen) in ranks.iter().enumerate() {
        // What follows the last mark is the end of the run.
        let mut timed = laps(&seen.events, steps);
        timed.pop();
        let timed: Vec<Lap> = timed.into_iter().skip(first).flatten().collect();
        let own_seconds = median(timed.iter().map(|lap| lap.seconds))?;
        let mean = |of: fn(&Lap) -> f64| timed.iter().map(of).sum::<f64>() / timed.len() as f64;
        let mut share = Share {
            own_seconds,
            stages: mean(|lap| lap.stages),
            messages: mean(|lap| lap.messages),
            bytes: mean(|lap| lap.bytes),
            ..Share::default()
        };
        // A rank alone has no records.
        let loads: Vec<_> = records.iter().skip(first).map(|record| record.loads[rank]).collect();
        if !loads.is_empty() {
            let mean = |of: fn(&crate::simulation::Load) -> u64| {
                loads.iter().map(|load| of(load) as f64).sum::<f64>() / loads.len() as f64
            };
            share.owned = mean(|load| load.owned);
            share.particles = mean(|load| load.particles);
            share.candidates = mean(|load| load.candidates);
            share.walls = mean(|load| load.walls);
            share.sheets = mean(|load| load.sheets);
            share.cells = mean(|load| load.cells);
            share.device_seconds = median(loads.iter().map(|load| load.seconds))?;
            // The same part of the middle time as of all times.
            let all: f64 = loads.iter().map(|load| load.seconds).sum();
            let pairs: Option<f64> = loads.iter().map(|load| load.pair_seconds).sum();
            share.pair_seconds = pairs.filter(|_| all > 0.0).map(|pairs| pairs / all * share.device_seconds);
        }
        shares.push(share);
    }
    let after = last.and_then(|at| records[at].rebalanced).map(|[_, after]| after);
    Some(Emulated { strategy, shares, passes: ranks[0].passes, after })
}

/// The middle one, or the mean of the two in the middle.
pub fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let count = values.len();
    (count > 0).then(|| 0.5 * (values[(count - 1) / 2] + values[count / 2]))
}
