//! One device's gas: the particle buffers and the kernels of each phase of the step.
//!
//! Invariants: between steps `particles` holds every particle once, in canonical order (cell, id) where
//! there are collisions; positions are fixed-point on the plan's grid; nothing is read back but the
//! tallies of an interval, one interval late, and whole states on request.

mod buffers;
mod constants;
mod counters;
mod encode;
mod kernels;
mod layout;
mod scales;
mod state;
mod tallies;
mod walls;

use crate::gpu::{BoundKernel, Device, GpuError, Readback};
use crate::plan::Plan;

pub use buffers::{BLOCK_WORDS, CHUNK, SURFACE_WORDS, ZONE_WORDS, most_particles};
pub use constants::{Features, WORKGROUP, block_counts, constants};
pub use counters::{Counters, WORDS as COUNTER_WORDS};
pub use encode::StepSlot;
pub use layout::{GpuFlight, GpuGas, GpuNewborn, GpuParticle, GpuStep, GpuTriangle, GpuZone};
pub use scales::Scales;
pub use state::{StateError, zone_of};
pub use tallies::{BlockSum, SurfaceSum, Tallies, ZoneSum};
pub use walls::Walls;

use buffers::{FIRST_LIST, FixedBuffers, ParticleBuffers, TallyWords};
use kernels::{Compiled, Kernels};

/// What a subdomain is made from.
pub struct SubdomainInput<'a> {
    pub plan: &'a Plan,
    pub walls: &'a Walls,
    /// Zone 0 is everything, then the chambers, then the probes.
    pub zones: &'a [GpuZone],
    /// Patches of wall whose impulse is tallied.
    pub patches: usize,
    pub particles: &'a [GpuParticle],
}

/// The particles before an interval, so that it can be run again with larger buffers.
pub struct Remembered {
    pub particles: wgpu::Buffer,
    count: u32,
}

pub struct Subdomain {
    plan: Plan,
    features: Features,
    constants: Vec<(&'static str, f64)>,
    compiled: Compiled,
    kernels: Kernels<BoundKernel>,
    fixed: FixedBuffers,
    particle: ParticleBuffers,
    words: TallyWords,
    blocks: usize,
    zones: usize,
    /// Particles on the device once all encoded steps have run.
    count: u32,
    staging: Vec<wgpu::Buffer>,
}

impl Subdomain {
    /// # Errors
    /// If the device refuses a kernel, or the scene is over its limits.
    pub fn new(device: &Device, input: &SubdomainInput<'_>) -> Result<Subdomain, GpuError> {
        let plan = input.plan;
        let features = Features::of(plan, input.patches);
        let gases = state::gas_table(plan);
        let blocks = block_counts(plan).iter().map(|&n| n as usize).product();
        let words = TallyWords {
            zones: input.zones.len() * plan.gases.len() * ZONE_WORDS,
            surfaces: input.patches.max(1) * SURFACE_WORDS,
            blocks: blocks * BLOCK_WORDS + plan.ladder_levels as usize,
        };
        let slots = u64::from(plan.steps_per_interval) * u64::from(plan.rounds + 1);
        let fixed = FixedBuffers::new(device, plan, input.walls, input.zones, &gases, words, slots)?;
        // Room for what is there and some inflow; it grows as the inflow comes.
        let capacity = input.particles.len() as u64 + (input.particles.len() as u64 / 8).max(1024);
        let particle = ParticleBuffers::new(device, capacity, 1024, FIRST_LIST, features.collisions)?;
        let constants = constants(plan, features, input.walls, &Scales::new(plan), particle.list);
        let compiled = Compiled::new(device, features, &constants)?;
        let kernels = compiled.bind(device, features, &fixed, &particle)?;
        device.write(&particle.particles, 0, input.particles);
        let count = input.particles.len() as u32;
        device.write(&fixed.counters, 4 * counters::PARTICLES as u64, &[count]);
        Ok(Subdomain {
            plan: plan.clone(),
            features,
            constants,
            compiled,
            kernels,
            fixed,
            particle,
            words,
            blocks,
            zones: input.zones.len(),
            count,
            staging: Vec::new(),
        })
    }

    /// Particles once all encoded steps have run.
    pub fn count(&self) -> u32 {
        self.count
    }

    pub fn features(&self) -> Features {
        self.features
    }

    /// Bytes of the buffers that grow with the particles.
    pub fn bytes(&self) -> u64 {
        self.particle.bytes()
    }

    /// Makes room for `newborns` more particles, and for neighbour lists of `wanted_list`. Particles are copied on the device, in order with the work already submitted.
    ///
    /// # Errors
    /// If the larger buffers are over the device's limits.
    pub fn make_room(&mut self, device: &Device, newborns: usize, wanted_list: u32) -> Result<(), GpuError> {
        let needed = u64::from(self.count) + newborns as u64;
        let longer = u64::from(wanted_list).next_multiple_of(8);
        let list = self.particle.list.max(longer);
        let room_for_newborns = self.particle.newborns.size() / size_of::<GpuNewborn>() as u64;
        if needed <= self.particle.capacity && newborns as u64 <= room_for_newborns && list == self.particle.list {
            return Ok(());
        }
        let capacity = if needed > self.particle.capacity { needed + needed / 4 } else { self.particle.capacity };
        let newborn_room = room_for_newborns.max((newborns as u64).next_power_of_two());
        let grown = ParticleBuffers::new(device, capacity, newborn_room, list, self.features.collisions)?;
        let mut encoder = device.encoder();
        let bytes = u64::from(self.count) * size_of::<GpuParticle>() as u64;
        encoder.copy_buffer_to_buffer(&self.particle.particles, 0, &grown.particles, 0, bytes);
        device.submit(encoder);
        if grown.list != self.particle.list {
            for constant in &mut self.constants {
                if constant.0 == "LIST" {
                    constant.1 = grown.list as f64;
                }
            }
            self.compiled = Compiled::new(device, self.features, &self.constants)?;
        }
        self.particle = grown;
        self.kernels = self.compiled.bind(device, self.features, &self.fixed, &self.particle)?;
        Ok(())
    }

