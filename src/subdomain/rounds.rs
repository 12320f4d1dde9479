//! The rounds of a step, in which particles choose partners and pairs collide, as dispatches.

use crate::gpu::{BoundKernel, Recording};

use super::device_gas::Subdomain;
use super::kernels::CollisionKernels;
use super::registry::{LIST_ON_DEMAND, LIST_PAIRS, LIST_RECHOOSE};
use super::step_slot::StepSlot;

impl Subdomain {
    pub fn choose(&self, rec: &mut Recording<'_>, step: &StepSlot, round: u32) {
        if let Some(kernels) = &self.kernels.collisions {
            self.choosing(&kernels.choose, rec, "choose", step, round);
            self.choose_on_demand(kernels, rec, "choose", step, round);
        }
    }

    pub fn settle(&self, rec: &mut Recording<'_>, step: &StepSlot, round: u32) {
        if let Some(kernels) = &self.kernels.collisions {
            self.choosing(&kernels.match_pairs, rec, "settle", step, round);
            let offset = self.offset(rec.device(), step, round);
            let (device, places) = (rec.device(), self.places(u64::from(step.total / 2)));
            let pass = &mut rec.phase("settle");
            self.over_list(
                &kernels.settle,
                (device, pass),
                offset,
                (&self.fixed.dispatches, LIST_PAIRS + round),
                places,
            );
        }
    }

    /// One more choice after the last round: pairs still mutual are collisions that the rounds lost.
    pub fn count_lost(&self, rec: &mut Recording<'_>, step: &StepSlot) {
        if let Some(kernels) = &self.kernels.collisions {
            let rounds = self.domain.plan.rounds;
            self.choosing(&kernels.choose, rec, "lost", step, rounds);
            self.choose_on_demand(kernels, rec, "lost", step, rounds);
            self.choosing(&kernels.match_pairs, rec, "lost", step, rounds);
            kernels.lost.dispatch(&mut rec.phase("lost"), 0, [1, 1, 1]);
        }
    }

    /// The ghosts that particles farther in have chosen choose.
    fn choose_on_demand(
        &self,
        kernels: &CollisionKernels<BoundKernel>,
        rec: &mut Recording<'_>,
        phase: &'static str,
        step: &StepSlot,
        round: u32,
    ) {
        if let Some(neighbours_on_demand) =
            kernels.neighbours_on_demand.as_ref().filter(|_| self.place.has_on_demand_ghosts())
        {
            let offset = self.on_demand_offset(rec.device(), step, round);
            let pass = &mut rec.phase(phase);
            for kernel in [neighbours_on_demand, &kernels.complete_lists, &kernels.choose_on_demand] {
                kernel.dispatch_indirect(pass, offset, &self.fixed.on_demand_dispatches, LIST_ON_DEMAND);
            }
        }
    }

    /// Over those that choose in the round.
    fn choosing(
        &self,
        kernel: &BoundKernel,
        rec: &mut Recording<'_>,
        phase: &'static str,
        step: &StepSlot,
        round: u32,
    ) {
        let (device, offset) = (rec.device(), self.offset(rec.device(), step, round));
        let places = self.places(step.total.into());
        let arguments = (&self.fixed.rechoose_dispatches, LIST_RECHOOSE + round);
        self.over_list(kernel, (device, &mut rec.phase(phase)), offset, arguments, places);
    }
}
