//! The guards of a run: what leaves the table of limits (`plan/limits.rs`) while the run goes on is told, once each.
//!
//! A guard decides by tallies that are summed over all ranks, of a whole interval or a whole row, so that all ranks tell the
//! same at the same time, and a run that goes on from a checkpoint tells what the run without interruption does. Guards
//! change nothing in a run but whether it goes on (`--strict`).

use serde::{Deserialize, Serialize};

use super::row::Row;
use crate::gas::kinetics;
use crate::plan::{Bound, Plan, Quantity, Warning, limit};
use crate::scene::{Method, Scene};
use crate::subdomain::{BlockSum, FULL_SHARE, Tallies, box_bits};

/// Collisions after which the share of lost ones is judged: known to .4 % at 3 %.
const EVENTS: u64 = 2000;
/// Standard errors beyond a limit from which on it is no noise.
const SURE: f64 = 3.0;
/// Share of the particles that may be beyond a limit: that of the ladder.
const TAIL: f64 = 0.02;
/// Of a block: of less gas the density is too uncertain.
const LEAST_VOLUME: f64 = 0.05;
/// Hits on a vent before it is judged.
const HITS: u64 = 100;
/// Particles from which on a place is not just empty.
const NOT_EMPTY: f64 = 1.0;

/// A warning and when it was given.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GuardWarning {
    /// s.
    pub time: f64,
    /// Which of several openings, probes or vents.
    pub index: u32,
    pub warning: Warning,
}

impl std::fmt::Display for GuardWarning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "at {:.4} ms: {}", 1e3 * self.time, self.warning)
    }
}

/// What guards remember.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct GuardState {
    /// Since they were last judged.
    lost: u64,
    sampled: u64,
    told: Vec<GuardWarning>,
}

pub struct Guards<'a> {
    scene: &'a Scene,
    plan: &'a Plan,
    /// m3, and of the largest.
    block_volumes: Vec<f64>,
    full_block: f64,
    state: GuardState,
}

/// What an interval shows.
pub struct Shown<'a> {
    /// s, at its end.
    pub time: f64,
    pub step: f64,
    pub tallies: &'a Tallies,
    /// What was left of the cross-section in each block, in `FULL_SHARE`ths; empty if all.
    pub shares: &'a [u32],
    /// Of all particles in the interval, together.
    pub particle_steps: u64,
    /// Energy found over that which should be there, less 1.
    pub drift: f64,
    /// Of each vent: particles that left, and hits that were clipped, so far.
    pub clipped: &'a [[u64; 2]],
}

