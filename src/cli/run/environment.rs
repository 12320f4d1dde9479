//! What a run is recorded to have run on.

use crate::gpu::{AdapterDescription, Device};
use crate::output::AdapterRecord;

pub(super) fn command() -> Vec<String> {
    std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect()
}

pub(super) fn record(device: &Device) -> AdapterRecord {
    let AdapterDescription { info, limits, features, .. } = device.adapter();
    let limits = [
        ("max_storage_buffer_binding_size", limits.max_storage_buffer_binding_size),
        ("max_buffer_size", limits.max_buffer_size),
        ("max_storage_buffers_per_shader_stage", limits.max_storage_buffers_per_shader_stage.into()),
        ("max_compute_workgroups_per_dimension", limits.max_compute_workgroups_per_dimension.into()),
        ("max_compute_workgroup_size_x", limits.max_compute_workgroup_size_x.into()),
        ("max_compute_workgroup_storage_size", limits.max_compute_workgroup_storage_size.into()),
        ("min_uniform_buffer_offset_alignment", limits.min_uniform_buffer_offset_alignment.into()),
    ];
    AdapterRecord {
        name: info.name.clone(),
        backend: info.backend.to_string(),
        driver: info.driver.clone(),
        driver_info: info.driver_info.clone(),
        device_type: format!("{:?}", info.device_type),
        form: device.variant().name().to_owned(),
        limits: limits.into_iter().map(|(name, value)| (name.to_owned(), value)).collect(),
        features: features.iter_names().map(|(name, _)| name.to_owned()).collect(),
    }
}
