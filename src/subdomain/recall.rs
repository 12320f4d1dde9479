//! Intervals that are run again: what is kept of the gas for that, and the way back.

use crate::gpu::{Device, GpuError, Recording};

use super::buffers::FixedBuffers;
use super::constants::Features;
use super::device_gas::Subdomain;
use super::dispatch::all;
use super::kernels::CollisionKernels;
use super::layout::GpuParticle;
use super::registry;
use super::step_slot::Newborns;

/// How an interval can be run again with larger buffers.
pub struct Remembered {
    pub(super) backup: Backup,
    count: u32,
}

pub(super) enum Backup {
    /// No interval is ever run again.
    Nothing,
    /// A device alone stalls where it had too little room, and goes on from there (`shaders/complete_lists.wgsl`).
    Stall,
    /// Whether one must is known when all ranks' tallies are: each interval has a copy of the particles before it.
    Copy(wgpu::Buffer),
}

impl Remembered {
    /// Memory that can be used again.
    pub fn spare(self) -> Option<wgpu::Buffer> {
        match self.backup {
            Backup::Copy(buffer) => Some(buffer),
            Backup::Nothing | Backup::Stall => None,
        }
    }
}

impl Subdomain {
    /// Keeps the particles as they are before the next interval, if it may have to run again: neighbour lists may need more room, and
    /// among others particles may stray. A device alone needs no copy; one among others has one of its own for each, in `spare` where that has
    /// the room.
    ///
    /// # Errors
    /// If the device has no memory for the copy.
    pub fn remember(&mut self, device: &Device, spare: Option<wgpu::Buffer>) -> Result<Remembered, GpuError> {
        let Features { rounds, halo, membrane, .. } = self.domain.features;
        // (Elastic fabric goes on where the gas has stalled, so that both go back to the start of the interval.)
        let backup = if halo || rounds && membrane {
            let bytes = u64::from(self.count) * size_of::<GpuParticle>() as u64;
            let copy = match spare.filter(|buffer| buffer.size() >= bytes) {
                Some(buffer) => buffer,
                None => device.storage::<GpuParticle>("remembered", self.particle.capacity)?,
            };
            let mut encoder = device.encoder();
            encoder.copy_buffer_to_buffer(&self.particle.particles, 0, &copy, 0, bytes);
            device.submit(encoder);
            Backup::Copy(copy)
        } else if rounds {
            Backup::Stall
        } else {
            Backup::Nothing
        };
        Ok(Remembered { backup, count: self.count })
    }

    /// Back to where the first interval that had too little room can go on with more: the step of it, as if nothing had run since. That is its
    /// first, and its tallies count for nothing, or on a device alone the one that stalled, and its tallies are those of the steps before.
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
        match &remembered.backup {
            Backup::Nothing => Ok(None),
            Backup::Copy(copy) => {
                let bytes = u64::from(remembered.count) * size_of::<GpuParticle>() as u64;
                let mut encoder = device.encoder();
                encoder.copy_buffer_to_buffer(copy, 0, &self.particle.particles, 0, bytes);
                device.submit(encoder);
                self.count = remembered.count;
                self.clear_tallies(device);
                Ok(Some(0))
            }
            Backup::Stall => {
                let words: Vec<u32> = device.read(&self.fixed.stalled, registry::STALLED_WORDS as usize)?;
                let (stalled, present) = (words[0], words[1]);
                let known =
                    (stalled as usize) <= newborns.of_step.len() && u64::from(present) <= self.particle.capacity;
                let step = stalled.checked_sub(1).filter(|_| known);
                if let Some(step) = step {
                    self.recall(device, present, newborns, step);
                }
                Ok(step)
            }
        }
    }

    /// On a device alone: the `present` particles of `sorted` are those before a step of an interval, less who entered in it. Clears what was
    /// tallied since the last read.
    pub(super) fn recall(&mut self, device: &Device, present: u32, newborns: &Newborns<'_>, step: u32) {
        self.count = present;
        let slot = newborns.entering(self.at_rest(device), step);
        self.write_parameters(device, &slot);
        if let Some(CollisionKernels { recall: Some(kernel), .. }) = &self.kernels.collisions {
            let mut rec = Recording::new(device);
            kernel.dispatch(&mut rec.phase("lists"), self.offset(device, &slot, 0), all(device, &slot));
            rec.submit();
        }
        self.clear_tallies(device);
    }

    fn clear_tallies(&self, device: &Device) {
        let mut encoder = device.encoder();
        let FixedBuffers { counters, stalled, step_state, zone_sums, surface_sums, block_sums, .. } = &self.fixed;
        for buffer in [counters, stalled, step_state, zone_sums, surface_sums, block_sums] {
            encoder.clear_buffer(buffer, 0, None);
        }
        device.submit(encoder);
    }
}
