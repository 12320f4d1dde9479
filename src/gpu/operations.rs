//! The operations of a kernel, counted in its source as it is specialised to a scene.
//!
//! Each addition, multiplication, division, comparison, shift, logical operation, conversion, selection, root or other function of a number
//! is one operation, of a vector one for each component; a scalar product of n components is 2 n - 1, a cross product 9, a
//! fused multiply-add 2, an atomic 1. Of several variants of a kernel it is the plain one. What is made of constants alone is none, nor is moving, packing, or reading and writing with the addresses that
//! the source does not spell out, nor a change of sign. Divisions and functions take a device longer than the one operation that they count.
//!
//! What a kernel is compiled without is not counted, both sides of `&&` and `||` are. What stands in a branch or in a loop is a [`Stretch`] of its own:
//! how often it runs the caller must know.

mod stretch;
mod walk;

use wgpu::naga::front::wgsl;
use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};

use super::GpuError;
use super::source::{Constants, KernelSource};
use walk::WholeKernel;

pub use stretch::{MARK, Operations, Stretch};

impl Stretch {
    /// Counts a kernel for these constants.
    ///
    /// # Errors
    /// If its source is not valid.
    pub fn of_kernel(kernel: &KernelSource, constants: &Constants) -> Result<Stretch, GpuError> {
        let refused = |reason: String| GpuError::Kernel { kernel: kernel.name.into(), reason };
        let module = wgsl::parse_str(kernel.source).map_err(|error| refused(error.to_string()))?;
        let checked = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module);
        let info = checked.map_err(|error| refused(error.to_string()))?;
        let place = module.entry_points.iter().position(|entry| entry.name == kernel.entry_point);
        let place = place.ok_or_else(|| refused("no entry point".into()))?;
        let whole = WholeKernel { module: &module, info: &info, constants, source: kernel.source };
        Ok(whole.function(&module.entry_points[place].function, info.get_entry_point(place)))
    }
}

#[cfg(test)]
mod tests;
