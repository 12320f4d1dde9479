//! What a subdomain sends to others and takes from them: particles at the start of a step, and what the
//! rounds did to the ghosts.
//!
//! Messages are the bytes of [`GpuParticle`]s and [`GpuUpdate`]s, in no particular order: the receiver sorts the
//! former by (cell, id) with its own particles, and finds the ghosts of the latter by cell and id.

use crate::gpu::{Device, Readback, Recording};

use super::buffers::{ExchangeBuffers, ExchangeRoom};
use super::counters;
use super::encode::{StepSlot, threads};
use super::layout::{GpuParticle, GpuUpdate, GpuWeights};
use super::{GpuError, Subdomain};

/// Least entries that are copied with the counts, before it is known how many there are.
const LEAST_GUESS: u64 = 256;

/// What of an outbox is copied at once: as much as was in it lately, and some more.
#[derive(Debug, Clone, Copy)]
pub(super) struct Guess(u64);

impl Guess {
    pub(super) fn new() -> Guess {
        Guess(LEAST_GUESS)
    }

    fn follow(&mut self, count: u64) {
        let wanted = (count + count / 4).max(LEAST_GUESS);
        // Up at once, down slowly.
        self.0 = wanted.max(self.0 - self.0 / 16);
    }
}

/// A copy of an outbox on its way to the host, and for how many entries it has room.
pub struct Outgoing {
    readback: Readback,
    entries: u64,
}

/// Bytes for each peer, in the order of the peers.
pub type Messages = Vec<Vec<u8>>;

const HEADER: u64 = 4 * counters::LISTS as u64;
const PARTICLE: u64 = size_of::<GpuParticle>() as u64;
const UPDATE: u64 = size_of::<GpuUpdate>() as u64;

impl Subdomain {
    /// Packs the particles that others need.
    ///
    /// # Errors
    /// If the device has no memory for the copy.
    pub fn pack(&mut self, rec: &mut Recording<'_>, step: &StepSlot) -> Result<Outgoing, GpuError> {
        let device = rec.device();
        if let Some(kernels) = &self.kernels.exchange {
            let offset = self.offset(device, step, 0);
            let list = counters::BORDER as u32;
            kernels.pack.dispatch_indirect(rec.phase("exchange"), offset, &self.fixed.dispatches, list);
        }
        let entries = self.outbox_guess.0.min(self.exchange.room);
        let staging = self.staging_of(device, HEADER + entries * (4 + PARTICLE))?;
        let encoder = rec.encoder();
        encoder.copy_buffer_to_buffer(&self.fixed.counters, 0, &staging, 0, HEADER);
        encoder.copy_buffer_to_buffer(&self.exchange.outbox_peer, 0, &staging, HEADER, entries * 4);
        encoder.copy_buffer_to_buffer(&self.exchange.outbox, 0, &staging, HEADER + entries * 4, entries * PARTICLE);
        let submission = rec.submit();
        Ok(Outgoing { readback: device.read_later(staging, submission), entries })
    }

    /// The packed particles, once the device is done.
    ///
    /// # Errors
    /// If the device fails.
    pub fn packed(
        &mut self,
        rec: &mut Recording<'_>,
        step: &mut StepSlot,
        outgoing: Outgoing,
    ) -> Result<Messages, GpuError> {
        let device = rec.device();
        let peers = self.place.peers.len();
        let entries = outgoing.entries as usize;
        let ((header, messages), staging) = outgoing.readback.finish(device, |bytes| {
            let header = header_of(bytes);
            let count = (header[counters::OUTBOX] as usize).min(entries);
            let to = &bytes[HEADER as usize..HEADER as usize + 4 * count];
            let particles = &bytes[HEADER as usize + 4 * entries..];
            let mut messages = vec![Vec::new(); peers];
            for (peer, particle) in to.chunks_exact(4).zip(particles.chunks_exact(PARTICLE as usize)) {
                messages[u32::from_le_bytes([peer[0], peer[1], peer[2], peer[3]]) as usize].extend(particle);
            }
            (header, messages)
        })?;
        self.spare_staging.push(staging);
        let count = u64::from(header[counters::OUTBOX]);
        self.outbox_guess.follow(count);
        if count > entries as u64 {
            // More than was copied, or than there was room for: once more, with room for all.
            if count > self.exchange.room {
                self.make_exchange_room(device, |room| room.particles = count + count / 4)?;
            }
            device.write(&self.fixed.counters, 4 * counters::OUTBOX as u64, &[0u32]);
            let outgoing = self.pack(rec, step)?;
            return self.packed(rec, step, outgoing);
        }
        let slots = step.count + step.newborns;
        step.total = slots - header[counters::DROPPED];
        Ok(messages)
    }

