//! One device's gas: the particle buffers and the kernels of each phase of the step.
//!
//! Invariants: between steps `particles` holds every particle once, in the order of their cells where
//! there are collisions (of a device alone that is held, for want of room, `sorted` does until the host goes on); positions are fixed-point on the plan's grid; nothing is read back but the
//! tallies of an interval, one interval late, and whole states on request.

mod buffers;
mod cell_table;
mod constants;
mod counters;
mod domain;
mod encode;
mod exchange;
mod kernels;
mod layout;
mod memory;
mod nearness;
mod place;
pub mod registry;
mod rounds;
mod scales;
mod state;
mod step_slot;
mod tallies;
mod walls;

use std::borrow::Cow;
use std::sync::Arc;

use crate::gpu::{BoundKernel, Constants, Device, Form, GpuError, PhaseTimer, Readback, Recording};
use crate::plan::Plan;

pub use buffers::{CHUNK, EMPTIED_CELLS, MOTION_ENTRIES, choose_empties, few_stretches, most_particles};
pub use cell_table::{CellTable, TooManyParts};
pub use constants::{CROWD, Features, MEMBERS, Patches, WORKGROUP, block_counts, constants, merges, readable_numbers};
pub use counters::{Counters, places_in_parts};
pub use domain::{Domain, DomainInput, KernelChoice};
pub use exchange::{Messages, Outgoing};
pub use layout::{
    GpuCoat, GpuFlight, GpuGas, GpuMotion, GpuNewborn, GpuPart, GpuParticle, GpuPeer, GpuSending, GpuStep, GpuStillGas,
    GpuTriangle, GpuUpdate, GpuVent, GpuWeights, GpuZone,
};
pub use memory::Memory;
pub use place::{Cells, Ghosts, GridCells, Place};
pub use scales::Scales;
pub use state::{StateError, share_table, zone_of};
pub use step_slot::{FULL_SHARE, Newborns, StepSlot, Steps, Tables};
pub use tallies::{BlockSum, CoatSum, SurfaceSum, Tallies, VentSum, ZoneSum};
pub use walls::Walls;

use buffers::{
    Buffers, CellBuffers, ExchangeBuffers, ExchangeRoom, FIRST_TAILS, FixedBuffers, ParticleBuffers, TallyWords,
};
use exchange::Guess;
use kernels::{CollisionKernels, Kernels};

/// How an interval can be run again with larger buffers.
pub struct Remembered {
    kept: Kept,
    count: u32,
}

enum Kept {
    /// No interval is ever run again.
    Nothing,
    /// A device alone is held where it had too little room, and goes on from there (`shaders/complete_lists.wgsl`).
    Held,
    /// Whether one must is known when all ranks' tallies are: each interval has a copy of the particles before it.
    Copy(wgpu::Buffer),
}

impl Remembered {
    /// Memory that can be used again.
    pub fn spare(self) -> Option<wgpu::Buffer> {
        match self.kept {
            Kept::Copy(buffer) => Some(buffer),
            Kept::Nothing | Kept::Held => None,
        }
    }
}

pub struct Subdomain {
    domain: Arc<Domain>,
    place: Place,
    kernels: Kernels<BoundKernel>,
    fixed: FixedBuffers,
    cell: CellBuffers,
    particle: ParticleBuffers,
    exchange: ExchangeBuffers,
    exchange_room: ExchangeRoom,
    outbox_guess: Guess,
    update_guess: Guess,
    /// Slots of `particles` in use once all encoded steps have run; among others some of them are dead.
    count: u32,
    staging: Vec<wgpu::Buffer>,
    spare_staging: Vec<wgpu::Buffer>,
    /// The last step that was encoded leaves lists and cells empty for the next.
    emptied: bool,
    /// Lists with so few places have a thread for each.
    short_lists: u64,
    /// A copy of the flights of each step, with their lists, before particles take their room.
    watched: Option<wgpu::Buffer>,
}

/// Places of a list for each of which a GPU is told of a thread: it would wait longer for the number of the entries.
const SHORT_LIST: u64 = 1 << 16;

/// The most particles that room is made for ahead of need: a device alone has at most all that the plan has.
fn most(plan: &Plan, features: Features) -> u64 {
    if features.halo { u64::MAX } else { plan.particles }
}

