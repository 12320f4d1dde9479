//! Adapters and devices. Vulkan only; CPU adapters (lavapipe) are chosen when nothing else is there, or
//! when asked for.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use super::GpuError;
use super::pipeline_cache::PipelineCache;
use super::source::KernelVariant;

/// How long a submission may take before a GPU counts as hung, and before a CPU adapter does, which is slow
/// but does not hang.
const PATIENCE: Duration = Duration::from_secs(120);
const PATIENCE_WITH_CPU: Duration = Duration::from_secs(3600);

/// A divisor of the threads of any workgroup of kernels with a variant for software devices.
pub const WORKGROUP_DIVISOR: u32 = 64;

/// What `corpuscle adapters` lists, and what a run records.
#[derive(Debug, Clone)]
pub struct AdapterDescription {
    pub index: usize,
    pub info: wgpu::AdapterInfo,
    pub limits: wgpu::Limits,
    pub features: wgpu::Features,
}

impl AdapterDescription {
    pub fn is_cpu(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Whether its driver is Mesa of before 23, whose lavapipe is slower than those since.
    pub fn has_old_mesa(&self) -> bool {
        is_old_mesa(&self.info.driver_info)
    }

    /// The variants of kernels that it can run, that which it takes first.
    pub fn variants(&self) -> Vec<KernelVariant> {
        let subgroups = self.features.contains(wgpu::Features::SUBGROUP);
        // All of one size, of which each workgroup has a whole number.
        let size = self.info.subgroup_max_size;
        let full = size > 0 && WORKGROUP_DIVISOR.is_multiple_of(size) && self.info.subgroup_min_size == size;
        match (subgroups, self.is_cpu(), full) {
            (false, ..) => vec![KernelVariant::Plain],
            (true, false, _) => vec![KernelVariant::Gpu, KernelVariant::Plain],
            (true, true, false) => vec![KernelVariant::Plain, KernelVariant::Gpu],
            (true, true, true) if self.has_old_mesa() => {
                vec![KernelVariant::Plain, KernelVariant::Software, KernelVariant::Gpu]
            }
            (true, true, true) => vec![KernelVariant::Software, KernelVariant::Plain, KernelVariant::Gpu],
        }
    }
}

/// Mesa's of before 23, by what it says of its version: 22.3 has nothing of what the variant for software devices goes around, 25.0 has. Those between
/// are not measured.
fn is_old_mesa(driver_info: &str) -> bool {
    let version = driver_info.strip_prefix("Mesa ").and_then(|text| text.split('.').next());
    version.and_then(|major| major.parse::<u32>().ok()).is_some_and(|major| major < 23)
}

fn instance() -> wgpu::Instance {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::VULKAN;
    descriptor.flags = wgpu::InstanceFlags::empty();
    wgpu::Instance::new(descriptor)
}

/// Sorted: GPUs by PCI bus id, then CPU adapters.
fn sorted_adapters() -> Vec<(wgpu::Adapter, AdapterDescription)> {
    let mut adapters = pollster::block_on(instance().enumerate_adapters(wgpu::Backends::VULKAN));
    adapters.sort_by_key(|adapter| {
        let info = adapter.get_info();
        (info.device_type == wgpu::DeviceType::Cpu, info.device_pci_bus_id, info.name)
    });
    adapters
        .into_iter()
        .enumerate()
        .map(|(index, adapter)| {
            let description = AdapterDescription {
                index,
                info: adapter.get_info(),
                limits: adapter.limits(),
                features: adapter.features(),
            };
            (adapter, description)
        })
        .collect()
}

pub fn adapters() -> Vec<AdapterDescription> {
    sorted_adapters().into_iter().map(|(_, description)| description).collect()
}

pub struct Device {
    device: wgpu::Device,
    queue: wgpu::Queue,
    adapter: AdapterDescription,
    timestamps: bool,
    variant: KernelVariant,
    trouble: Arc<Mutex<Option<String>>>,
    pipeline_cache: PipelineCache,
}

impl Device {
    /// Opens the adapter named by `selector` (index or PCI bus id of `corpuscle adapters`), or the first.
    ///
    /// # Errors
    /// If there is no such adapter, or it refuses the device.
    pub fn open(selector: Option<&str>) -> Result<Device, GpuError> {
        Device::opened(selector, None)
    }

    /// The same with another of the variants of kernels that it can run ([`KernelVariant`]).
    ///
    /// # Errors
    /// As [`Device::open`], and if it cannot run that variant.
    pub fn open_in(selector: Option<&str>, variant: KernelVariant) -> Result<Device, GpuError> {
        Device::opened(selector, Some(variant))
    }

