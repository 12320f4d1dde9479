//! What all checkpoints of a run share: where it came from and what computes it.

use super::error::CheckpointError;
use super::manifest::Adapter;
use crate::output::meshes::{MeshRecord, meshes_of};
use crate::scene::{Scene, UnitSystem, to_toml};

/// Made once, at the start of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Origin {
    /// TOML.
    pub scene: String,
    /// TOML.
    pub plan: String,
    pub meshes: Vec<MeshRecord>,
    pub adapter: Adapter,
    /// In which the run tells what it tells.
    pub units: UnitSystem,
}

impl Origin {
    /// `plan` is the plan as TOML. The meshes that the scene names are read, for their checksums.
    ///
    /// # Errors
    /// If a mesh cannot be read.
    pub fn new(scene: &Scene, plan: String, adapter: Adapter) -> Result<Origin, CheckpointError> {
        Ok(Origin { scene: to_toml(scene), plan, meshes: meshes_of(scene)?, adapter, units: scene.units })
    }
}
