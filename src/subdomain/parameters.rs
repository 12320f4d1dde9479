//! What the kernels of a step are told by the host: parameters of each step and round, tables of an interval, who enters.

use crate::gpu::{Device, GpuError, Recording};
use crate::scene::MOST_MOTIONS;

use super::buffers::step_stride;
use super::device_gas::Subdomain;
use super::fabric::most_entries;
use super::layout::{GpuMotion, GpuStep};
use super::nearness;
use super::registry::INTERVAL_STEPS;
use super::step_slot::{Newborns, StepSlot, Steps, Tables, uniforms};
use super::subdomain_box::Cells;

/// `GHOSTS_ALL` and so on of `shaders/shared/step.wgsl`.
const GHOSTS_ALL: u32 = 0;
const GHOSTS_WAIT: u32 = 1;
const GHOSTS_ON_DEMAND: u32 = 2;
/// Of tiles: where they begin, and the order in which their axes are halved.
const LATTICES: u32 = 6;

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
        // Work that was submitted before has seen the tables of its own interval.
        device.write(&self.fixed.surface_models, 0, &tables.surface_models);
        device.write(&self.fixed.vents, 0, &tables.vents);
        self.place_walls(device, &tables.motions);
        self.place_fabric(device, &tables.nodes)?;
        device.write(&self.fixed.cross_section_shares, 0, &tables.cross_section_shares);
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
        device.write(&self.fixed.step_state, 4 * u64::from(INTERVAL_STEPS), &[counted]);
        Ok(slots)
    }

    /// Starts a step of a device among others, whose number of particles is known only now.
    ///
    /// # Errors
    /// If room must be made and the device has none.
    pub fn begin_step(&mut self, rec: &mut Recording<'_>, slot: &mut StepSlot) -> Result<(), GpuError> {
        self.last_index = slot.index;
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
        let (fabric_low, fabric_size) = self.place.fabric_cells(self.domain.plan.grid.cells);
        let [lattice, next_lattice] = [slot.index, slot.index.wrapping_add(1)].map(|index| index % LATTICES);
        // Tiles begin a cell farther in every other step (`shaders/shared/local.wgsl`).
        let shift = if self.place.tiled { lattice & 1 } else { 0 };
        let moved = |corner: [u32; 3]| corner.map(|cell| cell + shift);
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
                low: moved(low),
                total: slot.total,
                size,
                bins: size.iter().product(),
                own_low: moved(self.place.own.low),
                depth: self.place.depth,
                own_high: moved(self.place.own.high),
                reach: self.place.reach(round),
                inner_low: moved(inner_low),
                // The arrivals are binned after the others.
                first: if slot.arrivals > 0 { slot.count + slot.newborns } else { 0 },
                inner_high: moved(inner_high),
                ghosts: match (self.place.has_on_demand_ghosts(), at < rounds) {
                    (false, _) => GHOSTS_ALL,
                    (true, true) => GHOSTS_WAIT,
                    (true, false) => GHOSTS_ON_DEMAND,
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
                lattice: if self.place.tiled { lattice } else { 0 },
                next_lattice,
                fabric_low,
                fabric_size,
                ..GpuStep::default()
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
            step.iter_mut().zip(&self.domain.bodies).for_each(|(motion, body)| *motion = body.complete(*motion));
        }
        device.write(&self.fixed.motions, 0, &told);
    }

    /// Places the nodes: at the start of each step of an interval, and at its end.
    ///
    /// # Errors
    /// If lists need more room than the device has.
    fn place_fabric(&mut self, device: &Device, nodes: &[[u32; 4]]) -> Result<(), GpuError> {
        if nodes.is_empty() {
            return Ok(());
        }
        let plan = &self.domain.plan;
        let listed = self.place.fabric_cells(plan.grid.cells);
        let wanted = most_entries(&plan.grid, &self.domain.fabric, nodes, listed);
        if wanted > self.fabric.room && self.fabric.make_room(device, [wanted + wanted / 4, 0])? {
            self.rebind(device)?;
        }
        device.write(&self.fabric.nodes, 0, nodes);
        Ok(())
    }

    /// Whether lists of elastic fabric have less room than they may need: then it can be made, and is the same on all ranks.
    pub fn is_short_of_fabric(&self) -> bool {
        self.domain.fabric.elastic.is_some_and(|most| self.fabric.room < most)
    }

    /// Makes twice the room for lists of elastic fabric.
    ///
    /// # Errors
    /// If the device has no memory for that.
    pub fn make_room_for_fabric(&mut self, device: &Device) -> Result<(), GpuError> {
        let most = self.domain.fabric.elastic.unwrap_or(0);
        if self.fabric.make_room(device, [(2 * self.fabric.room).min(most), 0])? {
            self.rebind(device)?;
        }
        Ok(())
    }

    /// From now on nodes are where others put them, in buffers as those of this subdomain: places, what hits give, and smoothed velocities.
    ///
    /// # Errors
    /// If the device refuses the buffers.
    pub fn follow_fabric(
        &mut self,
        device: &Device,
        [nodes, impulses, velocities]: [&wgpu::Buffer; 3],
    ) -> Result<(), GpuError> {
        self.fabric.nodes = nodes.clone();
        self.fabric.impulses = impulses.clone();
        self.fabric.velocities = velocities.clone();
        self.rebind(device)
    }

    /// The particles as they are, for tallies outside a step.
    pub fn at_rest(&self, device: &Device) -> StepSlot {
        // (What is left of the last step, as the cells of its particles, is numbered as in that.)
        let slot = StepSlot {
            slot: 0,
            index: self.last_index,
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
    pub(super) fn on_demand_offset(&self, device: &Device, step: &StepSlot, round: u32) -> u32 {
        self.offset(device, step, self.domain.plan.rounds + 1 + round)
    }
}
