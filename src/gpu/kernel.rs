//! Kernels: compute pipelines made from the validated shaders of `shaders/`, bound by name.
//!
//! A kernel is specialised by its `override` constants, some of which may be runtime constants instead (`runtime_constants.rs`); buffers
//! are bound by the names that the shader gives them, so that shader and host cannot disagree silently.

use super::pipeline_cache::{Compiled, Made};
use super::runtime_constants::RuntimeConstants;
use super::source::{Access, Binding, Constants, KernelSource, KernelVariant};
use super::{Device, GpuError};

pub struct Kernel {
    source: &'static KernelSource,
    compiled: Compiled,
    /// The uniform of its runtime constants, and where that is bound.
    runtime: Option<(u32, wgpu::Buffer)>,
}

/// Where dispatches of a phase go.
pub struct Pass<'a> {
    pub(super) pass: &'a mut wgpu::ComputePass<'static>,
    pub(super) phase: &'static str,
}

/// A kernel with its buffers.
pub struct BoundKernel {
    source: &'static KernelSource,
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
    dynamic: bool,
}

impl Kernel {
    /// Compiles a kernel for these constants.
    ///
    /// # Errors
    /// If a constant it needs is missing, or the device refuses it.
    pub fn new(device: &Device, source: &'static KernelSource, constants: &Constants) -> Result<Kernel, GpuError> {
        Kernel::with_runtime_constants(device, source, constants, &[])
    }

    /// The same, with those named in `runtime` as runtime constants.
    ///
    /// # Errors
    /// As [`Kernel::new`], and if a value is none of its type.
    pub fn with_runtime_constants(
        device: &Device,
        source: &'static KernelSource,
        constants: &Constants,
        runtime: &[&str],
    ) -> Result<Kernel, GpuError> {
        Kernel::in_variant(device, device.variant(), source, constants, runtime)
    }

    /// Compiles it in a variant that the device need not take, but must be able to run; `runtime` names its runtime constants.
    ///
    /// # Errors
    /// As [`Kernel::with_runtime_constants`].
    pub fn in_variant(
        device: &Device,
        variant: KernelVariant,
        source: &'static KernelSource,
        constants: &Constants,
        runtime: &[&str],
    ) -> Result<Kernel, GpuError> {
        let refused = |reason: String| GpuError::Kernel { kernel: source.name.into(), reason };
        let mut made = Made { source: source.text(variant), taken: Vec::new(), runtime: Vec::new() };
        for (constant, needed) in source.overrides {
            match constants.iter().find(|(given, _)| given == constant) {
                Some(_) if runtime.contains(constant) => made.runtime.push(constant),
                Some(&(given, value)) => made.taken.push((given, value)),
                None if *needed => return Err(refused(format!("no value for the constant {constant}"))),
                None => {}
            }
        }
        let with_runtime = RuntimeConstants::of(source, made.source, constants, &made.runtime).map_err(refused)?;
        let Some(RuntimeConstants { text, binding, words }) = with_runtime else {
            let make = |made: &Made| compile(source, device, made.source, &made.taken, None);
            // One that has none, of a scene whose others have some, is kept as they are.
            let compiled =
                if runtime.is_empty() { make(&made)? } else { device.pipeline_cache().or_make(made, make)? };
            return Ok(Kernel { source, compiled, runtime: None });
        };
        let buffer = device.uniform("runtime_constants", 4 * words.len().next_multiple_of(4) as u64)?;
        device.write(&buffer, 0, &words);
        let compiled =
            device.pipeline_cache().or_make(made, |made| compile(source, device, &text, &made.taken, Some(binding)))?;
        Ok(Kernel { source, compiled, runtime: Some((binding, buffer)) })
    }

    /// Binds buffers by the names in the shader.
    ///
    /// # Errors
    /// If `buffer` knows one of the names not, or the device refuses a buffer.
    pub fn bind<'a>(
        &self,
        device: &Device,
        buffer: impl Fn(&str) -> Option<&'a wgpu::Buffer>,
    ) -> Result<BoundKernel, GpuError> {
        let mut entries = Vec::new();
        for binding in self.source.bindings {
            let found = buffer(binding.name).ok_or_else(|| GpuError::Kernel {
                kernel: self.source.name.into(),
                reason: format!("no buffer for the binding {}", binding.name),
            })?;
            let resource = match binding.stepped {
                Some(bytes) => wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer: found,
                    offset: 0,
                    size: wgpu::BufferSize::new(bytes.into()),
                }),
                None => found.as_entire_binding(),
            };
            entries.push(wgpu::BindGroupEntry { binding: binding.index, resource });
        }
        entries.extend(
            self.runtime.iter().map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding: *binding,
                resource: buffer.as_entire_binding(),
            }),
        );
        let scope = device.raw().push_error_scope(wgpu::ErrorFilter::Validation);
        let group = device.raw().create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.source.name),
            layout: &self.compiled.layout,
            entries: &entries,
        });
        if let Some(error) = pollster::block_on(scope.pop()) {
            return Err(GpuError::Kernel { kernel: self.source.name.into(), reason: error.to_string() });
        }
        let dynamic = self.source.bindings.iter().any(|binding| binding.stepped.is_some());
        Ok(BoundKernel { source: self.source, pipeline: self.compiled.pipeline.clone(), group, dynamic })
    }
}

