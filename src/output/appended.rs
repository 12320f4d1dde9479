//! A text file that grows line by line and goes on after a restart.
//!
//! A checkpoint records the file's length and the CRC-32 of what was in it. On resuming, what was written after the
//! checkpoint is cut off, so that the file ends as that of a run without interruption; a file that is shorter than it
//! was, or that was altered, is refused.

use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::OutputError;

/// How far a file had got.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct AppendedState {
    pub bytes: u64,
    pub crc32: u32,
}

#[derive(Debug)]
pub struct AppendedFile {
    path: PathBuf,
    file: File,
    bytes: u64,
    crc: crc32fast::Hasher,
}

impl AppendedFile {
    /// An empty file; an earlier one is replaced.
    pub fn create(path: &Path) -> Result<AppendedFile, OutputError> {
        let file = File::create(path).map_err(OutputError::io("create", path))?;
        Ok(AppendedFile { path: path.to_path_buf(), file, bytes: 0, crc: crc32fast::Hasher::new() })
    }

    /// Cuts the file back to a state; also returns what is in it then.
    ///
    /// # Errors
    /// The file is missing, shorter, or begins otherwise; then it is left as it is.
    pub fn resume(path: &Path, state: AppendedState) -> Result<(AppendedFile, Vec<u8>), OutputError> {
        let mut file =
            OpenOptions::new().read(true).write(true).open(path).map_err(OutputError::io("go on with", path))?;
        let mut kept = Vec::new();
        (&mut file).take(state.bytes).read_to_end(&mut kept).map_err(OutputError::io("read", path))?;
        if kept.len() as u64 != state.bytes {
            let (found, expected) = (kept.len() as u64, state.bytes);
            return Err(OutputError::Shorter { path: path.to_path_buf(), found, expected });
        }
        let mut crc = crc32fast::Hasher::new();
        crc.update(&kept);
        if crc.clone().finalize() != state.crc32 {
            return Err(OutputError::Altered { path: path.to_path_buf(), bytes: state.bytes });
        }
        file.set_len(state.bytes)
            .and_then(|()| file.seek(SeekFrom::Start(state.bytes)))
            .map_err(OutputError::io("cut back", path))?;
        Ok((AppendedFile { path: path.to_path_buf(), file, bytes: state.bytes, crc }, kept))
    }

    /// One unbuffered write: it is the system's as soon as this returns.
    pub fn append(&mut self, bytes: &[u8]) -> Result<(), OutputError> {
        self.file.write_all(bytes).map_err(OutputError::io("write", &self.path))?;
        self.bytes += bytes.len() as u64;
        self.crc.update(bytes);
        Ok(())
    }

    /// How far the file has got, all of it on the disc.
    pub fn state(&self) -> Result<AppendedState, OutputError> {
        self.file.sync_data().map_err(OutputError::io("flush", &self.path))?;
        Ok(AppendedState { bytes: self.bytes, crc32: self.crc.clone().finalize() })
    }

    pub fn path(&self) -> &Path {
        &self.path
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Wherever it is cut and whatever was written after the cut, the file ends as without interruption.
        #[test]
        fn a_resumed_file_ends_as_an_uninterrupted_one(
            lines in proptest::collection::vec("[a-z0-9]{0,12}\n", 1..12), cut in 0usize..12, lost in 0usize..12
        ) {
            let dir = tempfile::tempdir().unwrap();
            let path = dir.path().join("a.csv");
            let cut = cut.min(lines.len());
            let mut file = AppendedFile::create(&path).unwrap();
            for line in &lines[..cut] {
                file.append(line.as_bytes()).unwrap();
            }
            let state = file.state().unwrap();
            for line in lines[cut..].iter().take(lost) {
                file.append(line.as_bytes()).unwrap();
            }
            drop(file);
            let (mut file, kept) = AppendedFile::resume(&path, state).unwrap();
            prop_assert_eq!(kept, lines[..cut].concat().into_bytes());
            for line in &lines[cut..] {
                file.append(line.as_bytes()).unwrap();
            }
            prop_assert_eq!(std::fs::read(&path).unwrap(), lines.concat().into_bytes());
            let crc32 = crc32fast::hash(lines.concat().as_bytes());
            prop_assert_eq!(file.state().unwrap(), AppendedState { bytes: lines.concat().len() as u64, crc32 });
        }
    }

    /// A file that cannot be the one of the checkpoint is refused with what was found, and not cut.
    #[test]
    fn a_missing_shorter_or_altered_file_is_refused() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("history.csv");
        let mut file = AppendedFile::create(&path).unwrap();
        file.append(b"time_s\n1\n2\n").unwrap();
        let state = file.state().unwrap();
        let refused = |bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            let error = AppendedFile::resume(&path, state).unwrap_err().to_string();
            assert!(error.contains("history.csv"), "{error}");
            assert_eq!(std::fs::read(&path).unwrap(), bytes);
            error
        };
        let short = refused(b"time_s\n1\n");
        assert!(short.contains("9 bytes") && short.contains("11"), "{short}");
        assert!(refused(b"time_s\n1\n3\n4\n").contains("altered"));
        std::fs::remove_file(&path).unwrap();
        assert!(AppendedFile::resume(&path, state).unwrap_err().to_string().contains("cannot go on with"));
        std::fs::write(&path, b"time_s\n1\n2\n3\n").unwrap();
        assert!(AppendedFile::resume(&path, state).is_ok());
    }
}
