//! Whether a folder is that of a run, and whether the run has ended.

use std::path::Path;

use super::error::OutputError;
use super::names::{AUDIT_FILE, MARKER_FILE};

/// Whether the run in a folder has reached its end.
pub fn has_ended(path: &Path) -> bool {
    path.join(AUDIT_FILE).exists()
}

/// Whether a run has written into a folder.
///
/// # Errors
/// If none has.
pub fn check_marker(path: &Path) -> Result<(), OutputError> {
    if path.join(MARKER_FILE).is_file() {
        return Ok(());
    }
    Err(OutputError::NotARun { path: path.to_path_buf(), marker: MARKER_FILE })
}
