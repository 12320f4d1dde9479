//! The folder of one run.
//!
//! A folder is ours if it carries the marker file that [`OutputFolder::create`] leaves in it. An earlier run's
//! results are removed before a new run starts, so that no stale snapshot stays beside new ones; nothing
//! that a run does not write is ever removed or, without `force`, written beside. Checkpoints are results too.

use std::fs;
use std::path::{Path, PathBuf};

use super::OutputError;
use super::checkpoint::{is_checkpoint_file, is_checkpoint_folder};
use super::error::{PARTIAL_SUFFIX, write_atomically};

pub const HISTORY_FILE: &str = "history.csv";
pub const PLAN_FILE: &str = "plan.toml";
pub const SCENE_FILE: &str = "scene.toml";
pub const ENVIRONMENT_FILE: &str = "environment.json";
pub const PRESSURE_CHART_FILE: &str = "pressure.svg";
/// Only there once the run has reached its end and all else is written.
pub const AUDIT_FILE: &str = "audit.txt";
pub const BALANCE_FILE: &str = "balance.csv";
pub const SUBDOMAIN_CHART_FILE: &str = "subdomains.svg";
pub const TIMING_FILE: &str = "timing.json";
pub const SWEEP_FILE: &str = "sweep.csv";
pub const SWEEP_TABLE_FILE: &str = "sweep.txt";
pub const SWEEP_CHART_FILE: &str = "sweep.svg";
pub const SWEEP_MODEL_CHART_FILE: &str = "sweep_modelled.svg";
pub const PARETO_FILE: &str = "pareto.csv";
pub const PARETO_TABLE_FILE: &str = "pareto.txt";
pub const PARETO_CHART_FILE: &str = "pareto.svg";
/// Mean and spread over the seeds of a repeated run.
pub const HISTORY_MEAN_FILE: &str = "history_mean.csv";
pub const STABILITY_FILE: &str = "stability.csv";
pub const STABILITY_TABLE_FILE: &str = "stability.txt";
pub const STABILITY_CHART_FILE: &str = "stability.svg";
pub const SNAPSHOT_FOLDER: &str = "snapshots";
pub const CHECKPOINT_FOLDER: &str = "checkpoints";

/// Says that the folder is a run's.
const MARKER_FILE: &str = ".corpuscle-run";

/// Everything a run or a study writes at the top of its folder, apart from the snapshots and checkpoints.
const RESULT_FILES: [&str; 21] = [
    MARKER_FILE,
    HISTORY_FILE,
    PLAN_FILE,
    SCENE_FILE,
    ENVIRONMENT_FILE,
    PRESSURE_CHART_FILE,
    AUDIT_FILE,
    BALANCE_FILE,
    SUBDOMAIN_CHART_FILE,
    TIMING_FILE,
    SWEEP_FILE,
    SWEEP_TABLE_FILE,
    SWEEP_CHART_FILE,
    SWEEP_MODEL_CHART_FILE,
    PARETO_FILE,
    PARETO_TABLE_FILE,
    PARETO_CHART_FILE,
    HISTORY_MEAN_FILE,
    STABILITY_FILE,
    STABILITY_TABLE_FILE,
    STABILITY_CHART_FILE,
];

const SEED_PREFIX: &str = "seed-";

/// The name of the folder of one run of several seeds.
pub fn seed_folder(seed: u64) -> String {
    format!("{SEED_PREFIX}{seed}")
}

/// A folder that exists, holds no earlier results, and carries the marker.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutputFolder {
    path: PathBuf,
}

impl OutputFolder {
    /// Makes `path` (with its parents) ready for a run; the results of an earlier run in it are removed.
    ///
    /// Errors: `path` is a file; it holds something that no run wrote and `force` is not set; the
    /// system refuses. With `force`, files that carry the names of results are replaced and all others stay.
    pub fn create(path: &Path, force: bool) -> Result<OutputFolder, OutputError> {
        if path.exists() && !path.is_dir() {
            return Err(OutputError::NotAFolder { path: path.to_path_buf() });
        }
        fs::create_dir_all(path).map_err(OutputError::io("create", path))?;
        let contents = Contents::of(path)?;
        if !force && let Some(foreign) = contents.foreign() {
            return Err(OutputError::FolderInUse { path: path.to_path_buf(), foreign });
        }
        for file in &contents.results {
            fs::remove_file(file).map_err(OutputError::io("remove", file))?;
        }
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
        let folder = OutputFolder { path: path.to_path_buf() };
        folder.write_text(MARKER_FILE, "Results of a corpuscle run; the next run into this folder replaces them.\n")?;
        Ok(folder)
    }