impl Subdomain {
    /// A subdomain at `place` that starts with these particles.
    ///
    /// # Errors
    /// If the particles or cells are over the device's limits.
    pub fn new(
        device: &Device,
        domain: Arc<Domain>,
        place: Place,
        particles: &[GpuParticle],
    ) -> Result<Subdomain, GpuError> {
        let (plan, features) = (&domain.plan, domain.features);
        let slots = u64::from(plan.steps_per_interval) * u64::from(encode::uniforms(plan, features));
        let shares = if features.capped { block_counts(plan).iter().map(|&n| u64::from(n)).product() } else { 1 };
        let tables =
            [domain.patches.coats as u64, domain.vent_entries as u64, domain.parted_cells, domain.moved_cells, shares];
        let fixed = FixedBuffers::new(device, domain.words, slots, tables)?;
        // Room for what is there, and for some that come: of an inflow, or from other devices.
        let present = particles.len() as u64;
        let come = if features.orifices || features.halo { (present / 8).max(1024) } else { 0 };
        let capacity = present.max((present + come).min(most(plan, features)));
        let particle = ParticleBuffers::new(device, capacity, 1024, capacity / FIRST_TAILS, features)?;
        // Without collisions nothing is binned.
        let bins = if features.collisions { bins_of(&place, &domain) } else { 4 };
        let cell = CellBuffers::new(device, bins, domain.features.has_cells())?;
        let exchange_room = ExchangeRoom { particles: 64, updates: 64, received: 64, peers: 16, cuts: 64, planes: 256 };
        let exchange = ExchangeBuffers::new(device, &exchange_room)?;
        let buffers =
            Buffers { domain: &domain.buffers, fixed: &fixed, cell: &cell, particle: &particle, exchange: &exchange };
        let kernels = domain.compiled.bind(device, features, &buffers)?;
        device.write(&particle.particles, 0, particles);
        let mut subdomain = Subdomain {
            place: place.clone(),
            kernels,
            fixed,
            cell,
            particle,
            exchange,
            exchange_room,
            outbox_guess: Guess::new(),
            update_guess: Guess::new(),
            count: particles.len() as u32,
            staging: Vec::new(),
            spare_staging: Vec::new(),
            emptied: false,
            short_lists: if domain.form == Form::Gpu { SHORT_LIST } else { 0 },
            watched: None,
            domain,
        };
        subdomain.move_to(device, place)?;
        Ok(subdomain)
    }

    /// Slots of `particles` in use once all encoded steps have run.
    pub fn count(&self) -> u32 {
        self.count
    }

    pub fn features(&self) -> Features {
        self.domain.features
    }

    pub fn place(&self) -> &Place {
        &self.place
    }

    pub fn cells(&self) -> GridCells {
        self.place.cells(self.domain.plan.grid.cells)
    }

    /// Bytes of the buffers that grow with the particles.
    pub fn bytes(&self) -> u64 {
        self.particle.bytes()
    }

    /// Bytes of the buffers that grow with the cells, lists of walls included.
    pub fn cell_bytes(&self) -> u64 {
        let lists = self.fixed.parted.size() + self.fixed.moved.size();
        self.cell.bytes() + self.domain.buffers.cell_bytes() + lists
    }

    /// What the kernels are specialised by.
    pub fn constants(&self) -> &Constants {
        &self.domain.constants
    }

    /// Of the neighbour lists of the last step: entries for each particle, and the share of the particles that have any; 0 of a
    /// method without.
    ///
    /// # Errors
    /// If the device fails.
    pub fn mean_lists(&self, device: &Device) -> Result<[f64; 2], GpuError> {
        if !self.domain.features.rounds || self.count == 0 {
            return Ok([0.0; 2]);
        }
        let lengths: Vec<u32> = device.read(&self.particle.neighbour_count, self.count as usize)?;
        let entries = lengths.iter().map(|&length| f64::from(length)).sum::<f64>();
        let listed = lengths.iter().filter(|&&length| length > 0).count() as f64;
        Ok([entries, listed].map(|sum| sum / lengths.len() as f64))
    }

