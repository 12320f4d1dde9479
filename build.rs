//! Parses and validates every shader, so that a broken one is a build error, and generates the table of kernels.
//!
//! Each `shaders/NAME.wgsl` is a kernel. Its leading `//!` lines may hold `//! uses: a.wgsl b.wgsl`, naming files
//! of `shaders/shared/` that go before it (each once, and before it what it uses in turn). `a.software.wgsl` takes the place of `a.wgsl` in
//! another source of each kernel that uses it, for software devices, and `a.gpu.wgsl` in one for GPUs. The result is
//! `$OUT_DIR/shaders.rs`: `pub static KERNELS: &[KernelSource]` (src/subdomain/shaders.rs) in order of name: all sources,
//! entry point, phases, and the bindings and override constants that the entry point uses.
//!
//! Each kernel begins with the numbers of `src/subdomain/registry.rs`. A declaration `var<storage, ..> NAME` or `var<uniform> NAME`
//! gets the binding number of the buffer NAME from there; `//! binds: BUFFER as NAME` says that a kernel (or what uses a shared file)
//! has another buffer by that name. `//! phase: choose lost` names the phases of the step in which a kernel is dispatched.
//!
//! The kernels of a membrane are in `shaders/membrane/`, with the registry `src/fabric/registry.rs`; they may use the files of `shaders/shared/`, too.
//! The shaders of pictures are in `shaders/render/`, and found by `build/render.rs`. What the program says of its own version is found in
//! `build/version.rs`.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs, process};

use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

#[path = "src/fabric/registry.rs"]
#[allow(dead_code)]
mod fabric_registry;
#[path = "src/subdomain/registry.rs"]
#[allow(dead_code)] // Most of it is for the host.
mod registry;
#[path = "build/render.rs"]
pub mod render;
#[path = "build/version.rs"]
mod version;

/// What all kernels of a folder have: numbers, and buffers whose places are their binding numbers.
#[derive(Clone, Copy)]
pub struct Registry<'a> {
    pub numbers: &'a [&'a [(&'a str, u32)]],
    pub buffers: &'a [&'a str],
    /// The uniform of which each dispatch sees a part of its own.
    pub stepped: &'a str,
    /// The file that all of this stands in.
    pub path: &'a str,
}

/// That of the package.
pub const REGISTRY: Registry<'static> = Registry {
    numbers: &registry::NUMBERS,
    buffers: registry::BUFFERS,
    stepped: registry::STEPPED,
    path: "src/subdomain/registry.rs",
};

/// That of the kernels of a membrane.
pub const FABRIC_REGISTRY: Registry<'static> = Registry {
    numbers: &fabric_registry::NUMBERS,
    buffers: fabric_registry::BUFFERS,
    stepped: fabric_registry::STEPPED,
    path: "src/fabric/registry.rs",
};

/// What the kernels may ask of an adapter beyond the basics of WebGPU: nothing.
pub const CAPABILITIES: Capabilities = Capabilities::empty();
/// The variants that a shared file may have beside its own, in the order of `KernelVariant` (src/gpu/source.rs), and what the sources made of them may ask.
pub const VARIANTS: [&str; 2] = ["software", "gpu"];
const CAPABILITIES_OF_VARIANTS: Capabilities = Capabilities::SUBGROUP;

/// A kernel with the shared files before it.
pub struct Kernel {
    pub name: String,
    pub source: String,
    /// Those of the other variants, where they are others.
    pub variants: [Option<String>; VARIANTS.len()],
    pub entry_point: String,
    /// The phases of the step in which it is dispatched.
    pub phases: Vec<String>,
    /// The buffers that the entry point uses.
    pub bindings: Vec<Bound>,
    /// Override constants, and whether they have no default.
    pub overrides: Vec<(String, bool)>,
    /// Buffers, and by what other names the shader has them.
    aliases: Vec<(String, String)>,
    files_of_source: Vec<SourceFile>,
}

/// A buffer that an entry point uses.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Bound {
    pub index: u32,
    /// In the registry.
    pub name: String,
    /// Variant of `Access`.
    pub access: &'static str,
    /// Bytes that a dispatch sees, of the uniform of which it sees a part.
    pub stepped: Option<u32>,
}

/// One file's place in the source of a kernel.
struct SourceFile {
    path: PathBuf,
    /// Bytes of the kernel's source.
    start: usize,
}