    /// Copies the particles as they are before the next interval, into `spare` where it has the room.
    ///
    /// # Errors
    /// If the device has no memory for the copy.
    pub fn remember(&self, device: &Device, spare: Option<wgpu::Buffer>) -> Result<Remembered, GpuError> {
        let bytes = u64::from(self.count) * size_of::<GpuParticle>() as u64;
        let particles = match spare.filter(|buffer| buffer.size() >= bytes) {
            Some(buffer) => buffer,
            None => device.storage::<GpuParticle>("remembered", self.particle.capacity)?,
        };
        let mut encoder = device.encoder();
        encoder.copy_buffer_to_buffer(&self.particle.particles, 0, &particles, 0, bytes);
        device.submit(encoder);
        Ok(Remembered { particles, count: self.count })
    }

    /// Back to a remembered state, as if the intervals since had not run. Their tallies are cleared.
    pub fn restore(&mut self, device: &Device, remembered: &Remembered) {
        let bytes = u64::from(remembered.count) * size_of::<GpuParticle>() as u64;
        let mut encoder = device.encoder();
        encoder.copy_buffer_to_buffer(&remembered.particles, 0, &self.particle.particles, 0, bytes);
        for buffer in [&self.fixed.counters, &self.fixed.zone_sums, &self.fixed.surface_sums, &self.fixed.block_sums] {
            encoder.clear_buffer(buffer, 0, None);
        }
        device.submit(encoder);
        device.write(&self.fixed.counters, 4 * counters::PARTICLES as u64, &[remembered.count]);
        self.count = remembered.count;
    }

    /// Every particle, in the order of the device; waits for the device.
    ///
    /// # Errors
    /// If the device fails.
    pub fn particles(&self, device: &Device) -> Result<Vec<GpuParticle>, GpuError> {
        device.read(&self.particle.particles, self.count as usize)
    }

    /// The flights of the last step, in the order of [`Subdomain::particles`]; zeros without collisions.
    ///
    /// # Errors
    /// If the device fails.
    pub fn flights(&self, device: &Device) -> Result<Vec<GpuFlight>, GpuError> {
        device.read(&self.particle.flights, if self.features.collisions { self.count as usize } else { 0 })
    }

    /// Copies the interval's tallies (and the timer's stamps) for a late read, and clears them.
    ///
    /// # Errors
    /// If the device has no memory for the copy.
    pub fn encode_readback(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        timer: Option<(&crate::gpu::PhaseTimer, usize)>,
    ) -> Result<wgpu::Buffer, GpuError> {
        let staging = match self.staging.pop() {
            Some(buffer) => buffer,
            None => device.staging(self.tally_bytes() + crate::gpu::PhaseTimer::bytes())?,
        };
        let mut offset = 0;
        for (buffer, words, cleared) in [
            (&self.fixed.counters, counters::WORDS, counters::CLEARED),
            (&self.fixed.zone_sums, self.words.zones, self.words.zones),
            (&self.fixed.surface_sums, self.words.surfaces, self.words.surfaces),
            (&self.fixed.block_sums, self.words.blocks, self.words.blocks),
        ] {
            let bytes = 4 * words as u64;
            encoder.copy_buffer_to_buffer(buffer, 0, &staging, offset, bytes);
            encoder.clear_buffer(buffer, 0, Some(4 * cleared as u64));
            offset += bytes;
        }
        if let Some((timer, phases)) = timer {
            timer.resolve(encoder, phases, &staging, offset.next_multiple_of(8));
        }
        Ok(staging)
    }

    fn tally_bytes(&self) -> u64 {
        let words = counters::WORDS + self.words.zones + self.words.surfaces + self.words.blocks;
        (4 * words as u64).next_multiple_of(8)
    }

    /// The tallies of an earlier [`Subdomain::encode_readback`], and the bytes of its timestamps.
    ///
    /// # Errors
    /// If the device fails.
    pub fn finish_readback(&mut self, device: &Device, readback: Readback) -> Result<(Tallies, Vec<u8>), GpuError> {
        let tally_bytes = self.tally_bytes() as usize;
        let (words, blocks) = (self.words, self.blocks);
        let (result, staging) = readback.finish(device, |bytes| {
            let all: Vec<u32> = bytemuck::pod_collect_to_vec(&bytes[..tally_bytes]);
            (Tallies::decode(&all, words, blocks), bytes[tally_bytes..].to_vec())
        })?;
        self.staging.push(staging);
        Ok(result)
    }
}
