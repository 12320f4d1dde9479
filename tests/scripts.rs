//! The scripts install only what is missing, and say what and why where they cannot.
//!
//! Each test gives `setup.sh` a PATH of stand-ins, so that nothing is really installed.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder of programs that alone make up PATH.
struct Programs(tempfile::TempDir);

impl Programs {
    /// The plain tools that the scripts call, and a Rust of this version.
    fn with_rust(version: &str) -> Programs {
        let programs = Programs(tempfile::tempdir().unwrap());
        for tool in ["bash", "env", "dirname", "basename", "sed", "sort"] {
            let real = ["/usr/bin", "/bin"].map(|dir| Path::new(dir).join(tool));
            let real = real.iter().find(|path| path.exists()).unwrap();
            symlink(real, programs.0.path().join(tool)).unwrap();
        }
        programs.add("cargo", "exit 0");
        programs.add("ldconfig", "exit 0");
        programs.add("rustc", &format!("echo 'rustc {version} (59807616e 2026-04-14)'"));
        programs
    }

    fn add(&self, name: &str, body: &str) {
        let path = self.0.path().join(name);
        fs::write(&path, format!("#!/bin/sh\n{body}\n")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }

    /// Where stand-ins note what they were asked.
    fn log(&self) -> PathBuf {
        self.0.path().join("log")
    }

    fn logs(&self, name: &str) {
        self.add(name, &format!("echo {name} \"$@\" >> '{}'", self.log().display()));
    }

    /// Runs the script as if its libclang were where the user says: fixed folders cannot be stood in for.
    fn run(&self, script: &str, arguments: &[&str]) -> Output {
        Command::new("/bin/bash")
            .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join(script))
            .args(arguments)
            .env("PATH", self.0.path())
            .env("LIBCLANG_PATH", self.0.path())
            .current_dir(self.0.path())
            .output()
            .unwrap()
    }

