//! `corpuscle check`: whether scenes can be run, by the set-up of a run up to its device: of each a line, what it holds,
//! and its warnings.

use std::path::Path;

use crate::output::grouped;
use crate::scene::load;
use crate::simulation::check_setup;

use super::CliError;
use super::arguments::CheckArguments;
use super::settings::model_of;
use super::terminal::{complain, say};

pub fn check(raw: CheckArguments, quiet: bool) -> Result<(), CliError> {
    let mut failed = 0;
    for path in &raw.scenes {
        match checked(path, raw.strict, quiet) {
            Ok(()) => {}
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

fn checked(path: &Path, strict: bool, quiet: bool) -> Result<(), CliError> {
    let model = model_of(path, load(path)?)?;
    check_setup(&model).map_err(|error| CliError::set_up(path, error))?;
    let plan = &model.plan;
    let warnings = plan.told();
    let mut line = format!(
        "ok {}: {} particles ({} injected), {} cells, {} steps",
        path.display(),
        grouped(plan.particles),
        grouped(plan.injected_particles),
        grouped(plan.grid.cell_count() as u64),
        grouped(plan.estimated_steps as u64),
    );
    match warnings.len() {
        0 => {}
        1 => line += ", 1 warning",
        several => line += &format!(", {several} warnings"),
    }
    say(&(line + "\n"))?;
    if !quiet {
        let indented = plan
            .inventory
            .render()
            .lines()
            .map(|line| format!("  {line}").trim_end().to_owned() + "\n")
            .collect::<String>();
        say(&indented)?;
    }
    say(&model.notes().iter().map(|note| format!("note: {note}\n")).collect::<String>())?;
    if strict && !warnings.is_empty() {
        return Err(CliError::PlanWarnings { scene: path.to_path_buf(), warnings });
    }
    say(&warnings.iter().map(|warning| format!("warning: {warning}\n")).collect::<String>())
}