    /// Takes what others sent, and bins it.
    ///
    /// # Errors
    /// If room must be made and the device has none.
    pub fn arrive(
        &mut self,
        rec: &mut Recording<'_>,
        step: &mut StepSlot,
        messages: &[Vec<u8>],
    ) -> Result<(), GpuError> {
        let device = rec.device();
        let slots = u64::from(step.count) + u64::from(step.newborns);
        let arrivals = messages.iter().map(|message| message.len() as u64 / PARTICLE).sum::<u64>();
        self.make_room(device, slots - u64::from(self.count) + arrivals, 0, 0)?;
        device.write(&self.particle.particles, slots * PARTICLE, &messages.concat());
        step.arrivals = arrivals as u32;
        step.total += step.arrivals;
        self.write_parameters(device, step);
        self.bin_slots(rec, step, arrivals);
        Ok(())
    }

    /// Packs what the rounds since the last exchange did to particles that others have as ghosts.
    ///
    /// # Errors
    /// If the device has no memory for the copy.
    pub fn pack_updates(&mut self, rec: &mut Recording<'_>, step: &StepSlot, round: u32) -> Result<Outgoing, GpuError> {
        let device = rec.device();
        if let Some(kernels) = self.kernels.exchange.as_ref().and_then(|kernels| kernels.updates.as_ref()) {
            let offset = self.offset(device, step, round);
            let (list, sizes) = (counters::CHANGED as u32, &self.fixed.rechoose_dispatches);
            kernels.pack.dispatch_indirect(rec.phase("update"), offset, sizes, list);
        }
        let entries = self.update_guess.0.min(self.exchange.update_room);
        let staging = self.staging_of(device, HEADER + entries * UPDATE)?;
        let encoder = rec.encoder();
        encoder.copy_buffer_to_buffer(&self.fixed.counters, 0, &staging, 0, HEADER);
        encoder.copy_buffer_to_buffer(&self.exchange.updates_out, 0, &staging, HEADER, entries * UPDATE);
        // The lists start anew after the exchange.
        for list in [counters::CHANGED, counters::UPDATES] {
            encoder.clear_buffer(&self.fixed.counters, 4 * list as u64, Some(4));
        }
        encoder.clear_buffer(&self.fixed.rechoose_dispatches, 12 * counters::CHANGED as u64, Some(4));
        let submission = rec.submit();
        Ok(Outgoing { readback: device.read_later(staging, submission), entries })
    }

    /// The packed updates for the near peers, once the device is done.
    ///
    /// # Errors
    /// If the device fails.
    pub fn packed_updates(
        &mut self,
        rec: &mut Recording<'_>,
        step: &StepSlot,
        round: u32,
        outgoing: Outgoing,
    ) -> Result<Messages, GpuError> {
        let device = rec.device();
        let near = self.place.near;
        let entries = outgoing.entries as usize;
        let ((changed, count, messages), staging) = outgoing.readback.finish(device, |bytes| {
            let header = header_of(bytes);
            let (changed, count) = (header[counters::CHANGED], header[counters::UPDATES]);
            let mut messages = vec![Vec::new(); near];
            let updates = bytes[HEADER as usize..].chunks_exact(UPDATE as usize);
            for update in updates.take((count as usize).min(entries)) {
                let peer = bytemuck::pod_read_unaligned::<GpuUpdate>(update).peer;
                messages[peer as usize].extend(update);
            }
            (changed, u64::from(count), messages)
        })?;
        self.spare_staging.push(staging);
        self.update_guess.follow(count);
        if count > entries as u64 {
            // More than was copied, or than there was room for: once more, with room for all.
            self.fill_list(device, counters::CHANGED, changed);
            if count > self.exchange.update_room {
                self.make_exchange_room(device, |room| room.updates = count + count / 4)?;
            }
            let outgoing = self.pack_updates(rec, step, round)?;
            return self.packed_updates(rec, step, round, outgoing);
        }
        Ok(messages)
    }

