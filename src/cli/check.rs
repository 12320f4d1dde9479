//! `corpuscle check`: whether scenes can be run, a line for each.

use std::path::Path;

use crate::output::grouped;
use crate::scene::load;

use super::CliError;
use super::arguments::CheckArguments;
use super::settings::model_of;
use super::terminal::{complain, say};

pub fn check(raw: CheckArguments) -> Result<(), CliError> {
    let mut failed = 0;
    for path in &raw.scenes {
        match verdict(path) {
            Ok(line) => say(&line)?,
            // The last word of a single scene is its own error.
            Err(error) if raw.scenes.len() == 1 => return Err(error),
            Err(error) => {
                failed += 1;
                complain(error);
            }
        }
    }
    if failed == 0 { Ok(()) } else { Err(CliError::Check { failed, checked: raw.scenes.len() }) }
}

fn verdict(path: &Path) -> Result<String, CliError> {
    let plan = model_of(path, load(path)?)?.plan;
    let mut line = format!(
        "ok {}: {} particles ({} injected), {} cells, {} steps",
        path.display(),
        grouped(plan.particles),
        grouped(plan.injected_particles),
        grouped(plan.grid.cell_count() as u64),
        grouped(plan.estimated_steps as u64),
    );
    match plan.warnings.len() {
        0 => {}
        1 => line += ", 1 warning",
        several => line += &format!(", {several} warnings"),
    }
    Ok(line + "\n")
}
