//! Pages of results and the view of a running one, as their readers have them.
//!
//! `pages` looks at the files, `browser` at what a browser makes of them (it needs Chromium and its driver; without them
//! it says so), `folders` at folders that are broken or have nothing to show, `watching` at runs that go on, `large` at
//! what a page of a long run of many particles weighs.

mod browser;
mod driver;
mod folders;
mod large;
mod pages;
mod watching;

use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn corpuscle(arguments: &[&str]) -> Command {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("corpuscle");
    command.current_dir(ROOT).env("NODEVICE_SELECT", "1").env("NO_COLOR", "1").args(arguments);
    command
}

/// Exit code, standard output and standard error.
fn outcome(arguments: &[&str]) -> (i32, String, String) {
    let output = corpuscle(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

/// Writes the report of folders; returns its path.
fn reported(arguments: &[&str]) -> PathBuf {
    let (code, out, err) = outcome(&[&["report"], arguments].concat());
    assert_eq!(code, 0, "{err}");
    PathBuf::from(out.trim())
}

/// A published scene that ends at `end` (s), with these words replaced, in a file of the folder.
fn scene(folder: &Path, name: &str, end: &str, replace: &[(&str, &str)]) -> PathBuf {
    let mut text = fs::read_to_string(Path::new(ROOT).join("scenes").join(name)).unwrap();
    let line = text.lines().find(|line| line.starts_with("end_time")).unwrap().to_owned();
    text = text.replace(&line, &format!("end_time = {end}"));
    for (old, new) in replace {
        assert!(text.contains(old), "{old} is not in {name}");
        text = text.replace(old, new);
    }
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path
}

/// Runs it into a folder.
fn run(scene: &Path, out: &Path, more: &[&str]) -> PathBuf {
    let basic = ["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap()];
    let (code, _, err) = outcome(&[&basic, more].concat());
    assert_eq!(code, 0, "{err}");
    out.to_path_buf()
}

/// A run of 64 steps of 500 particles at rest.
fn short_run(out: &Path, more: &[&str]) -> PathBuf {
    let basic = ["--particles", "500", "--steps", "64"];
    run(&Path::new(ROOT).join("scenes/box.toml"), out, &[&basic, more].concat())
}

/// The bag that is squeezed, with six snapshots.
fn bag(folder: &Path) -> PathBuf {
    let beside = |name: &str| format!("\"{ROOT}/scenes/{name}\"");
    let files = [("\"bag.obj\"", beside("bag.obj")), ("\"bag.nodes\"", beside("bag.nodes"))];
    let files = files.each_ref().map(|(old, new)| (*old, new.as_str()));
    let scene = scene(folder, "bag.toml", "5e-3", &files);
    run(&scene, &folder.join("bag"), &["--particles", "1000", "--report"])
}