    fn noted(&self) -> String {
        fs::read_to_string(self.log()).unwrap_or_default()
    }
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_missing_or_old_rust_is_told_and_a_new_one_is_not() {
    let programs = Programs::with_rust("1.70.0");
    let old = programs.run("scripts/setup.sh", &[]);
    assert!(!old.status.success());
    assert!(said(&old).contains("Rust 1.70.0 is too old"), "{}", said(&old));
    fs::remove_file(programs.0.path().join("cargo")).unwrap();
    let none = programs.run("scripts/setup.sh", &[]);
    assert!(!none.status.success() && said(&none).contains("Rust is missing"), "{}", said(&none));
    for version in ["1.95.0", "1.100.1", "2.0.0-nightly"] {
        let new = Programs::with_rust(version).run("scripts/setup.sh", &[]);
        assert!(!said(&new).contains("Rust"), "{version}: {}", said(&new));
    }
}

#[test]
fn only_what_is_missing_is_installed_and_named() {
    let programs = Programs::with_rust("1.95.0");
    programs.logs("apt-get");
    programs.logs("sudo");
    programs.add("id", "echo 0");
    // A compiler without the C library, and no library cache.
    programs.add("cc", "exit 1");
    let output = programs.run("scripts/setup.sh", &[]);
    assert!(output.status.success(), "{}", said(&output));
    assert!(said(&output).contains("installing libc6-dev libvulkan1"), "{}", said(&output));
    let noted = programs.noted();
    assert!(noted.contains("apt-get update"), "{noted}");
    assert!(noted.contains("apt-get install") && noted.contains("libc6-dev libvulkan1"), "{noted}");
    assert!(noted.contains("libopenmpi-dev openmpi-bin"), "{noted}");
    assert!(!noted.contains("gcc") && !noted.contains("sudo"), "{noted}");
    // With compiler, library and MPI's launcher there, none is named any more.
    programs.add("cc", "exit 0");
    programs.add("ldconfig", "echo 'libvulkan.so.1 (libc6,x86-64) => /usr/lib/libvulkan.so.1'");
    programs.add("mpirun", "exit 0");
    fs::remove_file(programs.log()).unwrap();
    assert!(programs.run("scripts/setup.sh", &[]).status.success());
    let noted = programs.noted();
    assert!(!noted.contains("libc6-dev") && !noted.contains("libvulkan1"), "{noted}");
    assert!(noted.contains("libopenmpi-dev") && !noted.contains("openmpi-bin"), "{noted}");
    // libclang has not been named all the while: see `Programs::run`.
    programs.add("mpicc", "exit 0");
    let _ = fs::remove_file(programs.log());
    assert!(programs.run("scripts/setup.sh", &[]).status.success());
    let noted = programs.noted();
    assert!(!noted.contains("openmpi") && !noted.contains("libclang-dev"), "{noted}");
}

#[test]
fn root_is_asked_for_through_sudo_and_its_absence_is_told() {
    let programs = Programs::with_rust("1.95.0");
    programs.logs("apt-get");
    programs.add("id", "echo 1000");
    let helpless = programs.run("scripts/setup.sh", &[]);
    assert!(!helpless.status.success());
    assert!(said(&helpless).contains("Neither root nor sudo"), "{}", said(&helpless));
    assert_eq!(programs.noted(), "", "nothing is tried without the right to");
    programs.logs("sudo");
    assert!(programs.run("scripts/setup.sh", &[]).status.success());
    assert!(programs.noted().contains("sudo env DEBIAN_FRONTEND=noninteractive apt-get install"));
}

#[test]
fn without_apt_the_missing_packages_are_told() {
    let output = Programs::with_rust("1.95.0").run("scripts/setup.sh", &[]);
    assert!(!output.status.success());
    assert!(said(&output).contains("gcc libc6-dev"), "{}", said(&output));
    assert!(said(&output).contains("no apt-get here"), "{}", said(&output));
}

#[test]
fn a_wrong_call_is_told_before_anything_is_built() {
    let programs = Programs::with_rust("1.95.0");
    programs.logs("cargo");
    let no_scene = programs.run("scripts/run.sh", &["--particles", "20000"]);
    assert_eq!(no_scene.status.code(), Some(2));
    assert!(said(&no_scene).contains("usage:"), "{}", said(&no_scene));
    let unknown = programs.run("scripts/test.sh", &["--short"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(said(&unknown).contains("--long"), "{}", said(&unknown));
    assert_eq!(programs.noted(), "");
}

/// A machine on which nothing is missing, where `corpuscle run` ends with `status`.
fn complete(status: u8) -> Programs {
    let programs = Programs::with_rust("1.95.0");
    for tool in ["cc", "mpicc", "mpirun"] {
        programs.add(tool, "exit 0");
    }
    programs.add("ldconfig", "echo 'libvulkan.so.1 (libc6) => /usr/lib/libvulkan.so.1'");
    // The driver's manifest is looked up in fixed folders: where it is missing an installation is noted.
    programs.add("id", "echo 0");
    programs.add("apt-get", "exit 0");
    let log = programs.log();
    programs.add(
        "cargo",
        &format!(
            "echo cargo \"$@\" >> '{}'\nif [ \"$1\" = run ]; then /bin/mkdir -p results/tank chosen; exit {status}; fi",
            log.display()
        ),
    );
    programs
}

#[test]
fn a_run_builds_then_runs_and_ends_with_the_path_of_its_results() {
    let programs = complete(0);
    let output = programs.run("scripts/run.sh", &["scenes/tank.toml", "--particles", "20000"]);
    assert!(output.status.success(), "{}", said(&output));
    let noted = programs.noted();
    let mut lines = noted.lines();
    let build = lines.next().unwrap();
    assert!(build.starts_with("cargo build --release") && build.contains("--features mpi"), "{noted}");
    assert!(lines.next().unwrap().ends_with("run scenes/tank.toml --particles 20000 --out results/tank"), "{noted}");
    let last = |output: &Output| String::from_utf8_lossy(&output.stdout).lines().last().unwrap_or_default().to_owned();
    assert!(last(&output).starts_with("Results: /") && last(&output).ends_with("/results/tank"));
    let chosen = programs.run("scripts/run.sh", &["scenes/tank.toml", "--out", "chosen"]);
    assert!(last(&chosen).ends_with("/chosen"));
    assert!(programs.noted().trim_end().ends_with("run scenes/tank.toml --out chosen"));
}

#[test]
fn a_run_passes_on_its_exit_status() {
    for (status, with_results) in [(2, false), (3, false), (4, true), (143, true)] {
        let output = complete(status).run("scripts/run.sh", &["scenes/tank.toml"]);
        assert_eq!(output.status.code(), Some(i32::from(status)));
        assert_eq!(String::from_utf8_lossy(&output.stdout).contains("Results:"), with_results);
    }
}

#[test]
fn every_script_parses_and_may_be_executed() {
    let parses = |path: &Path| Command::new("bash").arg("-n").arg(path).output().unwrap().status.success();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for script in ["scripts/setup.sh", "scripts/run.sh", "scripts/test.sh", ".ci/run"] {
        let path = root.join(script);
        assert!(parses(&path), "{script}");
        assert_ne!(fs::metadata(&path).unwrap().permissions().mode() & 0o111, 0, "{script}");
    }
    let dir = tempfile::tempdir().unwrap();
    let broken = dir.path().join("broken.sh");
    fs::write(&broken, "if true; then\n").unwrap();
    assert!(!parses(&broken));
}
