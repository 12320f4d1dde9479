//! What a program says of its own version.
//!
//! `CORPUSCLE_SOURCE` is a number of all sources, by which ranks see that they are of one build. `CORPUSCLE_COMMIT` is
//! the last commit of the working tree that changed sources, marked where they are others; not set where there is none,
//! or no git. It is found anew only where sources change: a commit of anything else builds nothing, and sources that are
//! committed as they were built stay marked. `CORPUSCLE_VERSION` is the package's with that commit.

use std::path::Path;
use std::{fs, process};

/// What a build is made of.
pub const SOURCES: [&str; 5] = ["Cargo.lock", "build", "build.rs", "shaders", "src"];
const FNV_START: u64 = 0xcbf2_9ce4_8422_2325;
const FNV_PRIME: u64 = 0x100_0000_01b3;

/// Tells Cargo what the program is compiled with.
pub fn tell() -> Result<(), String> {
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
