//! The rounds of a step, in which particles choose partners and pairs collide, as dispatches.

use crate::gpu::{BoundKernel, Recording};

use super::device_gas::Subdomain;
use super::encode::ListDispatch;
use super::kernels::CollisionKernels;
use super::registry::{LIST_ON_DEMAND, LIST_PAIRS, LIST_RECHOOSE};
use super::step_slot::StepSlot;

/// A round of a step, and the phase in which its time is counted.
struct Round<'a> {
    phase: &'static str,
    step: &'a StepSlot,
    number: u32,
}

impl Subdomain {
    /// Of a step.
    pub fn rounds(&self) -> u32 {
        self.domain.plan.rounds
    }

    pub fn choose(&self, rec: &mut Recording<'_>, step: &StepSlot, round: u32) {
        if let Some(kernels) = &self.kernels.collisions {
            let round = Round { phase: "choose", step, number: round };
            self.choosing(&kernels.choose, rec, &round);
            self.choose_on_demand(kernels, rec, &round);
        }
    }

    pub fn settle(&self, rec: &mut Recording<'_>, step: &StepSlot, round: u32) {
        if let Some(kernels) = &self.kernels.collisions {
            self.choosing(&kernels.match_pairs, rec, &Round { phase: "settle", step, number: round });
            let offset = self.offset(rec.device(), step, round);
            let list = ListDispatch {
                arguments: &self.fixed.dispatches,
                list: LIST_PAIRS + round,
                places: self.places(u64::from(step.total / 2)),
            };
            let device = rec.device();
            self.over_list(&kernels.settle, (device, &mut rec.phase("settle")), offset, list);
        }
    }

    /// One more choice after the last round: pairs still mutual are collisions that the rounds lost.
    pub fn count_lost(&self, rec: &mut Recording<'_>, step: &StepSlot) {
        if let Some(kernels) = &self.kernels.collisions {
            let round = Round { phase: "lost", step, number: self.rounds() };
            self.choosing(&kernels.choose, rec, &round);
            self.choose_on_demand(kernels, rec, &round);
            self.choosing(&kernels.match_pairs, rec, &round);
            kernels.lost.dispatch(&mut rec.phase("lost"), 0, [1, 1, 1]);
        }
    }

    /// The ghosts that particles farther in have chosen choose.
    fn choose_on_demand(&self, kernels: &CollisionKernels<BoundKernel>, rec: &mut Recording<'_>, round: &Round<'_>) {
        if let Some(neighbours_on_demand) =
            kernels.neighbours_on_demand.as_ref().filter(|_| self.place.has_on_demand_ghosts())
        {
            let offset = self.on_demand_offset(rec.device(), round.step, round.number);
            let pass = &mut rec.phase(round.phase);
            for kernel in [neighbours_on_demand, &kernels.complete_lists, &kernels.choose_on_demand] {
                kernel.dispatch_indirect(pass, offset, &self.fixed.on_demand_dispatches, LIST_ON_DEMAND);
            }
        }
    }

    /// Over those that choose in the round.
    fn choosing(&self, kernel: &BoundKernel, rec: &mut Recording<'_>, round: &Round<'_>) {
        let (device, offset) = (rec.device(), self.offset(rec.device(), round.step, round.number));
        let list = ListDispatch {
            arguments: &self.fixed.rechoose_dispatches,
            list: LIST_RECHOOSE + round.number,
            places: self.places(round.step.total.into()),
        };
        self.over_list(kernel, (device, &mut rec.phase(round.phase)), offset, list);
    }
}
