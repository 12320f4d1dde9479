//! The buffers of a subdomain, named as the shaders name them.

use crate::gpu::{Device, GpuError};

use super::constants::Features;
use super::counters;
use super::domain_buffers::DomainBuffers;
use super::fabric::FabricBuffers;
use super::layout::{
    GpuMotion, GpuNewborn, GpuParticle, GpuPeer, GpuSending, GpuStep, GpuSurfaceModel, GpuUpdate, GpuVent, GpuWeights,
};
use super::registry;
use super::sizes::{CHUNK, FEW_STRETCHES, MOTION_ENTRIES, STRETCH};

/// Whether so many bins are few stretches.
pub fn few_stretches(bins: u64) -> bool {
    bins / STRETCH < FEW_STRETCHES
}

/// Words of a particle's record, its flight and the first entries of its neighbour list (`shaders/shared/neighbour_list.wgsl`): the room
/// of a particle.
pub const RECORD: u64 = 8;
/// Particles for each entry of a tail that there is room for at first: thin gas has no longer lists.
pub const FIRST_TAILS: u64 = 8;

/// Words of the tallies of one interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TallyWords {
    pub zones: usize,
    pub surfaces: usize,
    pub blocks: usize,
}

/// Entries of the tables whose sizes go with the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TableRoom {
    pub surface_models: u64,
    pub vents: u64,
    pub divided: u64,
    pub moved: u64,
    pub cross_section_shares: u64,
}

/// What grows neither with the number of particles nor with that of cells.
pub struct FixedBuffers {
    pub step: wgpu::Buffer,
    pub counters: wgpu::Buffer,
    /// The words `STALLED` and so on of the registry.
    pub stalled: wgpu::Buffer,
    /// The words `PRESENT` and so on.
    pub step_state: wgpu::Buffer,
    pub zone_sums: wgpu::Buffer,
    pub surface_sums: wgpu::Buffer,
    pub block_sums: wgpu::Buffer,
    /// Sizes of the indirect dispatches over lists, and those over the particles that choose: a
    /// dispatch may not write the buffer that it takes its size from.
    pub dispatches: wgpu::Buffer,
    pub rechoose_dispatches: wgpu::Buffer,
    pub on_demand_dispatches: wgpu::Buffer,
    pub weights: wgpu::Buffer,
    /// What surface models and vents do in the interval at hand.
    pub surface_models: wgpu::Buffer,
    pub vents: wgpu::Buffer,
    /// Where the walls that move are in its steps.
    pub motions: wgpu::Buffer,
    /// What is left of the cross-section in each coarse block.
    pub cross_section_shares: wgpu::Buffer,
    /// The cells whose gas walls part, of a step.
    pub divided: wgpu::Buffer,
    /// And those that moving walls may touch.
    pub moved: wgpu::Buffer,
}

impl FixedBuffers {
    pub fn new(
        device: &Device,
        words: TallyWords,
        step_slots: u64,
        tables: TableRoom,
    ) -> Result<FixedBuffers, GpuError> {
        Ok(FixedBuffers {
            step: device.uniform("step", step_slots * step_stride(device))?,
            counters: device.storage::<u32>("counters", counters::WORDS as u64)?,
            stalled: device.storage::<u32>("stalled", registry::STALLED_WORDS.into())?,
            step_state: device.storage::<u32>("step_state", registry::STEP_STATE_WORDS.into())?,
            zone_sums: device.storage::<u32>("zone_sums", words.zones as u64)?,
            surface_sums: device.storage::<u32>("surface_sums", words.surfaces as u64)?,
            block_sums: device.storage::<u32>("block_sums", words.blocks as u64)?,
            dispatches: device.indirect("dispatches", registry::LISTS.into())?,
            rechoose_dispatches: device.indirect("rechoose_dispatches", registry::LISTS.into())?,
            on_demand_dispatches: device.indirect("on_demand_dispatches", registry::LISTS.into())?,
            weights: device.uniform("weights", size_of::<GpuWeights>() as u64)?,
            surface_models: device.storage::<GpuSurfaceModel>("surface_models", tables.surface_models.max(1))?,
            vents: device.storage::<GpuVent>("vents", tables.vents.max(1))?,
            motions: device.uniform("motions", (MOTION_ENTRIES * size_of::<GpuMotion>()) as u64)?,
            divided: device.storage::<u32>("divided", tables.divided)?,
            moved: device.storage::<u32>("moved", tables.moved)?,
            cross_section_shares: device.storage::<u32>("cross_section_shares", tables.cross_section_shares.max(1))?,
        })
    }
}

