//! Intervals on their way through the device: they are submitted, and read late.

use std::time::Instant;

use super::elastic_fabric::{ElasticFabric, SavedFabric};
use super::step::{Sampling, step};
use crate::gpu::{Device, PhaseTimer, Readback, Recording};
use crate::ranks::Reduction;
use crate::simulation::accounting::phases::{BLOCKS, LOST, TALLY};
use crate::simulation::control::interval::Interval;
use crate::simulation::error::SimulationError;
use crate::simulation::parallel::decomposition::Decomposition;
use crate::simulation::parallel::exchange::{Exchange, Traffic};
use crate::subdomain::{GridCells, Remembered, Steps, Subdomain, Tallies};

/// An interval on its way through the device.
pub struct InFlight {
    pub interval: Interval,
    pub before: Remembered,
    pub tallies: Pending,
    /// Phases that were timed: of one step, and what is once an interval.
    pub phases: Vec<&'static str>,
    /// Particles on this rank, ghosts included, in the last step.
    pub present: u32,
    /// Cells on this rank, in the last step.
    pub cells: GridCells,
    /// What went between the ranks in it.
    pub traffic: Traffic,
    /// Of elastic fabric.
    pub fabric: Option<FabricInFlight>,
}

/// Elastic fabric of an interval on its way.
pub struct FabricInFlight {
    /// As it was before.
    pub before: SavedFabric,
    /// As it becomes.
    pub after: Readback,
}

/// Tallies on their way to the host and through the ranks.
pub enum Pending {
    OnDevice(Readback),
    /// This rank's, the timer's stamps, and the sums over the ranks that are being formed.
    Reducing(Box<Tallies>, Vec<u8>, Reduction),
}

/// What an interval runs on.
pub struct Machine<'a, 'b> {
    pub device: &'a Device,
    pub subdomain: &'a mut Subdomain,
    pub exchange: &'a mut Exchange<'b>,
    pub decomposition: Option<&'a mut Decomposition>,
    pub fabric: Option<&'a ElasticFabric<'b>>,
    pub timer: Option<&'a PhaseTimer>,
    /// Steps per submission.
    pub batch: u32,
    /// Whether neighbour lists get the room that the first step wants before it runs.
    pub fit_lists: bool,
}

impl Machine<'_, '_> {
    /// Encodes and submits the interval, `batch` steps a submission. Neither the batches nor the timed step
    /// change a bit of the result.
    pub fn submit(&mut self, interval: Interval, spare: Option<wgpu::Buffer>) -> Result<InFlight, SimulationError> {
        let start = Instant::now();
        let device = self.device;
        if let Some(decomposition) = self.decomposition.as_deref_mut()
            && decomposition.is_scattered()
        {
            decomposition.apply(device, self.subdomain, self.exchange)?;
        }
        let before = self.subdomain.remember(device, spare)?;
        if self.fit_lists {
            self.subdomain.fit_lists(device, interval.dt, &interval.tables, &before)?;
        }
        let done = interval.done.as_ref().map_or(0, |(steps, _)| *steps);
        let steps = Steps { first: interval.first_step, done, dt: interval.dt, tallied: &interval.tallied };
        let slots = self.subdomain.begin_interval(device, &steps, &interval.entering(), &interval.tables)?;
        let last = interval.steps - 1;
        // The last step is timed; on a device alone, where all but the last count the next one's particles, and the first has a `bin` of its own, the one
        // before, unless that is the first that is to be done, and of the last what that one has not.
        let early = self.subdomain.place().is_alone() && last > done + 1;
        let timed = if early { last - 1 } else { last };
        // A tally is timed once, in the timed step or in the last that has one.
        let sampled =
            interval.tallied.iter().rposition(|&tallied| tallied).filter(|_| !interval.tallied[timed as usize]);
        let alone = |k: u32| -> &'static [&'static str] {
            match (k == last, k == 0, Some(k as usize) == sampled) {
                (true, _, true) => &[TALLY, BLOCKS],
                (true, _, false) => &[BLOCKS],
                (false, true, true) => &[LOST, TALLY],
                (false, true, false) => &[LOST],
                (false, false, true) => &[TALLY],
                (false, false, false) => &[],
            }
        };
        let mut rec = Recording::new(device);
        let fabric_before = self.fabric.map(|fabric| fabric.begin_interval(&mut rec, &interval)).transpose()?;
        let (mut present, mut cells) = (0, GridCells::default());
        for (k, mut slot) in (done..).zip(slots) {
            let sampling = Sampling { lost: k == 0, tally: interval.tallied[k as usize] };
            if k == timed {
                rec.time(self.timer);
            } else {
                rec.time_alone(self.timer.filter(|_| !alone(k).is_empty()), alone(k));
            }
            self.subdomain.begin_step(&mut rec, &mut slot)?;
            if let (Some(fabric), Some(begun)) = (self.fabric, &fabric_before) {
                self.exchange.impulses(&mut rec, fabric.impulses())?;
                fabric.step(&mut rec, k, begun);
            }
            step(self.subdomain, self.exchange, &mut rec, &mut slot, sampling)?;
            if k == last {
                self.subdomain.tally_blocks(&mut rec, &slot);
                self.subdomain.count_candidates(&mut rec, &slot);
                (present, cells) = (slot.present(), self.subdomain.cells());
            } else if (k + 1).is_multiple_of(self.batch.max(1)) {
                rec.submit();
            }
            if let Some(decomposition) = self.decomposition.as_deref_mut()
                && decomposition.home()
            {
                decomposition.apply(device, self.subdomain, self.exchange)?;
            }
        }
        let phases = rec.timed().to_vec();
        let timed = self.timer.map(|timer| (timer, phases.len()));
        let staging = self.subdomain.encode_readback(&mut rec, timed)?;
        let staging_of_fabric =
            self.fabric.map(|fabric| fabric.encode_readback(&mut rec, &interval.tallied)).transpose()?;
        let submission = rec.submit();
        let fabric = fabric_before
            .zip(staging_of_fabric)
            .map(|(before, staging)| FabricInFlight { before, after: device.read_later(staging, submission.clone()) });
        let tallies = Pending::OnDevice(device.read_later(staging, submission));
        self.exchange.ran(start.elapsed().as_secs_f64());
        let traffic = self.exchange.recent();
        Ok(InFlight { before, tallies, phases, present, cells, traffic, fabric, interval })
    }
}
