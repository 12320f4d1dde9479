//! Validates every shader at build time and writes the table of kernels that `src/gpu/kernel.rs` includes.
//!
//! A kernel is a file `shaders/NAME.wgsl`; its first line may be `//! uses: a.wgsl b.wgsl`, files of
//! `shaders/shared/` that are put before it. A shader that naga refuses is a build error.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

use naga::valid::{Capabilities, ValidationFlags, Validator};

/// One kernel's source and, for error messages, which file each of its lines came from.
struct Source {
    text: String,
    /// (first line in `text`, file), ascending.
    parts: Vec<(usize, PathBuf)>,
}

fn main() {
    println!("cargo:rerun-if-changed=shaders");
    println!("cargo:rerun-if-changed=build.rs");
    let mut kernels: Vec<PathBuf> = fs::read_dir("shaders")
        .expect("the folder shaders/ exists")
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|extension| extension == "wgsl"))
        .collect();
    kernels.sort();
    let mut table = String::from("pub static KERNELS: &[KernelSource] = &[\n");
    for path in kernels {
        match entry(&path) {
            Ok(text) => table.push_str(&text),
            Err(message) => {
                eprintln!("{message}");
                std::process::exit(1);
            }
        }
    }
    table.push_str("];\n");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::write(out.join("kernels.rs"), table).expect("OUT_DIR is writable");
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

fn assemble(path: &Path) -> Result<Source, String> {
    let own = read(path)?;
    let mut source = Source { text: String::new(), parts: Vec::new() };
    let uses = own.lines().next().and_then(|line| line.strip_prefix("//! uses:")).unwrap_or("");
    let shared = uses.split_whitespace().map(|name| Path::new("shaders/shared").join(name));
    for part in shared.chain([path.to_path_buf()]) {
        source.parts.push((source.text.lines().count() + 1, part.clone()));
        source.text.push_str(&read(&part)?);
        source.text.push('\n');
    }
    Ok(source)
}

impl Source {
    /// naga's error, with the file and line that it means.
    fn located(&self, line: Option<u32>, message: &str) -> String {
        let line = line.unwrap_or(1) as usize;
        let part = self.parts.iter().rev().find(|(first, _)| *first <= line);
        match part {
            Some((first, file)) => format!("{}:{}: {message}", file.display(), line - first + 1),
            None => message.to_string(),
        }
    }
}

/// One row of the table: name, source, bindings, overrides.
fn entry(path: &Path) -> Result<String, String> {
    let source = assemble(path)?;
    let module = naga::front::wgsl::parse_str(&source.text).map_err(|error| {
        let line = error.location(&source.text).map(|location| location.line_number);
        source.located(line, &error.emit_to_string(&source.text))
    })?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module).map_err(|error| {
        let line = error.location(&source.text).map(|location| location.line_number);
        source.located(line, &error.emit_to_string(&source.text))
    })?;
    let [entry_point] = module.entry_points.as_slice() else {
        return Err(format!("{}: a kernel file has one entry point", path.display()));
    };
    let name = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
    let mut row = format!("KernelSource {{ name: {name:?}, entry_point: {:?}, bindings: &[", entry_point.name);
    let mut bindings = Vec::new();
    for (handle, global) in module.global_variables.iter() {
        // A shared file may declare what this kernel does not touch.
        if info.get_entry_point(0)[handle].is_empty() {
            continue;
        }
        let (Some(binding), Some(variable)) = (&global.binding, &global.name) else { continue };
        let kind = match global.space {
            naga::AddressSpace::Uniform => "Uniform",
            naga::AddressSpace::Storage { access } if access.contains(naga::StorageAccess::STORE) => "ReadWrite",
            naga::AddressSpace::Storage { .. } => "Read",
            _ => return Err(format!("{}: unexpected binding `{variable}`", path.display())),
        };
        bindings.push((binding.binding, variable.clone(), kind));
    }
    bindings.sort();
    for (index, variable, kind) in bindings {
        let _ = write!(row, "Binding {{ index: {index}, name: {variable:?}, access: Access::{kind} }}, ");
    }
    row.push_str("], overrides: &[");
    for (_, constant) in module.overrides.iter() {
        if let Some(name) = &constant.name {
            let _ = write!(row, "({name:?}, {}), ", constant.init.is_none());
        }
    }
    let _ = writeln!(row, "], source: {:?} }},", source.text);
    Ok(row)
}
