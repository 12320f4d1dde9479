//! An interval of steps as its dispatches see it: its steps, who enters in them, and what the host tells of walls and gas.

use crate::plan::Plan;

use super::constants::Features;
use super::layout::{GpuMotion, GpuNewborn, GpuSurfaceModel, GpuVent};

/// One step of an interval, as its dispatches see it.
#[derive(Debug, Clone, Copy)]
pub struct StepSlot {
    /// SubdomainBox in the interval.
    pub(super) slot: u32,
    pub(super) index: u32,
    pub(super) dt: f32,
    pub(super) count: u32,
    pub(super) newborns: u32,
    pub(super) newborn_offset: u32,
    pub(super) first_id: u32,
    pub(super) stride: u32,
    pub(super) arrivals: u32,
    /// Entries of `sorted`.
    pub(super) total: u32,
    pub(super) tallies_left: u32,
    pub(super) near2: u32,
    /// Those who enter in the step that follows in the interval, if there is one on a device alone.
    pub(super) next: Option<u32>,
    /// The step before has counted the particles of the cells.
    pub(super) binned: bool,
}

/// What surface models and vents do in an interval, empty where all walls are mirrors; and where the walls that move are in each
/// of its steps, `MOST_MOTIONS` entries for each, empty where none does.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tables {
    pub surface_models: Vec<GpuSurfaceModel>,
    pub vents: Vec<GpuVent>,
    pub motions: Vec<GpuMotion>,
    /// Of surfaces that deform the places of all nodes, quanta, at the start of each step and at the end of the last.
    pub nodes: Vec<[u32; 4]>,
    /// What is left of the cross-section in each coarse block, in [`FULL_SHARE`]ths; empty without a cap.
    pub cross_section_shares: Vec<u32>,
    /// By how many halvings less the fastest pairs fly in these steps than in the longest.
    pub halvings: u32,
}

/// The share of a block whose gas has the largest diameter (`shaders/shared/cap.wgsl`).
pub const FULL_SHARE: u32 = 1 << 15;

/// The steps of an interval.
#[derive(Debug, Clone, Copy)]
pub struct Steps<'a> {
    /// Steps of the run before it.
    pub first: u64,
    /// The first of its steps that are done already.
    pub done: u32,
    /// s.
    pub dt: f64,
    /// Whether each adds to the zones.
    pub tallied: &'a [bool],
}

/// Who enters in an interval.
#[derive(Debug, Clone, Copy)]
pub struct Newborns<'a> {
    /// The number in each step.
    pub of_step: &'a [u32],
    /// All of them, in order of entry.
    pub list: &'a [GpuNewborn],
    pub first_id: u32,
    /// Distance of two ids.
    pub stride: u32,
}

impl Newborns<'_> {
    /// A step in which those of the interval's step of this place enter.
    pub(super) fn entering(&self, slot: StepSlot, step: u32) -> StepSlot {
        let before: u32 = self.of_step[..step as usize].iter().sum();
        StepSlot {
            newborns: self.of_step[step as usize],
            newborn_offset: before,
            first_id: self.first_id + before * self.stride,
            stride: self.stride,
            ..slot
        }
    }
}

impl StepSlot {
    /// Steps since the start of the run.
    pub fn index(&self) -> u32 {
        self.index
    }

    /// Particles on the device in this step, ghosts included.
    pub fn present(&self) -> u32 {
        self.total
    }

    /// Those of them that came from other devices.
    pub fn arrived(&self) -> u32 {
        self.arrivals
    }
}

/// Uniforms of a step: of each round and of the count of lost collisions; among others, as many for the passes over
/// the ghosts that were asked.
pub(super) fn uniforms(plan: &Plan, features: Features) -> u32 {
    (plan.rounds + 1) * if features.halo { 2 } else { 1 }
}
