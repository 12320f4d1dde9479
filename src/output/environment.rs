//! The record of what a run ran on: `environment.json`.
//!
//! Same bits mean the same adapter model and driver (method.md, "Equal bits"): this file says which they were.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::OutputError;
use super::error::write_atomically;
use super::names::ENVIRONMENT_FILE;
use crate::scene::UnitSystem;

#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Environment {
    /// Of corpuscle.
    pub version: String,
    /// The command line, program first.
    pub command: Vec<String>,
    /// For instance `linux (Debian GNU/Linux 12 (bookworm))`.
    pub os: String,
    /// Of the processor, for instance `x86_64`.
    pub architecture: String,
    /// Threads that the host offers to this process.
    pub cpu_count: usize,
    /// That of the scene file, as it names it: a recorded scene is in SI. Empty in the record of an older version.
    #[serde(default)]
    pub units: String,
    pub adapter: AdapterRecord,
}

#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct AdapterRecord {
    pub name: String,
    pub backend: String,
    pub driver: String,
    pub driver_info: String,
    pub device_type: String,
    /// That of the kernels (`docs/reference/performance.md`, "What a software device does"); empty in the record of an older version.
    #[serde(default)]
    pub form: String,
    pub limits: BTreeMap<String, u64>,
    pub features: Vec<String>,
}

impl Environment {
    /// This program and this host, with the adapter that was chosen.
    pub fn of_this_host(command: Vec<String>, adapter: AdapterRecord) -> Environment {
        Environment {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            command,
            os: os_name(std::fs::read_to_string("/etc/os-release").ok().as_deref()),
            architecture: std::env::consts::ARCH.to_owned(),
            cpu_count: std::thread::available_parallelism().map_or(1, usize::from),
            units: String::new(),
            adapter,
        }
    }

    /// Of a run whose scene file has these units.
    pub fn in_units(self, system: UnitSystem) -> Environment {
        Environment { units: system.name().to_owned(), ..self }
    }

    /// Writes `environment.json` into the existing folder `dir`; returns its path.
    pub fn write(&self, dir: &Path) -> Result<PathBuf, OutputError> {
        let path = dir.join(ENVIRONMENT_FILE);
        write_atomically(&path, |out| {
            serde_json::to_writer_pretty(&mut *out, self)?;
            out.write_all(b"\n")
        })?;
        Ok(path)
    }
}

/// The name of this machine.
pub fn host_name() -> String {
    std::fs::read_to_string("/proc/sys/kernel/hostname")
        .map_or_else(|_| "this machine".into(), |name| name.trim().into())
}

/// The system's kind, and its own name for itself where `os-release` gives one.
fn os_name(os_release: Option<&str>) -> String {
    let kind = std::env::consts::OS;
    let pretty = os_release
        .unwrap_or_default()
        .lines()
        .find_map(|line| line.strip_prefix("PRETTY_NAME="))
        .map(|name| name.trim_matches(['"', '\'']));
    match pretty {
        Some(name) if !name.is_empty() => format!("{kind} ({name})"),
        _ => kind.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_record_reads_back_as_written_and_differs_with_the_driver() {
        let dir = tempfile::tempdir().unwrap();
        let adapter = AdapterRecord {
            name: "llvmpipe \"quoted\"".to_owned(),
            backend: "Vulkan".to_owned(),
            driver: "llvmpipe".to_owned(),
            driver_info: "Mesa 22.3.6".to_owned(),
            device_type: "Cpu".to_owned(),
            form: "software".to_owned(),
            limits: [("max_buffer_size".to_owned(), u64::MAX)].into(),
            features: vec!["TIMESTAMP_QUERY".to_owned()],
        };
        let command = vec!["corpuscle".to_owned(), "run".to_owned(), "a scene.toml".to_owned()];
        let mut written = Environment::of_this_host(command, adapter);
        let path = written.write(dir.path()).unwrap();
        let text = std::fs::read_to_string(path).unwrap();
        let read: Environment = serde_json::from_str(&text).unwrap();
        assert_eq!(read, written);
        assert!(read.cpu_count > 0 && read.version == env!("CARGO_PKG_VERSION"));
        written.adapter.driver_info = "Mesa 25.0.0".to_owned();
        assert_ne!(read, written);
    }

    #[test]
    fn the_systems_name_is_taken_from_os_release_where_there_is_one() {
        let named = os_name(Some("ID=debian\nPRETTY_NAME=\"Debian 12\"\n"));
        assert_eq!(named, format!("{} (Debian 12)", std::env::consts::OS));
        assert_eq!(os_name(Some("ID=debian\n")), std::env::consts::OS);
        assert_eq!(os_name(None), std::env::consts::OS);
    }
}