    /// The folder of a run that goes on; nothing in it is changed.
    ///
    /// Errors: no run wrote it.
    pub fn open(path: &Path) -> Result<OutputFolder, OutputError> {
        if !path.join(MARKER_FILE).is_file() {
            return Err(OutputError::NotARun { path: path.to_path_buf(), marker: MARKER_FILE });
        }
        Ok(OutputFolder { path: path.to_path_buf() })
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether the run in it has reached its end.
    pub fn has_ended(&self) -> bool {
        self.path.join(AUDIT_FILE).exists()
    }

    /// Writes the audit: the run has reached its end.
    pub fn end(&self, audit: &str) -> Result<PathBuf, OutputError> {
        self.write_text(AUDIT_FILE, audit)
    }

    /// The run in it goes on: it has not ended.
    pub fn go_on(&self) -> Result<(), OutputError> {
        let path = self.path.join(AUDIT_FILE);
        match fs::remove_file(&path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(OutputError::io("remove", &path)(error)),
            _ => Ok(()),
        }
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

/// What a folder holds before a run.
struct Contents {
    marked: bool,
    results: Vec<PathBuf>,
    /// Folders of checkpoints, whole or not, and of the runs of several seeds, the inner ones first; their files are among
    /// the results.
    folders: Vec<PathBuf>,
    /// Names, sorted, of what no run writes.
    others: Vec<String>,
}

impl Contents {
    fn of(folder: &Path) -> Result<Contents, OutputError> {
        let mut contents = Contents { marked: false, results: Vec::new(), folders: Vec::new(), others: Vec::new() };
        for (name, path, kind) in entries(folder)? {
            if name == SNAPSHOT_FOLDER && kind.is_dir() {
                for (inner, path, kind) in entries(&path)? {
                    if kind.is_file() && is_snapshot_file(&inner) {
                        contents.results.push(path);
                    } else {
                        contents.others.push(format!("{name}/{inner}"));
                    }
                }
            } else if name == CHECKPOINT_FOLDER && kind.is_dir() {
                contents.add_checkpoints(&path)?;
            } else if kind.is_dir() && is_seed_folder(&name) && path.join(MARKER_FILE).is_file() {
                contents.add_run(&name, &path)?;
            } else if kind.is_file() && RESULT_FILES.contains(&name.trim_end_matches(PARTIAL_SUFFIX)) {
                contents.marked |= name == MARKER_FILE;
                contents.results.push(path);
            } else {
                contents.others.push(name);
            }
        }
        contents.others.sort();
        Ok(contents)
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

    /// Of one of several seeds, in a folder of its own.
    fn add_run(&mut self, name: &str, folder: &Path) -> Result<(), OutputError> {
        let run = Contents::of(folder)?;
        self.results.extend(run.results);
        self.others.extend(run.others.iter().map(|other| format!("{name}/{other}")));
        self.folders.extend(run.folders);
        self.folders.extend([folder.join(SNAPSHOT_FOLDER), folder.join(CHECKPOINT_FOLDER), folder.to_path_buf()]);
        Ok(())
    }

    /// What forbids writing here, in words; `None` if the folder is empty or an earlier run's alone.
    fn foreign(&self) -> Option<String> {
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

fn entries(folder: &Path) -> Result<Vec<(String, PathBuf, fs::FileType)>, OutputError> {
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

fn is_seed_folder(name: &str) -> bool {
    name.strip_prefix(SEED_PREFIX).is_some_and(|seed| !seed.is_empty() && seed.bytes().all(|b| b.is_ascii_digit()))
}

pub(super) fn is_snapshot_file(name: &str) -> bool {
    let name = name.trim_end_matches(PARTIAL_SUFFIX);
    let numbered = name
        .strip_prefix("particles_")
        .and_then(|rest| rest.strip_suffix(".vtu"))
        .is_some_and(|digits| !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit()));
    numbered || name == "particles.pvd" || name == "walls.vtp"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::{Column, HistoryWriter, SnapshotWriter};

    fn finished_run(path: &Path) {
        let folder = OutputFolder::create(path, false).unwrap();
        HistoryWriter::create(folder.path(), &[Column::new("time", "s")]).unwrap();
        for name in [PLAN_FILE, SCENE_FILE, ENVIRONMENT_FILE, PRESSURE_CHART_FILE] {
            folder.write_text(name, "x").unwrap();
        }
        let mut snapshots = SnapshotWriter::create(folder.path()).unwrap();
        snapshots.write(0.0, &[]).unwrap();
        snapshots.write_walls(&[], &[], &[]).unwrap();
    }

    #[test]
    fn a_run_may_replace_an_earlier_run_and_leaves_nothing_of_it() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("new/results");
        finished_run(&path);
        assert!(path.join("snapshots/particles_000000.vtu").exists());
        // A run killed while it wrote leaves a partial file, which is no obstacle either.
        fs::write(path.join("plan.toml.partial"), "half").unwrap();
        OutputFolder::create(&path, false).unwrap();
        assert!(!path.join("snapshots/particles_000000.vtu").exists());
        assert!(!path.join(HISTORY_FILE).exists() && !path.join("plan.toml.partial").exists());
        assert!(path.join(MARKER_FILE).exists());
    }

    /// Checkpoints of an earlier run, whole or cut short, go with it: the new run must not be resumed from them.
    #[test]
    fn checkpoints_of_an_earlier_run_go_with_it() {
        let dir = tempfile::tempdir().unwrap();
        finished_run(dir.path());
        for name in ["step-0000000064", "step-0000000128.partial"] {
            let folder = dir.path().join(CHECKPOINT_FOLDER).join(name);
            fs::create_dir_all(&folder).unwrap();
            for file in ["manifest.toml", "state.bin", "particles-0003.bin"] {
                fs::write(folder.join(file), "x").unwrap();
            }
        }
        OutputFolder::create(dir.path(), false).unwrap();
        assert_eq!(fs::read_dir(dir.path().join(CHECKPOINT_FOLDER)).unwrap().count(), 0);
        // What is not a checkpoint's is the user's.
        let mine = dir.path().join("checkpoints/step-0000000064/mine.txt");
        fs::create_dir_all(mine.parent().unwrap()).unwrap();
        fs::write(&mine, "mine").unwrap();
        let error = OutputFolder::create(dir.path(), false).unwrap_err().to_string();
        assert!(error.contains("checkpoints/step-0000000064/mine.txt"), "{error}");
        OutputFolder::create(dir.path(), true).unwrap();
        assert!(mine.exists());
    }

    /// The runs of several seeds go with the next, whatever is in their folders, but for what is the user's.
    #[test]
    fn the_runs_of_several_seeds_go_with_the_next() {
        let dir = tempfile::tempdir().unwrap();
        OutputFolder::create(dir.path(), false).unwrap().write_text(HISTORY_MEAN_FILE, "x").unwrap();
        for seed in [1, 20] {
            let run = dir.path().join(seed_folder(seed));
            finished_run(&run);
            fs::create_dir_all(run.join(CHECKPOINT_FOLDER).join("step-0000000064")).unwrap();
        }
        OutputFolder::create(dir.path(), false).unwrap();
        let left: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left, [MARKER_FILE]);
        // What no run wrote is not taken for one by its name.
        fs::create_dir(dir.path().join("seed-3")).unwrap();
        assert!(OutputFolder::create(dir.path(), false).unwrap_err().to_string().contains("seed-3"));
        fs::remove_dir(dir.path().join("seed-3")).unwrap();
        finished_run(&dir.path().join("seed-4"));
        let mine = dir.path().join("seed-4/mine.txt");
        fs::write(&mine, "mine").unwrap();
        assert!(OutputFolder::create(dir.path(), false).unwrap_err().to_string().contains("seed-4/mine.txt"));
        OutputFolder::create(dir.path(), true).unwrap();
        assert!(mine.exists() && !dir.path().join("seed-4").join(HISTORY_FILE).exists());
    }

    #[test]
    fn only_a_runs_folder_can_be_gone_on_with() {
        let dir = tempfile::tempdir().unwrap();
        assert!(matches!(OutputFolder::open(dir.path()), Err(OutputError::NotARun { .. })));
        finished_run(dir.path());
        OutputFolder::open(dir.path()).unwrap();
        assert!(dir.path().join(HISTORY_FILE).exists());
    }

    /// The audit is there from the end of a run until it goes on or another takes its place.
    #[test]
    fn only_an_ended_run_has_its_audit() {
        let dir = tempfile::tempdir().unwrap();
        let folder = OutputFolder::create(dir.path(), false).unwrap();
        assert!(!folder.has_ended());
        folder.go_on().unwrap();
        folder.end("all is well").unwrap();
        assert!(OutputFolder::open(dir.path()).unwrap().has_ended());
        folder.go_on().unwrap();
        assert!(!folder.has_ended());
        folder.end("all is well").unwrap();
        assert!(!OutputFolder::create(dir.path(), false).unwrap().has_ended());
    }

    #[test]
    fn a_folder_with_anything_else_is_refused_with_path_and_remedy_and_left_alone() {
        let dir = tempfile::tempdir().unwrap();
        finished_run(dir.path());
        let notes = dir.path().join("snapshots/notes.txt");
        fs::write(&notes, "mine").unwrap();
        let error = OutputFolder::create(dir.path(), false).unwrap_err().to_string();
        assert!(error.contains(&dir.path().display().to_string()), "{error}");
        assert!(error.contains("snapshots/notes.txt") && error.contains("--force"), "{error}");
        assert!(dir.path().join(HISTORY_FILE).exists(), "a refusal changes nothing");
        OutputFolder::create(dir.path(), true).unwrap();
        assert_eq!(fs::read_to_string(&notes).unwrap(), "mine");
        assert!(!dir.path().join(HISTORY_FILE).exists());
    }

    #[test]
    fn a_users_own_scene_file_is_not_taken_for_a_result() {
        let dir = tempfile::tempdir().unwrap();
        let scene = dir.path().join(SCENE_FILE);
        fs::write(&scene, "title = 'mine'").unwrap();
        let error = OutputFolder::create(dir.path(), false).unwrap_err().to_string();
        assert!(error.contains("scene.toml"), "{error}");
        assert_eq!(fs::read_to_string(&scene).unwrap(), "title = 'mine'");
    }

    #[test]
    fn a_file_in_the_folders_place_is_an_error() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("file");
        fs::write(&path, "").unwrap();
        assert!(matches!(OutputFolder::create(&path, true), Err(OutputError::NotAFolder { .. })));
    }
}
