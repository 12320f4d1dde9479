//! One device's gas as a whole: its buffers, its kernels bound to them, its place among the ranks.

use std::sync::Arc;

use crate::gpu::{BoundKernel, Constants, Device, GpuError, KernelVariant};

use super::buffers::{
    Buffers, CellBuffers, ExchangeBuffers, ExchangeRoom, FIRST_TAILS, FixedBuffers, ParticleBuffers, TableRoom,
};
use super::constants::{Features, block_counts};
use super::domain::Domain;
use super::fabric::{FIRST_ENTRIES, FabricBuffers};
use super::guess::Guess;
use super::kernels::Kernels;
use super::layout::{GpuParticle, GpuPeer};
use super::step_slot::uniforms;
use super::subdomain_box::{Cells, GridCells, SubdomainBox};

pub struct Subdomain {
    pub(super) domain: Arc<Domain>,
    pub(super) place: SubdomainBox,
    pub(super) kernels: Kernels<BoundKernel>,
    pub(super) fixed: FixedBuffers,
    pub(super) cell: CellBuffers,
    pub(super) fabric: FabricBuffers,
    pub(super) particle: ParticleBuffers,
    pub(super) exchange: ExchangeBuffers,
    pub(super) exchange_room: ExchangeRoom,
    pub(super) outbox_guess: Guess,
    pub(super) update_guess: Guess,
    /// Slots of `particles` in use once all encoded steps have run; among others some of them are dead.
    pub(super) count: u32,
    /// The last step that was begun among others.
    pub(super) last_index: u32,
    pub(super) staging: Vec<wgpu::Buffer>,
    pub(super) spare_staging: Vec<wgpu::Buffer>,
    /// Lists with so few places have a thread for each.
    pub(super) short_lists: u64,
    /// A copy of the flights of each step, with their lists, before particles take their room.
    pub(super) watched: Option<wgpu::Buffer>,
}

/// Places of a list for each of which a GPU is told of a thread: it would wait longer for the number of the entries.
const SHORT_LIST: u64 = 1 << 16;

impl Subdomain {
    /// A subdomain at `place` that starts with these particles.
    ///
    /// # Errors
    /// If the particles or cells are over the device's limits.
    pub fn new(
        device: &Device,
        domain: Arc<Domain>,
        place: SubdomainBox,
        particles: &[GpuParticle],
    ) -> Result<Subdomain, GpuError> {
        let (plan, features) = (&domain.plan, domain.features);
        let slots = u64::from(plan.steps_per_interval) * u64::from(uniforms(plan, features));
        let cross_section_shares =
            if features.capped { block_counts(plan).iter().map(|&n| u64::from(n)).product() } else { 1 };
        let tables = TableRoom {
            surface_models: domain.patches.surface_models as u64,
            vents: domain.vent_entries as u64,
            divided: domain.divided_cells,
            moved: domain.moved_cells,
            cross_section_shares,
        };
        let fixed = FixedBuffers::new(device, domain.words, slots, tables)?;
        // Room for what is there, and for some that come: of an inflow, or from other devices.
        let present = particles.len() as u64;
        let come = if features.orifices || features.halo { (present / 8).max(1024) } else { 0 };
        let capacity = present.max((present + come).min(domain.most_particles()));
        let particle = ParticleBuffers::new(device, capacity, 1024, capacity / FIRST_TAILS, features)?;
        // Without collisions nothing is binned.
        let bins = if features.collisions { bins_of(&place, &domain) } else { 4 };
        let cell = CellBuffers::new(device, bins)?;
        let exchange_room = ExchangeRoom { particles: 64, updates: 64, received: 64, peers: 16, cuts: 64, planes: 256 };
        let exchange = ExchangeBuffers::new(device, &exchange_room)?;
        // Where intervals can run again lists of elastic fabric begin with little room.
        let most = domain.fabric.elastic.unwrap_or(0);
        let room = if features.halo { most.min(FIRST_ENTRIES * domain.fabric.sheets.len() as u64) } else { most };
        let listed = place.cells_with_fabric_lists(plan.grid.cells);
        let fabric = FabricBuffers::new(device, &domain.fabric, plan.steps_per_interval, [room, listed])?;
        let buffers = Buffers {
            domain: &domain.buffers,
            fixed: &fixed,
            cell: &cell,
            fabric: &fabric,
            particle: &particle,
            exchange: &exchange,
        };
        let kernels = domain.compiled.bind(device, features, &buffers)?;
        device.write(&particle.particles, 0, particles);
        let mut subdomain = Subdomain {
            place: place.clone(),
            kernels,
            fixed,
            cell,
            fabric,
            particle,
            exchange,
            exchange_room,
            outbox_guess: Guess::new(),
            update_guess: Guess::new(),
            count: particles.len() as u32,
            last_index: 0,
            staging: Vec::new(),
            spare_staging: Vec::new(),
            short_lists: if domain.variant == KernelVariant::Gpu { SHORT_LIST } else { 0 },
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

    pub fn place(&self) -> &SubdomainBox {
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
        let lists = self.fixed.divided.size() + self.fixed.moved.size();
        self.cell.bytes() + self.domain.buffers.cell_bytes() + lists
    }

    /// What the kernels are specialised by.
    pub fn constants(&self) -> &Constants {
        &self.domain.constants
    }

    /// Other cells and peers, from the next step on, whose exchange moves the particles there.
    ///
    /// # Errors
    /// If the cells are over the device's limits.
    pub fn move_to(&mut self, device: &Device, place: SubdomainBox) -> Result<(), GpuError> {
        self.place = place;
        let peers = self.gpu_peers();
        if self.domain.features.collisions && bins_of(&self.place, &self.domain) > self.cell.capacity {
            let bins = bins_of(&self.place, &self.domain);
            self.cell = CellBuffers::new(device, bins + bins / 8)?;
            self.rebind(device)?;
        }
        let listed = self.place.cells_with_fabric_lists(self.domain.plan.grid.cells);
        if self.domain.fabric.nodes > 0 && self.fabric.make_room(device, [0, listed])? {
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

    pub(super) fn rebind(&mut self, device: &Device) -> Result<(), GpuError> {
        let buffers = Buffers {
            domain: &self.domain.buffers,
            fixed: &self.fixed,
            cell: &self.cell,
            fabric: &self.fabric,
            particle: &self.particle,
            exchange: &self.exchange,
        };
        self.kernels = self.domain.compiled.bind(device, self.domain.features, &buffers)?;
        Ok(())
    }
}

/// Cells with bins.
fn bins_of(place: &SubdomainBox, domain: &Domain) -> u64 {
    let (_, size) = place.bins(domain.plan.grid.cells);
    size.iter().map(|&n| u64::from(n)).product()
}
