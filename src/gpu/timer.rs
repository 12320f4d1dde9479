//! Device time of named phases. A timed pass is split at every phase, which costs a little; so only a
//! few steps are timed, and the others run in one pass.

use super::{Device, GpuError, Pass};

/// Room for the phases of one timed step.
const SLOTS: u32 = 128;

/// The timestamps of one timed stretch of commands.
pub struct PhaseTimer {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    period: f64,
}

/// Seconds by phase name, in the order they ran.
pub type PhaseSeconds = Vec<(&'static str, f64)>;

impl PhaseTimer {
    /// `None` on a device without timestamps.
    ///
    /// # Errors
    /// If the device has no memory for it.
    pub fn new(device: &Device) -> Result<Option<PhaseTimer>, GpuError> {
        if !device.has_timestamps() {
            return Ok(None);
        }
        Ok(Some(PhaseTimer {
            queries: device.query_set(2 * SLOTS),
            resolved: device.resolve(u64::from(SLOTS) * 16)?,
            period: device.timestamp_period(),
        }))
    }

    pub fn bytes() -> u64 {
        u64::from(SLOTS) * 16
    }

    /// Copies the timestamps to `staging` at `offset`.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder, phases: usize, staging: &wgpu::Buffer, offset: u64) {
        let count = 2 * phases as u32;
        encoder.resolve_query_set(&self.queries, 0..count, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, staging, offset, u64::from(count) * 8);
    }

    /// Seconds of each phase from the bytes that [`PhaseTimer::resolve`] copied.
    pub fn seconds(&self, names: &[&'static str], bytes: &[u8]) -> PhaseSeconds {
        let stamps: Vec<u64> = bytemuck::pod_collect_to_vec(&bytes[..names.len() * 16]);
        names
            .iter()
            .zip(stamps.chunks_exact(2))
            .map(|(name, stamp)| (*name, stamp[1].saturating_sub(stamp[0]) as f64 * self.period * 1e-9))
            .collect()
    }
}

/// Commands on their way to the device: one open compute pass, cut into phases where it is timed.
pub struct Recording<'a> {
    device: &'a Device,
    timer: Option<&'a PhaseTimer>,
    /// The phases that are timed, if not all.
    alone: Option<&'a [&'static str]>,
    encoder: Option<wgpu::CommandEncoder>,
    pass: Option<wgpu::ComputePass<'static>>,
    /// The phase whose pass is open, where it is timed.
    open: Option<&'static str>,
    names: Vec<&'static str>,
}

impl<'a> Recording<'a> {
    pub fn new(device: &'a Device) -> Recording<'a> {
        Recording { device, timer: None, alone: None, encoder: None, pass: None, open: None, names: Vec::new() }
    }

    pub fn device(&self) -> &'a Device {
        self.device
    }

    /// Times the phases from here on, or no longer.
    pub fn time(&mut self, timer: Option<&'a PhaseTimer>) {
        self.pass = None;
        self.timer = timer;
        self.alone = None;
    }

    /// Times of the phases from here on these alone.
    pub fn time_alone(&mut self, timer: Option<&'a PhaseTimer>, names: &'a [&'static str]) {
        self.time(timer);
        self.alone = Some(names);
    }

    /// The names of the phases timed so far, in order.
    pub fn timed(&self) -> &[&'static str] {
        &self.names
    }

    /// The pass in which the dispatches of `name` go; a phase goes on until another is named.
    pub fn phase(&mut self, name: &'static str) -> Pass<'_> {
        let slot = self.names.len() as u32;
        let timer = self.timer.filter(|_| slot < SLOTS && self.alone.is_none_or(|alone| alone.contains(&name)));
        let goes_on = self.open == Some(name) || (self.open.is_none() && timer.is_none());
        if self.pass.is_none() || !goes_on {
            self.pass = None;
            self.open = timer.map(|_| name);
        }
        let device = self.device;
        let encoder = self.encoder.get_or_insert_with(|| device.encoder());
        let pass = self.pass.get_or_insert_with(|| {
            let timestamp_writes = timer.map(|timer| {
                self.names.push(name);
                wgpu::ComputePassTimestampWrites {
                    query_set: &timer.queries,
                    beginning_of_pass_write_index: Some(2 * slot),
                    end_of_pass_write_index: Some(2 * slot + 1),
                }
            });
            let descriptor = wgpu::ComputePassDescriptor { label: timer.map(|_| name), timestamp_writes };
            encoder.begin_compute_pass(&descriptor).forget_lifetime()
        });
        Pass { pass, phase: name }
    }

    /// For commands outside passes.
    pub fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        self.pass = None;
        let device = self.device;
        self.encoder.get_or_insert_with(|| device.encoder())
    }

    /// Submits what was recorded; recording goes on with a new encoder.
    pub fn submit(&mut self) -> wgpu::SubmissionIndex {
        self.pass = None;
        let encoder = self.encoder.take().unwrap_or_else(|| self.device.encoder());
        self.device.submit(encoder)
    }
}
