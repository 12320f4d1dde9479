//! What is read of a device's gas: the tallies of an interval, late, and whole states on request.

use std::borrow::Cow;

use crate::gpu::{Device, GpuError, PhaseTimer, Readback, Recording};

use super::buffers::TallyWords;
use super::counters;
use super::device_gas::Subdomain;
use super::layout::{GpuFlight, GpuParticle};
use super::tallies::Tallies;

impl Subdomain {
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
}
