//! Rust twins of the structs of `shaders/membrane/`. `tests/layouts.rs` holds them against naga's offsets.

use bytemuck::{Pod, Zeroable};

use super::registry::WORK_TABLE;

#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuMembraneStep {
    pub dt: f32,
    pub gas_dt: f32,
    pub quantum: f32,
    pub quanta: f32,
    pub gravity: [f32; 3],
    pub drag: f32,
    pub limit: [u32; 3],
    pub nodes: u32,
    pub elements: u32,
    pub substeps: u32,
    pub impulse_unit: f32,
    /// Steps of the gas that have velocities of held nodes of their own; the last of them is that of all later ones.
    pub prescribed_steps: u32,
}

#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuSubstep {
    pub slot: u32,
    pub substep: u32,
}

#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuMembraneNode {
    /// Quanta of the grid.
    pub place: [u32; 3],
    /// Its last step, s.
    pub dt: f32,
    /// Quanta beside its place.
    pub remainder: [f32; 3],
    pub pad: f32,
    /// m/s, of half a step before.
    pub velocity: [f32; 3],
    pub pad2: f32,
    /// Of the gas, for each step of the fabric, kg m/s.
    pub given: [f32; 3],
    pub pad3: f32,
    /// With which the gas saw it fly, m/s.
    pub seen: [f32; 3],
    pub pad4: f32,
    /// J, and what each sum is too large by.
    pub work: [[f32; 2]; WORK_TABLE.len()],
    pub pad5: [f32; 2],
}

#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuNeighbour {
    pub node: u32,
    /// Of its difference, in a pass of smoothing.
    pub share: f32,
}

#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuElement {
    pub nodes: [u32; 3],
    pub elastic: u32,
    pub second: [f32; 2],
    pub third: [f32; 2],
    pub second2: [u32; 2],
    pub third2: [u32; 2],
    pub second_third: [u32; 2],
    pub volume: f32,
    pub viscosity: f32,
    pub pressure: f32,
    pub pad: u32,
    pub pad2: u32,
    pub pad3: u32,
}

#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuElastic {
    pub stiffness: [f32; 4],
    pub compliance: [f32; 3],
    pub young: f32,
    pub share: f32,
    pub isotropic: u32,
    pub loose: f32,
    pub tightening: f32,
}

#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuElementForces {
    /// N, of strain.
    pub second: [f32; 3],
    /// J.
    pub energy: f32,
    pub third: [f32; 3],
    /// 0 slack, 1 wrinkled, 2 taut.
    pub state: u32,
    pub damped_second: [f32; 3],
    /// J, of a reference that changes.
    pub relaxed: f32,
    pub damped_third: [f32; 3],
    pub pad2: u32,
    /// On each corner.
    pub pressed: [f32; 3],
    pub pad3: u32,
}

#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuNodeConstants {
    /// kg.
    pub mass: f32,
    /// 1: it moves with its prescribed velocity.
    pub held: u32,
    /// Its part of the list of corners.
    pub first: u32,
    pub end: u32,
    /// mu on obstacles.
    pub friction: f32,
}

#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct GpuObstacle {
    /// Quanta of the grid, which may be beyond it.
    pub place: [u32; 3],
    pub friction: f32,
    pub normal: [f32; 3],
    pub pad: f32,
    /// 2^22 times the normal.
    pub whole_normal: [i32; 3],
    /// 1: the last face of its body.
    pub last: u32,
    /// m/s.
    pub velocity: [f32; 3],
    pub pad3: f32,
}