fn main() {
    // Cargo looks at every file below.
    for path in version::SOURCES {
        println!("cargo::rerun-if-changed={path}");
    }
    if let Err(message) = write_tables().and_then(|()| version::tell()) {
        eprintln!("{message}");
        process::exit(1);
    }
}

fn write_tables() -> Result<(), String> {
    let out = env::var_os("OUT_DIR").ok_or("cargo did not set OUT_DIR")?;
    let write = |name: &str, text: String| {
        let path = Path::new(&out).join(name);
        fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))
    };
    let (of_gas, mut unused) = kernels(Path::new("shaders"), REGISTRY)?;
    write("shaders.rs", table(&of_gas))?;
    let (membrane, unused_there) = kernels(Path::new("shaders/membrane"), FABRIC_REGISTRY)?;
    write("membrane_shaders.rs", table(&membrane))?;
    unused.extend(unused_there);
    let (shaders, unused_there) = render::shaders(Path::new("shaders/render"))?;
    write("render_shaders.rs", render::table(&shaders))?;
    unused.extend(unused_there);
    for path in unused {
        println!("cargo::warning={} is used by no shader", path.display());
    }
    Ok(())
}

/// The validated kernels of a folder by name, and the shared files that none of them uses. A missing folder has no kernels.
pub fn kernels(folder: &Path, registry: Registry<'_>) -> Result<(Vec<Kernel>, Vec<PathBuf>), String> {
    let mut kernels = Vec::new();
    let mut errors = Vec::new();
    let mut used = Vec::new();
    for path in wgsl_files(folder)? {
        if path.file_stem().is_some_and(|stem| Path::new(stem).extension().is_some()) {
            errors.push(format!("{}: error: only files of shared/ have variants", path.display()));
            continue;
        }
        match Kernel::with_variants(Files { folder, registry }, &path, &mut used) {
            Ok(kernel) => kernels.push(kernel),
            Err(error) => errors.push(error),
        }
    }
    if !errors.is_empty() {
        return Err(errors.join("\n"));
    }
    let mut unused = wgsl_files(&folder.join("shared"))?;
    unused.retain(|path| !used.contains(path));
    Ok((kernels, unused))
}

/// Rust source of the table.
pub fn table(kernels: &[Kernel]) -> String {
    let mut rust = String::from("pub static KERNELS: &[KernelSource] = &[\n");
    for kernel in kernels {
        let Kernel { name, source, variants, entry_point, phases, .. } = kernel;
        rust +=
            &format!("KernelSource {{ name: {name:?}, entry_point: {entry_point:?}, phases: &{phases:?}, bindings: &[");
        for Bound { index, name, access, stepped } in &kernel.bindings {
            rust += &format!(
                "Binding {{ index: {index}, name: {name:?}, access: Access::{access}, stepped: {stepped:?} }}, "
            );
        }
        rust += &format!("], overrides: &{:?}, source: {source:?}, variants: {variants:?} }},\n", kernel.overrides);
    }
    rust + "];\n"
}

/// Where shaders are, and what they are made with.
#[derive(Clone, Copy)]
struct Files<'a> {
    folder: &'a Path,
    registry: Registry<'a>,
}

impl Kernel {
    /// A kernel with all of its sources, each of them valid. What files it uses is added to `used`.
    fn with_variants(files: Files<'_>, path: &Path, used: &mut Vec<PathBuf>) -> Result<Kernel, String> {
        let mut kernel = Kernel::assemble(files, path, None)?;
        kernel.validate(CAPABILITIES, files.registry)?;
        used.extend(kernel.files_of_source.iter().map(|part| part.path.clone()));
        for (at, variant) in VARIANTS.into_iter().enumerate() {
            let mut other = Kernel::assemble(files, path, Some(variant))?;
            used.extend(other.files_of_source.iter().map(|part| part.path.clone()));
            if other.source == kernel.source {
                continue;
            }
            other.validate(CAPABILITIES_OF_VARIANTS, files.registry)?;
            let sorted = |mut overrides: Vec<(String, bool)>| {
                overrides.sort();
                overrides
            };
            let overrides = [&other, &kernel].map(|kernel| sorted(kernel.overrides.clone()));
            if other.bindings != kernel.bindings || overrides[0] != overrides[1] {
                let message = format!("in its variant {variant} it has other bindings or constants");
                return Err(other.report(&message, Vec::new(), Vec::new()));
            }
            kernel.variants[at] = Some(other.source);
        }
        Ok(kernel)
    }