/// Distance of two `step` uniforms, bytes.
pub fn step_stride(device: &Device) -> u64 {
    let alignment = u64::from(device.limits().min_uniform_buffer_offset_alignment);
    (size_of::<GpuStep>() as u64).next_multiple_of(alignment.max(1))
}

/// Bytes of these buffers for each bin.
pub fn bytes_per_bin() -> f64 {
    4.0 * (1.0 + 1.0 / CHUNK as f64 + 1.0 / STRETCH as f64)
}

/// What grows with the number of cells that have bins.
pub struct CellBuffers {
    pub capacity: u64,
    pub chunk_sums: wgpu::Buffer,
    /// Of stretches of STRETCH cells.
    pub stretch_sums: wgpu::Buffer,
    /// How many particles each cell has, and from the scan on where they start (`cell_start`).
    pub cell_counts: wgpu::Buffer,
}

impl CellBuffers {
    pub fn new(device: &Device, bins: u64) -> Result<CellBuffers, GpuError> {
        // Starts of the cells and of the end, which kernels write by chunks.
        let chunked = CHUNK * (bins / CHUNK + 1);
        Ok(CellBuffers {
            capacity: bins,
            chunk_sums: device.storage::<u32>("chunk_sums", (bins / STRETCH + 1) * (STRETCH / CHUNK))?,
            stretch_sums: device.storage::<u32>("stretch_sums", bins / STRETCH + 1)?,
            cell_counts: device.storage::<u32>("cell_counts", chunked)?,
        })
    }

    pub fn bytes(&self) -> u64 {
        self.chunk_sums.size() + self.stretch_sums.size() + self.cell_counts.size()
    }
}

/// What is sent to other devices and received from them, and the cuts that particles are weighed by.
/// Small on a device alone.
pub struct ExchangeBuffers {
    /// Particles.
    pub room: u64,
    /// Updates.
    pub update_room: u64,
    pub peers: wgpu::Buffer,
    /// Who goes to which peer, particles or updates; how many go to each, zero between uses; and where each one's
    /// message begins, with the end of the last behind them.
    pub sendings: wgpu::Buffer,
    pub peer_counts: wgpu::Buffer,
    pub peer_starts: wgpu::Buffer,
    pub outbox: wgpu::Buffer,
    pub updates_out: wgpu::Buffer,
    pub updates_in: wgpu::Buffer,
    pub cuts: wgpu::Buffer,
    pub histogram: wgpu::Buffer,
}

/// Sizes of the exchange buffers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ExchangeRoom {
    pub particles: u64,
    pub updates: u64,
    pub received: u64,
    pub peers: u64,
    pub cuts: u64,
    pub planes: u64,
}

impl ExchangeBuffers {
    pub fn new(device: &Device, room: &ExchangeRoom) -> Result<ExchangeBuffers, GpuError> {
        Ok(ExchangeBuffers {
            room: room.particles,
            update_room: room.updates,
            peers: device.storage::<GpuPeer>("peers", room.peers)?,
            sendings: device.storage::<GpuSending>("sendings", room.particles.max(room.updates))?,
            peer_counts: device.storage::<u32>("peer_counts", room.peers)?,
            peer_starts: device.storage::<u32>("peer_starts", room.peers + 1)?,
            outbox: device.storage::<GpuParticle>("outbox", room.particles)?,
            updates_out: device.storage::<GpuUpdate>("updates_out", room.updates)?,
            updates_in: device.storage::<GpuUpdate>("updates_in", room.received)?,
            cuts: device.storage::<[u32; 4]>("cuts", room.cuts)?,
            histogram: device.storage::<[u32; 2]>("histogram", room.planes)?,
        })
    }
}

/// Of the buffers that grow with the number of particles, on a device alone, with room for the tails of neighbour lists as at first: most gas at an
/// occupancy of .12 and in steps of a tenth of the collision time wants no more. A run finds what its gas wants.
pub fn bytes_per_particle(collisions: bool, rounds: bool) -> f64 {
    let particle = size_of::<GpuParticle>() as f64;
    // `particles` and `scratch`; `sorted`, `bins`, `slots` and `marks`; `cells`, `midpoints`, the lengths of
    // the lists and their tails.
    let mut bytes = particle + 4.0;
    if collisions {
        bytes += particle + 8.0 + 4.0 + 4.0;
    }
    if rounds {
        bytes += 4.0 + 4.0 + 4.0 + 4.0 / FIRST_TAILS as f64;
    }
    bytes
}

