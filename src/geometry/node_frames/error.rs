//! What can be wrong with frames of a mesh's nodes, and with their files. Frames, nodes and triangles count from 0.

use std::path::{Path, PathBuf};

/// What is wrong with frames themselves.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FrameFault {
    #[error("found no frame, expected at least one")]
    NoFrame,
    #[error("found no node, expected at least one")]
    NoNode,
    #[error("found {times} times, expected one for each of the {frames} frames")]
    TimeCount { times: usize, frames: usize },
    #[error("frame {frame}: found {found} nodes, expected {expected} as in frame 0")]
    NodeCount { frame: usize, found: usize, expected: usize },
    #[error("frame {frame}: found the time {found}, expected a finite one{}",
        before.map_or(String::new(), |before| format!(" after {before}, that of the frame before")))]
    Time { frame: usize, found: f64, before: Option<f64> },
    #[error("frame {frame}, node {node}: found {found:?}, expected finite numbers")]
    NotFinite { frame: usize, node: usize, found: [f64; 3] },
    #[error("triangle {triangle}: found node {found}, expected one of the {nodes} from 0 on")]
    NoSuchNode { triangle: usize, found: u64, nodes: usize },
    #[error("frame {frame}: found {found} triangles, expected {expected} as in frame 0")]
    TriangleCount { frame: usize, found: usize, expected: usize },
    #[error("frame {frame}, triangle {triangle}: found nodes {found:?}, expected {expected:?} as in frame 0")]
    Connectivity { frame: usize, triangle: usize, found: [u32; 3], expected: [u32; 3] },
    #[error("found {found} nodes, expected the {expected} of the mesh")]
    OtherNodes { found: usize, expected: usize },
    #[error("found {found} triangles, expected the {expected} of the mesh")]
    OtherTriangles { found: usize, expected: usize },
    #[error("triangle {triangle}: found nodes {found:?}, expected {expected:?} as in the mesh")]
    OtherConnectivity { triangle: usize, found: [u32; 3], expected: [u32; 3] },
}

impl FrameFault {
    /// The frame that it is of.
    pub(super) fn frame(&self) -> Option<usize> {
        use FrameFault::*;
        match *self {
            NodeCount { frame, .. }
            | Time { frame, .. }
            | NotFinite { frame, .. }
            | TriangleCount { frame, .. }
            | Connectivity { frame, .. } => Some(frame),
            NoFrame | NoNode | TimeCount { .. } | NoSuchNode { .. } => None,
            OtherNodes { .. } | OtherTriangles { .. } | OtherConnectivity { .. } => None,
        }
    }
}

#[derive(Debug, Clone, PartialEq, thiserror::Error, miette::Diagnostic)]
pub enum NodeFramesError {
    #[error("cannot {action} {path}: {reason}", path = path.display())]
    Io { action: &'static str, path: PathBuf, reason: String },

    #[error("{path}: found the ending `{found}`, expected `nodes`, `vtk.series`, `vtu.series`, `vtp.series` or `pvd`",
        path = path.display())]
    Ending { path: PathBuf, found: String },

    /// `place` is a line, an element or nothing.
    #[error("{path}{}{place}: found {found}, expected {expected}",
        if place.is_empty() { "" } else { ": " }, path = path.display())]
    Malformed { path: PathBuf, place: String, found: String, expected: String },

    /// `file`: that of the frame, where each has its own.
    #[error("{path}{}: {fault}", file.as_ref().map_or(String::new(), |file| format!(" ({file})")), path = path.display())]
    Frames { path: PathBuf, file: Option<String>, fault: FrameFault },
}

/// A place in a file that says something else than it should; the file is known to who reads it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Misread {
    pub place: String,
    pub found: String,
    pub expected: String,
}

impl Misread {
    pub fn new(place: impl Into<String>, found: impl Into<String>, expected: impl Into<String>) -> Misread {
        Misread { place: place.into(), found: found.into(), expected: expected.into() }
    }

    pub fn of(self, path: &Path) -> NodeFramesError {
        let Misread { place, found, expected } = self;
        NodeFramesError::Malformed { path: path.to_path_buf(), place, found, expected }
    }
}

/// For `map_err`: what was being done to which file.
pub(super) fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> NodeFramesError {
    move |error| NodeFramesError::Io { action, path: path.to_path_buf(), reason: error.to_string() }
}
