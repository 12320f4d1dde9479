//! Checkpoints on disc: one folder each, `checkpoints/step-0000123456/`.
//!
//! | file | what |
//! |---|---|
//! | `manifest.toml` | versions, moment, adapter, and the length and CRC-32 of every other file; its last line is its own CRC-32 |
//! | `scene.toml`, `plan.toml` | as at the start of the run: a resume needs nothing else but the copies of meshes that are in the folder of the run |
//! | `state.bin` | all that is not particles, postcard in zstd |
//! | `particles-0000.bin`, ... | records of [`RECORD_BYTES`], one file per rank, in zstd |
//!
//! **Writing.** All files go into `step-0000123456.partial` and are flushed to the disc, then the folder; it is renamed,
//! and the parent flushed. Only then are older checkpoints removed, all but [`KEPT`]. So a kill at any moment leaves
//! the last good one, and a folder with a plain name is complete.
//!
//! **Reading.** [`Checkpoint::open`] believes nothing before its checksum: first the manifest, then sizes and checksums of
//! all files, then that particles are those of the manifest, each id once. Memory is asked for as data come, never by a
//! length that a file claims.
//!
//! Knows of a particle only its size and where its id is; of the state only that serde can read it.

mod error;
mod manifest;
mod origin;
mod read;
#[cfg(test)]
mod tests;
mod write;

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::error::PARTIAL_SUFFIX;
use super::{HistoryState, SnapshotState};

pub use error::CheckpointError;
pub use manifest::{Adapter, FileRecord, Manifest};
pub use origin::Origin;
pub(super) use origin::length_and_crc;
pub use read::Checkpoint;
pub use write::{CheckpointWriter, Moment, forget_after};

/// Of the files' layout and of what is in `state.bin`; another is refused.
pub const FORMAT: u32 = 9;
/// Complete checkpoints that stay.
pub const KEPT: usize = 2;
/// One particle.
pub const RECORD_BYTES: usize = 32;
/// A record's id is in the low 28 bits of the little-endian word at this offset.
const ID_OFFSET: usize = 12;
const ID_MASK: u32 = (1 << 28) - 1;

const MANIFEST: &str = "manifest.toml";
const SCENE: &str = "scene.toml";
const PLAN: &str = "plan.toml";
const STATE: &str = "state.bin";
/// Ends the name of a folder that is being removed.
const REMOVED_SUFFIX: &str = ".removed";

/// How far the files of a run had got.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OutputState {
    pub history: HistoryState,
    /// `None` in a scene that wants no snapshots.
    pub snapshots: Option<SnapshotState>,
}

fn particle_file(rank: usize) -> String {
    format!("particles-{rank:04}.bin")
}

fn folder_name(step: u64) -> String {
    format!("step-{step:010}")
}

/// The step of a complete checkpoint's folder.
fn step_of(name: &str) -> Option<u64> {
    let digits = name.strip_prefix("step-")?;
    let sound = digits.len() >= 10 && digits.bytes().all(|byte| byte.is_ascii_digit());
    let step = digits.parse().ok().filter(|_| sound)?;
    (folder_name(step) == name).then_some(step)
}

/// Complete, partial or about to be removed.
pub(super) fn is_checkpoint_folder(name: &str) -> bool {
    step_of(name.trim_end_matches(PARTIAL_SUFFIX).trim_end_matches(REMOVED_SUFFIX)).is_some()
}

/// Whether it is the folder of a checkpoint that a kill has cut short.
pub(super) fn is_left_over(name: &str) -> bool {
    let unfinished = name.ends_with(PARTIAL_SUFFIX) || name.ends_with(REMOVED_SUFFIX);
    unfinished && is_checkpoint_folder(name)
}

pub(super) fn is_checkpoint_file(name: &str) -> bool {
    let numbered = || name.strip_prefix("particles-")?.strip_suffix(".bin")?.parse::<usize>().ok();
    [MANIFEST, SCENE, PLAN, STATE].contains(&name) || numbered().is_some_and(|rank| particle_file(rank) == name)
}

/// The folders in `folder`, by step; complete ones only.
fn complete(folder: &Path) -> Result<Vec<(u64, PathBuf)>, CheckpointError> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(CheckpointError::io("list", folder))? {
        let path = entry.map_err(CheckpointError::io("list", folder))?.path();
        if let Some(step) = path.file_name().and_then(|name| step_of(&name.to_string_lossy()))
            && path.is_dir()
        {
            found.push((step, path));
        }
    }
    found.sort();
    Ok(found)
}

/// The checkpoint that a user means by `path`: itself, or the newest complete one of a run's folder or of its
/// `checkpoints`. What a kill left half written is passed over. It is not looked into: if it is broken,
/// [`Checkpoint::open`] says so and names the one before.
///
/// # Errors
/// If there is none.
pub fn latest(path: &Path) -> Result<PathBuf, CheckpointError> {
    let named = path.file_name().is_some_and(|name| step_of(&name.to_string_lossy()).is_some());
    if path.is_dir() && (named || path.join(MANIFEST).is_file()) {
        return Ok(path.to_path_buf());
    }
    let inner = path.join(super::CHECKPOINT_FOLDER);
    let folder = if inner.is_dir() { inner } else { path.to_path_buf() };
    if !folder.is_dir() {
        return Err(no_folder(folder));
    }
    let newest = complete(&folder)?.pop();
    newest.map(|(_, path)| path).ok_or_else(|| match super::check_marker(path) {
        Ok(()) => CheckpointError::NoneYet { path: path.to_path_buf() },
        Err(_) => CheckpointError::None { path: folder },
    })
}

/// What a path is in place of a folder.
fn no_folder(path: PathBuf) -> CheckpointError {
    if !path.exists() {
        return CheckpointError::Absent { path };
    }
    let is_scene = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
    let (what, help) = if is_scene {
        ("a scene file", "a scene is run by `corpuscle run`; to go on with a run name the folder of its results")
    } else {
        ("a file", "name a run's folder, its `checkpoints` or one of the folders `step-...` in there")
    };
    CheckpointError::NoFolder { path, what, help }
}

/// The folder of the run that the checkpoint `path`, found for `from`, is of.
pub fn run_folder(from: &Path, path: &Path) -> PathBuf {
    if path.starts_with(from.join(super::CHECKPOINT_FOLDER)) {
        return from.to_path_buf();
    }
    // A relative path may have too few parts.
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    whole.ancestors().nth(2).unwrap_or(&whole).to_path_buf()
}