    fn opened(selector: Option<&str>, variant: Option<KernelVariant>) -> Result<Device, GpuError> {
        let adapters = sorted_adapters();
        let known: Vec<String> =
            adapters.iter().map(|(_, adapter)| format!("{}: {}", adapter.index, adapter.info.name)).collect();
        let chosen = match selector {
            None => adapters.into_iter().next(),
            Some(text) => adapters
                .into_iter()
                .find(|(_, adapter)| adapter.index.to_string() == text || adapter.info.device_pci_bus_id == text),
        };
        let Some((raw, adapter)) = chosen else {
            return Err(match selector {
                Some(text) => GpuError::UnknownAdapter { asked: text.into(), known },
                None => GpuError::NoAdapter,
            });
        };
        let variants = adapter.variants();
        let variant = variant.unwrap_or(variants[0]);
        if !variants.contains(&variant) {
            let reason = format!("it cannot run kernels in the variant {}", variant.name());
            return Err(GpuError::Open { adapter: adapter.info.name, reason });
        }
        let features = adapter.features & (wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::SUBGROUP);
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("corpuscle"),
            required_features: features,
            required_limits: adapter.limits.clone(),
            experimental_features: wgpu::ExperimentalFeatures::disabled(),
            memory_hints: wgpu::MemoryHints::Performance,
            trace: wgpu::Trace::Off,
        };
        let (device, queue) = pollster::block_on(raw.request_device(&descriptor))
            .map_err(|error| GpuError::Open { adapter: adapter.info.name.clone(), reason: error.to_string() })?;
        let trouble = Arc::new(Mutex::new(None));
        let on_lost = Arc::clone(&trouble);
        device.set_device_lost_callback(move |reason, message| {
            note(&on_lost, format!("device lost ({reason:?}): {message}"));
        });
        let on_error = Arc::clone(&trouble);
        device.on_uncaptured_error(Arc::new(move |error| note(&on_error, error.to_string())));
        let timestamps = features.contains(wgpu::Features::TIMESTAMP_QUERY);
        Ok(Device { device, queue, adapter, timestamps, variant, trouble, pipeline_cache: PipelineCache::default() })
    }

    pub fn adapter(&self) -> &AdapterDescription {
        &self.adapter
    }

    pub fn limits(&self) -> &wgpu::Limits {
        &self.adapter.limits
    }

    /// Whether phases can be timed on the device.
    pub fn has_timestamps(&self) -> bool {
        self.timestamps
    }

    /// The variant of its kernels.
    pub fn variant(&self) -> KernelVariant {
        self.variant
    }

    /// Nanoseconds per timestamp unit.
    pub fn timestamp_period(&self) -> f64 {
        f64::from(self.queue.get_timestamp_period())
    }

    pub(crate) fn raw(&self) -> &wgpu::Device {
        &self.device
    }

    pub(super) fn pipeline_cache(&self) -> &PipelineCache {
        &self.pipeline_cache
    }

    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    pub fn encoder(&self) -> wgpu::CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    pub fn query_set(&self, count: u32) -> wgpu::QuerySet {
        self.device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("timestamps"),
            ty: wgpu::QueryType::Timestamp,
            count,
        })
    }

    /// Submits and returns what to wait for.
    pub fn submit(&self, encoder: wgpu::CommandEncoder) -> wgpu::SubmissionIndex {
        self.queue.submit([encoder.finish()])
    }

    /// Waits until a submission is done.
    ///
    /// # Errors
    /// If the device hangs, is lost, ran out of memory or refused a command.
    pub fn wait(&self, submission: &wgpu::SubmissionIndex) -> Result<(), GpuError> {
        let patience = if self.adapter.is_cpu() { PATIENCE_WITH_CPU } else { PATIENCE };
        let poll = wgpu::PollType::Wait { submission_index: Some(submission.clone()), timeout: Some(patience) };
        let polled = self.device.poll(poll);
        // What was refused says more than that waiting for it failed.
        self.check()?;
        polled.map(|_| ()).map_err(|error| GpuError::Trouble { reason: error.to_string() })
    }

    fn check(&self) -> Result<(), GpuError> {
        let trouble = self.trouble.lock().map_or_else(|poisoned| poisoned.into_inner().clone(), |text| text.clone());
        trouble.map_or(Ok(()), |reason| Err(GpuError::Trouble { reason }))
    }
}

fn note(trouble: &Mutex<Option<String>>, text: String) {
    if let Ok(mut slot) = trouble.lock() {
        slot.get_or_insert(text);
    }
}

#[cfg(test)]
mod tests {
    use super::is_old_mesa;

    #[test]
    fn mesa_tells_its_version() {
        assert!(is_old_mesa("Mesa 22.3.6 (LLVM 15.0.6)"));
        for other in ["Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)", "Mesa 23.1.0-devel", "Mesa", "22.3.6", "580.159.04", ""] {
            assert!(!is_old_mesa(other), "{other}");
        }
    }
}
