//! `corpuscle report`: the page of a run, of several side by side, or of a study.

use std::io::{IsTerminal, stderr};

use crate::output::{OutputFolder, write_report};

use super::CliError;
use super::arguments::ReportArguments;
use super::settings::RunSettings;
use super::terminal::say;

pub fn report(raw: ReportArguments) -> Result<(), CliError> {
    let path = write_report(&raw.folders, raw.out.as_deref())?;
    say(&format!("{}\n", path.display()))
}

/// The page at the end of a run: if it was asked for; unless anything was said, if somebody sees the run. That it cannot be
/// written is warned of: all that it would be made of is there.
pub fn report_of_run(settings: &RunSettings, folder: &OutputFolder, quiet: bool) {
    let asked = settings.model.scene.output.report;
    if !settings.execution.report && !asked.unwrap_or_else(|| !quiet && stderr().is_terminal()) {
        return;
    }
    match write_report(&[folder.path().to_path_buf()], None) {
        Ok(path) => tracing::info!("page of the run: {}", path.display()),
        Err(error) => tracing::warn!("no page of the run: {error}"),
    }
}