/// What grows with the number of particles.
pub struct ParticleBuffers {
    pub capacity: u64,
    /// Entries of the tails of neighbour lists.
    pub tails: u64,
    /// Where there are rounds, from the sort until the particles fly, `flights` and `neighbours`, a record of each and the tails: what the
    /// particles are is in `sorted` then.
    pub particles: wgpu::Buffer,
    pub newborns: wgpu::Buffer,
    /// Of the sort `bins`; afterwards the `choices` of the rounds, or the `crowds` of the method `cell`.
    pub bins: wgpu::Buffer,
    /// Of the exchange `border`, of the method `cell` `slots`, else from the sort on `incomplete`; afterwards the `pairs` of the rounds, half as many.
    pub slots: wgpu::Buffer,
    /// With room for the parts of lists (`counters::FREE_ENTRIES`), as `slots` have. One after the other `crowded` and `order_by_id`, or `rechoose` of each round and `bouncing`: a list is done with before the next begins.
    pub scratch: wgpu::Buffer,
    pub sorted: wgpu::Buffer,
    pub midpoints: wgpu::Buffer,
    pub neighbour_count: wgpu::Buffer,
    pub cells: wgpu::Buffer,
    pub marks: wgpu::Buffer,
    /// On a device among others.
    pub changed: wgpu::Buffer,
    pub on_demand: wgpu::Buffer,
    /// There also, where ghosts are searched for late: what the particles were before the rounds.
    pub firsts: wgpu::Buffer,
}

impl ParticleBuffers {
    /// Room for `capacity` particles (rounded up) and for tails of neighbour lists of `tails` entries.
    pub fn new(
        device: &Device,
        capacity: u64,
        newborns: u64,
        tails: u64,
        features: Features,
    ) -> Result<ParticleBuffers, GpuError> {
        let capacity = capacity.max(64).next_multiple_of(64);
        // Without collisions the particles are flown in place.
        let binned = if features.collisions { capacity } else { 4 };
        // Without rounds nobody chooses.
        let chosen = if features.rounds { capacity } else { 4 };
        let weighed = if features.rounds || features.halo { binned } else { 4 };
        let exchange = if features.halo { capacity } else { 4 };
        let tails = if features.rounds { tails.next_multiple_of(8) } else { 0 };
        let late = if features.rounds { exchange } else { 4 };
        Ok(ParticleBuffers {
            capacity,
            tails,
            particles: device.storage::<u32>("particles", RECORD * capacity + tails)?,
            newborns: device.storage::<GpuNewborn>("newborns", newborns)?,
            bins: device.storage::<[u32; 2]>("bins", binned)?,
            slots: device.storage::<u32>(
                "slots",
                if features.halo { 2 * binned } else { binned } + 2 * counters::FREE_ENTRIES,
            )?,
            scratch: device.storage::<u32>("scratch", capacity + counters::FREE_ENTRIES)?,
            sorted: device.storage::<GpuParticle>("sorted", binned)?,
            midpoints: device.storage::<u32>("midpoints", chosen)?,
            cells: device.storage::<u32>("cells", weighed)?,
            neighbour_count: device.storage::<u32>("neighbour_count", weighed)?,
            marks: device.storage::<u32>("marks", binned)?,
            changed: device.storage::<u32>("changed", exchange)?,
            on_demand: device.storage::<u32>("on_demand", exchange)?,
            firsts: device.storage::<GpuParticle>("firsts", late)?,
        })
    }

    pub fn bytes(&self) -> u64 {
        self.buffers().iter().map(|buffer| buffer.size()).sum()
    }

    fn buffers(&self) -> [&wgpu::Buffer; 13] {
        [
            &self.particles,
            &self.newborns,
            &self.bins,
            &self.slots,
            &self.scratch,
            &self.sorted,
            &self.midpoints,
            &self.neighbour_count,
            &self.cells,
            &self.marks,
            &self.changed,
            &self.on_demand,
            &self.firsts,
        ]
    }
}

/// How many particles, whose buffer with that of their neighbour lists is the largest that grows with them, fit a buffer of
/// `bytes`. Lists grow where gas is dense, and buffers are made larger than the gas at hand: a guide, no promise.
pub fn most_particles(bytes: u64) -> u64 {
    bytes * FIRST_TAILS / (size_of::<u32>() as u64 * (RECORD * FIRST_TAILS + 1))
}

