//! The meshes of a run: what they were, and copies of them in its folder, so that it can go on wherever the originals are.

use std::fs::{self, File};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::OutputError;
use super::checkpoint::CheckpointError;
use super::checksum::length_and_crc;
use super::error::write_atomically;
use super::names::MESH_FOLDER;
use crate::scene::{Fabric, Scene, Shape};

/// One file that a scene names.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshRecord {
    pub path: PathBuf,
    pub bytes: u64,
    pub crc32: u32,
}

/// The meshes of a scene, in the order of its walls.
///
/// # Errors
/// If one cannot be read.
pub fn meshes_of(scene: &Scene) -> Result<Vec<MeshRecord>, CheckpointError> {
    named(scene).map(|path| MeshRecord::of(path)).collect()
}

/// Their paths.
pub fn mesh_paths(scene: &Scene) -> Vec<PathBuf> {
    named(scene).cloned().collect()
}

/// Those of walls, then those of fabric, each with its other files.
fn named(scene: &Scene) -> impl Iterator<Item = &PathBuf> {
    let of_walls = scene.walls.iter().filter_map(|wall| match &wall.shape {
        Shape::Mesh { path, .. } => Some(path),
        _ => None,
    });
    of_walls.chain(scene.fabrics.iter().flat_map(Fabric::files))
}

impl MeshRecord {
    fn of(path: &Path) -> Result<MeshRecord, CheckpointError> {
        let mut file = File::open(path).map_err(CheckpointError::io("read", path))?;
        let (bytes, crc32) = length_and_crc(&mut file).map_err(CheckpointError::io("read", path))?;
        Ok(MeshRecord { path: path.to_path_buf(), bytes, crc32 })
    }

    fn is_of(&self, path: &Path) -> bool {
        MeshRecord::of(path).is_ok_and(|found| (found.bytes, found.crc32) == (self.bytes, self.crc32))
    }

    /// Where the copy is in a run's folder. Meshes of one name and different content have different copies.
    pub fn copy_in(&self, folder: &Path) -> PathBuf {
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        folder.join(MESH_FOLDER).join(format!("{:08x}-{name}", self.crc32))
    }

    /// The file with this content: the copy in the folder `run`, or else the original.
    ///
    /// # Errors
    /// If neither is there as it was.
    pub fn find(&self, run: &Path) -> Result<PathBuf, CheckpointError> {
        let copy = self.copy_in(run);
        let found = [copy.clone(), self.path.clone()].into_iter().find(|path| self.is_of(path));
        found.ok_or_else(|| {
            let there = MeshRecord::of(&self.path).map(|found| (found.bytes, found.crc32));
            CheckpointError::Mesh {
                path: self.path.clone(),
                found: there.map_or_else(
                    |_| "cannot be read".to_owned(),
                    |(bytes, crc32)| format!("has {bytes} bytes with checksum {crc32:08x}"),
                ),
                expected: format!("{} bytes with checksum {:08x}", self.bytes, self.crc32),
                copy,
            }
        })
    }

    /// Copies `source`, which has this content, into the folder of a run.
    ///
    /// # Errors
    /// If the system refuses, or the file was changed in between.
    pub fn keep(&self, source: &Path, folder: &Path) -> Result<(), CheckpointError> {
        let copy = self.copy_in(folder);
        if self.is_of(&copy) {
            return Ok(());
        }
        let parent = copy.parent().unwrap_or(folder);
        fs::create_dir_all(parent).map_err(CheckpointError::io("create", parent))?;
        let mut file = File::open(source).map_err(CheckpointError::io("read", source))?;
        let copied = write_atomically(&copy, |out| std::io::copy(&mut file, out).map(|_| ()));
        copied.map_err(|error| match error {
            OutputError::Io { action, path, source } => CheckpointError::Io { action, path, source },
            other => CheckpointError::Content { path: copy.clone(), problem: other.to_string() },
        })?;
        self.find(folder).map(|_| ())
    }
}
