//! The kernels of `shaders/membrane/`: the table that `build.rs` generates from them.

use crate::gpu::{Access, Binding, GpuError, KernelSource};

include!(concat!(env!("OUT_DIR"), "/membrane_shaders.rs"));

/// The kernel of a name.
///
/// # Errors
/// If there is none.
pub fn shader(name: &str) -> Result<&'static KernelSource, GpuError> {
    let found = KERNELS.iter().find(|kernel| kernel.name == name);
    found.ok_or_else(|| GpuError::Kernel { kernel: name.into(), reason: "no such shader".into() })
}