    fn assemble(files: Files<'_>, path: &Path, variant: Option<&str>) -> Result<Kernel, String> {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mut kernel = Kernel {
            name,
            source: String::new(),
            variants: Default::default(),
            entry_point: String::new(),
            phases: Vec::new(),
            bindings: Vec::new(),
            overrides: Vec::new(),
            aliases: Vec::new(),
            files_of_source: vec![SourceFile { path: PathBuf::from(files.registry.path), start: 0 }],
        };
        for (name, value) in files.registry.numbers.iter().copied().flatten() {
            kernel.source += &format!("const {name}: u32 = {value}u;\n");
        }
        let mut texts = Vec::new();
        collect(files.folder, path, variant, &mut Vec::new(), &mut texts)?;
        // A kernel's own line goes before those of the files that it uses.
        for (path, text) in texts.iter().rev() {
            for (line, alias) in marked(text, "binds:") {
                let words: Vec<&str> = alias.split_whitespace().collect();
                let [buffer, "as", variable] = words[..] else {
                    return Err(format!(
                        "{}:{line}: error: found 'binds: {alias}', allowed: BUFFER as NAME",
                        path.display()
                    ));
                };
                if !kernel.aliases.iter().any(|(_, known)| known == variable) {
                    kernel.aliases.push((buffer.to_owned(), variable.to_owned()));
                }
            }
        }
        for (path, text) in texts {
            kernel.append(files.registry, path, &text)?;
        }
        let own = kernel.files_of_source.last().map_or(0, |part| part.start);
        let phases = marked(&kernel.source[own..], "phase:").flat_map(|(_, names)| names.split_whitespace());
        kernel.phases = phases.map(str::to_owned).collect();
        Ok(kernel)
    }

    /// Appends a file, with the binding numbers of its buffers.
    fn append(&mut self, registry: Registry<'_>, path: PathBuf, text: &str) -> Result<(), String> {
        let start = self.source.len();
        for (number, line) in text.lines().enumerate() {
            if let Some(name) = declared(line) {
                let buffer = self.aliases.iter().find(|(_, known)| known == name).map_or(name, |(buffer, _)| buffer);
                let Some(binding) = registry.buffers.iter().position(|known| *known == buffer) else {
                    let (path, line) = (path.display(), number + 1);
                    return Err(format!("{path}:{line}: error: no buffer {buffer} in {}", registry.path));
                };
                self.source += &format!("@group(0) @binding({binding}) ");
            } else if line.contains("@binding(") {
                let (path, line) = (path.display(), number + 1);
                return Err(format!(
                    "{path}:{line}: error: binding numbers are those of {}: leave it out",
                    registry.path
                ));
            }
            self.source += line;
            self.source.push('\n');
        }
        self.files_of_source.push(SourceFile { path, start });
        Ok(())
    }

    /// The parsed and validated source.
    fn checked(&self, capabilities: Capabilities) -> Result<(naga::Module, ModuleInfo), String> {
        let module = naga::front::wgsl::parse_str(&self.source).map_err(|error| {
            let labels = error.labels().map(|(span, label)| (span, label.to_owned())).collect();
            let notes = error.notes().map(str::to_owned).collect();
            self.report(error.message(), labels, notes)
        })?;
        let mut validator = Validator::new(ValidationFlags::all(), capabilities);
        let info = validator.validate(&module).map_err(|error| {
            let labels = error.spans().cloned().collect();
            let mut causes = Vec::new();
            let mut cause = std::error::Error::source(error.as_inner());
            while let Some(inner) = cause {
                causes.push(inner.to_string());
                cause = inner.source();
            }
            self.report(&error.as_inner().to_string(), labels, causes)
        })?;
        Ok((module, info))
    }

    fn validate(&mut self, capabilities: Capabilities, registry: Registry<'_>) -> Result<(), String> {
        let (module, info) = self.checked(capabilities)?;
        let [entry_point] = module.entry_points.as_slice() else {
            return Err(self.report("a kernel file needs one entry point", Vec::new(), Vec::new()));
        };
        self.entry_point = entry_point.name.clone();
        for (handle, global) in module.global_variables.iter() {
            // A shared file may declare what this kernel does not touch.
            if info.get_entry_point(0)[handle].is_empty() {
                continue;
            }
            let (Some(binding), Some(name)) = (&global.binding, &global.name) else { continue };
            let access = match global.space {
                naga::AddressSpace::Uniform => "Uniform",
                naga::AddressSpace::Storage { access } if access.contains(naga::StorageAccess::STORE) => "ReadWrite",
                naga::AddressSpace::Storage { .. } => "Read",
                _ => return Err(self.report(&format!("unexpected binding {name}"), Vec::new(), Vec::new())),
            };
            let buffer = registry.buffers.get(binding.binding as usize).copied().unwrap_or(name);
            let stepped = (buffer == registry.stepped).then(|| module.types[global.ty].inner.size(module.to_ctx()));
            self.bindings.push(Bound { index: binding.binding, name: buffer.to_owned(), access, stepped });
        }
        self.bindings.sort();
        let named = module.overrides.iter().filter_map(|(_, o)| Some((o.name.clone()?, o.init.is_none())));
        self.overrides = named.collect();
        Ok(())
    }

    /// naga's message with each place mapped from the joined source back to its file.
    fn report(&self, message: &str, labels: Vec<(naga::Span, String)>, notes: Vec<String>) -> String {
        let kernel = self.files_of_source.last().map_or(Path::new(""), |part| &part.path);
        let mut text = format!("error in kernel {}: {message}\n", kernel.display());
        for (span, label) in labels {
            let Some(range) = span.to_range() else {
                continue;
            };
            let Some(part) = self.files_of_source.iter().rev().find(|part| part.start <= range.start) else {
                continue;
            };
            let before = &self.source[part.start..range.start];
            let line = before.matches('\n').count() + 1;
            let line_start = part.start + before.rfind('\n').map_or(0, |at| at + 1);
            let column = self.source[line_start..range.start].chars().count();
            let shown = self.source[line_start..].lines().next().unwrap_or_default();
            let marked = self.source[range].lines().next().unwrap_or_default().chars().count().max(1);
            let (path, carets) = (part.path.display(), "^".repeat(marked));
            // Writing to a String cannot fail.
            let _ = write!(text, "  {path}:{line}:{}: {label}\n    {shown}\n    {:column$}{carets}\n", column + 1, "");
        }
        for note in notes {
            text += &format!("  note: {note}\n");
        }
        text
    }
}

