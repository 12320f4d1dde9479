//! What the device can do at most, measured in the same run: bytes per second of a copy, fused multiply-adds, reads of words
//! that caches have, and particles that are read, moved and written.

use std::time::Instant;

use crate::gpu::{Device, GpuError, Kernel, Recording, fold};

/// Items of four words: 64 MiB, more than caches hold.
const ITEMS: u64 = 1 << 22;
const ITEM_BYTES: f64 = 16.0;
/// In the same room.
const PARTICLES: u64 = ITEMS / 2;
/// Measurements of which the best counts.
const TURNS: u32 = 4;
const LOOPS: f64 = 64.0;
/// Multiplications and additions of a thread in a loop: four vectors of four, two each.
const OPERATIONS: f64 = 32.0;
/// Reads of a thread in a loop.
const READS: f64 = 4.0;
const WORKGROUP: u32 = 64;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ceilings {
    /// Read and written, bytes/s.
    pub copy: f64,
    /// Single-precision operations per second.
    pub arithmetic: f64,
    /// Words read from a table that the nearest cache has, per second.
    pub loads: f64,
    /// Particles read, moved and written where they were, per second: steps of a gas that has no walls and no collisions.
    pub flights: f64,
}

impl Ceilings {
    /// # Errors
    /// If the device fails or has no room.
    pub fn measure(device: &Device) -> Result<Ceilings, GpuError> {
        let from = device.storage::<[u32; 4]>("copy_from", ITEMS)?;
        let to = device.storage::<[u32; 4]>("copy_to", ITEMS)?;
        // A dispatch takes milliseconds or more: waiting for it is little beside.
        let best = |kernel: &str, threads: u64, dispatches: u32| -> Result<f64, GpuError> {
            let constants = [("WORKGROUP", f64::from(WORKGROUP)), ("LOOPS", LOOPS)];
            let compiled = Kernel::new(device, kernel, &constants)?;
            let bound = compiled.bind(device, |name| match name {
                "copy_from" => Some(&from),
                "copy_to" => Some(&to),
                _ => None,
            })?;
            let groups = fold(threads, WORKGROUP, device.limits().max_compute_workgroups_per_dimension);
            let mut best = f64::INFINITY;
            // The first turn pays for what is compiled and touched for the first time.
            for turn in 0..=TURNS {
                let mut recording = Recording::new(device);
                for _ in 0..dispatches {
                    bound.dispatch(recording.phase("ceiling"), 0, groups);
                }
                let start = Instant::now();
                let submission = recording.submit();
                device.wait(&submission)?;
                if turn > 0 {
                    best = best.min(start.elapsed().as_secs_f64() / f64::from(dispatches));
                }
            }
            Ok(best)
        };
        Ok(Ceilings {
            copy: 2.0 * ITEM_BYTES * ITEMS as f64 / best("ceiling_copy", ITEMS, 8)?,
            arithmetic: OPERATIONS * LOOPS * ITEMS as f64 / best("ceiling_arithmetic", ITEMS, 1)?,
            loads: READS * LOOPS * ITEMS as f64 / best("ceiling_loads", ITEMS, 1)?,
            flights: PARTICLES as f64 / best("ceiling_flights", PARTICLES, 8)?,
        })
    }
}
