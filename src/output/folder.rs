//! The folder of one run.
//!
//! A folder is ours if it carries the marker file that [`OutputFolder::clear`] leaves in it. Who writes into a folder has it
//! alone ([`lock`]). A run first claims it, which changes nothing in it and may be refused ([`claim`]); once the run has shown that
//! it can start, the folder is cleared of an earlier run's results, so that no stale snapshot stays beside new ones. Nothing
//! that a run does not write is ever removed or, without `force`, written beside; nothing that it reads is, with or without.
//! Checkpoints are results too.

mod claim;
mod contents;
mod lock;
#[cfg(test)]
mod tests;

use super::marker::check_marker;
use std::fs;
use std::path::{Path, PathBuf};

use super::OutputError;
use super::error::{PARTIAL_SUFFIX, write_atomically};
use super::names::{AUDIT_FILE, CHECKPOINT_FOLDER, MARKER_FILE, RESULT_FILES};
use contents::{Contents, entries};
use lock::FolderLock;

pub use claim::{Claim, Content};

/// A folder that this process alone writes into.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    /// It was not there before.
    made: bool,
    /// Always there but while it is dropped.
    lock: Option<FolderLock>,
}

impl Drop for OutputFolder {
    /// A folder that was made for nothing does not stay.
    fn drop(&mut self) {
        drop(self.lock.take());
        if self.made {
            // Refused where something is in it.
            let _ = fs::remove_dir(&self.path);
        }
    }
}

impl OutputFolder {
    /// Claims `path` (made with its parents) for what `claim` says. Nothing in it changes before [`OutputFolder::clear`].
    ///
    /// # Errors
    /// `path` is a file; another process writes into it; what it has must not be replaced ([`Claim`]); the system refuses.
    pub fn claim(path: &Path, claim: &Claim<'_>) -> Result<OutputFolder, OutputError> {
        if path.exists() && !path.is_dir() {
            return Err(OutputError::NotAFolder { path: path.to_path_buf() });
        }
        let made = !path.exists();
        fs::create_dir_all(path).map_err(OutputError::io("create", path))?;
        let lock = FolderLock::take(path)?;
        claim.judge(path)?;
        Ok(OutputFolder { path: path.to_path_buf(), made, lock: Some(lock) })
    }

    /// Removes the results of an earlier run and leaves the marker. Files that are not a run's stay.
    ///
    /// # Errors
    /// If the system refuses, or another process writes into the folder of one of several seeds.
    pub fn clear(&self) -> Result<(), OutputError> {
        let contents = Contents::of(&self.path)?;
        let seeds = contents.seeds.iter().map(|seed| FolderLock::take(seed)).collect::<Result<Vec<_>, _>>()?;
        for file in contents.results.iter().chain(&contents.links) {
            fs::remove_file(file).map_err(OutputError::io("remove", file))?;
        }
        drop(seeds);
        for own in &contents.folders {
            use std::io::ErrorKind;
            // With `force` a folder may hold what is the user's: it stays.
            match fs::remove_dir(own) {
                Err(error) if !matches!(error.kind(), ErrorKind::DirectoryNotEmpty | ErrorKind::NotFound) => {
                    return Err(OutputError::io("remove", own)(error));
                }
                _ => {}
            }
        }
        self.write_text(MARKER_FILE, "Results of a corpuscle run; `corpuscle run` says what may replace them.\n")?;
        Ok(())
    }

    /// Claimed and cleared at once.
    ///
    /// # Errors
    /// As of the two.
    pub fn create(path: &Path, claim: &Claim<'_>) -> Result<OutputFolder, OutputError> {
        let folder = OutputFolder::claim(path, claim)?;
        folder.clear()?;
        Ok(folder)
    }

    /// The folder of a run that goes on; nothing in it is changed.
    ///
    /// # Errors
    /// No run wrote it, or another process writes into it.
    pub fn open(path: &Path) -> Result<OutputFolder, OutputError> {
        check_marker(path)?;
        Ok(OutputFolder { path: path.to_path_buf(), made: false, lock: Some(FolderLock::take(path)?) })
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the audit: the run has reached its end.
    pub fn end(&self, audit: &str) -> Result<PathBuf, OutputError> {
        self.write_text(AUDIT_FILE, audit)
    }

    /// The run in it goes on: it has not ended. What a kill has left half written is removed.
    ///
    /// # Errors
    /// If the system refuses.
    pub fn go_on(&self) -> Result<(), OutputError> {
        self.remove_partial()?;
        let path = self.path.join(AUDIT_FILE);
        match fs::remove_file(&path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(OutputError::io("remove", &path)(error)),
            _ => Ok(()),
        }
    }

    fn remove_partial(&self) -> Result<(), OutputError> {
        for file in Contents::of(&self.path)?.results {
            // Those of checkpoints go with their folders.
            if file.as_os_str().to_string_lossy().ends_with(PARTIAL_SUFFIX) {
                fs::remove_file(&file).map_err(OutputError::io("remove", &file))?;
            }
        }
        let checkpoints = self.checkpoints();
        if !checkpoints.is_dir() {
            return Ok(());
        }
        for (name, path, kind) in entries(&checkpoints)? {
            if kind.is_dir() && super::checkpoint::is_left_over(&name) {
                fs::remove_dir_all(&path).map_err(OutputError::io("remove", &path))?;
            }
        }
        Ok(())
    }

    /// Where the run's checkpoints are; made with the first.
    pub fn checkpoints(&self) -> PathBuf {
        self.path.join(CHECKPOINT_FOLDER)
    }

    /// Writes one of the result files (`PLAN_FILE`, ...) whole; returns its path. Panics on any other name.
    pub fn write_text(&self, name: &str, text: &str) -> Result<PathBuf, OutputError> {
        // A programming error: the next run would take the file for the user's.
        assert!(RESULT_FILES.contains(&name), "{name} is not in RESULT_FILES");
        let path = self.path.join(name);
        write_atomically(&path, |out| out.write_all(text.as_bytes()))?;
        Ok(path)
    }
}
