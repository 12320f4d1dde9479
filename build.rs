//! Parses and validates every shader, so that a broken one is a build error, and generates the table of kernels.
//!
//! Each `shaders/NAME.wgsl` is a kernel. Its leading `//!` lines may hold `//! uses: a.wgsl b.wgsl`, naming files
//! of `shaders/shared/` that go before it (each once, and before it what it uses in turn). `a.software.wgsl` takes the place of `a.wgsl` in
//! another source of each kernel that uses it, for software devices, and `a.gpu.wgsl` in one for GPUs. The result is
//! `$OUT_DIR/shaders.rs`: `pub static KERNELS: &[KernelSource]` (src/gpu/kernel.rs) in order of name: all sources,
//! entry point, and the bindings and override constants that the entry point uses.
//!
//! `CORPUSCLE_SOURCE` is a number of all sources, by which ranks see that they are of one build. `CORPUSCLE_COMMIT` is the last commit
//! of the working tree that changed sources, marked where they are others; not set where there is none, or no git. It is found anew
//! only where sources change: a commit of anything else builds nothing, and sources that are committed as they were built stay
//! marked. `CORPUSCLE_VERSION` is the package's with that commit.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs, process};

use naga::valid::{Capabilities, ValidationFlags, Validator};

/// What the kernels may ask of an adapter beyond the basics of WebGPU: nothing.
pub const CAPABILITIES: Capabilities = Capabilities::empty();
/// The forms that a shared file may have beside its own, in the order of `Form` (src/gpu/kernel.rs), and what the sources made of them may ask.
pub const FORMS: [&str; 2] = ["software", "gpu"];
const CAPABILITIES_OF_FORMS: Capabilities = Capabilities::SUBGROUP;

/// What a build is made of.
const SOURCES: [&str; 4] = ["Cargo.lock", "build.rs", "shaders", "src"];
const FNV_START: u64 = 0xcbf2_9ce4_8422_2325;
const FNV_PRIME: u64 = 0x100_0000_01b3;

