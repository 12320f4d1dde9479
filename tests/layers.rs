//! Law: a module of `src` imports only modules of layers below its own.
//!
//! `cli -> study -> simulation -> subdomain, fabric, partition, ranks, output -> gpu, plan -> gas, geometry
//! -> scene`; besides, `gpu`, `partition` and `ranks` import no module of ours.

use std::fs;
use std::path::{Path, PathBuf};

/// From the top down; modules of one layer do not import each other.
const LAYERS: &[&[&str]] = &[
    &["cli"],
    &["study"],
    &["simulation"],
    &["subdomain", "fabric", "partition", "ranks", "output"],
    &["gpu", "plan"],
    &["gas", "geometry"],
    &["scene"],
];

/// Modules that stand on their own.
const ALONE: &[&str] = &["gpu", "partition", "ranks"];

fn layer(module: &str) -> Option<usize> {
    LAYERS.iter().position(|layer| layer.contains(&module))
}

/// The identifiers at the start of `text`'s paths: of `a::b` a, of `{a::b, c}` a and c.
fn heads(text: &str) -> Vec<&str> {
    let head = |text: &'_ str| text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len());
    let Some(list) = text.strip_prefix('{') else { return vec![&text[..head(text)]] };
    let (mut depth, mut start, mut found) = (0, 0, Vec::new());
    for (at, c) in list.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth > 0 => depth -= 1,
            ',' | '}' if depth == 0 => {
                let entry = list[start..at].trim();
                found.push(&entry[..head(entry)]);
                start = at + 1;
                if c == '}' {
                    break;
                }
            }
            _ => {}
        }
    }
    found
}

/// The modules of the crate that a source file names. `depth` is how many `super` lead from the file to the
/// crate's root.
fn imports(source: &str, depth: usize) -> Vec<String> {
    let code: Vec<&str> = source.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
    let code = code.join("\n");
    let root = "super::".repeat(depth);
    let mut found = Vec::new();
    for prefix in ["crate::", root.as_str()] {
        for (at, _) in code.match_indices(prefix) {
            let before = code[..at].chars().next_back().unwrap_or(' ');
            // `$crate::`, another identifier's end, or a longer chain of `super`.
            if before.is_alphanumeric() || matches!(before, '_' | '$' | ':') {
                continue;
            }
            let names = heads(&code[at + prefix.len()..]).into_iter();
            found.extend(names.filter(|name| layer(name).is_some()).map(str::to_owned));
        }
    }
    found
}

/// What is wrong with a file of `module`.
fn violations(module: &str, source: &str, depth: usize) -> Vec<String> {
    let Some(own) = layer(module) else { return vec![format!("`{module}` is in no layer")] };
    let allowed = |name: &str| name == module || (layer(name) > Some(own) && !ALONE.contains(&module));
    let wrong = imports(source, depth).into_iter().filter(|name| !allowed(name));
    wrong.map(|name| format!("`{module}` imports `{name}`")).collect()
}

fn rust_files(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            rust_files(&path, into);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            into.push(path);
        }
    }
}

#[test]
fn every_import_points_down() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    rust_files(&src, &mut files);
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for path in files {
        let inside = path.strip_prefix(&src).expect("below src");
        let parts: Vec<String> = inside.iter().map(|part| part.to_string_lossy().into_owned()).collect();
        let [module, .., file] = parts.as_slice() else {
            assert!(["lib.rs", "main.rs"].contains(&parts[0].as_str()), "a module is a folder, not {}", parts[0]);
            continue;
        };
        let depth = parts.len() - usize::from(file == "mod.rs");
        let source = fs::read_to_string(&path).expect("text");
        seen += imports(&source, depth).len();
        wrong.extend(violations(module, &source, depth).iter().map(|text| format!("{}: {text}", inside.display())));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(seen > 50, "only {seen} imports were seen: the search has gone blind");
}

/// The check can fail: each way to write an upward or sideways import is found, and no other.
#[test]
fn a_violation_is_found() {
    let one = |module: &str, source: &str, depth: usize| violations(module, source, depth).len();
    assert_eq!(one("gas", "use crate::plan::Plan;", 2), 1);
    assert_eq!(one("gas", "fn f(x: &crate::geometry::Grid) {}", 2), 1);
    assert_eq!(one("plan", "use crate::{gas::Inflow, gpu::{Device, fold}, scene};", 2), 1);
    assert_eq!(one("plan", "use crate::{\n    gas,\n    simulation::Model,\n};", 2), 1);
    assert_eq!(one("scene", "use super::gas;", 1), 1);
    assert_eq!(one("scene", "use super::super::gas;", 2), 1);
    assert_eq!(one("gpu", "use crate::scene::Scene;", 2), 1);
    assert_eq!(one("toolbox", "", 2), 1);
    // Downward, within the module, in a comment, or a child of the same name as a module.
    assert_eq!(one("gas", "use crate::scene::Gas;\nuse crate::gas::Draws;\n// see crate::plan::Plan", 2), 0);
    assert_eq!(one("simulation", "use super::plan;", 2), 0);
}
