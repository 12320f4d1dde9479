//! What a subdomain sends to others and takes from them: particles at the start of a step, and what the
//! rounds did to the ghosts.
//!
//! Messages are the bytes of [`GpuParticle`]s and [`GpuUpdate`]s, in no particular order; the device puts those to one
//! peer together (`shaders/shared/sendings.wgsl`), and the host looks at none of them. The receiver sorts the
//! former by cell with its own particles, and finds the ghosts of the latter by cell and id.

use crate::gpu::{Device, GpuError, Readback, Recording};

use super::buffers::ExchangeBuffers;
use super::device_gas::Subdomain;
use super::dispatch::{all, threads};
use super::layout::{GpuParticle, GpuUpdate, GpuWeights};
use super::registry::{self, COUNT_DROPPED, LIST_BORDER, LIST_CHANGED, LIST_OUTBOX, LIST_UPDATES};
use super::step_slot::StepSlot;

/// A copy of an outbox on its way to the host: how many entries are in the copy, and peers in its header.
pub struct Outgoing {
    readback: Readback,
    entries: u64,
    peers: usize,
}

/// Bytes for each peer, in the order of the peers.
pub type Messages = Vec<Vec<u8>>;

/// Room that every message has behind it, for what its sender may add.
const SPARE: usize = 16;
/// The lengths of the lists, and behind them where each message begins.
const LISTS: u64 = 4 * registry::LISTS as u64;
const PARTICLE: u64 = size_of::<GpuParticle>() as u64;
const UPDATE: u64 = size_of::<GpuUpdate>() as u64;

/// What is before the entries of an outbox.
struct Header {
    lists: Vec<u32>,
    /// Entries, where each peer's begin and where the last one's end.
    starts: Vec<u32>,
}

impl Header {
    fn bytes(peers: usize) -> u64 {
        LISTS + 4 * (peers as u64 + 1)
    }

    /// The header of a copy, and the messages that it holds if the copy holds them all.
    fn and_messages(bytes: &[u8], peers: usize, size: u64) -> (Header, Messages) {
        let (header, entries) = bytes.split_at(Header::bytes(peers) as usize);
        let (lists, starts) = header.split_at(LISTS as usize);
        let header =
            Header { lists: bytemuck::pod_collect_to_vec(lists), starts: bytemuck::pod_collect_to_vec(starts) };
        let message = |ends: &[u32]| {
            let [begin, end] = [ends[0], ends[1]].map(|entry| (u64::from(entry) * size) as usize);
            let found = entries.get(begin..end).unwrap_or_default();
            let mut message = Vec::with_capacity(found.len() + SPARE);
            message.extend_from_slice(found);
            message
        };
        let messages = header.starts.windows(2).map(message).collect();
        (header, messages)
    }
}

impl Subdomain {
    /// Packs the particles that others need.
    ///
    /// # Errors
    /// If the device has no memory for the copy.
    pub fn pack(&mut self, rec: &mut Recording<'_>, step: &StepSlot) -> Result<Outgoing, GpuError> {
        let device = rec.device();
        if let Some(kernels) = &self.kernels.exchange {
            let offset = self.offset(device, step, 0);
            let pass = &mut rec.phase("exchange");
            kernels.pack.dispatch_indirect(pass, offset, &self.fixed.dispatches, LIST_BORDER);
            kernels.message_starts.dispatch(pass, offset, [1, 1, 1]);
            kernels.fill.dispatch_indirect(pass, offset, &self.fixed.rechoose_dispatches, LIST_OUTBOX);
        }
        let entries = self.outbox_guess.entries().min(self.exchange.room);
        let staging = self.copy_outbox(rec, entries, PARTICLE, |exchange| &exchange.outbox)?;
        let readback = rec.device().read_later(staging, rec.submit());
        Ok(Outgoing { readback, entries, peers: self.place.peers.len() })
    }

