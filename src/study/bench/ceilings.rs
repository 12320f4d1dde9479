//! What the device can do at most, measured in the same run: bytes per second of a copy, fused multiply-adds, reads of words
//! that caches have, and particles that are read, moved and written.

use std::time::Instant;

use crate::gpu::{Device, GpuError, Kernel, Recording, fold};
use crate::subdomain::shader;

const ITEM_BYTES: u64 = 16;
/// Measurements of which the best counts.
const TURNS: u32 = 4;
/// As many dispatches make one as take so long together, s: waiting for them is little beside.
const LONG: f64 = 0.05;
const MOST_DISPATCHES: f64 = 4096.0;
/// How long a GPU is kept busy before what is timed: idle, it clocks lower, and takes its time to rise. And how many particles that moves.
const WAKING: f64 = 1.0;
const WAKING_PARTICLES: u64 = 1 << 20;
/// Multiplications and additions of a thread in a loop: four vectors of four, two each.
const OPERATIONS: f64 = 32.0;
/// Reads of a thread in a loop.
const READS: f64 = 4.0;
const WORKGROUP: u32 = 64;

/// What is done in one dispatch.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Size {
    /// Of four words, in each of two buffers.
    items: u64,
    /// Turns of the loops of a thread.
    loops: f64,
}

impl Size {
    /// More than caches hold: 64 MiB on a CPU; on a GPU 256 MiB, as far as it allows, and so many turns that what a thread writes
    /// at the end is little beside them, and a small GPU is done within a second or two, before its driver thinks it hangs.
    fn of(cpu: bool, most_bytes: u64) -> Size {
        let (bytes, loops) = if cpu { (1 << 26, 64.0) } else { (1 << 28, 256.0) };
        // The largest power of two that fits.
        let most = 1 << most_bytes.max(1).ilog2();
        Size { items: most.min(bytes) / ITEM_BYTES, loops }
    }
}

/// Dispatches of which one takes `seconds` that take [`LONG`] together.
fn dispatches(seconds: f64) -> u32 {
    (LONG / seconds.max(1e-9)).ceil().clamp(1.0, MOST_DISPATCHES) as u32
}

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
        let limits = device.limits();
        let Size { items, loops } = Size::of(device.adapter().is_cpu(), limits.max_storage_buffer_binding_size);
        let from = device.storage::<[u32; 4]>("copy_from", items)?;
        let to = device.storage::<[u32; 4]>("copy_to", items)?;
        // Seconds of a dispatch.
        let best = |kernel: &str, threads: u64| -> Result<f64, GpuError> {
            let constants = [("WORKGROUP", f64::from(WORKGROUP)), ("LOOPS", loops)];
            let compiled = Kernel::new(device, shader(kernel)?, &constants)?;
            let bound = compiled.bind(device, |name| match name {
                "copy_from" => Some(&from),
                "copy_to" => Some(&to),
                _ => None,
            })?;
            let groups = fold(threads, WORKGROUP, limits.max_compute_workgroups_per_dimension);
            let timed = |dispatches: u32| -> Result<f64, GpuError> {
                let mut recording = Recording::new(device);
                for _ in 0..dispatches {
                    bound.dispatch(&mut recording.phase("ceiling"), 0, groups);
                }
                let start = Instant::now();
                let submission = recording.submit();
                device.wait(&submission)?;
                Ok(start.elapsed().as_secs_f64() / f64::from(dispatches))
            };
            // The first pays for what is compiled and touched for the first time, the second says how many it takes; the many of the third,
            // whether the one was held up by being alone.
            timed(1)?;
            let some = dispatches(timed(1)?);
            let many = if some > 1 { dispatches(timed(some)?) } else { 1 };
            let mut best = f64::INFINITY;
            for _ in 0..TURNS {
                best = best.min(timed(many)?);
            }
            Ok(best)
        };
        let particles = items / 2;
        Ok(Ceilings {
            copy: 2.0 * (ITEM_BYTES * items) as f64 / best("ceiling_copy", items)?,
            arithmetic: OPERATIONS * loops * items as f64 / best("ceiling_arithmetic", items)?,
            loads: READS * loops * items as f64 / best("ceiling_loads", items)?,
            flights: particles as f64 / best("ceiling_flights", particles)?,
        })
    }
}

/// Keeps a GPU busy until its clocks are up; a software device has none of its own.
///
/// # Errors
/// If the device fails or has no room.
pub fn wake(device: &Device) -> Result<(), GpuError> {
    if device.adapter().is_cpu() {
        return Ok(());
    }
    let moved = device.storage::<[[u32; 4]; 2]>("copy_to", WAKING_PARTICLES)?;
    let kernel = Kernel::new(device, shader("ceiling_flights")?, &[("WORKGROUP", f64::from(WORKGROUP))])?;
    let bound = kernel.bind(device, |name| (name == "copy_to").then_some(&moved))?;
    let groups = fold(WAKING_PARTICLES, WORKGROUP, device.limits().max_compute_workgroups_per_dimension);
    let start = Instant::now();
    while start.elapsed().as_secs_f64() < WAKING {
        let mut recording = Recording::new(device);
        (0..256).for_each(|_| bound.dispatch(&mut recording.phase("wake"), 0, groups));
        let submission = recording.submit();
        device.wait(&submission)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fast_dispatches_are_many_and_slow_ones_alone() {
        let counts = [1.0, 0.05, 0.02, 2.5e-5, 0.0].map(dispatches);
        assert_eq!(counts, [1, 1, 3, 2000, 4096]);
    }

    #[test]
    fn a_gpu_copies_more_than_its_caches_hold_and_no_more_than_it_allows() {
        let mib = |size: Size| (size.items * ITEM_BYTES) >> 20;
        assert_eq!(mib(Size::of(true, (1 << 27) - 4)), 64);
        assert_eq!(mib(Size::of(false, u64::from(u32::MAX))), 256);
        assert_eq!(mib(Size::of(false, (1 << 28) - 1)), 128);
    }
}