    /// Brings the ghosts up to date; `round` is the last that was settled.
    ///
    /// # Errors
    /// If room must be made and the device has none.
    pub fn receive(
        &mut self,
        rec: &mut Recording<'_>,
        step: &StepSlot,
        round: u32,
        messages: &[Vec<u8>],
    ) -> Result<(), GpuError> {
        let device = rec.device();
        let updates = messages.iter().map(|message| message.len() as u64 / UPDATE).sum::<u64>();
        if updates == 0 {
            return Ok(());
        }
        if (updates + 1) * UPDATE > self.exchange.updates_in.size() {
            self.make_exchange_room(device, |room| room.received = updates + updates / 4 + 1)?;
        }
        // The first entry says how many follow.
        let count = GpuUpdate { cell: updates as u32, ..GpuUpdate::default() };
        let mut bytes = bytemuck::bytes_of(&count).to_vec();
        bytes.extend(messages.iter().flatten());
        device.write(&self.exchange.updates_in, 0, &bytes);
        if let Some(kernels) = self.kernels.exchange.as_ref().and_then(|kernels| kernels.updates.as_ref()) {
            let offset = self.offset(device, step, round);
            kernels.receive.dispatch(rec.phase("update"), offset, threads(device, updates));
        }
        Ok(())
    }

    /// Adds up the entries of the neighbour lists of the last step, for the interval's readback.
    pub fn count_candidates(&self, rec: &mut Recording<'_>, step: &StepSlot) {
        let device = rec.device();
        if let Some(kernels) = &self.kernels.exchange {
            device.write(&self.fixed.weights, 0, &[GpuWeights::default()]);
            kernels.weigh.dispatch(rec.phase("tally"), self.offset(device, step, 0), super::encode::all(device, step));
        }
    }

    /// The weights of the own particles where the last step had them, summed over planes: `cuts` is the tree so
    /// far (`shaders/weigh.wgsl`), `planes` the length of the histogram.
    ///
    /// # Errors
    /// If the device fails.
    pub fn histogram(
        &mut self,
        device: &Device,
        weights: [u32; 3],
        cuts: &[[u32; 4]],
        planes: usize,
    ) -> Result<Vec<u64>, GpuError> {
        let (cut_room, plane_room) = (self.exchange.cuts.size() / 16, self.exchange.histogram.size() / 8);
        if cuts.len() as u64 > cut_room || planes as u64 > plane_room {
            let wanted = (cuts.len() as u64, planes as u64);
            self.make_exchange_room(device, |room| (room.cuts, room.planes) = (2 * wanted.0, 2 * wanted.1))?;
        }
        let [particle, candidate, wall] = weights;
        device.write(&self.fixed.weights, 0, &[GpuWeights { particle, candidate, wall, cuts: cuts.len() as u32 }]);
        device.write(&self.exchange.cuts, 0, cuts);
        let mut rec = Recording::new(device);
        rec.encoder().clear_buffer(&self.exchange.histogram, 0, None);
        // Ghosts are among them, so it is as many as `sorted` had.
        let step = self.at_rest(device);
        if let Some(kernels) = &self.kernels.exchange {
            let all = super::encode::all(device, &step);
            kernels.weigh.dispatch(rec.phase("weigh"), self.offset(device, &step, 0), all);
        }
        rec.submit();
        let words: Vec<[u32; 2]> = device.read(&self.exchange.histogram, planes)?;
        Ok(words.iter().map(|word| u64::from(word[0]) | (u64::from(word[1]) << 32)).collect())
    }

    /// Gives a list that was emptied its length again; its entries are still there.
    fn fill_list(&self, device: &Device, list: usize, length: u32) {
        let [x, y, z] = threads(device, length.into());
        device.write(&self.fixed.counters, 4 * list as u64, &[length]);
        device.write(&self.fixed.rechoose_dispatches, 12 * list as u64, &[x, y, z]);
    }

    fn staging_of(&mut self, device: &Device, bytes: u64) -> Result<wgpu::Buffer, GpuError> {
        match self.spare_staging.iter().position(|buffer| buffer.size() >= bytes) {
            Some(index) => Ok(self.spare_staging.swap_remove(index)),
            None => {
                // Smaller ones would pile up.
                self.spare_staging.clear();
                device.staging(bytes.next_power_of_two())
            }
        }
    }

    /// Makes the exchange buffers larger; what is in them is lost.
    pub(super) fn make_exchange_room(
        &mut self,
        device: &Device,
        larger: impl FnOnce(&mut ExchangeRoom),
    ) -> Result<(), GpuError> {
        larger(&mut self.exchange_room);
        let peers = self.gpu_peers();
        self.exchange = ExchangeBuffers::new(device, &self.exchange_room)?;
        device.write(&self.exchange.peers, 0, &peers);
        self.rebind(device)
    }
}

fn header_of(bytes: &[u8]) -> Vec<u32> {
    bytemuck::pod_collect_to_vec(&bytes[..HEADER as usize])
}