    /// Other cells and peers, from the next step on, whose exchange moves the particles there.
    ///
    /// # Errors
    /// If the cells are over the device's limits.
    pub fn move_to(&mut self, device: &Device, place: Place) -> Result<(), GpuError> {
        self.place = place;
        self.emptied = false;
        let peers = self.gpu_peers();
        if self.domain.features.collisions && bins_of(&self.place, &self.domain) > self.cell.capacity {
            let bins = bins_of(&self.place, &self.domain);
            self.cell = CellBuffers::new(device, bins + bins / 8, self.domain.features.has_cells())?;
            self.rebind(device)?;
        }
        if peers.len() as u64 > self.exchange_room.peers {
            let wanted = 2 * peers.len() as u64;
            self.make_exchange_room(device, |room| room.peers = wanted)?;
        }
        device.write(&self.exchange.peers, 0, &peers);
        Ok(())
    }

    fn gpu_peers(&self) -> Vec<GpuPeer> {
        let signed = |corner: [u32; 3]| corner.map(|cell| cell as i32);
        let peer = |cells: &Cells| GpuPeer { low: signed(cells.low), high: signed(cells.high), ..GpuPeer::default() };
        self.place.peers.iter().map(peer).collect()
    }

    fn rebind(&mut self, device: &Device) -> Result<(), GpuError> {
        let buffers = Buffers {
            domain: &self.domain.buffers,
            fixed: &self.fixed,
            cell: &self.cell,
            particle: &self.particle,
            exchange: &self.exchange,
        };
        self.kernels = self.domain.compiled.bind(device, self.domain.features, &buffers)?;
        Ok(())
    }

    /// Makes room for `more` particles in the slots after those in use, for `newborns` of an interval, and for
    /// `tails` entries of the tails of neighbour lists. Particles and bins are copied on the device once what is recorded has
    /// run, which is submitted with the copy: a step on the way writes to the buffers of before.
    ///
    /// # Errors
    /// If the larger buffers are over the device's limits.
    pub fn make_room(&mut self, rec: &mut Recording<'_>, more: u64, newborns: u64, tails: u64) -> Result<(), GpuError> {
        let device = rec.device();
        let needed = u64::from(self.count) + more;
        let room_for_newborns = self.particle.newborns.size() / size_of::<GpuNewborn>() as u64;
        let old = &self.particle;
        if needed <= old.capacity && newborns <= room_for_newborns && tails <= old.tails {
            return Ok(());
        }
        let most = most(&self.domain.plan, self.domain.features);
        let capacity = if needed > old.capacity { needed.max((needed + needed / 4).min(most)) } else { old.capacity };
        // More particles of the same gas have more tails. Among others what another device wanted may have been made here.
        let grown_tails = if self.domain.features.halo { old.tails } else { old.tails * capacity / old.capacity };
        let tails = tails.max(grown_tails);
        let newborn_room = room_for_newborns.max(newborns.next_power_of_two());
        let grown = ParticleBuffers::new(device, capacity, newborn_room, tails, self.domain.features)?;
        let encoder = rec.encoder();
        for (old, new) in [
            (&self.particle.particles, &grown.particles),
            (&self.particle.bins, &grown.bins),
            (&self.particle.newborns, &grown.newborns),
            // Where a device alone is held they are the particles, and the host may not know yet that it is.
            (&self.particle.sorted, &grown.sorted),
        ] {
            encoder.copy_buffer_to_buffer(old, 0, new, 0, old.size().min(new.size()));
        }
        rec.submit();
        self.particle = grown;
        self.rebind(device)?;
        if self.watched.take().is_some() {
            self.watch_flights(device)?;
        }
        Ok(())
    }

    /// Makes room for tails of neighbour lists of `wanted` entries, and for a share of that more if the device has it.
    ///
    /// # Errors
    /// If it has no room for those that are wanted.
    pub fn make_room_for_tails(&mut self, device: &Device, wanted: u64, more: f64) -> Result<(), GpuError> {
        let mut rec = Recording::new(device);
        match self.make_room(&mut rec, 0, 0, wanted + (wanted as f64 * more) as u64) {
            Err(GpuError::TooLarge { .. } | GpuError::Memory { .. }) => self.make_room(&mut rec, 0, 0, wanted),
            made => made,
        }
    }

