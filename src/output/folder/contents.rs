//! What is in a folder: results that a run may replace, and what no run wrote.

use std::fs;
use std::path::{Path, PathBuf};

use super::super::OutputError;
use super::super::checkpoint::{is_checkpoint_file, is_checkpoint_folder};
use super::super::error::PARTIAL_SUFFIX;
use super::super::names::{
    CHECKPOINT_FOLDER, LOCK_FILE, MARKER_FILE, MESH_FOLDER, RESULT_FILES, SNAPSHOT_FOLDER, is_mesh_copy,
    is_seed_folder, is_snapshot_file,
};

/// What a folder holds before a run.
#[derive(Debug, Default)]
pub(super) struct Contents {
    pub marked: bool,
    pub results: Vec<PathBuf>,
    /// Links in the place of results; among the others, too.
    pub links: Vec<PathBuf>,
    /// Folders of checkpoints, whole or not, and of the runs of several seeds, the inner ones first; their files are among
    /// the results.
    pub folders: Vec<PathBuf>,
    /// Those of the runs of several seeds, with runs in them.
    pub seeds: Vec<PathBuf>,
    /// Names, sorted, of what no run writes.
    pub others: Vec<String>,
}

impl Contents {
    pub fn of(folder: &Path) -> Result<Contents, OutputError> {
        let mut contents = Contents::default();
        for (name, path, kind) in entries(folder)? {
            let named = RESULT_FILES.contains(&name.trim_end_matches(PARTIAL_SUFFIX));
            if name == LOCK_FILE {
                // Its owner is who asks.
            } else if name == SNAPSHOT_FOLDER && kind.is_dir() {
                contents.add_files(&name, &path, is_snapshot_file)?;
            } else if name == MESH_FOLDER && kind.is_dir() {
                contents.add_files(&name, &path, is_mesh_copy)?;
            } else if name == CHECKPOINT_FOLDER && kind.is_dir() {
                contents.add_checkpoints(&path)?;
            } else if kind.is_dir() && is_seed_folder(&name) && path.join(MARKER_FILE).is_file() {
                contents.add_run(&name, &path)?;
            } else if kind.is_file() && named {
                contents.marked |= name == MARKER_FILE;
                contents.results.push(path);
            } else if kind.is_symlink() && named {
                contents.links.push(path);
                contents.others.push(name);
            } else {
                contents.others.push(name);
            }
        }
        contents.others.sort();
        Ok(contents)
    }

    /// The results are those files of a folder that are named as ours.
    fn add_files(&mut self, name: &str, folder: &Path, own: impl Fn(&str) -> bool) -> Result<(), OutputError> {
        for (inner, path, kind) in entries(folder)? {
            if kind.is_file() && own(&inner) {
                self.results.push(path);
            } else {
                self.others.push(format!("{name}/{inner}"));
            }
        }
        Ok(())
    }

    fn add_checkpoints(&mut self, folder: &Path) -> Result<(), OutputError> {
        for (name, path, kind) in entries(folder)? {
            if !(kind.is_dir() && is_checkpoint_folder(&name)) {
                self.others.push(format!("{CHECKPOINT_FOLDER}/{name}"));
                continue;
            }
            for (inner, file, kind) in entries(&path)? {
                if kind.is_file() && is_checkpoint_file(&inner) {
                    self.results.push(file);
                } else {
                    self.others.push(format!("{CHECKPOINT_FOLDER}/{name}/{inner}"));
                }
            }
            self.folders.push(path);
        }
        Ok(())
    }

    /// The run of one of several seeds, in a folder of its own.
    fn add_run(&mut self, name: &str, folder: &Path) -> Result<(), OutputError> {
        let run = Contents::of(folder)?;
        self.results.extend(run.results);
        self.links.extend(run.links);
        self.seeds.push(folder.to_path_buf());
        self.others.extend(run.others.iter().map(|other| format!("{name}/{other}")));
        self.folders.extend(run.folders);
        let inner = [SNAPSHOT_FOLDER, CHECKPOINT_FOLDER, MESH_FOLDER].map(|inner| folder.join(inner));
        self.folders.extend(inner);
        self.folders.push(folder.to_path_buf());
        Ok(())
    }

    /// What forbids writing here, in words; `None` if the folder is empty or an earlier run's alone.
    pub fn foreign(&self) -> Option<String> {
        if self.others.is_empty() && (self.marked || self.results.is_empty()) {
            return None;
        }
        let mut names = self.others.clone();
        if !self.marked {
            names.extend(self.results.iter().filter_map(|path| Some(path.file_name()?.to_string_lossy().into_owned())));
        }
        const SHOWN: usize = 3;
        let more = names.len().saturating_sub(SHOWN);
        names.truncate(SHOWN);
        let mut list = names.join(", ");
        if more > 0 {
            list += &format!(" and {more} more");
        }
        Some(list)
    }
}

pub(super) fn entries(folder: &Path) -> Result<Vec<(String, PathBuf, fs::FileType)>, OutputError> {
    let list = || -> std::io::Result<Vec<_>> {
        fs::read_dir(folder)?
            .map(|entry| {
                let entry = entry?;
                let name = entry.file_name().to_string_lossy().into_owned();
                Ok((name, entry.path(), entry.file_type()?))
            })
            .collect()
    };
    list().map_err(OutputError::io("list", folder))
}