/// Collects the files that `path` uses and that are not there yet, then `path` itself. `visited` ends circles.
fn collect(
    folder: &Path,
    path: &Path,
    variant: Option<&str>,
    visited: &mut Vec<PathBuf>,
    texts: &mut Vec<(PathBuf, String)>,
) -> Result<(), String> {
    visited.push(path.to_path_buf());
    let text = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    for (line, used) in
        marked(&text, "uses:").flat_map(|(line, names)| names.split_whitespace().map(move |name| (line, name)))
    {
        let mut shared = folder.join("shared").join(used);
        if let Some(above) = folder.parent().map(|above| above.join("shared").join(used)).filter(|_| !shared.is_file())
        {
            // What the kernels of all folders use stands above them.
            shared = if above.is_file() { above } else { shared };
        }
        let other = variant.map(|variant| shared.with_extension(format!("{variant}.wgsl")));
        if let Some(other) = other.filter(|other| other.is_file()) {
            shared = other;
        }
        if visited.contains(&shared) {
            continue;
        }
        if !shared.is_file() {
            return Err(format!("{}:{line}: error: uses {used}, but there is no {}", path.display(), shared.display()));
        }
        collect(folder, &shared, variant, visited, texts)?;
    }
    texts.push((path.to_path_buf(), text));
    Ok(())
}

/// What the leading `//!` lines say behind a mark, with their line numbers.
fn marked<'a>(text: &'a str, mark: &'static str) -> impl Iterator<Item = (usize, &'a str)> {
    text.lines()
        .enumerate()
        .map_while(|(i, line)| Some((i + 1, line.strip_prefix("//!")?)))
        .filter_map(move |(line, comment)| Some((line, comment.trim_start().strip_prefix(mark)?.trim())))
}

/// The variable that a line declares, if it is a buffer.
fn declared(line: &str) -> Option<&str> {
    let (space, rest) = line.strip_prefix("var<")?.split_once('>')?;
    let is_buffer = space.starts_with("storage") || space.starts_with("uniform");
    rest.split_once(':').map(|(name, _)| name.trim()).filter(|_| is_buffer)
}

/// In order of name; none if the folder is missing.
fn wgsl_files(folder: &Path) -> Result<Vec<PathBuf>, String> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let list = || -> std::io::Result<Vec<PathBuf>> { fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect() };
    let mut paths = list().map_err(|error| format!("{}: {error}", folder.display()))?;
    paths.retain(|path| path.is_file() && path.extension().is_some_and(|extension| extension == "wgsl"));
    paths.sort();
    Ok(paths)
}