    /// Copies the lists' lengths, the messages' starts and the first entries that go out.
    fn copy_outbox(
        &mut self,
        rec: &mut Recording<'_>,
        entries: u64,
        size: u64,
        outbox: impl Fn(&ExchangeBuffers) -> &wgpu::Buffer,
    ) -> Result<wgpu::Buffer, GpuError> {
        let header = Header::bytes(self.place.peers.len());
        let staging = self.staging_of(rec.device(), header + entries * size)?;
        let encoder = rec.encoder();
        encoder.copy_buffer_to_buffer(&self.fixed.counters, 0, &staging, 0, LISTS);
        encoder.copy_buffer_to_buffer(&self.exchange.peer_starts, 0, &staging, LISTS, header - LISTS);
        encoder.copy_buffer_to_buffer(outbox(&self.exchange), 0, &staging, header, entries * size);
        Ok(staging)
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
        let (entries, peers) = (outgoing.entries, outgoing.peers);
        let read = |bytes: &[u8]| Header::and_messages(bytes, peers, PARTICLE);
        let ((header, messages), staging) = outgoing.readback.finish(device, read)?;
        self.spare_staging.push(staging);
        let count = u64::from(header.lists[LIST_OUTBOX as usize]);
        self.outbox_guess.follow(count);
        if count > entries {
            // More than was copied, or than there was room for: once more, with room for all.
            if count > self.exchange.room {
                self.make_exchange_room(device, |room| room.particles = count + count / 4)?;
            }
            device.write(&self.fixed.counters, 4 * u64::from(LIST_OUTBOX), &[0u32]);
            let outgoing = self.pack(rec, step)?;
            return self.packed(rec, step, outgoing);
        }
        let slots = step.count + step.newborns;
        step.total = slots - header.lists[COUNT_DROPPED as usize];
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
        self.make_room(rec, slots - u64::from(self.count) + arrivals, 0, 0)?;
        device.write_joined(&self.particle.particles, slots * PARTICLE, messages)?;
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
        if let Some((kernels, updates)) =
            self.kernels.exchange.as_ref().and_then(|kernels| Some((kernels, kernels.updates.as_ref()?)))
        {
            let offset = self.offset(rec.device(), step, round);
            let pass = &mut rec.phase("update");
            let sizes = &self.fixed.rechoose_dispatches;
            updates.pack.dispatch_indirect(pass, offset, sizes, LIST_CHANGED);
            kernels.message_starts.dispatch(pass, offset, [1, 1, 1]);
            updates.fill.dispatch_indirect(pass, offset, &self.fixed.dispatches, LIST_UPDATES);
        }
        let entries = self.update_guess.entries().min(self.exchange.update_room);
        let staging = self.copy_outbox(rec, entries, UPDATE, |exchange| &exchange.updates_out)?;
        // The lists start anew after the exchange.
        let encoder = rec.encoder();
        for list in [LIST_CHANGED, LIST_UPDATES] {
            encoder.clear_buffer(&self.fixed.counters, 4 * u64::from(list), Some(4));
        }
        encoder.clear_buffer(&self.fixed.rechoose_dispatches, 12 * u64::from(LIST_CHANGED), Some(4));
        encoder.clear_buffer(&self.fixed.dispatches, 12 * u64::from(LIST_UPDATES), Some(4));
        let readback = rec.device().read_later(staging, rec.submit());
        Ok(Outgoing { readback, entries, peers: self.place.peers.len() })
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
        let (entries, peers) = (outgoing.entries, outgoing.peers);
        let read = |bytes: &[u8]| Header::and_messages(bytes, peers, UPDATE);
        let ((header, mut messages), staging) = outgoing.readback.finish(device, read)?;
        self.spare_staging.push(staging);
        let count = u64::from(header.lists[LIST_UPDATES as usize]);
        self.update_guess.follow(count);
        if count > entries {
            // More than was copied, or than there was room for: once more, with room for all.
            self.fill_list(device, LIST_CHANGED, header.lists[LIST_CHANGED as usize]);
            if count > self.exchange.update_room {
                self.make_exchange_room(device, |room| room.updates = count + count / 4)?;
            }
            let outgoing = self.pack_updates(rec, step, round)?;
            return self.packed_updates(rec, step, round, outgoing);
        }
        // Nothing goes to those that are not near.
        messages.truncate(self.place.near);
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
        device.write(&self.exchange.updates_in, 0, &[count]);
        device.write_joined(&self.exchange.updates_in, UPDATE, messages)?;
        if let Some(kernels) = self.kernels.exchange.as_ref().and_then(|kernels| kernels.updates.as_ref()) {
            let offset = self.offset(device, step, round);
            kernels.receive.dispatch(&mut rec.phase("update"), offset, threads(device, updates));
        }
        Ok(())
    }

    /// Adds up the entries of the neighbour lists of the last step, for the interval's readback.
    pub fn count_candidates(&self, rec: &mut Recording<'_>, step: &StepSlot) {
        let device = rec.device();
        if let Some(kernels) = &self.kernels.exchange {
            device.write(&self.fixed.weights, 0, &[GpuWeights::default()]);
            kernels.weigh.dispatch(&mut rec.phase("blocks"), self.offset(device, step, 0), all(device, step));
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
        weights: [u32; 4],
        cuts: &[[u32; 4]],
        planes: usize,
    ) -> Result<Vec<u64>, GpuError> {
        let (cut_room, plane_room) = (self.exchange.cuts.size() / 16, self.exchange.histogram.size() / 8);
        if cuts.len() as u64 > cut_room || planes as u64 > plane_room {
            let wanted = (cuts.len() as u64, planes as u64);
            self.make_exchange_room(device, |room| (room.cuts, room.planes) = (2 * wanted.0, 2 * wanted.1))?;
        }
        let [particle, candidate, wall, sheet] = weights;
        let weights = GpuWeights { particle, candidate, wall, sheet, cuts: cuts.len() as u32 };
        device.write(&self.fixed.weights, 0, &[weights]);
        device.write(&self.exchange.cuts, 0, cuts);
        let mut rec = Recording::new(device);
        rec.encoder().clear_buffer(&self.exchange.histogram, 0, None);
        // Ghosts are among them, so it is as many as `sorted` had.
        let step = self.at_rest(device);
        if let Some(kernels) = &self.kernels.exchange {
            kernels.weigh.dispatch(&mut rec.phase("weigh"), self.offset(device, &step, 0), all(device, &step));
        }
        rec.submit();
        let words: Vec<[u32; 2]> = device.read(&self.exchange.histogram, planes)?;
        Ok(words.iter().map(|word| u64::from(word[0]) | (u64::from(word[1]) << 32)).collect())
    }

    /// Gives a list that was emptied its length again; its entries are still there.
    fn fill_list(&self, device: &Device, list: u32, length: u32) {
        let [x, y, z] = threads(device, length.into());
        device.write(&self.fixed.counters, 4 * u64::from(list), &[length]);
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
}
