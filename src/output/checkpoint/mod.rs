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
//! and the parent flushed. Only then are older checkpoints removed, all but [`KEPT`](layout::KEPT). So a kill at any moment leaves
//! the last good one, and a folder with a plain name is complete.
//!
//! **Reading.** [`Checkpoint::open`] believes nothing before its checksum: first the manifest, then sizes and checksums of
//! all files, then that particles are those of the manifest, each id once. Memory is asked for as data come, never by a
//! length that a file claims.
//!
//! Knows of a particle only its size and where its id is; of the state only that serde can read it.

mod error;
mod layout;
mod manifest;
mod origin;
mod read;
#[cfg(test)]
mod tests;
mod write;

use serde::{Deserialize, Serialize};

use super::{HistoryState, SnapshotState};

pub use error::CheckpointError;
pub use layout::{RECORD_BYTES, latest, run_folder};
pub(super) use layout::{is_checkpoint_file, is_checkpoint_folder, is_left_over};
pub use manifest::{Adapter, FileRecord, Manifest};
pub use origin::Origin;
pub use read::Checkpoint;
pub use write::{CheckpointWriter, Moment, RunContext, forget_after};

/// How far the files of a run had got.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OutputState {
    pub history: HistoryState,
    /// `None` in a scene that wants no snapshots.
    pub snapshots: Option<SnapshotState>,
}
