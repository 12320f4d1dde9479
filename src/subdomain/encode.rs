//! The phases of a step, as dispatches in the order of `simulation::step`.

use crate::gpu::{BoundKernel, Device, TimedPass, fold};
use crate::plan::Plan;

use super::buffers::{CHUNK, step_stride};
use super::constants::WORKGROUP;
use super::layout::{GpuNewborn, GpuStep};
use super::{GpuError, Subdomain};

/// One step of an interval, as its dispatches see it.
#[derive(Debug, Clone, Copy)]
pub struct StepSlot {
    /// Place in the interval.
    slot: u32,
    newborns: u32,
    /// Particles, newborns included.
    total: u32,
}

/// The lists of `shaders/shared/lists.wgsl` that have a dispatch of their own; lower ones are the rounds'.
const LIST_NEAR_WALLS: u32 = 9;
const LIST_SCREEN: u32 = 10;
const LIST_BOUNCE: u32 = 11;
const LIST_RECHOOSE: u32 = 16;

/// Particles per workgroup of the tally: WORKGROUP threads x CHUNK_LOOPS.
const TALLY_CHUNK: u64 = 64 * 32;

impl Subdomain {
    /// Uploads the parameters and newborns of the steps of one interval and returns their slots.
    /// `newborns_of` gives the number of newborns of each step, in order; the first has `first_id`.
    ///
    /// # Errors
    /// If room must be made and the device has none.
    pub fn begin_interval(
        &mut self,
        device: &Device,
        first_step: u64,
        dt: f64,
        newborns_of: &[u32],
        newborns: &[GpuNewborn],
        first_id: u32,
    ) -> Result<Vec<StepSlot>, GpuError> {
        self.make_room(device, newborns.len(), 0)?;
        device.write(&self.particle.newborns, 0, newborns);
        let rounds = self.plan.rounds + 1;
        let stride = step_stride(device) as usize;
        let mut bytes = vec![0u8; stride * newborns_of.len() * rounds as usize];
        let mut slots = Vec::with_capacity(newborns_of.len());
        let mut entered = 0;
        for (k, &born) in newborns_of.iter().enumerate() {
            for round in 0..rounds {
                let step = GpuStep {
                    count: self.count,
                    newborns: born,
                    newborn_offset: entered,
                    newborn_first_id: first_id + entered,
                    index: (first_step + k as u64) as u32,
                    dt: dt as f32,
                    round,
                    pad: 0,
                };
                let at = stride * (k * rounds as usize + round as usize);
                bytes[at..at + size_of::<GpuStep>()].copy_from_slice(bytemuck::bytes_of(&step));
            }
            entered += born;
            self.count += born;
            slots.push(StepSlot { slot: k as u32, newborns: born, total: self.count });
        }
        device.write(&self.fixed.step, 0, &bytes);
        Ok(slots)
    }

    /// The particles as they are, for tallies outside a step.
    pub fn at_rest(&self, device: &Device) -> StepSlot {
        let step = GpuStep { count: self.count, ..GpuStep::default() };
        device.write(&self.fixed.step, 0, bytemuck::bytes_of(&step));
        StepSlot { slot: 0, newborns: 0, total: self.count }
    }

    fn offset(&self, device: &Device, step: StepSlot, round: u32) -> u32 {
        (step_stride(device) as u32) * (step.slot * (self.plan.rounds + 1) + round)
    }

    pub fn inject(&self, device: &Device, pass: &mut TimedPass<'_>, step: StepSlot) {
        self.kernels.reset.dispatch(pass.phase("inject"), 0, [1, 1, 1]);
        if let (Some(kernel), true) = (&self.kernels.inject, step.newborns > 0) {
            kernel.dispatch(
                pass.phase("inject"),
                self.offset(device, step, 0),
                threads(device, u64::from(step.newborns)),
            );
        }
    }

    pub fn bin(&self, device: &Device, pass: &mut TimedPass<'_>, step: StepSlot) {
        if let Some(kernels) = &self.kernels.collisions {
            kernels.bin.dispatch(pass.phase("bin"), self.offset(device, step, 0), self.all(device, step));
        }
    }

    pub fn scan(&self, device: &Device, pass: &mut TimedPass<'_>) {
        if let Some(kernels) = &self.kernels.collisions {
            let chunks = threads(device, chunk_count(&self.plan));
            let pass = pass.phase("scan");
            kernels.scan_sums.dispatch(pass, 0, chunks);
            kernels.scan_chunks.dispatch(pass, 0, [1, 1, 1]);
            kernels.scan_cells.dispatch(pass, 0, chunks);
        }
    }