/// Compiles `text` made of a kernel's; `runtime` is the binding of its runtime constants.
fn compile(
    source: &KernelSource,
    device: &Device,
    text: &str,
    constants: &Constants,
    runtime: Option<u32>,
) -> Result<Compiled, GpuError> {
    let name = source.name;
    let mut entries: Vec<_> = source.bindings.iter().map(layout_entry).collect();
    entries.extend(runtime.map(|binding| uniform_entry(binding, false)));
    let scope = device.raw().push_error_scope(wgpu::ErrorFilter::Validation);
    let layout = device
        .raw()
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(name), entries: &entries });
    let module = device.raw().create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(name),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let pipeline_layout = device.raw().create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(name),
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    let pipeline = device.raw().create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(name),
        layout: Some(&pipeline_layout),
        module: &module,
        entry_point: Some(source.entry_point),
        compilation_options: wgpu::PipelineCompilationOptions { constants, zero_initialize_workgroup_memory: true },
        cache: None,
    });
    match pollster::block_on(scope.pop()) {
        Some(error) => Err(GpuError::Kernel { kernel: name.into(), reason: error.to_string() }),
        None => Ok(Compiled { pipeline, layout }),
    }
}

fn layout_entry(binding: &Binding) -> wgpu::BindGroupLayoutEntry {
    let ty = match binding.access {
        Access::Uniform => return uniform_entry(binding.index, binding.stepped.is_some()),
        Access::Read => wgpu::BufferBindingType::Storage { read_only: true },
        Access::ReadWrite => wgpu::BufferBindingType::Storage { read_only: false },
    };
    buffer_entry(binding.index, ty, false)
}

fn uniform_entry(index: u32, has_dynamic_offset: bool) -> wgpu::BindGroupLayoutEntry {
    buffer_entry(index, wgpu::BufferBindingType::Uniform, has_dynamic_offset)
}

fn buffer_entry(binding: u32, ty: wgpu::BufferBindingType, has_dynamic_offset: bool) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset, min_binding_size: None },
        count: None,
    }
}

impl BoundKernel {
    /// In which it may be dispatched: those of [`KernelSource::phases`].
    pub fn phases(&self) -> &'static [&'static str] {
        self.source.phases
    }

    /// One dispatch over `groups` workgroups; `offset` is that of the stepped uniform.
    ///
    /// # Panics
    /// If the phase is none of the kernel's.
    pub fn dispatch(&self, pass: &mut Pass<'_>, offset: u32, groups: [u32; 3]) {
        if groups.contains(&0) {
            return;
        }
        self.set(pass, offset);
        pass.pass.dispatch_workgroups(groups[0], groups[1], groups[2]);
    }

    /// One dispatch over the workgroups that kernels wrote into entry `item` of `arguments`.
    ///
    /// # Panics
    /// If the phase is none of the kernel's.
    pub fn dispatch_indirect(&self, pass: &mut Pass<'_>, offset: u32, arguments: &wgpu::Buffer, item: u32) {
        self.set(pass, offset);
        pass.pass.dispatch_workgroups_indirect(arguments, u64::from(item) * 12);
    }

    fn set(&self, pass: &mut Pass<'_>, offset: u32) {
        // What buffers are reused for goes by what the shader says of its phases.
        let known = self.phases().is_empty() || self.phases().contains(&pass.phase);
        assert!(known, "{} in the phase {}, it says {:?}", self.source.name, pass.phase, self.phases());
        pass.pass.set_pipeline(&self.pipeline);
        let offsets = [offset];
        pass.pass.set_bind_group(0, &self.group, if self.dynamic { &offsets } else { &[] });
    }
}

/// Workgroups for `items` threads of `workgroup` each, folded into two dimensions beyond `limit`.
pub fn fold(items: u64, workgroup: u32, limit: u32) -> [u32; 3] {
    let groups = items.div_ceil(u64::from(workgroup));
    let y = groups.div_ceil(u64::from(limit)).max(1);
    let x = groups.div_ceil(y);
    [x as u32, y as u32, u32::from(groups > 0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    static PROBE: KernelSource = KernelSource {
        overrides: &[("EDGE", true), ("LOOPS", false)],
        ..KernelSource::probe(
            "override EDGE: f32;\noverride LOOPS: u32 = 1;\nvar<workgroup> product: f32;\n\
             @compute @workgroup_size(1)\nfn probe() {\n    product = EDGE * f32(LOOPS);\n}\n",
        )
    };

    /// One with runtime constants serves all values of these, and no other of what is compiled in.
    #[test]
    fn kernels_with_runtime_constants_are_cached() {
        let device = Device::open(None).expect("a device");
        let after = |edge: f64, loops: f64, runtime: &[&str]| {
            let constants = [("EDGE", edge), ("LOOPS", loops)];
            Kernel::in_variant(&device, KernelVariant::Plain, &PROBE, &constants, runtime).expect("a kernel");
            device.pipeline_cache().len()
        };
        assert_eq!(after(0.1, 1.0, &[]), 0, "what is made for one scene serves no other");
        assert_eq!(after(0.1, 1.0, &["EDGE"]), 1);
        assert_eq!(after(0.2, 1.0, &["EDGE"]), 1);
        assert_eq!(after(0.2, 2.0, &["EDGE"]), 2);
        assert_eq!(after(0.3, 3.0, &["EDGE", "LOOPS"]), 3);
        assert_eq!(after(0.3, 3.0, &["DIAMETER"]), 4, "it has nothing to read");
        assert_eq!(after(0.4, 2.0, &["EDGE"]), 4);
    }

    /// Every item has a thread, and no dimension is over the limit.
    #[test]
    fn a_folded_dispatch_covers_all_items() {
        for items in [0_u64, 1, 64, 65, 65_535 * 64, 65_535 * 64 + 1, 1 << 28] {
            let [x, y, z] = fold(items, 64, 65_535);
            assert!(u64::from(x) * u64::from(y) * u64::from(z) * 64 >= items);
            assert!(x <= 65_535 && y <= 65_535);
        }
        assert_eq!(fold(0, 64, 65_535)[2], 0, "nothing to do is no dispatch");
    }
}
