//! What the folder of a run has: read once, for its page, for a comparison and for whoever watches it.
//!
//! `history.csv` and `scene.toml` must be there. All else may be missing: a run that was killed has less. What is there and
//! broken is an error that names the file.

use std::fs;
use std::path::{Path, PathBuf};

use super::super::environment::Environment;
use super::super::error::OutputError;
use super::super::history::History;
use super::super::names::{AUDIT_FILE, ENVIRONMENT_FILE, HISTORY_FILE, LOG_FILE, PLAN_FILE, SCENE_FILE, TIMING_FILE};
use super::super::timing::Timing;
use super::columns::Meaning;
use super::state::Progressing;
use crate::scene::{Scene, UnitSystem, parse};

#[derive(Debug)]
pub struct Record {
    pub path: PathBuf,
    pub scene: Scene,
    /// As it was written.
    pub scene_table: toml::Table,
    pub plan: toml::Table,
    pub history: History,
    /// By column, in the units of the scene.
    pub meanings: Vec<Meaning>,
    /// The column of the time.
    pub axis: usize,
    /// The last line of the history had no end.
    pub cut: bool,
    pub state: Progressing,
    pub audit: Option<String>,
    pub environment: Option<Environment>,
    pub timing: Option<Timing>,
    pub log: String,
}

impl Record {
    /// # Errors
    /// If no run is there, or a file of it is broken.
    pub fn read(path: &Path) -> Result<Record, OutputError> {
        if !path.is_dir() {
            let source = std::io::Error::new(std::io::ErrorKind::NotFound, "no folder of that name");
            return Err(OutputError::io("open", path)(source));
        }
        for file in [HISTORY_FILE, SCENE_FILE] {
            if !path.join(file).is_file() {
                let expected = format!("{file} of a run");
                return Err(OutputError::NothingToReport { path: path.to_path_buf(), expected });
            }
        }
        let (history, cut) = History::read_so_far(&path.join(HISTORY_FILE))?;
        let scene_file = path.join(SCENE_FILE);
        let text = text_of(&scene_file)?;
        let mut scene = parse(&text, &scene_file.display().to_string(), Path::new(""))
            .map_err(|error| bad(&scene_file, &error.to_string()))?;
        let axis = history.headers().iter().position(|head| head == "time_s");
        let axis = axis.ok_or_else(|| bad(&path.join(HISTORY_FILE), "no column `time_s`"))?;
        let plan = if path.join(PLAN_FILE).exists() { table_of(&path.join(PLAN_FILE))? } else { toml::Table::new() };
        let environment = optional(&path.join(ENVIRONMENT_FILE), |file| {
            serde_json::from_str(&text_of(file)?).map_err(|error| bad(file, &error.to_string()))
        })?;
        let wished = environment.as_ref().map(|known: &Environment| known.units.as_str());
        if let Some(&system) = UnitSystem::ALL.iter().find(|system| Some(system.name()) == wished) {
            // The recorded scene is in SI, whatever the file was in.
            scene.units = system;
        }
        let meanings: Vec<Meaning> = history.headers().iter().map(|head| Meaning::of(head, scene.units)).collect();
        Ok(Record {
            scene_table: table_of(&scene_file)?,
            scene,
            plan,
            history,
            meanings,
            axis,
            cut,
            state: Progressing::of(path),
            audit: optional(&path.join(AUDIT_FILE), text_of)?,
            environment,
            timing: optional(&path.join(TIMING_FILE), |_| Timing::read(path))?,
            log: optional(&path.join(LOG_FILE), text_of)?.unwrap_or_default(),
            path: path.to_path_buf(),
        })
    }

    /// That of the folder.
    pub fn name(&self) -> String {
        let whole = self.path.canonicalize().unwrap_or_else(|_| self.path.clone());
        whole.file_name().map_or_else(|| "run".to_owned(), |name| name.to_string_lossy().into_owned())
    }

    /// s, at the end of the last row.
    pub fn reached(&self) -> f64 {
        let end = self.history.headers().iter().position(|head| head == "window_end_s").unwrap_or(self.axis);
        self.history.rows().last().map_or(0.0, |row| row[end])
    }

    /// What the log has told as a warning or an error, without the times of the clock.
    pub fn logged(&self) -> Vec<String> {
        let told = |line: &str| {
            let (_, rest) = line.split_once(" WARN ").or_else(|| line.split_once("ERROR "))?;
            Some(rest.trim().to_owned())
        };
        let mut lines: Vec<String> = self.log.lines().filter_map(told).collect();
        lines.dedup();
        lines
    }

    /// A value of the plan, as it is written.
    pub fn planned(&self, key: &str) -> Option<&toml::Value> {
        self.plan.get(key)
    }
}

fn bad(path: &Path, problem: &str) -> OutputError {
    OutputError::BadFile { path: path.to_path_buf(), problem: problem.to_owned() }
}

/// UTF-8.
pub fn text_of(path: &Path) -> Result<String, OutputError> {
    fs::read_to_string(path).map_err(OutputError::io("read", path))
}

fn table_of(path: &Path) -> Result<toml::Table, OutputError> {
    text_of(path)?.parse().map_err(|error: toml::de::Error| bad(path, error.message()))
}

/// Of a file that need not be there.
fn optional<T>(path: &Path, read: impl FnOnce(&Path) -> Result<T, OutputError>) -> Result<Option<T>, OutputError> {
    if path.exists() { read(path).map(Some) } else { Ok(None) }
}
