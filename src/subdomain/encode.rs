//! The phases of a step, as dispatches in the order of `simulation::step`.

use crate::gpu::{BoundKernel, Device, KernelVariant, Pass, Recording};

use super::buffers::{RECORD, few_stretches};
use super::counters;
use super::device_gas::Subdomain;
use super::dispatch::{all, threads};
use super::fabric::words_of_cells;
use super::registry::{
    LIST_BOUNCE, LIST_COLLISION_CELLS, LIST_CROWDED, LIST_CROWDS, LIST_CUT_CELLS, LIST_DIVIDED, LIST_INCOMPLETE,
    LIST_MOVED, LISTS,
};
use super::sizes::{CHUNK, CLEARED_CELLS, MEMBERS, STRETCH, WORKGROUP};
use super::step_slot::StepSlot;

/// A list, and how a kernel is dispatched over it.
pub(super) struct ListDispatch<'a> {
    /// Where its length has been told.
    pub arguments: &'a wgpu::Buffer,
    /// Its number in them.
    pub list: u32,
    /// Places that may have its entries.
    pub places: u64,
}

impl Subdomain {
    /// Empties the lists of the step before (`shaders/reset.wgsl`).
    pub fn reset(&self, rec: &mut Recording<'_>) {
        let sorts = self.kernels.sort.is_some();
        let stretches = if sorts { self.cell.capacity / STRETCH + 1 } else { 0 };
        let groups = threads(rec.device(), stretches.max(LISTS.into()));
        self.kernels.reset.dispatch(&mut rec.phase(if sorts { "bin" } else { "advect" }), 0, groups);
    }

    /// Lists the triangles of fabric by cell.
    pub fn list_fabric(&self, rec: &mut Recording<'_>, step: &StepSlot) {
        if let Some(kernels) = &self.kernels.fabric {
            let listed = self.place.cells_with_fabric_lists(self.domain.plan.grid.cells);
            let bytes = 4 * words_of_cells(listed);
            rec.encoder().clear_buffer(&self.fabric.cells, 0, Some(bytes));
            let device = rec.device();
            let sheets = threads(device, self.domain.fabric.sheets.len() as u64);
            let cells = threads(device, self.fabric.room.min(listed));
            let offset = self.offset(device, step, 0);
            let pass = &mut rec.phase("fabric");
            kernels.list.dispatch(pass, offset, sheets);
            kernels.bound.dispatch(pass, offset, cells);
        }
    }

    /// The particles that are here, and the newborns, which it puts behind them; those that come from other devices are binned as they arrive.
    pub fn bin(&self, rec: &mut Recording<'_>, step: &StepSlot) {
        if !step.binned {
            let slots = u64::from(step.count) + u64::from(step.newborns);
            self.bin_slots(rec, step, slots);
        }
    }

    pub(super) fn bin_slots(&self, rec: &mut Recording<'_>, step: &StepSlot, slots: u64) {
        if let Some(kernels) = &self.kernels.sort {
            let device = rec.device();
            kernels.bin.dispatch(&mut rec.phase("bin"), self.offset(device, step, 0), threads(device, slots));
        }
    }

    pub fn scan(&self, rec: &mut Recording<'_>, step: &StepSlot) {
        if let Some(kernels) = &self.kernels.sort {
            let device = rec.device();
            let chunks = threads(device, self.bins() / CHUNK + 1);
            let offset = self.offset(device, step, 0);
            let pass = &mut rec.phase("scan");
            kernels.scan_sums.dispatch(pass, offset, chunks);
            if !few_stretches(self.bins()) {
                kernels.scan_stretches.dispatch(pass, offset, [1, 1, 1]);
            }
            kernels.scan_cells.dispatch(pass, offset, chunks);
        }
    }

    pub fn sort(&self, rec: &mut Recording<'_>, step: &StepSlot) {
        let device = rec.device();
        let offset = self.offset(device, step, 0);
        let slots = threads(device, u64::from(step.count) + u64::from(step.newborns) + u64::from(step.arrivals));
        if let Some(kernels) = &self.kernels.collisions {
            let pass = &mut rec.phase("sort");
            kernels.order.dispatch(pass, offset, slots);
            if let Some(start_flights) = &kernels.start_flights {
                start_flights.dispatch(pass, offset, all(device, step));
            }
        }
        if let Some(kernels) = &self.kernels.cells {
            let pass = &mut rec.phase("sort");
            kernels.arrange.dispatch(pass, offset, slots);
            let list =
                ListDispatch { arguments: &self.fixed.dispatches, list: LIST_CROWDED, places: step.total.into() };
            self.over_list(&kernels.arrange_crowded, (device, pass), offset, list);
        }
        if let Some(kernels) = &self.kernels.half_turn {
            let pass = &mut rec.phase("sort");
            kernels.list_ids.dispatch(pass, offset, slots);
            kernels.arrange_by_id.dispatch(pass, offset, slots);
        }
    }