impl<'a> Guards<'a> {
    pub fn new(scene: &'a Scene, plan: &'a Plan, block_volumes: Vec<f64>) -> Guards<'a> {
        let full_block = block_volumes.iter().copied().fold(0.0, f64::max);
        Guards { scene, plan, block_volumes, full_block, state: GuardState::default() }
    }

    pub fn state(&self) -> &GuardState {
        &self.state
    }

    pub fn restore(&mut self, state: &GuardState) {
        self.state.clone_from(state);
    }

    pub fn told(&self) -> &[GuardWarning] {
        &self.state.told
    }

    fn table(&self, quantity: Quantity, subject: &str, value: f64, remedy: &str) -> Option<Warning> {
        Warning::by_table(quantity, self.plan.method, subject, value, remedy)
    }

    /// The warnings that are new.
    fn note(&mut self, time: f64, found: impl IntoIterator<Item = (u32, Option<Warning>)>) -> Vec<GuardWarning> {
        let mut new = Vec::new();
        for (index, warning) in found {
            let Some(warning) = warning else { continue };
            let known = |told: &GuardWarning| (told.warning.quantity, told.index) == (warning.quantity, index);
            if !self.state.told.iter().any(known) {
                new.push(GuardWarning { time, index, warning });
                self.state.told.extend(new.last().cloned());
            }
        }
        new
    }

    /// After every interval.
    pub fn interval(&mut self, shown: &Shown<'_>) -> Vec<GuardWarning> {
        let mut found = vec![
            (0, self.lost_events(shown.tallies)),
            (0, self.dense(&shown.tallies.blocks, shown.shares)),
            (0, self.last_step(shown.step)),
            (0, self.busy_walls(shown)),
            (0, self.fast(shown)),
            (0, self.starved(&shown.tallies.blocks)),
            (0, self.table(Quantity::EnergyDrift, "the gas", shown.drift.abs(), "report it with the scene")),
        ];
        for (index, (vent, [left, clipped])) in self.scene.vents.iter().zip(shown.clipped).enumerate() {
            if *left >= HITS {
                let (subject, share) = (format!("vent `{}`", vent.name), *clipped as f64 / *left as f64);
                let remedy = "a larger place, or a resolved hole";
                found.push((index as u32, self.table(Quantity::ClippedHits, &subject, share, remedy)));
            }
        }
        self.note(shown.time, found)
    }

    /// Lost events over all, once there are enough to tell.
    fn lost_events(&mut self, tallies: &Tallies) -> Option<Warning> {
        let counters = &tallies.counters;
        self.state.lost += u64::from(counters.lost);
        self.state.sampled += match self.plan.method {
            Method::None | Method::HalfTurn => return None,
            Method::Cell => counters.collisions,
            _ => u64::from(counters.sampled),
        };
        let events = self.state.lost + self.state.sampled;
        if events < EVENTS {
            return None;
        }
        let share = self.state.lost as f64 / events as f64;
        (self.state.lost, self.state.sampled) = (0, 0);
        let surely = share - SURE * (share * (1.0 - share) / events as f64).sqrt();
        let bound = limit(Quantity::LostCollisions, self.plan.method)?.bound;
        if bound.holds(surely) {
            return None;
        }
        self.table(Quantity::LostCollisions, "the gas", share, "a smaller `time_step`, or more `rounds`")
    }

    /// Blocks that are surely denser than the limit, with the diameters that they had, if more than a few particles are in
    /// them.
    fn dense(&self, blocks: &[BlockSum], shares: &[u32]) -> Option<Warning> {
        let bound = limit(Quantity::Occupancy, self.plan.method)?.bound;
        let per_density = kinetics::occupancy(1.0, self.plan.diameter);
        let (mut total, mut within, mut sum) = (0, 0, 0.0);
        for (index, (block, &room)) in blocks.iter().zip(&self.block_volumes).enumerate() {
            total += block.number;
            let number = block.number as f64;
            // Of most blocks it is known without a root: with the whole diameter and all particles it holds.
            if bound.holds(number / room * per_density) {
                continue;
            }
            let share = shares.get(index).map_or(1.0, |&share| f64::from(share) / f64::from(FULL_SHARE));
            let occupancy = |number: f64| number / room * per_density * share * share.sqrt();
            if room > LEAST_VOLUME * self.full_block && !bound.holds(occupancy(number - SURE * number.sqrt())) {
                within += block.number;
                sum += number * occupancy(number);
            }
        }
        if within as f64 <= TAIL * total as f64 {
            return None;
        }
        let share = 100.0 * within as f64 / total as f64;
        let subject = format!("where {share:.0} % of the gas is");
        let remedy = match self.plan.method {
            Method::ClosestApproach => "a smaller `diameter` or `diameter_cap`",
            _ => "a smaller `diameter`, or more `particles`",
        };
        self.table(Quantity::Occupancy, &subject, sum / within as f64, remedy)
    }

    fn busy_walls(&self, shown: &Shown<'_>) -> Option<Warning> {
        let hits = f64::from(shown.tallies.counters.bounces) / shown.particle_steps.max(1) as f64;
        self.table(Quantity::WallHits, "the time step", hits, "a smaller `time_step`")
    }

    /// By the gas at its end: the step follows what was seen two intervals before.
    fn fast(&self, shown: &Shown<'_>) -> Option<Warning> {
        let bound = limit(Quantity::FastParticles, self.plan.method)?.bound;
        let total: u64 = shown.tallies.blocks.iter().map(|block| block.number).sum();
        let fast = f64::from(*shown.tallies.fast.get(self.level(shown.step) as usize)?);
        let share = |number: f64| number / total.max(1) as f64;
        if bound.holds(share(fast - SURE * fast.sqrt())) {
            return None;
        }
        self.table(Quantity::FastParticles, "the time step", share(fast), "a smaller `time_step`")
    }

    /// Blocks whose cells surely have too few particles, if more than a few of all are in them. Gas with a longer free path
    /// than its cells leaves them before it collides again.
    fn starved(&self, blocks: &[BlockSum]) -> Option<Warning> {
        let bound = limit(Quantity::CellParticles, self.plan.method)?.bound;
        // The largest collision cell of `half-turn` is a tile.
        let tiled = self.plan.method == Method::HalfTurn;
        let cell = self.plan.grid.cell * f64::from(1u32 << box_bits(self.plan.method));
        let (mut total, mut within, mut sum) = (0, 0, 0.0);
        for (block, &room) in blocks.iter().zip(&self.block_volumes) {
            total += block.number;
            let number = block.number as f64;
            let in_cell = |number: f64| number / room * cell.powi(3);
            if bound.holds(in_cell(number)) {
                continue;
            }
            let holds = room <= LEAST_VOLUME * self.full_block || bound.holds(in_cell(number + SURE * number.sqrt()));
            if !holds && (tiled || kinetics::mean_free_path(number / room, self.plan.diameter) <= cell) {
                within += block.number;
                sum += number * in_cell(number);
            }
        }
        if within as f64 <= TAIL * total as f64 {
            return None;
        }
        let share = 100.0 * within as f64 / total as f64;
        let subject = format!("where {share:.0} % of the gas is");
        let remedy = match self.plan.method {
            Method::HalfTurn => "another `method` where viscosity counts there",
            _ => "a smaller `diameter` or `occupancy`, or another `method`",
        };
        self.table(Quantity::CellParticles, &subject, sum / within as f64, remedy)
    }

    fn level(&self, step: f64) -> f64 {
        (self.plan.time_step / step).log2().round()
    }

    /// How far the step is from the ladder's smallest.
    fn last_step(&self, step: f64) -> Option<Warning> {
        let left = f64::from(self.plan.ladder_levels - 1) - self.level(step);
        let remedy = "a smaller `time_step`, a smaller `diameter`, or more `rounds`";
        self.table(Quantity::Halvings, "the time step", left, remedy)
    }

    /// After every row: openings and probes that have too few particles.
    pub fn row(&mut self, row: &Row) -> Vec<GuardWarning> {
        let mut found = Vec::new();
        if self.plan.method != Method::None {
            for (index, opening) in self.plan.openings.iter().enumerate() {
                let densities = opening.between.map(|chamber| {
                    row.chambers[chamber].particles.iter().sum::<f64>() / self.plan.chambers[chamber].volume
                });
                let count = densities[0].max(densities[1]) * opening.length.powi(3);
                let subject = format!("opening `{}`", opening.name);
                let remedy = "more `particles`, or a modelled vent";
                found.push((index as u32, self.table(Quantity::OpeningParticles, &subject, count, remedy)));
            }
        }
        for (index, (probe, state)) in self.scene.probes.iter().zip(&row.probes).enumerate() {
            let count: f64 = state.particles.iter().sum();
            if Bound::AtLeast(NOT_EMPTY).holds(count) {
                let subject = format!("probe `{}`", probe.name);
                let remedy = "a larger region, or more `particles`";
                found.push((index as u32, self.table(Quantity::ProbeParticles, &subject, count, remedy)));
            }
        }
        self.note(row.time, found)
    }
}

#[cfg(test)]
mod tests;
