//! Pictures on a device: batches of triangles drawn into a texture that nobody sees, which is read back with its depths.
//!
//! All is drawn in the order given, without multisampling: on one adapter the same batches give the same bytes. Shaders
//! take what they draw from a storage buffer, and bind it after a uniform.

use super::source::RenderSource;
use super::{Device, GpuError};

const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Of both formats.
const TEXEL_BYTES: u32 = 4;

/// What a batch does to what is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layer {
    /// Hides what is behind it.
    Opaque,
    /// Is laid over what is there by its opacity, unless that is nearer; leaves depth and alpha channel alone.
    Translucent,
}

/// A shader of pictures, ready to draw.
pub struct Painter {
    name: &'static str,
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

impl Painter {
    /// # Errors
    /// If the device refuses the shader.
    pub fn new(device: &Device, source: &'static RenderSource, layer: Layer) -> Result<Painter, GpuError> {
        let name = source.name;
        let scope = device.raw().push_error_scope(wgpu::ErrorFilter::Validation);
        let entries = [
            layout_entry(0, wgpu::BufferBindingType::Uniform),
            layout_entry(1, wgpu::BufferBindingType::Storage { read_only: true }),
        ];
        let layout = device
            .raw()
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(name), entries: &entries });
        let pipeline = pipeline(device, source, &layout, layer);
        match pollster::block_on(scope.pop()) {
            Some(error) => Err(GpuError::Shader { shader: name.into(), reason: error.to_string() }),
            None => Ok(Painter { name, pipeline, layout }),
        }
    }
}

fn layout_entry(binding: u32, ty: wgpu::BufferBindingType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
        count: None,
    }
}

fn pipeline(
    device: &Device,
    source: &'static RenderSource,
    layout: &wgpu::BindGroupLayout,
    layer: Layer,
) -> wgpu::RenderPipeline {
    let module = device.raw().create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(source.name),
        source: wgpu::ShaderSource::Wgsl(source.source.into()),
    });
    let pipeline_layout = device.raw().create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(source.name),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    let (blend, write_mask) = match layer {
        Layer::Opaque => (None, wgpu::ColorWrites::ALL),
        Layer::Translucent => (Some(wgpu::BlendState::ALPHA_BLENDING), wgpu::ColorWrites::COLOR),
    };
    let depth_compare = match layer {
        Layer::Opaque => wgpu::CompareFunction::Less,
        Layer::Translucent => wgpu::CompareFunction::LessEqual,
    };
    device.raw().create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(source.name),
        layout: Some(&pipeline_layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(layer == Layer::Opaque),
            depth_compare: Some(depth_compare),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fragment"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState { format: COLOUR, blend, write_mask })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Something to draw: `vertices` vertices for each of `instances` instances.
pub struct Batch<'a> {
    pub painter: &'a Painter,
    /// The uniform at binding 0.
    pub view: &'a wgpu::Buffer,
    /// The storage buffer at binding 1.
    pub items: &'a wgpu::Buffer,
    pub vertices: u32,
    pub instances: u32,
}

/// What has been drawn, in rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// Width and height.
    pub size: [u32; 2],
    /// Red, green, blue and the alpha channel.
    pub colours: Vec<[u8; 4]>,
    /// 0 near, 1 far and where nothing was drawn.
    pub depths: Vec<f32>,
}

/// Draws batches one after the other on a background, whose alpha channel is 0.
///
/// # Errors
/// If the device has no memory for it, allows no texture of this size, or fails.
pub fn draw(device: &Device, size: [u32; 2], background: [f64; 3], batches: &[Batch<'_>]) -> Result<Drawn, GpuError> {
    let most = device.limits().max_texture_dimension_2d;
    if size.iter().any(|&edge| edge == 0 || edge > most) {
        return Err(GpuError::Texture { width: size[0], height: size[1], most });
    }
    let textures = [texture(device, "colours", size, COLOUR)?, texture(device, "depths", size, DEPTH)?];
    let bindings = batches.iter().map(|batch| bind(device, batch)).collect::<Result<Vec<_>, _>>()?;
    let mut encoder = device.encoder();
    {
        let views = textures.each_ref().map(|texture| texture.create_view(&wgpu::TextureViewDescriptor::default()));
        let mut pass = begin(&mut encoder, &views, background);
        for (batch, group) in batches.iter().zip(&bindings) {
            pass.set_pipeline(&batch.painter.pipeline);
            pass.set_bind_group(0, group, &[]);
            pass.draw(0..batch.vertices, 0..batch.instances);
        }
    }
    let row = (size[0] * TEXEL_BYTES).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let mut staging = Vec::new();
    for texture in &textures {
        let buffer = device.staging(u64::from(row) * u64::from(size[1]))?;
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let destination = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), destination, texture.size());
        staging.push(buffer);
    }
    let submission = device.submit(encoder);
    let mut texels = staging.into_iter().map(|buffer| {
        let readback = device.read_later(buffer, submission.clone());
        Ok(readback.finish(device, |bytes| unpadded(bytes, row, size[0]))?.0)
    });
    let mut next = || texels.next().unwrap_or(Ok(Vec::new()));
    let colours = next()?.iter().map(|texel: &u32| texel.to_le_bytes()).collect();
    let depths = next()?.iter().map(|&texel| f32::from_bits(texel)).collect();
    Ok(Drawn { size, colours, depths })
}

/// The texels of all rows, without what pads them.
fn unpadded(bytes: &[u8], row: u32, width: u32) -> Vec<u32> {
    let rows = bytes.chunks_exact(row as usize);
    rows.flat_map(|row| bytemuck::pod_collect_to_vec::<u8, u32>(&row[..(width * TEXEL_BYTES) as usize])).collect()
}

fn texture(
    device: &Device,
    name: &'static str,
    size: [u32; 2],
    format: wgpu::TextureFormat,
) -> Result<wgpu::Texture, GpuError> {
    let memory = device.raw().push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let texture = device.raw().create_texture(&wgpu::TextureDescriptor {
        label: Some(name),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let bytes = u64::from(size[0]) * u64::from(size[1]) * u64::from(TEXEL_BYTES);
    match pollster::block_on(memory.pop()) {
        Some(error) => Err(GpuError::Memory { name, bytes, reason: error.to_string() }),
        None => Ok(texture),
    }
}

fn bind(device: &Device, batch: &Batch<'_>) -> Result<wgpu::BindGroup, GpuError> {
    let scope = device.raw().push_error_scope(wgpu::ErrorFilter::Validation);
    let group = device.raw().create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(batch.painter.name),
        layout: &batch.painter.layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: batch.view.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: batch.items.as_entire_binding() },
        ],
    });
    match pollster::block_on(scope.pop()) {
        Some(error) => Err(GpuError::Shader { shader: batch.painter.name.into(), reason: error.to_string() }),
        None => Ok(group),
    }
}

fn begin<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    [colours, depths]: &'a [wgpu::TextureView; 2],
    [r, g, b]: [f64; 3],
) -> wgpu::RenderPass<'a> {
    let store = wgpu::StoreOp::Store;
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("picture"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: colours,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 0.0 }), store },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depths,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store }),
            stencil_ops: None,
        }),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}
