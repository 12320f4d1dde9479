//! The page of a run, of several runs side by side, or of a study: `report.html`, made from files of results alone.
//!
//! [`record`] reads the folder of a run; [`run`], [`compare`] and [`study`] say what stands on a page; [`page`] makes one
//! file of it. A page has a part of the data: [`series`] joins rows, [`cloud`] takes a sample of the particles, [`surfaces`]
//! makes fine meshes coarser, and the page says so. [`watch`] tells of a run in a terminal.

mod cloud;
mod columns;
mod compare;
mod extent;
mod figure;
mod packed;
mod page;
mod record;
mod run;
mod series;
mod state;
mod study;
mod surfaces;
mod verdict;
mod view;
mod watch;

use std::path::{Path, PathBuf};

use super::OutputError;
use super::names::{HISTORY_FILE, PARETO_FILE, REPORT_FILE, STABILITY_FILE, SWEEP_FILE, is_seed_folder};

pub use state::Progressing;
pub use verdict::audit_verdict;
pub use watch::{Seen, seen};

/// The page of several runs, in the working directory.
pub const COMPARISON_FILE: &str = "comparison.html";

/// Writes the page of what the folders have: of one its run, study or seeds, into it; of several the comparison of their
/// runs, into the working directory. `out` is another place. Returns where the page is.
///
/// # Errors
/// If a folder has nothing to report, a file is broken, or the page cannot be written.
pub fn write_report(folders: &[PathBuf], out: Option<&Path>) -> Result<PathBuf, OutputError> {
    let [folder] = folders else {
        let path = out.map_or_else(|| PathBuf::from(COMPARISON_FILE), Path::to_path_buf);
        compare::write(folders, &path)?;
        return Ok(path);
    };
    let path = out.map_or_else(|| folder.join(REPORT_FILE), Path::to_path_buf);
    if let Some(page) = study::page(folder)? {
        page.write(&path)?;
        return Ok(path);
    }
    let seeds = seeds(folder)?;
    if !folder.join(HISTORY_FILE).is_file() && !seeds.is_empty() {
        compare::write(&seeds, &path)?;
        return Ok(path);
    }
    if folder.is_dir() && !folder.join(HISTORY_FILE).is_file() {
        let expected = format!("{HISTORY_FILE}, {SWEEP_FILE}, {PARETO_FILE}, {STABILITY_FILE} or folder of a seed");
        return Err(OutputError::NothingToReport { path: folder.clone(), expected });
    }
    run::write(folder, out)
}

/// The folders of the runs of several seeds, by seed.
fn seeds(folder: &Path) -> Result<Vec<PathBuf>, OutputError> {
    let list = || -> std::io::Result<Vec<PathBuf>> {
        let mut found = Vec::new();
        for entry in std::fs::read_dir(folder)? {
            let entry = entry?;
            if is_seed_folder(&entry.file_name().to_string_lossy()) && entry.path().join(HISTORY_FILE).is_file() {
                found.push(entry.path());
            }
        }
        found.sort_by_key(|path| {
            let name = path.to_string_lossy();
            name.rsplit('-').next().and_then(|seed| seed.parse::<u64>().ok())
        });
        Ok(found)
    };
    list().map_err(OutputError::io("list", folder))
}
