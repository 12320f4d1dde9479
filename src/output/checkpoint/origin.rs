//! What all checkpoints of a run share: where it came from and what computes it.

use std::io::Read;

use super::error::CheckpointError;
use super::manifest::Adapter;
use crate::output::meshes::{MeshRecord, meshes_of};
use crate::scene::{Scene, to_toml};

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
        Ok(Origin { scene: to_toml(scene), plan, meshes: meshes_of(scene)?, adapter })
    }
}

/// Of all that is left in `source`.
pub(in crate::output) fn length_and_crc(source: &mut impl Read) -> std::io::Result<(u64, u32)> {
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
