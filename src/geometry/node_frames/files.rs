//! Frames as files, by their ending: `.nodes` or a series of VTK files.

use super::binary::{self, Precision, Refused};
use super::error::{NodeFramesError, io};
use super::frames::NodeFrames;
use super::series;
use std::path::Path;

impl NodeFrames {
    /// Whether a file's ending is one of frames.
    pub fn is_file(path: &Path) -> bool {
        let name = path.to_string_lossy().to_lowercase();
        [".nodes", ".series", ".pvd"].iter().any(|ending| name.ends_with(ending))
    }

    /// Reads frames, with lengths and times in the units of the file.
    ///
    /// # Errors
    /// The file, or one that it lists, cannot be read or is of another form; frames do not fit each other.
    pub fn read(path: &Path) -> Result<NodeFrames, NodeFramesError> {
        match Form::of(path)? {
            Form::Nodes => {
                let bytes = std::fs::read(path).map_err(io("read", path))?;
                binary::decoded(&bytes).map_err(|refused| match refused {
                    Refused::Misread(misread) => misread.of(path),
                    Refused::Fault(fault) => NodeFramesError::Frames { path: path.into(), file: None, fault },
                })
            }
            Form::Json => series::read_json(path),
            Form::Collection => series::read_collection(path),
        }
    }

    /// Writes frames as they are. A series has a file for each frame beside it, as legacy VTK text in f64; the precision
    /// is that of a `.nodes` file.
    pub fn write(&self, path: &Path, precision: Precision) -> Result<(), NodeFramesError> {
        match Form::of(path)? {
            Form::Nodes => std::fs::write(path, binary::encoded(self, precision)).map_err(io("write", path)),
            // A collection lists files of other forms.
            Form::Json | Form::Collection => series::write(self, path),
        }
    }
}

enum Form {
    Nodes,
    /// ParaView's list of files as JSON.
    Json,
    /// ParaView's list of files as XML.
    Collection,
}

impl Form {
    fn of(path: &Path) -> Result<Form, NodeFramesError> {
        let found = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
        match found.as_str() {
            "nodes" => Ok(Form::Nodes),
            "series" => Ok(Form::Json),
            "pvd" => Ok(Form::Collection),
            _ => Err(NodeFramesError::Ending { path: path.into(), found }),
        }
    }
}
