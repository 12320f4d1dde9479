//! Who writes into a folder: one process at a time.
//!
//! The lock is the system's, on an open file; it goes with the process, however that ends. The file tells others who has it. It is
//! removed at the end; a file that a kill has left locks nothing. Whoever gets the lock of a file that another has removed in
//! between starts over.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Read, Seek, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use super::super::OutputError;
use super::super::environment::host_name;
use super::super::names::LOCK_FILE;

/// How often a lock may be found to be of a removed file: each time another process has just ended.
const ATTEMPTS: usize = 100;
/// Bytes that are read of a lock file: more than any command line of ours has.
const MOST_TOLD: u64 = 4096;

/// Held as long as it lives.
#[derive(Debug)]
pub(super) struct FolderLock {
    path: PathBuf,
    file: File,
}

impl FolderLock {
    /// # Errors
    /// If another process has it; the message says which.
    pub fn take(folder: &Path) -> Result<FolderLock, OutputError> {
        FolderLock::take_by(folder, File::try_lock)
    }

    /// A file system that has no locks is warned of, and nothing is locked.
    fn take_by(folder: &Path, lock: impl Fn(&File) -> Result<(), TryLockError>) -> Result<FolderLock, OutputError> {
        let path = folder.join(LOCK_FILE);
        for _ in 0..ATTEMPTS {
            if path.is_symlink() {
                // What it leads to would be written over.
                let source = std::io::Error::new(ErrorKind::AlreadyExists, "it is a symbolic link");
                return Err(OutputError::io("lock", &path)(source));
            }
            let mut file = OpenOptions::new()
                .read(true)
                .write(true)
                .create(true)
                .truncate(false)
                .open(&path)
                .map_err(OutputError::io("lock", &path))?;
            match lock(&file) {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => {
                    return Err(OutputError::InUse { path: folder.to_path_buf(), holder: holder(&mut file) });
                }
                Err(TryLockError::Error(error)) => tracing::warn!(
                    "{} cannot be locked on its file system ({error}): nothing keeps a second run out of it",
                    folder.display()
                ),
            }
            let found = FolderLock { path: path.clone(), file };
            if found.stands() {
                found.sign().map_err(OutputError::io("write", &path))?;
                return Ok(found);
            }
        }
        Err(OutputError::InUse { path: folder.to_path_buf(), holder: "others, one after another".to_owned() })
    }

    /// Whether the file is still the one of that name.
    fn stands(&self) -> bool {
        let identity = |data: std::fs::Metadata| (data.dev(), data.ino());
        match (self.file.metadata(), std::fs::symlink_metadata(&self.path)) {
            (Ok(own), Ok(there)) => identity(own) == identity(there),
            _ => false,
        }
    }

    fn sign(&self) -> std::io::Result<()> {
        let command: Vec<String> =
            std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect();
        let text = format!("process {} of {}: {}\n", std::process::id(), host_name(), command.join(" "));
        let mut file = &self.file;
        file.set_len(0)?;
        file.rewind()?;
        file.write_all(text.as_bytes())
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        if self.stands() {
            // A file that stays locks nothing.
            let _ = std::fs::remove_file(&self.path);
        }
    }
}

/// As the one that has the lock has written.
fn holder(file: &mut File) -> String {
    let mut bytes = Vec::new();
    let _ = file.take(MOST_TOLD).read_to_end(&mut bytes);
    let text = String::from_utf8_lossy(&bytes).trim().to_owned();
    if text.is_empty() { "another process".to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two handles of one process are two owners, as those of two processes are.
    #[test]
    fn a_lock_is_held_once_and_says_by_whom() {
        let folder = tempfile::tempdir().unwrap();
        let first = FolderLock::take(folder.path()).unwrap();
        let told = FolderLock::take(folder.path()).unwrap_err().to_string();
        assert!(told.contains(&format!("process {} of ", std::process::id())) && told.contains("--out"), "{told}");
        drop(first);
        assert!(!folder.path().join(LOCK_FILE).exists());
        FolderLock::take(folder.path()).unwrap();
    }

    /// What a kill leaves is no obstacle, whatever is in it.
    #[test]
    fn a_file_without_an_owner_locks_nothing() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(LOCK_FILE), "process 1 of elsewhere: corpuscle run\n".repeat(9)).unwrap();
        let lock = FolderLock::take(folder.path()).unwrap();
        let text = std::fs::read_to_string(folder.path().join(LOCK_FILE)).unwrap();
        assert!(text.starts_with("process ") && !text.contains("elsewhere") && text.lines().count() == 1, "{text}");
        drop(lock);
    }

    /// The owner of a file that was removed in between is not the owner of the folder.
    #[test]
    fn a_removed_file_is_not_taken_for_the_lock() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(LOCK_FILE);
        let removed_once = std::cell::Cell::new(false);
        let lock = FolderLock::take_by(folder.path(), |file| {
            if !removed_once.replace(true) {
                std::fs::remove_file(&path).unwrap();
            }
            file.try_lock()
        })
        .unwrap();
        assert!(lock.stands());
        assert!(FolderLock::take(folder.path()).is_err());
    }

    #[test]
    fn a_file_system_without_locks_is_no_obstacle() {
        let folder = tempfile::tempdir().unwrap();
        let refuse = |_: &File| Err(TryLockError::Error(ErrorKind::Unsupported.into()));
        let first = FolderLock::take_by(folder.path(), refuse).unwrap();
        FolderLock::take_by(folder.path(), refuse).unwrap();
        drop(first);
    }

    #[test]
    fn a_link_in_the_place_of_the_lock_is_not_written_through() {
        let folder = tempfile::tempdir().unwrap();
        let mine = folder.path().join("mine.toml");
        std::fs::write(&mine, "mine").unwrap();
        std::os::unix::fs::symlink(&mine, folder.path().join(LOCK_FILE)).unwrap();
        assert!(FolderLock::take(folder.path()).unwrap_err().to_string().contains("symbolic link"));
        assert_eq!(std::fs::read_to_string(&mine).unwrap(), "mine");
    }
}
