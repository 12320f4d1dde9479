//! Small inputs that once went wrong, each with the value or the message that is right.
//!
//! Inputs lie in `inputs/`, a folder for each fault; what is one line of a known scene is made where it is used.

mod borders;
mod first_scenes;
mod folders;
mod gas;
mod inflators;
mod meshes;
mod mistakes;
mod plan;
mod plausible;
mod vents;
mod walls;

use std::path::{Path, PathBuf};

use assert_cmd::Command;

/// The path of an input.
#[allow(dead_code)]
fn input(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/inputs").join(name)
}

/// The program, without colours.
#[allow(dead_code)]
fn corpuscle(arguments: &[&str]) -> Command {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("corpuscle");
    // Silences a warning of Mesa's device selection layer.
    command.env("NODEVICE_SELECT", "1").env("NO_COLOR", "1").args(arguments);
    command
}

/// Exit code, standard output and standard error.
#[allow(dead_code)]
fn outcome(arguments: &[&str]) -> (i32, String, String) {
    let output = corpuscle(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap_or(-1), text(output.stdout), text(output.stderr))
}
