//! Room for more particles, newborns and neighbours than there were.

use crate::gpu::{Device, GpuError, Recording};

use super::buffers::ParticleBuffers;
use super::device_gas::Subdomain;
use super::layout::GpuNewborn;

impl Subdomain {
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
        let most = self.domain.most_particles();
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
            // Where a device alone is stalled they are the particles, and the host may not know yet that it is.
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

    /// At most so many particles are left here (all that have left before the last interval that was submitted are
    /// known): frees the slots beyond, on a device alone that sorts its particles. (Among others every step does.)
    pub fn shrink(&mut self, particles: u64) {
        if self.place.depth == 0 && self.domain.features.collisions {
            self.count = u64::from(self.count).min(particles) as u32;
        }
    }
}
