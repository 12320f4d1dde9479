//! The kernels of `shaders/`: the table that `build.rs` generates from them.

use crate::gpu::{Access, Binding, GpuError, KernelSource};

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

/// The kernel of a name.
///
/// # Errors
/// If there is none.
pub fn shader(name: &str) -> Result<&'static KernelSource, GpuError> {
    let found = KERNELS.iter().find(|kernel| kernel.name == name);
    found.ok_or_else(|| GpuError::Kernel { kernel: name.into(), reason: "no such shader".into() })
}

#[cfg(test)]
mod tests {
    use wgpu::naga::front::wgsl;
    use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};

    use super::*;
    use crate::gpu::{KernelVariant, RuntimeConstants, Stretch};

    #[test]
    fn every_kernel_of_a_step_can_be_counted() {
        for kernel in KERNELS {
            let counted = Stretch::of_kernel(kernel, &[]).unwrap();
            assert!(counted.straight().all() > 0.0, "{}", kernel.name);
        }
    }

    /// The ceiling's own count, by which its rate is formed: of its loop 32 operations of floating point.
    #[test]
    fn the_ceilings_loop_has_the_operations_that_it_is_said_to_have() {
        let counted = Stretch::of_kernel(shader("ceiling_arithmetic").unwrap(), &[]).unwrap();
        assert_eq!(counted.inner("arithmetic").unwrap().straight().floating, 32.0);
    }

    #[test]
    fn a_name_that_no_shader_has_is_refused() {
        let message = shader("no_such").unwrap_err().to_string();
        assert_eq!(message, "the kernel `no_such` cannot be used on this device: no such shader");
    }

    /// All that could be a runtime constant is made one: if that is valid, so is any part of it.
    #[test]
    fn every_kernel_in_every_variant_can_have_runtime_constants() {
        let mut found = 0;
        for kernel in KERNELS {
            for variant in [KernelVariant::Plain, KernelVariant::Software, KernelVariant::Gpu] {
                let text = kernel.text(variant);
                let numbers = text.lines().filter_map(|line| line.strip_prefix("override ")?.split_once(':'));
                let numbers = numbers.filter(|(name, rest)| {
                    !rest.trim_start().starts_with("bool") && !["WORKGROUP", "SCAN_THREADS"].contains(name)
                });
                let names: Vec<&str> = numbers.map(|(name, _)| name).collect();
                let constants: Vec<(&'static str, f64)> =
                    kernel.overrides.iter().map(|&(name, _)| (name, 1.0)).collect();
                let Some(made) = RuntimeConstants::of(kernel, text, &constants, &names).unwrap() else {
                    continue;
                };
                let module = wgsl::parse_str(&made.text)
                    .unwrap_or_else(|error| panic!("{}: {}", kernel.name, error.emit_to_string(&made.text)));
                let checked = Validator::new(ValidationFlags::all(), Capabilities::SUBGROUP).validate(&module);
                checked.unwrap_or_else(|error| panic!("{}: {error:?}", kernel.name));
                found += 1;
            }
        }
        assert!(found > 60, "{found}");
    }
}
