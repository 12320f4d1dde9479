//! Rust twins of the structs in the shaders. `tests/layouts.rs` holds them against naga's offsets.

use bytemuck::{Pod, Zeroable};

/// `Step` of `shaders/shared/step.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuStep {
    pub count: u32,
    pub newborns: u32,
    pub newborn_offset: u32,
    pub newborn_first_id: u32,
    pub index: u32,
    pub dt: f32,
    pub round: u32,
    pub arrivals: u32,
    pub low: [u32; 3],
    pub total: u32,
    pub size: [u32; 3],
    pub bins: u32,
    pub own_low: [u32; 3],
    pub depth: u32,
    pub own_high: [u32; 3],
    pub reach: u32,
    pub inner_low: [u32; 3],
    pub first: u32,
    pub inner_high: [u32; 3],
    pub ghosts: u32,
    pub peers: u32,
    pub near_peers: u32,
    pub capacity: u32,
    pub stride: u32,
    pub tallies_left: u32,
    pub slot: u32,
    pub near2: u32,
    pub flight: u32,
    pub next_newborns: u32,
    pub lattice: u32,
    pub next_lattice: u32,
    pub pad: u32,
    pub fabric_low: [u32; 3],
    pub pad2: u32,
    pub fabric_size: [u32; 3],
    pub pad3: u32,
}

/// `Part` of `shaders/shared/cell_gas.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuPart {
    /// Quanta of the grid.
    pub place: [u32; 3],
    /// m3.
    pub volume: f32,
}

/// `StillGas` of `shaders/shared/cell_gas.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuStillGas {
    /// A bit for each point of the lattice.
    pub points: [u32; 3],
    /// m3.
    pub volume: f32,
}

/// `Particle` of `shaders/shared/particle.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuParticle {
    /// Quanta of the grid.
    pub position: [u32; 3],
    /// Gas in the top 4 bits, below it a bit that is set inside of closed fabric, the id below.
    pub tag: u32,
    /// m/s.
    pub velocity: [f32; 3],
    /// Internal energy over the reference mass, (m/s)^2.
    pub spin: f32,
}

impl GpuParticle {
    /// The tag of a slot that holds no particle.
    pub const NOBODY: u32 = u32::MAX;
    pub const ID_MASK: u32 = (1 << 27) - 1;
    pub const INSIDE: u32 = 1 << 27;

    pub fn tag(gas: u8, id: u32) -> u32 {
        (u32::from(gas) << 28) | (id & Self::ID_MASK)
    }

    pub fn id(&self) -> u32 {
        self.tag & Self::ID_MASK
    }

    pub fn gas(&self) -> u8 {
        (self.tag >> 28) as u8
    }

    /// Whether it is inside of closed fabric.
    pub fn is_inside(&self) -> bool {
        self.tag & Self::INSIDE != 0
    }
}

/// `Sheet` of `shaders/shared/fabric.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuSheet {
    pub a: u32,
    pub b: u32,
    pub c: u32,
    pub closed: u32,
    pub surface: u32,
    pub surface_model: u32,
    pub work: u32,
    pub recoil: f32,
}

/// `Swept` of `shaders/shared/fabric.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuSwept {
    pub normal: [f32; 3],
    pub away: f32,
    pub corner: [u32; 3],
    pub pad: u32,
}

/// `Newborn` of `shaders/shared/newborn.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuNewborn {
    /// At its virtual position x0 = place - v start.
    pub particle: GpuParticle,
    /// s from the start of its step.
    pub start: f32,
    pub pad: [u32; 3],
}

/// `Flight` of `shaders/shared/particle.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuFlight {
    pub start: f32,
    pub wall: f32,
    pub partner: u32,
    /// Those of this step in the lower half; in the upper half `shaders/shared/cap.wgsl`.
    pub collisions: u32,
}

impl GpuFlight {
    /// Collisions in this step.
    pub fn collided(&self) -> u32 {
        self.collisions & 0xffff
    }
}

/// `Triangle` of `shaders/shared/walls.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuTriangle {
    pub a: [u32; 3],
    pub sense: f32,
    pub b: [u32; 3],
    pub surface: u32,
    pub c: [u32; 3],
    pub surface_model: u32,
    pub normal: [f32; 3],
    pub motion: u32,
}

/// `Motion` of `shaders/shared/motions.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuMotion {
    /// Quanta of the grid.
    pub moved: [i32; 3],
    pub cells: u32,
    pub velocity: [f32; 3],
    pub rows: u32,
    pub low: [u32; 3],
    pub pad: u32,
    pub high: [u32; 3],
    pub pad2: u32,
    pub body_low: [u32; 3],
    pub pad3: u32,
    pub body_size: [u32; 3],
    pub pad4: u32,
}

/// `SurfaceModel` of `shaders/shared/surface_models.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuSurfaceModel {
    pub thermal: f32,
    pub accommodation: f32,
    pub friction: f32,
    pub first_vent: u32,
    pub end_vent: u32,
    pub zone: u32,
    pub next: u32,
}

/// `Vent` of `shaders/shared/surface_models.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuVent {
    pub center: [u32; 3],
    pub radius2: f32,
    pub beta: f32,
    pub index: u32,
    /// 1: to the other side of fabric, else out of the run.
    pub passes: u32,
    pub pad: u32,
}

/// `Zone` of `shaders/shared/zones.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuZone {
    pub low: [u32; 3],
    pub kind: u32,
    pub high: [u32; 3],
    pub radius: f32,
    pub axis: [f32; 3],
    pub height: f32,
    pub carried: u32,
    pub planes: u32,
    pub pad2: u32,
    pub pad3: u32,
}

/// `Gas` of `shaders/shared/gas.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuGas {
    pub mass: f32,
    pub exchange: f32,
    pub inverse_beta: f32,
    pub inverse_beta1: f32,
}

/// `Update` of `shaders/shared/update.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuUpdate {
    pub particle: GpuParticle,
    pub flight: GpuFlight,
    pub cell: u32,
    pub pad: u32,
    pub pad2: u32,
    pub pad3: u32,
}

/// `Sending` of `shaders/shared/sendings.wgsl`, which no host reads.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuSending {
    pub index: u32,
    pub peer: u32,
    pub place: u32,
}

/// `Peer` of `shaders/shared/update.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuPeer {
    pub low: [i32; 3],
    pub pad: u32,
    pub high: [i32; 3],
    pub pad2: u32,
}

/// `Weights` of `shaders/weigh.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuWeights {
    pub particle: u32,
    pub candidate: u32,
    pub wall: u32,
    pub sheet: u32,
    pub cuts: u32,
}
