//! The phases of a step, as dispatches in the order of `simulation::step`.

use crate::gpu::{BoundKernel, Device, KernelVariant, Pass, Recording};

use super::buffers::{CellBuffers, RECORD, choose_empties, few_stretches};
use super::counters;
use super::device_gas::Subdomain;
use super::dispatch::{all, threads};
use super::kernels::Flights;
use super::registry::{
    LIST_BOUNCE, LIST_BOUNCE_ODD, LIST_CROWDED, LIST_CROWDS, LIST_DIVIDED, LIST_INCOMPLETE, LIST_MOVED,
};
use super::sizes::{CHUNK, EMPTIED_CELLS, MEMBERS, STRETCH, WORKGROUP};
use super::step_slot::StepSlot;

/// Those that meet walls, of steps at even and at odd places in their interval.
const BOUNCES: [u32; 2] = [LIST_BOUNCE, LIST_BOUNCE_ODD];

/// The most cells that one workgroup scans, where kernels are merged.
const FEW_CELLS: u64 = 1 << 16;

impl Subdomain {
    /// Empties lists and cells, where the step before has not (`shaders/scan_sums.wgsl`, `shaders/choose.wgsl`, `shaders/scan_cells.wgsl`, `shaders/advect.wgsl`); of many cells by clears of buffers, each of
    /// which a small step would wait for.
    pub fn reset(&self, rec: &mut Recording<'_>) {
        let bins = if self.kernels.sort.is_some() { self.bins() } else { 0 };
        let mut cells = CellBuffers::start_bytes(bins) / 4;
        if !few_stretches(bins) && !self.emptied {
            rec.encoder().clear_buffer(self.cell.counts(), 0, Some(4 * cells));
            rec.encoder().clear_buffer(&self.cell.stretch_sums, 0, None);
            cells = 1;
        }
        if !self.emptied {
            let groups = threads(rec.device(), cells.div_ceil(EMPTIED_CELLS));
            let phase = if self.kernels.sort.is_some() { "bin" } else { "advect" };
            self.kernels.reset.dispatch(&mut rec.phase(phase), 0, groups);
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
            if let Some(scan) = kernels.scan_merged.as_ref().filter(|_| self.bins() <= FEW_CELLS) {
                return scan.dispatch(pass, offset, [1, 1, 1]);
            }
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
            let arguments = (&self.fixed.dispatches, LIST_CROWDED);
            self.over_list(&kernels.arrange_crowded, (device, pass), offset, arguments, step.total.into());
        }
    }

    pub fn neighbours(&self, rec: &mut Recording<'_>, step: &StepSlot) {
        if let Some(kernels) = &self.kernels.collisions {
            let device = rec.device();
            let offset = self.offset(device, step, 0);
            let pass = &mut rec.phase("neighbours");
            kernels.neighbours.dispatch(pass, offset, all(device, step));
            let arguments = (&self.fixed.rechoose_dispatches, LIST_INCOMPLETE);
            self.over_list(&kernels.complete_lists, (device, pass), offset, arguments, step.total.into());
        }
    }

    /// The collisions of the method `cell`, within each cell.
    pub fn collide(&self, rec: &mut Recording<'_>, step: &StepSlot) {
        if let Some(kernels) = &self.kernels.cells {
            let device = rec.device();
            let offset = self.offset(device, step, 0);
            let pass = &mut rec.phase("collide");
            kernels.collide.dispatch(pass, offset, threads(device, self.bins()));
            // (Each has several particles.)
            let arguments = (&self.fixed.dispatches, LIST_CROWDS);
            self.over_list(&kernels.collide_crowded, (device, pass), offset, arguments, (step.total / MEMBERS).into());
            if let Some(divided) = &kernels.divided {
                divided.dispatch_indirect(pass, offset, &self.fixed.dispatches, LIST_DIVIDED);
            }
            if let Some(moved) = &kernels.moved {
                moved.dispatch_indirect(pass, offset, &self.fixed.dispatches, LIST_MOVED);
            }
        }
    }

    pub(super) fn bins(&self) -> u64 {
        self.cells().all
    }

    /// Kernels over lists are dispatched over the entries that these have, as on any device, also where it is a GPU and the lists are short. (Not so
    /// where kernels are merged.)
    pub fn dispatch_by_lengths(&mut self) {
        self.short_lists = 0;
    }

    /// Over the entries of a list, `item` of these arguments, that has them among so many places.
    pub(super) fn over_list(
        &self,
        kernel: &BoundKernel,
        (device, pass): (&Device, &mut Pass<'_>),
        offset: u32,
        (arguments, item): (&wgpu::Buffer, u32),
        places: u64,
    ) {
        // (A merged kernel may write what it would take its size from.)
        if places <= self.short_lists || self.domain.features.merged {
            kernel.dispatch(pass, offset, threads(device, places));
        } else {
            kernel.dispatch_indirect(pass, offset, arguments, item);
        }
    }

    /// Of a list that is in parts on a GPU.
    pub(super) fn places(&self, most: u64) -> u64 {
        if self.domain.variant == KernelVariant::Gpu { counters::places_in_shards(most) } else { most }
    }

    /// Afterwards the slots of `particles` in use are those of `sorted`, dead ones where the ghosts were.
    pub fn advect(&mut self, rec: &mut Recording<'_>, step: &StepSlot) {
        if let Some(watched) = &self.watched {
            let bytes = 4 * RECORD * u64::from(step.total);
            rec.encoder().copy_buffer_to_buffer(&self.particle.particles, 0, watched, 0, bytes);
        }
        let empties = self.kernels.cells.is_some() || choose_empties(self.domain.variant, self.bins());
        if self.kernels.sort.is_some() && self.place.is_alone() && !empties {
            rec.encoder().clear_buffer(self.cell.counts(), 0, Some(CellBuffers::start_bytes(self.bins())));
        }
        let device = rec.device();
        let offset = self.offset(device, step, 0);
        let entering = u64::from(step.next.unwrap_or(0));
        let stretches = if self.kernels.sort.is_some() { self.bins() / STRETCH + 1 } else { 0 };
        let groups = threads(device, (u64::from(step.total) + entering).max(stretches));
        let pass = &mut rec.phase("advect");
        match &self.kernels.flights {
            Flights::Merged(fly) => fly.dispatch(pass, offset, groups),
            Flights::Split { advect, bounce } => {
                advect.dispatch(pass, offset, groups);
                let arguments = (&self.fixed.dispatches, BOUNCES[step.slot as usize % 2]);
                self.over_list(bounce, (device, pass), offset, arguments, step.total.into());
            }
        }
        self.emptied = self.place.is_alone();
        if !self.emptied {
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