    pub fn sort(&self, device: &Device, pass: &mut TimedPass<'_>, step: StepSlot) {
        if let Some(kernels) = &self.kernels.collisions {
            let (offset, all) = (self.offset(device, step, 0), self.all(device, step));
            let pass = pass.phase("sort");
            kernels.scatter.dispatch(pass, offset, all);
            kernels.order.dispatch(pass, offset, all);
            kernels.wall_times.dispatch_indirect(pass, offset, &self.fixed.dispatches, LIST_NEAR_WALLS);
        }
    }

    pub fn neighbours(&self, device: &Device, pass: &mut TimedPass<'_>, step: StepSlot) {
        if let Some(kernels) = &self.kernels.collisions {
            let offset = self.offset(device, step, 0);
            let pass = pass.phase("neighbours");
            kernels.neighbours.dispatch(pass, offset, self.all(device, step));
            kernels.screen.dispatch_indirect(pass, offset, &self.fixed.dispatches, LIST_SCREEN);
        }
    }

    pub fn choose(&self, device: &Device, pass: &mut TimedPass<'_>, step: StepSlot, round: u32) {
        if let Some(kernels) = &self.kernels.collisions {
            self.choosing(&kernels.choose, device, pass.phase("choose"), step, round);
        }
    }

    pub fn settle(&self, device: &Device, pass: &mut TimedPass<'_>, step: StepSlot, round: u32) {
        if let Some(kernels) = &self.kernels.collisions {
            let offset = self.offset(device, step, round);
            let pass = pass.phase("settle");
            self.choosing(&kernels.match_pairs, device, pass, step, round);
            kernels.settle.dispatch_indirect(pass, offset, &self.fixed.dispatches, round);
        }
    }

    /// One more choice after the last round: pairs still mutual are collisions that the rounds lost.
    pub fn count_lost(&self, device: &Device, pass: &mut TimedPass<'_>, step: StepSlot) {
        if let Some(kernels) = &self.kernels.collisions {
            let pass = pass.phase("lost");
            self.choosing(&kernels.choose, device, pass, step, self.plan.rounds);
            self.choosing(&kernels.match_pairs, device, pass, step, self.plan.rounds);
            kernels.lost.dispatch(pass, 0, [1, 1, 1]);
        }
    }

    /// Over all particles in the first round, over those that choose again in later ones.
    fn choosing(
        &self,
        kernel: &BoundKernel,
        device: &Device,
        pass: &mut wgpu::ComputePass<'_>,
        step: StepSlot,
        round: u32,
    ) {
        let offset = self.offset(device, step, round);
        if round == 0 {
            kernel.dispatch(pass, offset, self.all(device, step));
        } else {
            kernel.dispatch_indirect(pass, offset, &self.fixed.rechoose_dispatches, LIST_RECHOOSE + round);
        }
    }

    pub fn advect(&self, device: &Device, pass: &mut TimedPass<'_>, step: StepSlot) {
        let offset = self.offset(device, step, 0);
        let pass = pass.phase("advect");
        self.kernels.advect.dispatch(pass, offset, self.all(device, step));
        self.kernels.bounce.dispatch_indirect(pass, offset, &self.fixed.dispatches, LIST_BOUNCE);
    }

    pub fn tally(&self, device: &Device, pass: &mut TimedPass<'_>, step: StepSlot) {
        let chunks = u64::from(step.total).div_ceil(TALLY_CHUNK) as u32;
        let groups = [chunks, self.zones as u32, self.plan.gases.len() as u32];
        self.kernels.tally.dispatch(pass.phase("tally"), self.offset(device, step, 0), groups);
    }

    /// The blocks that the choice of the step size needs.
    pub fn tally_blocks(&self, device: &Device, pass: &mut TimedPass<'_>, step: StepSlot) {
        self.kernels.blocks.dispatch(pass.phase("tally"), self.offset(device, step, 0), self.all(device, step));
    }

    fn all(&self, device: &Device, step: StepSlot) -> [u32; 3] {
        threads(device, u64::from(step.total))
    }
}

fn threads(device: &Device, items: u64) -> [u32; 3] {
    fold(items, WORKGROUP, device.limits().max_compute_workgroups_per_dimension)
}

fn chunk_count(plan: &Plan) -> u64 {
    (plan.grid.cell_count() as u64).next_multiple_of(4).div_ceil(CHUNK)
}