/// A kernel with the shared files before it.
pub struct Kernel {
    pub name: String,
    pub source: String,
    /// Those of the other forms, where they are others.
    pub forms: [Option<String>; FORMS.len()],
    pub entry_point: String,
    /// Index, name, and variant of `Access`, of the buffers that the entry point uses.
    pub bindings: Vec<(u32, String, &'static str)>,
    /// Override constants, and whether they have no default.
    pub overrides: Vec<(String, bool)>,
    parts: Vec<Part>,
}

/// One file's place in the source of a kernel.
struct Part {
    path: PathBuf,
    /// Bytes of the kernel's source.
    start: usize,
}

fn main() {
    // Cargo looks at every file below.
    for path in SOURCES {
        println!("cargo::rerun-if-changed={path}");
    }
    let written = kernels(Path::new("shaders")).and_then(|(kernels, unused)| {
        for path in unused {
            println!("cargo::warning={} is used by no kernel", path.display());
        }
        let out = env::var_os("OUT_DIR").ok_or("cargo did not set OUT_DIR")?;
        let path = Path::new(&out).join("shaders.rs");
        fs::write(&path, table(&kernels)).map_err(|error| format!("{}: {error}", path.display()))
    });
    let numbered = written.and_then(|()| {
        let mut number = FNV_START;
        SOURCES.iter().try_for_each(|path| add_to(&mut number, Path::new(path)))?;
        println!("cargo::rustc-env=CORPUSCLE_SOURCE={number:016x}");
        let version = env!("CARGO_PKG_VERSION");
        match commit() {
            Some(commit) => {
                println!("cargo::rustc-env=CORPUSCLE_COMMIT={commit}");
                println!("cargo::rustc-env=CORPUSCLE_VERSION={version} ({commit})");
            }
            None => println!("cargo::rustc-env=CORPUSCLE_VERSION={version}"),
        }
        Ok(())
    });
    if let Err(message) = numbered {
        eprintln!("{message}");
        process::exit(1);
    }
}

/// What git says of this package's own working tree.
fn commit() -> Option<String> {
    // The package may lie within another's working tree.
    let root = fs::canonicalize(git(&["rev-parse", "--show-toplevel"])?).ok()?;
    if root != fs::canonicalize(".").ok()? {
        return None;
    }
    let log = ["log", "-1", "--format=%h", "--abbrev=12", "--"];
    let commit = git(&[&log, &SOURCES[..]].concat()).filter(|commit| !commit.is_empty())?;
    let changed = !git(&[&["status", "--porcelain", "--"], &SOURCES[..]].concat())?.is_empty();
    Some(if changed { commit + "-changed" } else { commit })
}

/// What git answers, if it does.
fn git(arguments: &[&str]) -> Option<String> {
    let done = process::Command::new("git").args(arguments).output().ok().filter(|done| done.status.success())?;
    Some(String::from_utf8(done.stdout).ok()?.trim().to_owned())
}

/// Adds a file, or all files of a folder in the order of their names, to a hash (FNV-1a, 64 bits).
fn add_to(number: &mut u64, path: &Path) -> Result<(), String> {
    let told = |error: std::io::Error| format!("{}: {error}", path.display());
    if path.is_dir() {
        let entries: Result<Vec<_>, _> = fs::read_dir(path).map_err(told)?.map(|entry| Ok(entry?.path())).collect();
        let mut paths = entries.map_err(told)?;
        paths.sort();
        return paths.iter().try_for_each(|path| add_to(number, path));
    }
    let name = path.to_string_lossy();
    for byte in name.bytes().chain(fs::read(path).map_err(told)?) {
        *number = (*number ^ u64::from(byte)).wrapping_mul(FNV_PRIME);
    }
    Ok(())
}

/// The validated kernels of a folder by name, and the shared files that none of them uses. A missing folder has no kernels.
pub fn kernels(folder: &Path) -> Result<(Vec<Kernel>, Vec<PathBuf>), String> {
    let mut kernels = Vec::new();
    let mut errors = Vec::new();
    let mut used = Vec::new();
    for path in wgsl_files(folder)? {
        if path.file_stem().is_some_and(|stem| Path::new(stem).extension().is_some()) {
            errors.push(format!("{}: error: only files of shared/ have forms", path.display()));
            continue;
        }
        match Kernel::with_forms(folder, &path, &mut used) {
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
        let Kernel { name, source, forms, entry_point, .. } = kernel;
        rust += &format!("KernelSource {{ name: {name:?}, entry_point: {entry_point:?}, bindings: &[");
        for (index, variable, access) in &kernel.bindings {
            rust += &format!("Binding {{ index: {index}, name: {variable:?}, access: Access::{access} }}, ");
        }
        rust += &format!("], overrides: &{:?}, source: {source:?}, forms: {forms:?} }},\n", kernel.overrides);
    }
    rust + "];\n"
}

impl Kernel {
    /// A kernel with all of its sources, each of them valid. What files it uses is added to `used`.
    fn with_forms(folder: &Path, path: &Path, used: &mut Vec<PathBuf>) -> Result<Kernel, String> {
        let mut kernel = Kernel::assemble(folder, path, None)?;
        kernel.validate(CAPABILITIES)?;
        used.extend(kernel.parts.iter().map(|part| part.path.clone()));
        for (at, form) in FORMS.into_iter().enumerate() {
            let mut other = Kernel::assemble(folder, path, Some(form))?;
            used.extend(other.parts.iter().map(|part| part.path.clone()));
            if other.source == kernel.source {
                continue;
            }
            other.validate(CAPABILITIES_OF_FORMS)?;
            let sorted = |mut overrides: Vec<(String, bool)>| {
                overrides.sort();
                overrides
            };
            let overrides = [&other, &kernel].map(|kernel| sorted(kernel.overrides.clone()));
            if other.bindings != kernel.bindings || overrides[0] != overrides[1] {
                let message = format!("in its form {form} it has other bindings or constants");
                return Err(other.report(&message, Vec::new(), Vec::new()));
            }
            kernel.forms[at] = Some(other.source);
        }
        Ok(kernel)
    }

    fn assemble(folder: &Path, path: &Path, form: Option<&str>) -> Result<Kernel, String> {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mut kernel = Kernel {
            name,
            source: String::new(),
            forms: Default::default(),
            entry_point: String::new(),
            bindings: Vec::new(),
            overrides: Vec::new(),
            parts: Vec::new(),
        };
        kernel.append(folder, path, form, &mut Vec::new())?;
        Ok(kernel)
    }

    /// Appends what `path` uses and is not there yet, then `path` itself. `visited` ends circles.
    fn append(
        &mut self,
        folder: &Path,
        path: &Path,
        form: Option<&str>,
        visited: &mut Vec<PathBuf>,
    ) -> Result<(), String> {
        visited.push(path.to_path_buf());
        let text = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
        for (line, used) in uses(&text) {
            let mut shared = folder.join("shared").join(used);
            let other = form.map(|form| shared.with_extension(format!("{form}.wgsl")));
            if let Some(other) = other.filter(|other| other.is_file()) {
                shared = other;
            }
            if visited.contains(&shared) {
                continue;
            }
            if !shared.is_file() {
                return Err(format!(
                    "{}:{line}: error: uses {used}, but there is no {}",
                    path.display(),
                    shared.display()
                ));
            }
            self.append(folder, &shared, form, visited)?;
        }
        self.parts.push(Part { path: path.to_path_buf(), start: self.source.len() });
        self.source += &text;
        if !text.ends_with('\n') {
            self.source.push('\n');
        }
        Ok(())
    }

    fn validate(&mut self, capabilities: Capabilities) -> Result<(), String> {
        let module = naga::front::wgsl::parse_str(&self.source).map_err(|error| {
            let labels = error.labels().map(|(span, label)| (span, label.to_owned())).collect();
            let notes = error.notes().map(str::to_owned).collect();
            self.report(error.message(), labels, notes)
        })?;
        let [entry_point] = module.entry_points.as_slice() else {
            return Err(self.report("a kernel file needs one entry point", Vec::new(), Vec::new()));
        };
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
            self.bindings.push((binding.binding, name.clone(), access));
        }
        self.bindings.sort();
        let named = module.overrides.iter().filter_map(|(_, o)| Some((o.name.clone()?, o.init.is_none())));
        self.overrides = named.collect();
        Ok(())
    }

    /// naga's message with each place mapped from the joined source back to its file.
    fn report(&self, message: &str, labels: Vec<(naga::Span, String)>, notes: Vec<String>) -> String {
        let kernel = self.parts.last().map_or(Path::new(""), |part| &part.path);
        let mut text = format!("error in kernel {}: {message}\n", kernel.display());
        for (span, label) in labels {
            let Some(range) = span.to_range() else {
                continue;
            };
            let Some(part) = self.parts.iter().rev().find(|part| part.start <= range.start) else {
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

/// The files that the leading `//!` lines name, with their line numbers.
fn uses(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines()
        .enumerate()
        .map_while(|(i, line)| Some((i + 1, line.strip_prefix("//!")?)))
        .filter_map(|(line, comment)| Some((line, comment.trim_start().strip_prefix("uses:")?)))
        .flat_map(|(line, names)| names.split_whitespace().map(move |name| (line, name)))
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
