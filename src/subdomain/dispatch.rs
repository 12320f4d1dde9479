//! How many workgroups a dispatch has.

use crate::gpu::{Device, fold};

use super::sizes::WORKGROUP;
use super::step_slot::StepSlot;

/// A thread for each of so many items.
pub(super) fn threads(device: &Device, items: u64) -> [u32; 3] {
    fold(items, WORKGROUP, device.limits().max_compute_workgroups_per_dimension)
}

/// A thread for each particle that is on the device in a step.
pub(super) fn all(device: &Device, step: &StepSlot) -> [u32; 3] {
    threads(device, u64::from(step.total))
}