    /// Keeps the particles as they are before the next interval, if it may have to run again: neighbour lists may need more room, and
    /// among others particles may stray. A device alone needs no copy; one among others has one of its own for each, in `spare` where that has
    /// the room.
    ///
    /// # Errors
    /// If the device has no memory for the copy.
    pub fn remember(&mut self, device: &Device, spare: Option<wgpu::Buffer>) -> Result<Remembered, GpuError> {
        let Features { rounds, halo, .. } = self.domain.features;
        let kept = if halo {
            let bytes = u64::from(self.count) * size_of::<GpuParticle>() as u64;
            let copy = match spare.filter(|buffer| buffer.size() >= bytes) {
                Some(buffer) => buffer,
                None => device.storage::<GpuParticle>("remembered", self.particle.capacity)?,
            };
            let mut encoder = device.encoder();
            encoder.copy_buffer_to_buffer(&self.particle.particles, 0, &copy, 0, bytes);
            device.submit(encoder);
            Kept::Copy(copy)
        } else if rounds {
            Kept::Held
        } else {
            Kept::Nothing
        };
        Ok(Remembered { kept, count: self.count })
    }

    /// At most so many particles are left here (all that have left before the last interval that was submitted are
    /// known): frees the slots beyond, on a device alone that sorts its particles. (Among others every step does.)
    pub fn shrink(&mut self, particles: u64) {
        if self.place.depth == 0 && self.domain.features.collisions {
            self.count = u64::from(self.count).min(particles) as u32;
        }
    }

    /// Back to where the first interval that had too little room can go on with more: the step of it, as if nothing had run since. That is its
    /// first, and its tallies count for nothing, or on a device alone the one that was held, and its tallies are those of the steps before.
    /// What has been tallied since the last read is cleared. `None`, and nothing is done, of one of which nothing was kept.
    ///
    /// # Errors
    /// If the device fails.
    pub fn restore(
        &mut self,
        device: &Device,
        remembered: &Remembered,
        newborns: &Newborns<'_>,
    ) -> Result<Option<u32>, GpuError> {
        match &remembered.kept {
            Kept::Nothing => Ok(None),
            Kept::Copy(copy) => {
                let bytes = u64::from(remembered.count) * size_of::<GpuParticle>() as u64;
                let mut encoder = device.encoder();
                encoder.copy_buffer_to_buffer(copy, 0, &self.particle.particles, 0, bytes);
                device.submit(encoder);
                self.count = remembered.count;
                self.clear_tallies(device);
                Ok(Some(0))
            }
            Kept::Held => {
                let words: Vec<u32> = device.read(&self.fixed.held, registry::HELD_WORDS as usize)?;
                let (held, present) = (words[0], words[1]);
                let known = (held as usize) <= newborns.of_step.len() && u64::from(present) <= self.particle.capacity;
                let step = held.checked_sub(1).filter(|_| known);
                if let Some(step) = step {
                    self.recall(device, present, newborns, step);
                }
                Ok(step)
            }
        }
    }

    /// On a device alone: the `present` particles of `sorted` are those before a step of an interval, less who entered in it. Clears what was
    /// tallied since the last read.
    fn recall(&mut self, device: &Device, present: u32, newborns: &Newborns<'_>, step: u32) {
        self.count = present;
        let slot = newborns.entering(self.at_rest(device), step);
        self.write_parameters(device, &slot);
        if let Some(CollisionKernels { recall: Some(kernel), .. }) = &self.kernels.collisions {
            let mut rec = Recording::new(device);
            kernel.dispatch(&mut rec.phase("lists"), self.offset(device, &slot, 0), encode::all(device, &slot));
            rec.submit();
        }
        self.clear_tallies(device);
    }

    fn clear_tallies(&self, device: &Device) {
        let mut encoder = device.encoder();
        let FixedBuffers { counters, held, zone_sums, surface_sums, block_sums, .. } = &self.fixed;
        for buffer in [counters, held, zone_sums, surface_sums, block_sums] {
            encoder.clear_buffer(buffer, 0, None);
        }
        device.submit(encoder);
    }

