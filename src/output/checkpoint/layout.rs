//! Names and layout of what a checkpoint is made of, and where the newest of a run is.

use std::path::{Path, PathBuf};

use super::CheckpointError;
use crate::output::error::PARTIAL_SUFFIX;
use crate::output::marker::check_marker;
use crate::output::names::CHECKPOINT_FOLDER;

/// The format of the files' layout and of what is in `state.bin`; another is refused.
pub const FORMAT: u32 = 13;
/// Complete checkpoints that stay.
pub const KEPT: usize = 2;
/// One particle.
pub const RECORD_BYTES: usize = 32;
/// A record's id is in the low 27 bits of the little-endian word at this offset.
pub(super) const ID_OFFSET: usize = 12;
pub(super) const ID_MASK: u32 = (1 << 27) - 1;

pub(super) const MANIFEST: &str = "manifest.toml";
pub(super) const SCENE: &str = "scene.toml";
pub(super) const PLAN: &str = "plan.toml";
pub(super) const STATE: &str = "state.bin";
/// Ends the name of a folder that is being removed.
pub(super) const REMOVED_SUFFIX: &str = ".removed";

pub(super) fn particle_file(rank: usize) -> String {
    format!("particles-{rank:04}.bin")
}

pub(super) fn folder_name(step: u64) -> String {
    format!("step-{step:010}")
}

/// The step of a complete checkpoint's folder.
pub(super) fn step_of(name: &str) -> Option<u64> {
    let digits = name.strip_prefix("step-")?;
    let sound = digits.len() >= 10 && digits.bytes().all(|byte| byte.is_ascii_digit());
    let step = digits.parse().ok().filter(|_| sound)?;
    (folder_name(step) == name).then_some(step)
}

/// Complete, partial or about to be removed.
pub(in crate::output) fn is_checkpoint_folder(name: &str) -> bool {
    step_of(name.trim_end_matches(PARTIAL_SUFFIX).trim_end_matches(REMOVED_SUFFIX)).is_some()
}

/// Whether it is the folder of a checkpoint that a kill has cut short.
pub(in crate::output) fn is_left_over(name: &str) -> bool {
    let unfinished = name.ends_with(PARTIAL_SUFFIX) || name.ends_with(REMOVED_SUFFIX);
    unfinished && is_checkpoint_folder(name)
}

pub(in crate::output) fn is_checkpoint_file(name: &str) -> bool {
    let numbered = || name.strip_prefix("particles-")?.strip_suffix(".bin")?.parse::<usize>().ok();
    [MANIFEST, SCENE, PLAN, STATE].contains(&name) || numbered().is_some_and(|rank| particle_file(rank) == name)
}

/// The folders in `folder`, by step; complete ones only.
pub(super) fn complete(folder: &Path) -> Result<Vec<(u64, PathBuf)>, CheckpointError> {
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
    let inner = path.join(CHECKPOINT_FOLDER);
    let folder = if inner.is_dir() { inner } else { path.to_path_buf() };
    if !folder.is_dir() {
        return Err(no_folder(folder));
    }
    let newest = complete(&folder)?.pop();
    newest.map(|(_, path)| path).ok_or_else(|| match check_marker(path) {
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
    if path.starts_with(from.join(CHECKPOINT_FOLDER)) {
        return from.to_path_buf();
    }
    // A relative path may have too few parts.
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    whole.ancestors().nth(2).unwrap_or(&whole).to_path_buf()
}