    pub fn neighbours(&self, rec: &mut Recording<'_>, step: &StepSlot) {
        if let Some(kernels) = &self.kernels.collisions {
            let device = rec.device();
            let offset = self.offset(device, step, 0);
            let pass = &mut rec.phase("neighbours");
            kernels.neighbours.dispatch(pass, offset, all(device, step));
            let list = ListDispatch {
                arguments: &self.fixed.rechoose_dispatches,
                list: LIST_INCOMPLETE,
                places: step.total.into(),
            };
            self.over_list(&kernels.complete_lists, (device, pass), offset, list);
        }
    }

    /// The collisions of the methods `cell` and `half-turn`, within each cell.
    pub fn collide(&self, rec: &mut Recording<'_>, step: &StepSlot) {
        if let Some(kernels) = &self.kernels.cells {
            let device = rec.device();
            let offset = self.offset(device, step, 0);
            let pass = &mut rec.phase("collide");
            kernels.collide.dispatch(pass, offset, threads(device, self.bins()));
            // (Each has several particles.)
            let list = ListDispatch {
                arguments: &self.fixed.dispatches,
                list: LIST_CROWDS,
                places: (step.total / MEMBERS).into(),
            };
            self.over_list(&kernels.collide_crowded, (device, pass), offset, list);
            if let Some(divided) = &kernels.divided {
                divided.dispatch_indirect(pass, offset, &self.fixed.dispatches, LIST_DIVIDED);
            }
            if let Some(moved) = &kernels.moved {
                moved.dispatch_indirect(pass, offset, &self.fixed.dispatches, LIST_MOVED);
            }
        }
        if let Some(kernels) = &self.kernels.half_turn {
            let device = rec.device();
            let offset = self.offset(device, step, 0);
            let pass = &mut rec.phase("collide");
            kernels.collision_cells.dispatch(pass, offset, threads(device, self.bins()));
            kernels.half_turn.dispatch_indirect(pass, offset, &self.fixed.dispatches, LIST_COLLISION_CELLS);
            if let Some(cut) = &kernels.cut {
                cut.dispatch_indirect(pass, offset, &self.fixed.dispatches, LIST_CUT_CELLS);
            }
        }
    }

    pub(super) fn bins(&self) -> u64 {
        self.cells().all
    }

    /// Kernels over lists are dispatched over the entries that these have, as on any device, also where it is a GPU and the lists are short.
    pub fn dispatch_by_lengths(&mut self) {
        self.short_lists = 0;
    }

    /// Over the entries of a list.
    pub(super) fn over_list(
        &self,
        kernel: &BoundKernel,
        (device, pass): (&Device, &mut Pass<'_>),
        offset: u32,
        list: ListDispatch<'_>,
    ) {
        if list.places <= self.short_lists {
            kernel.dispatch(pass, offset, threads(device, list.places));
        } else {
            kernel.dispatch_indirect(pass, offset, list.arguments, list.list);
        }
    }

    /// Of a list that is in parts on a GPU.
    pub(super) fn places(&self, most: u64) -> u64 {
        if self.domain.variant == KernelVariant::Gpu { counters::places_in_shards(most) } else { most }
    }

    /// Clears the cells for the step that follows (`shaders/clear_cells.wgsl`).
    pub fn clear_cells(&self, rec: &mut Recording<'_>, step: &StepSlot) {
        if let Some(kernels) = &self.kernels.sort {
            let device = rec.device();
            let groups = threads(device, self.bins() / CLEARED_CELLS + 1);
            kernels.clear_cells.dispatch(&mut rec.phase("advect"), self.offset(device, step, 0), groups);
        }
    }

    /// Afterwards the slots of `particles` in use are those of `sorted`, dead ones where the ghosts were.
    pub fn advect(&mut self, rec: &mut Recording<'_>, step: &StepSlot) {
        if let Some(watched) = &self.watched {
            let bytes = 4 * RECORD * u64::from(step.total);
            rec.encoder().copy_buffer_to_buffer(&self.particle.particles, 0, watched, 0, bytes);
        }
        let device = rec.device();
        let offset = self.offset(device, step, 0);
        let entering = u64::from(step.next.unwrap_or(0));
        let groups = threads(device, u64::from(step.total) + entering);
        let pass = &mut rec.phase("advect");
        self.kernels.advect.dispatch(pass, offset, groups);
        let list = ListDispatch { arguments: &self.fixed.dispatches, list: LIST_BOUNCE, places: step.total.into() };
        self.over_list(&self.kernels.bounce, (device, pass), offset, list);
        if !self.place.is_alone() {
            self.count = step.total;
        }
    }

    pub fn tally(&self, rec: &mut Recording<'_>, step: &StepSlot) {
        let chunk = u64::from(WORKGROUP) * u64::from(self.domain.tally_loops);
        let chunks = u64::from(step.total).div_ceil(chunk) as u32;
        // Two gases at a time.
        let pairs = (self.domain.plan.gases.len() as u32).div_ceil(2);
        let groups = [self.domain.zones as u32, chunks, pairs];
        let offset = self.offset(rec.device(), step, 0);
        self.kernels.tally.dispatch(&mut rec.phase("tally"), offset, groups);
    }

    /// The blocks that the choice of the step size needs.
    pub fn tally_blocks(&self, rec: &mut Recording<'_>, step: &StepSlot) {
        let device = rec.device();
        self.kernels.blocks.dispatch(&mut rec.phase("blocks"), self.offset(device, step, 0), all(device, step));
    }
}
