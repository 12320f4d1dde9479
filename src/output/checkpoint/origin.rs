//! What all checkpoints of a run share: where it came from and what computes it.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::error::CheckpointError;
use super::manifest::{Adapter, MeshRecord};
use crate::scene::{Scene, Shape, to_toml};

/// Made once, at the start of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Origin {
    /// TOML.
    pub scene: String,
    /// TOML.
    pub plan: String,
    pub meshes: Vec<MeshRecord>,
    pub adapter: Adapter,
}

impl Origin {
    /// `plan` is the plan as TOML. The meshes that the scene names are read, for their checksums.
    ///
    /// # Errors
    /// If a mesh cannot be read.
    pub fn new(scene: &Scene, plan: String, adapter: Adapter) -> Result<Origin, CheckpointError> {
        let meshes = scene.walls.iter().filter_map(|wall| match &wall.shape {
            Shape::Mesh { path, .. } => Some(MeshRecord::of(path)),
            _ => None,
        });
        Ok(Origin { scene: to_toml(scene), plan, meshes: meshes.collect::<Result<_, _>>()?, adapter })
    }
}

impl MeshRecord {
    fn of(path: &Path) -> Result<MeshRecord, CheckpointError> {
        let mut file = File::open(path).map_err(CheckpointError::io("read", path))?;
        let (bytes, crc32) = length_and_crc(&mut file).map_err(CheckpointError::io("read", path))?;
        Ok(MeshRecord { path: path.to_path_buf(), bytes, crc32 })
    }

    /// # Errors
    /// If the file is not the one of the record.
    pub(super) fn check(&self) -> Result<(), CheckpointError> {
        let found = MeshRecord::of(&self.path)?;
        if found == *self {
            return Ok(());
        }
        Err(CheckpointError::Mesh {
            path: self.path.clone(),
            found_bytes: found.bytes,
            found_crc32: found.crc32,
            expected_bytes: self.bytes,
            expected_crc32: self.crc32,
        })
    }
}

/// Of all that is left in `source`.
pub(super) fn length_and_crc(source: &mut impl Read) -> std::io::Result<(u64, u32)> {
    let mut crc = crc32fast::Hasher::new();
    let mut chunk = vec![0; 1 << 16];
    let mut bytes = 0;
    loop {
        match source.read(&mut chunk) {
            Ok(0) => return Ok((bytes, crc.finalize())),
            Ok(count) => {
                crc.update(&chunk[..count]);
                bytes += count as u64;
            }
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}
