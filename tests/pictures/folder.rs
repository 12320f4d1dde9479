//! Runs of a box with a gas in either half, and pictures of them.

use std::path::{Path, PathBuf};

use assert_cmd::Command;

const SCENE: &str = r#"
title = "Two halves"
end_time = 1e-4

[[gas]]
name = "air"
molar_mass = 0.02897
gamma = 1.4

[[gas]]
name = "helium"
molar_mass = 0.0040026
gamma = 1.6666666666666667

[[wall]]
name = "box"
shape = "box"
min = [0.0, 0.0, 0.0]
max = [0.2, 0.1, 0.1]
gas = "inside"

[[chamber]]
name = "left"
region = { box = { min = [0.0, 0.0, 0.0], max = [0.1, 0.1, 0.1] } }
pressure = 1e5
temperature = 300.0
gas = "air"

[[chamber]]
name = "right"
pressure = 1e5
temperature = 300.0
gas = "helium"

[model]
method = "closest-approach"
particles = 2000
"#;

/// Exit code, standard output and standard error of the program.
pub fn outcome(arguments: &[&str]) -> (i32, String, String) {
    let mut command: Command = assert_cmd::cargo::cargo_bin_cmd!("corpuscle");
    let command = command.env("NODEVICE_SELECT", "1").env("NO_COLOR", "1").args(arguments);
    let output = command.output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

/// A whole run with four snapshots, unless `more` of its scene says otherwise.
pub fn finished_run(dir: &Path, more: &str) -> PathBuf {
    run(dir, more, &[])
}

pub fn run(dir: &Path, more: &str, options: &[&str]) -> PathBuf {
    let (scene, folder) = (dir.join("halves.toml"), dir.join("halves"));
    let output = if more.is_empty() { "\n[output]\nsnapshots = 3\n" } else { more };
    std::fs::write(&scene, SCENE.to_owned() + output).unwrap();
    let basic = ["run", scene.to_str().unwrap(), "--out", folder.to_str().unwrap(), "-q"];
    let (code, _, err) = outcome(&[&basic, options].concat());
    assert_eq!(code, 0, "{err}");
    folder
}

/// Lays the walls of a run beside its first snapshot as fabric.
pub fn add_fabric(run: &Path) {
    let snapshots = run.join("snapshots");
    let bytes = std::fs::read(snapshots.join("walls.vtp")).unwrap();
    // A character for each byte: the arrays behind the head stay as they are.
    let text: String = bytes.iter().map(|&byte| char::from(byte)).collect();
    let bytes: Vec<u8> = text.replace("Name=\"wall", "Name=\"fabric").chars().map(|c| c as u8).collect();
    std::fs::write(snapshots.join("fabric_000000.vtp"), bytes).unwrap();
}

/// A picture of a run or a mesh, without a word but its path.
pub fn rendered(subject: &Path, options: &[&str]) -> PathBuf {
    let (code, said, err) = outcome(&[&["render", subject.to_str().unwrap()], options].concat());
    assert_eq!((code, err.as_str()), (0, ""), "{options:?}");
    PathBuf::from(said.trim_end())
}
