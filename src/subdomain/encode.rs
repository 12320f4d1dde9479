//! The phases of a step, as dispatches in the order of `simulation::step`.

use crate::gpu::{BoundKernel, Device, Form, Pass, Recording, fold};
use crate::plan::Plan;
use crate::scene::MOST_MOTIONS;

use super::buffers::{CHUNK, CellBuffers, EMPTIED_CELLS, RECORD, STRETCH, choose_empties, few_stretches, step_stride};
use super::constants::{Features, MEMBERS, WORKGROUP};
use super::counters;
use super::kernels::Flights;
use super::layout::{GpuMotion, GpuStep};
use super::nearness;
use super::place::Cells;
use super::registry::{
    COUNT_DROPPED, INTERVAL, LIST_BOUNCE, LIST_BOUNCE_ODD, LIST_CROWDED, LIST_CROWDS, LIST_INCOMPLETE, LIST_MOVED,
    LIST_PARTED, LIST_TAILS,
};
use super::step_slot::{Newborns, StepSlot, Steps, Tables};
use super::{GpuError, Kept, Remembered, Subdomain};

/// Those that meet walls, of steps at even and at odd places in their interval.
const BOUNCES: [u32; 2] = [LIST_BOUNCE, LIST_BOUNCE_ODD];

/// The most cells that one workgroup scans, where kernels are merged.
const FEW_CELLS: u64 = 1 << 16;

/// Uniforms of a step: of each round and of the count of lost collisions; among others, as many for the passes over
/// the ghosts that were asked.
pub(super) fn uniforms(plan: &Plan, features: Features) -> u32 {
    (plan.rounds + 1) * if features.halo { 2 } else { 1 }
}

/// `GHOSTS_ALL` and so on of `shaders/shared/step.wgsl`.
const GHOSTS_ALL: u32 = 0;
const GHOSTS_WAIT: u32 = 1;
const GHOSTS_ASKED: u32 = 2;

impl Subdomain {
    /// Uploads the newborns of one interval, on a device alone also the parameters of its steps, and returns
    /// the slots of those that are to be done.
    ///
    /// # Errors
    /// If room must be made and the device has none.
    pub fn begin_interval(
        &mut self,
        device: &Device,
        steps: &Steps<'_>,
        newborns: &Newborns<'_>,
        tables: &Tables,
    ) -> Result<Vec<StepSlot>, GpuError> {
        let Steps { first, done, dt, tallied } = *steps;
        self.emptied = false;
        // Work that was submitted before has seen the tables of its own interval.
        device.write(&self.fixed.coats, 0, &tables.coats);
        device.write(&self.fixed.vents, 0, &tables.vents);
        self.place_walls(device, &tables.motions);
        device.write(&self.fixed.shares, 0, &tables.shares);
        let near2 = nearness::near2(&self.domain.plan, tables.halvings);
        let mut tallies_left: u32 = tallied.iter().map(|&tallied| u32::from(tallied)).sum();
        let Newborns { of_step, list, .. } = *newborns;
        let entering = of_step[done as usize..].iter().map(|&born| u64::from(born)).sum();
        self.make_room(&mut Recording::new(device), entering, list.len() as u64, 0)?;
        device.write(&self.particle.newborns, 0, list);
        let mut slots = Vec::with_capacity(of_step.len());
        let mut bytes = Vec::new();
        let flies_to_bins = self.place.is_alone() && self.kernels.sort.is_some();
        for (k, (&born, &tallied)) in (0u32..).zip(of_step.iter().zip(tallied)) {
            let slot = StepSlot {
                slot: k,
                index: (first + u64::from(k)) as u32,
                dt: dt as f32,
                count: self.count,
                newborns: born,
                newborn_offset: 0,
                first_id: 0,
                stride: 1,
                arrivals: 0,
                total: self.count + born,
                tallies_left,
                near2,
                next: if flies_to_bins { of_step.get(k as usize + 1).copied() } else { None },
                binned: flies_to_bins && k > done,
            };
            let slot = newborns.entering(slot, k);
            tallies_left -= u32::from(tallied);
            if self.place.is_alone() {
                bytes.extend(self.parameters(device, &slot));
            }
            if k < done {
                continue;
            }
            if self.place.is_alone() {
                self.count += born;
            }
            slots.push(slot);
        }
        device.write(&self.fixed.step, 0, &bytes);
        let counted = if flies_to_bins { done + slots.len() as u32 } else { 0 };
        device.write(&self.fixed.held, 4 * u64::from(INTERVAL), &[counted]);
        Ok(slots)
    }