/// All buffers of a subdomain.
#[derive(Clone, Copy)]
pub struct Buffers<'a> {
    pub domain: &'a DomainBuffers,
    pub fixed: &'a FixedBuffers,
    pub cell: &'a CellBuffers,
    pub fabric: &'a FabricBuffers,
    pub particle: &'a ParticleBuffers,
    pub exchange: &'a ExchangeBuffers,
}

impl<'a> Buffers<'a> {
    /// The buffer that shaders call `name`.
    pub fn by_name(&self, name: &str) -> Option<&'a wgpu::Buffer> {
        let Buffers { domain, fixed, cell, fabric, particle, exchange } = *self;
        Some(match registry::made_as(name) {
            "step" => &fixed.step,
            "gases" => &domain.gases,
            "modes" => &domain.modes,
            "mass_shares" => &domain.mass_shares,
            "motions" => &fixed.motions,
            "weights" => &fixed.weights,
            "counters" => &fixed.counters,
            "dispatches" => &fixed.dispatches,
            "rechoose_dispatches" => &fixed.rechoose_dispatches,
            "on_demand_dispatches" => &fixed.on_demand_dispatches,
            "stalled" => &fixed.stalled,
            "step_state" => &fixed.step_state,
            "zone_sums" => &fixed.zone_sums,
            "surface_sums" => &fixed.surface_sums,
            "block_sums" => &fixed.block_sums,
            "histogram" => &exchange.histogram,
            "surface_models" => &fixed.surface_models,
            "vents" => &fixed.vents,
            "cross_section_shares" => &fixed.cross_section_shares,
            "zones" => &domain.zones,
            "wall_start" => &domain.wall_start,
            "wall_list" => &domain.wall_list,
            "triangles" => &domain.triangles,
            "cell_class" => &domain.cell_class,
            "parting" => &domain.parting,
            "nodes" => &fabric.nodes,
            "fabric" => &domain.fabric,
            "fabric_cells" => &fabric.cells,
            "fabric_entries" => &fabric.entries,
            "fabric_swept" => &fabric.swept,
            "node_impulses" => &fabric.impulses,
            "node_velocities" => &fabric.velocities,
            "cell_volume" => &domain.cell_volume,
            "cell_parts" => &domain.cell_parts,
            "still_gas" => &domain.still_gas,
            "chunk_sums" => &cell.chunk_sums,
            "stretch_sums" => &cell.stretch_sums,
            "cell_counts" => &cell.cell_counts,
            "particles" => &particle.particles,
            "newborns" => &particle.newborns,
            "bins" => &particle.bins,
            "slots" => &particle.slots,
            "crowded" => &particle.scratch,
            "sorted" => &particle.sorted,
            "midpoints" => &particle.midpoints,
            "neighbour_count" => &particle.neighbour_count,
            "cells" => &particle.cells,
            "marks" => &particle.marks,
            "changed" => &particle.changed,
            "on_demand" => &particle.on_demand,
            "firsts" => &particle.firsts,
            "divided" => &fixed.divided,
            "moved" => &fixed.moved,
            "peers" => &exchange.peers,
            "sendings" => &exchange.sendings,
            "peer_counts" => &exchange.peer_counts,
            "peer_starts" => &exchange.peer_starts,
            "outbox" => &exchange.outbox,
            "updates_out" => &exchange.updates_out,
            "updates_in" => &exchange.updates_in,
            "cuts" => &exchange.cuts,
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a plan is told to take is what is made: a change of one without the other is seen here.
    #[test]
    fn the_bytes_of_a_particle_are_those_of_its_buffers() {
        let device = Device::open(None).expect("a device");
        let bytes = |features: Features, capacity: u64| {
            ParticleBuffers::new(&device, capacity, 1, capacity / FIRST_TAILS, features).expect("room").bytes()
        };
        for (collisions, rounds) in [(false, false), (true, false), (true, true)] {
            let features = Features { collisions, rounds, ..Features::default() };
            let found = bytes(features, 6400) - bytes(features, 3200);
            assert_eq!(found as f64, 3200.0 * bytes_per_particle(collisions, rounds), "{collisions} {rounds}");
        }
        let bins = |bins: u64| CellBuffers::new(&device, bins).expect("room").bytes();
        let some = 4 * STRETCH;
        assert_eq!((bins(2 * some) - bins(some)) as f64, some as f64 * bytes_per_bin());
    }
}
