//! The shaders of pictures: `shaders/render/NAME.wgsl`, each with an entry point `vertex` and one `fragment`.
//!
//! They are joined with `shaders/render/shared/` and checked as kernels are. What a picture binds is in [`BINDINGS`]. The
//! result is `$OUT_DIR/render_shaders.rs`: `pub static RENDER_SHADERS: &[RenderSource]` in order of name.

use std::path::{Path, PathBuf};

use naga::ShaderStage;

use super::{CAPABILITIES, Files, Kernel, Registry, wgsl_files};

/// Their binding numbers are their places: the camera, and what is drawn.
pub const BINDINGS: [&str; 2] = ["view", "items"];

/// A shader with the shared files before it.
pub struct RenderShader {
    pub name: String,
    pub source: String,
}

/// The valid shaders of a folder by name, and the shared files that none of them uses.
pub fn shaders(folder: &Path) -> Result<(Vec<RenderShader>, Vec<PathBuf>), String> {
    let registry = Registry { numbers: &[], buffers: &BINDINGS, stepped: "", path: "build/render.rs" };
    let files = Files { folder, registry };
    let (mut shaders, mut errors, mut unused) = (Vec::new(), Vec::new(), wgsl_files(&folder.join("shared"))?);
    for path in wgsl_files(folder)? {
        match shader(files, &path) {
            Ok(shader) => {
                unused.retain(|path| !shader.files_of_source.iter().any(|part| part.path == *path));
                shaders.push(RenderShader { name: shader.name, source: shader.source });
            }
            Err(error) => errors.push(error),
        }
    }
    if errors.is_empty() { Ok((shaders, unused)) } else { Err(errors.join("\n")) }
}

fn shader(files: Files<'_>, path: &Path) -> Result<Kernel, String> {
    let shader = Kernel::assemble(files, path, None)?;
    let (module, _) = shader.checked(CAPABILITIES)?;
    for (name, stage) in [("vertex", ShaderStage::Vertex), ("fragment", ShaderStage::Fragment)] {
        if module.entry_points.iter().filter(|entry| entry.name == name && entry.stage == stage).count() != 1 {
            return Err(shader.report(
                &format!("a shader of pictures needs an @{name} fn {name}"),
                Vec::new(),
                Vec::new(),
            ));
        }
    }
    Ok(shader)
}

/// Rust source of the table.
pub fn table(shaders: &[RenderShader]) -> String {
    let mut rust = String::from("pub static RENDER_SHADERS: &[RenderSource] = &[\n");
    for RenderShader { name, source } in shaders {
        rust += &format!("RenderSource {{ name: {name:?}, source: {source:?} }},\n");
    }
    rust + "];\n"
}