    /// Makes half as much room again as the first step of an interval wants for the tails of neighbour lists, by a search among
    /// the particles that are here, which are remembered as `before`: a run begins with gas of any density, and room that is
    /// found to be too small only afterwards costs the intervals under way. Changes nothing else but the order of the slots.
    ///
    /// # Errors
    /// If the device fails, or has no room for such lists.
    pub fn fit_lists(
        &mut self,
        device: &Device,
        dt: f64,
        tables: &Tables,
        before: &Remembered,
    ) -> Result<(), GpuError> {
        if !self.domain.features.rounds || self.count == 0 || matches!(before.kept, Kept::Nothing) {
            return Ok(());
        }
        device.write(&self.fixed.shares, 0, &tables.shares);
        let near2 = nearness::near2(&self.domain.plan, tables.halvings);
        let slot = StepSlot { dt: dt as f32, near2, ..self.at_rest(device) };
        self.write_parameters(device, &slot);
        let mut rec = Recording::new(device);
        self.reset(&mut rec);
        self.bin(&mut rec, &slot);
        self.scan(&mut rec, &slot);
        self.sort(&mut rec, &slot);
        self.neighbours(&mut rec, &slot);
        rec.submit();
        self.emptied = false;
        let words: Vec<u32> = device.read(&self.fixed.counters, counters::WORDS)?;
        let nobody = Newborns { of_step: &[0], list: &[], first_id: 0, stride: 1 };
        if let Kept::Held = before.kept {
            self.recall(device, self.count - words[COUNT_DROPPED as usize], &nobody, 0);
        } else {
            self.restore(device, before, &nobody)?;
        }
        // Where particles lie outside of the own cells and the halo, `sorted` has gaps: then the intervals tell.
        if words[COUNT_DROPPED as usize] > 0 {
            return Ok(());
        }
        self.make_room_for_tails(device, words[LIST_TAILS as usize].into(), 0.5)
    }

    /// Starts a step of a device among others, whose number of particles is known only now.
    ///
    /// # Errors
    /// If room must be made and the device has none.
    pub fn begin_step(&mut self, rec: &mut Recording<'_>, slot: &mut StepSlot) -> Result<(), GpuError> {
        if !self.place.is_alone() {
            self.make_room(rec, slot.newborns.into(), 0, 0)?;
            slot.count = self.count;
            slot.total = self.count + slot.newborns;
            self.write_parameters(rec.device(), slot);
        }
        Ok(())
    }

    pub(super) fn write_parameters(&self, device: &Device, slot: &StepSlot) {
        let stride = step_stride(device) * u64::from(uniforms(&self.domain.plan, self.domain.features));
        device.write(&self.fixed.step, stride * u64::from(slot.slot), &self.parameters(device, slot));
    }

