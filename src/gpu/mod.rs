//! wgpu and nothing else: adapters, devices, buffers, kernels, timers, readback, pictures. Knows no particles, and no shader by name.

mod buffer;
mod canvas;
mod device;
mod kernel;
mod operations;
mod pipeline_cache;
mod runtime_constants;
mod source;
mod timer;

pub use buffer::Readback;
pub use canvas::{Batch, Drawn, Layer, Painter, draw};
pub use device::{AdapterDescription, Device, WORKGROUP_DIVISOR, adapters};
pub use kernel::{BoundKernel, Kernel, Pass, fold};
pub use operations::{MARK, Operations, Stretch};
pub use runtime_constants::RuntimeConstants;
pub use source::{Access, Binding, Constants, KernelSource, KernelVariant, RenderSource};
pub use timer::{PhaseTimer, Recording};

/// Trouble with the device: exit code 3.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    #[error(
        "no Vulkan adapter was found; on a machine without a GPU install Mesa's lavapipe (package mesa-vulkan-drivers)"
    )]
    NoAdapter,
    #[error("no adapter `{asked}`; there are: {}", known.join(", "))]
    UnknownAdapter { asked: String, known: Vec<String> },
    #[error("the adapter {adapter} refused a device: {reason}")]
    Open { adapter: String, reason: String },
    #[error(
        "the buffer `{name}` needs {bytes} bytes for {items} items; this device allows {limit} bytes per buffer: use fewer particles, a larger diameter or a larger device"
    )]
    TooLarge { name: &'static str, bytes: u64, limit: u64, items: u64 },
    #[error("the device has no memory for the buffer `{name}` ({bytes} bytes): {reason}")]
    Memory { name: &'static str, bytes: u64, reason: String },
    #[error("the kernel `{kernel}` cannot be used on this device: {reason}")]
    Kernel { kernel: String, reason: String },
    #[error("the shader `{shader}` cannot be used on this device: {reason}")]
    Shader { shader: String, reason: String },
    #[error("a picture is drawn at {width} x {height}, twice its size; this device allows 1 to {most} each way")]
    Texture { width: u32, height: u32, most: u32 },
    #[error("the device failed: {reason}")]
    Trouble { reason: String },
}