    /// The particles owned here, in the order of the device; waits for the device.
    ///
    /// # Errors
    /// If the device fails.
    pub fn particles(&self, device: &Device) -> Result<Vec<GpuParticle>, GpuError> {
        let mut particles: Vec<GpuParticle> = device.read(&self.particle.particles, self.count as usize)?;
        particles.retain(|particle| particle.tag != GpuParticle::NOBODY);
        Ok(particles)
    }

    /// From now on the flights of each step are kept, which are gone when the particles have flown.
    ///
    /// # Errors
    /// If the device has no memory for them.
    pub fn watch_flights(&mut self, device: &Device) -> Result<(), GpuError> {
        if self.domain.features.rounds {
            self.watched = Some(device.storage::<[GpuFlight; 2]>("watched", self.particle.capacity)?);
        }
        Ok(())
    }

    /// The flights of the last step, in the order of [`Subdomain::particles`]; none without rounds of pairs, or where they are not watched.
    ///
    /// # Errors
    /// If the device fails.
    pub fn flights(&self, device: &Device) -> Result<Vec<GpuFlight>, GpuError> {
        let Some(watched) = &self.watched else { return Ok(Vec::new()) };
        let records: Vec<[GpuFlight; 2]> = device.read(watched, self.count as usize)?;
        Ok(records.into_iter().map(|[flight, _]| flight).collect())
    }

    /// Copies the interval's tallies (and the timer's stamps) for a late read, and clears them.
    ///
    /// # Errors
    /// If the device has no memory for the copy.
    pub fn encode_readback(
        &mut self,
        rec: &mut Recording<'_>,
        timer: Option<(&PhaseTimer, usize)>,
    ) -> Result<wgpu::Buffer, GpuError> {
        let device = rec.device();
        let staging = match self.staging.pop() {
            Some(buffer) => buffer,
            None => device.staging(self.tally_bytes() + PhaseTimer::bytes())?,
        };
        let mut offset = 0;
        let words = self.domain.words;
        let encoder = rec.encoder();
        for (buffer, words) in [
            (&self.fixed.counters, counters::WORDS),
            (&self.fixed.zone_sums, words.zones),
            (&self.fixed.surface_sums, words.surfaces),
            (&self.fixed.block_sums, words.blocks),
        ] {
            let bytes = 4 * words as u64;
            encoder.copy_buffer_to_buffer(buffer, 0, &staging, offset, bytes);
            encoder.clear_buffer(buffer, 0, Some(bytes));
            offset += bytes;
        }
        if let Some((timer, phases)) = timer {
            timer.resolve(encoder, phases, &staging, offset.next_multiple_of(8));
        }
        Ok(staging)
    }

    fn tally_bytes(&self) -> u64 {
        let TallyWords { zones, surfaces, blocks } = self.domain.words;
        let words = counters::WORDS + zones + surfaces + blocks;
        (4 * words as u64).next_multiple_of(8)
    }

    /// The tallies of an earlier [`Subdomain::encode_readback`], and the bytes of its timestamps.
    ///
    /// # Errors
    /// If the device fails.
    pub fn finish_readback(&mut self, device: &Device, readback: Readback) -> Result<(Tallies, Vec<u8>), GpuError> {
        let tally_bytes = self.tally_bytes() as usize;
        let (words, patches, blocks) = (self.domain.words, self.domain.patches, self.domain.blocks);
        let (result, staging) = readback.finish(device, |bytes| {
            let (tallied, stamps) = bytes.split_at(tally_bytes);
            // (What the driver maps lies on a page.)
            let all: Cow<'_, [u32]> = match bytemuck::try_cast_slice(tallied) {
                Ok(all) => Cow::Borrowed(all),
                Err(_) => Cow::Owned(bytemuck::pod_collect_to_vec(tallied)),
            };
            (Tallies::decode(&all, words, patches, blocks), stamps.to_vec())
        })?;
        self.staging.push(staging);
        Ok(result)
    }
}

/// Cells with bins.
fn bins_of(place: &Place, domain: &Domain) -> u64 {
    let (_, size) = place.bins(domain.plan.grid.cells);
    size.iter().map(|&n| u64::from(n)).product()
}
