//! `corpuscle plan`: what a run would model, and why.

use super::CliError;
use super::arguments::PlanArguments;
use super::settings::wished_model;
use super::terminal::say;

pub fn plan(raw: PlanArguments) -> Result<(), CliError> {
    let model = wished_model(&raw.scene, &raw.wish)?;
    let plan = model.explained();
    if raw.toml {
        say(&plan.to_toml()?)?;
    } else {
        let notes: String = model.notes().iter().map(|note| format!("\nnote: {note}\n")).collect();
        say(&(plan.render() + &notes))?;
    }
    if raw.strict && !plan.warnings.is_empty() {
        return Err(CliError::PlanWarnings { scene: raw.scene.scene, warnings: plan.warnings });
    }
    Ok(())
}
