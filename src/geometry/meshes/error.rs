//! What can be wrong with a mesh that is made, read or written.

use crate::geometry::GeometryError;
use std::path::PathBuf;

#[derive(Debug, Clone, PartialEq, thiserror::Error, miette::Diagnostic)]
pub enum MeshError {
    #[error("{shape}: {what}: found {found}, expected {expected}")]
    Number { shape: &'static str, what: &'static str, found: String, expected: String },

    #[error("cannot {action} {path}: {reason}", path = path.display())]
    Io { action: &'static str, path: PathBuf, reason: String },

    #[error("{path}: found the ending `{found}`, expected `obj` or `stl`", path = path.display())]
    Ending { path: PathBuf, found: String },

    #[error("{path}: {reason}", path = path.display())]
    Unreadable { path: PathBuf, reason: String },

    #[error(transparent)]
    #[diagnostic(transparent)]
    Geometry(#[from] GeometryError),
}
