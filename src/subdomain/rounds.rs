//! The rounds of a step, in which particles choose partners and pairs collide, as dispatches.

use crate::gpu::{BoundKernel, Recording};

use super::device_gas::Subdomain;
use super::kernels::{CollisionKernels, Settle};
use super::registry::{LIST_ASKED, LIST_PAIRS, LIST_RECHOOSE};
use super::sizes::{STRETCH, WORKGROUP};
use super::step_slot::StepSlot;

impl Subdomain {
    pub fn choose(&self, rec: &mut Recording<'_>, step: &StepSlot, round: u32) {
        if let Some(kernels) = &self.kernels.collisions {
            self.choosing(&kernels.choose, rec, "choose", step, round);
            self.choose_asked(kernels, rec, "choose", step, round);
        }
    }

    pub fn settle(&self, rec: &mut Recording<'_>, step: &StepSlot, round: u32) {
        if let Some(kernels) = &self.kernels.collisions {
            let settle = match &kernels.settle {
                Settle::Merged(settle) => return self.choosing(settle, rec, "settle", step, round),
                Settle::Parted(settle) => settle,
            };
            self.choosing(&kernels.match_pairs, rec, "settle", step, round);
            let offset = self.offset(rec.device(), step, round);
            let (device, places) = (rec.device(), self.places(u64::from(step.total / 2)));
            let pass = &mut rec.phase("settle");
            self.over_list(settle, (device, pass), offset, (&self.fixed.dispatches, LIST_PAIRS + round), places);
        }
    }

    /// One more choice after the last round: pairs still mutual are collisions that the rounds lost.
    pub fn count_lost(&self, rec: &mut Recording<'_>, step: &StepSlot) {
        if let Some(kernels) = &self.kernels.collisions {
            let rounds = self.domain.plan.rounds;
            self.choosing(&kernels.choose, rec, "lost", step, rounds);
            self.choose_asked(kernels, rec, "lost", step, rounds);
            self.choosing(&kernels.match_pairs, rec, "lost", step, rounds);
            kernels.lost.dispatch(&mut rec.phase("lost"), 0, [1, 1, 1]);
        }
    }

    /// The ghosts that particles farther in have chosen choose.
    fn choose_asked(
        &self,
        kernels: &CollisionKernels<BoundKernel>,
        rec: &mut Recording<'_>,
        phase: &'static str,
        step: &StepSlot,
        round: u32,
    ) {
        if let Some(neighbours_asked) = kernels.neighbours_asked.as_ref().filter(|_| self.place.asks()) {
            let offset = self.asked_offset(rec.device(), step, round);
            let pass = &mut rec.phase(phase);
            for kernel in [neighbours_asked, &kernels.complete_lists, &kernels.choose_asked] {
                kernel.dispatch_indirect(pass, offset, &self.fixed.asked_dispatches, LIST_ASKED);
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
        // At least as many as the first of `choose` has cells to empty for (`shaders/scan_sums.wgsl`).
        let emptying = if round == 0 { u64::from(WORKGROUP) * (self.bins() / STRETCH + 1) } else { 0 };
        let places = self.places(step.total.into()).max(emptying);
        let arguments = (&self.fixed.rechoose_dispatches, LIST_RECHOOSE + round);
        self.over_list(kernel, (device, &mut rec.phase(phase)), offset, arguments, places);
    }
}