    /// The uniforms of all rounds of a step.
    fn parameters(&self, device: &Device, slot: &StepSlot) -> Vec<u8> {
        let rounds = self.domain.plan.rounds + 1;
        let uniforms = uniforms(&self.domain.plan, self.domain.features);
        let stride = step_stride(device) as usize;
        let mut bytes = vec![0u8; stride * uniforms as usize];
        let (low, size) = self.place.bins(self.domain.plan.grid.cells);
        let Cells { low: inner_low, high: inner_high } = self.place.inner(self.domain.plan.grid.cells);
        for at in 0..uniforms {
            let round = at % rounds;
            let step = GpuStep {
                count: slot.count,
                newborns: slot.newborns,
                newborn_offset: slot.newborn_offset,
                newborn_first_id: slot.first_id,
                index: slot.index,
                dt: slot.dt,
                round,
                arrivals: slot.arrivals,
                low,
                total: slot.total,
                size,
                bins: size.iter().product(),
                own_low: self.place.own.low,
                depth: self.place.depth,
                own_high: self.place.own.high,
                reach: self.place.reach(round),
                inner_low,
                // The arrivals are binned after the others.
                first: if slot.arrivals > 0 { slot.count + slot.newborns } else { 0 },
                inner_high,
                ghosts: match (self.place.asks(), at < rounds) {
                    (false, _) => GHOSTS_ALL,
                    (true, true) => GHOSTS_WAIT,
                    (true, false) => GHOSTS_ASKED,
                },
                peers: self.place.peers.len() as u32,
                near_peers: self.place.near as u32,
                capacity: self.particle.capacity as u32,
                stride: slot.stride,
                tallies_left: slot.tallies_left,
                slot: slot.slot,
                near2: slot.near2,
                flight: self.place.flight,
                next_newborns: slot.next.unwrap_or(0),
                pad: [0; 3],
            };
            let at = stride * at as usize;
            bytes[at..at + size_of::<GpuStep>()].copy_from_slice(bytemuck::bytes_of(&step));
        }
        bytes
    }

    /// Places the walls that move: in each step of an interval, or for tallies outside of one.
    pub fn place_walls(&self, device: &Device, motions: &[GpuMotion]) {
        let mut told = motions.to_vec();
        for step in told.chunks_mut(MOST_MOTIONS) {
            step.iter_mut().zip(&self.domain.drawn).for_each(|(motion, drawn)| *motion = drawn.complete(*motion));
        }
        device.write(&self.fixed.motions, 0, &told);
    }

    /// The particles as they are, for tallies outside a step.
    pub fn at_rest(&self, device: &Device) -> StepSlot {
        let slot = StepSlot {
            slot: 0,
            index: 0,
            dt: 0.0,
            count: self.count,
            newborns: 0,
            newborn_offset: 0,
            first_id: 0,
            stride: 1,
            arrivals: 0,
            total: self.count,
            tallies_left: 0,
            near2: 0,
            next: None,
            binned: false,
        };
        self.write_parameters(device, &slot);
        slot
    }

    pub(super) fn offset(&self, device: &Device, step: &StepSlot, round: u32) -> u32 {
        (step_stride(device) as u32) * (step.slot * uniforms(&self.domain.plan, self.domain.features) + round)
    }

    /// Of the pass over those that were asked.
    pub(super) fn asked_offset(&self, device: &Device, step: &StepSlot, round: u32) -> u32 {
        self.offset(device, step, self.domain.plan.rounds + 1 + round)
    }

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
            if let Some(parted) = &kernels.parted {
                parted.dispatch_indirect(pass, offset, &self.fixed.dispatches, LIST_PARTED);
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
        if self.domain.form == Form::Gpu { counters::places_in_parts(most) } else { most }
    }

    /// Afterwards the slots of `particles` in use are those of `sorted`, dead ones where the ghosts were.
    pub fn advect(&mut self, rec: &mut Recording<'_>, step: &StepSlot) {
        if let Some(watched) = &self.watched {
            let bytes = 4 * RECORD * u64::from(step.total);
            rec.encoder().copy_buffer_to_buffer(&self.particle.particles, 0, watched, 0, bytes);
        }
        let empties = self.kernels.cells.is_some() || choose_empties(self.domain.form, self.bins());
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
            Flights::Parted { advect, bounce } => {
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

pub(super) fn threads(device: &Device, items: u64) -> [u32; 3] {
    fold(items, WORKGROUP, device.limits().max_compute_workgroups_per_dimension)
}

pub(super) fn all(device: &Device, step: &StepSlot) -> [u32; 3] {
    threads(device, u64::from(step.total))
}
