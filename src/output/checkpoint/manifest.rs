//! `manifest.toml`: what a checkpoint is of, and what belongs to it.
//!
//! The first line says what the file is and its format; the last is the CRC-32 of all bytes before it. In between is
//! TOML, so that people can read it.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::error::CheckpointError;
use super::layout::{FORMAT, PLAN, RECORD_BYTES, SCENE, STATE, is_checkpoint_file};
use crate::output::{AdapterRecord, MeshRecord};

const FIRST_LINE: &str = "# corpuscle checkpoint, format ";
const LAST_LINE: &str = "# crc32 of the lines above: ";
/// Far more than the ranks of any machine need.
pub(super) const MOST_BYTES: u64 = 64 << 20;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// Of the program that wrote it.
    pub version: String,
    pub step: u64,
    /// s.
    pub time: f64,
    /// All particles at that moment.
    pub particles: u64,
    /// Particles that had entered till then: ids are below.
    pub ids: u64,
    /// The unit system in which the run tells what it tells; its scene is in SI.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub units: Option<String>,
    pub adapter: Adapter,
    /// All files but the manifest.
    pub file: Vec<FileRecord>,
    /// The meshes that the scene names, in the order of its walls; copies of them are in the run's folder.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mesh: Vec<MeshRecord>,
}

/// What the particles were computed on: the same bits need the same.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Adapter {
    pub name: String,
    pub driver: String,
}

/// One file of the checkpoint.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileRecord {
    pub name: String,
    pub bytes: u64,
    pub crc32: u32,
    /// Particles in it; zero in other files.
    pub particles: u64,
}

impl From<&AdapterRecord> for Adapter {
    fn from(record: &AdapterRecord) -> Adapter {
        let driver = format!("{} {}", record.driver, record.driver_info).trim().to_owned();
        Adapter { name: record.name.clone(), driver }
    }
}

fn first_line() -> String {
    format!("{FIRST_LINE}{FORMAT}\n")
}

fn last_line(above: &[u8]) -> String {
    format!("{LAST_LINE}{:08x}\n", crc32fast::hash(above))
}

impl Manifest {
    pub(super) fn to_text(&self) -> Result<String, CheckpointError> {
        let body = toml::to_string(self)
            .map_err(|error| CheckpointError::Encode { what: "the manifest", problem: error.to_string() })?;
        let above = first_line() + &body;
        let last = last_line(above.as_bytes());
        Ok(above + &last)
    }

    /// `path` stands in messages.
    pub(super) fn from_bytes(path: &Path, bytes: &[u8]) -> Result<Manifest, CheckpointError> {
        let path = || path.to_path_buf();
        if !bytes.starts_with(first_line().as_bytes()) {
            return Err(foreign(path(), bytes));
        }
        let (above, last) = bytes.split_at(bytes.len().saturating_sub(last_line(&[]).len()));
        if last != last_line(above).as_bytes() {
            let written = String::from_utf8_lossy(last);
            let written = written.trim_end().strip_prefix(LAST_LINE).unwrap_or("another").to_owned();
            return Err(CheckpointError::Checksum { path: path(), found: crc32fast::hash(above), expected: written });
        }
        let content = |problem: String| CheckpointError::Content { path: path(), problem };
        let text = std::str::from_utf8(above).map_err(|error| content(error.to_string()))?;
        let manifest: Manifest = toml::from_str(text).map_err(|error| content(error.to_string()))?;
        manifest.check().map_err(content)?;
        Ok(manifest)
    }

    /// The files of particles, in the order of the ranks that wrote them.
    pub fn particle_files(&self) -> impl Iterator<Item = &FileRecord> {
        self.file.iter().filter(|file| file.name.starts_with("particles-"))
    }

    fn check(&self) -> Result<(), String> {
        // A name with a path in it would lead out of the folder.
        if let Some(file) = self.file.iter().find(|file| !is_checkpoint_file(&file.name)) {
            return Err(format!("it names a file {:?}, which is none of a checkpoint", file.name));
        }
        let mut names: Vec<&str> = self.file.iter().map(|file| file.name.as_str()).collect();
        names.sort_unstable();
        if let Some(pair) = names.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(format!("it names {} twice", pair[0]));
        }
        for needed in [SCENE, PLAN, STATE] {
            if !names.contains(&needed) {
                return Err(format!("it does not name {needed}"));
            }
        }
        let in_files = self.particle_files().try_fold(0u64, |sum, file| sum.checked_add(file.particles));
        let bounded = self.particles.checked_mul(RECORD_BYTES as u64).is_some();
        if in_files != Some(self.particles) || !bounded || self.particles > self.ids {
            let files = in_files.map_or("too many".to_owned(), |sum| sum.to_string());
            return Err(format!(
                "its files hold {files} particles, {} are said to be there of {} that entered",
                self.particles, self.ids
            ));
        }
        Ok(())
    }
}

/// Another format, or another file altogether.
fn foreign(path: PathBuf, bytes: &[u8]) -> CheckpointError {
    let line = bytes.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let line = String::from_utf8_lossy(&line[..line.len().min(80)]).into_owned();
    let other = line.strip_prefix(FIRST_LINE).and_then(|format| format.parse().ok());
    match other.filter(|&format| format != u64::from(FORMAT)) {
        Some(found) => CheckpointError::OtherFormat { path, found, expected: FORMAT },
        None => CheckpointError::Foreign { path, found: line, expected: first_line().trim_end().to_owned() },
    }
}
