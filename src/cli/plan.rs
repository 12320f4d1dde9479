//! `corpuscle plan`: what a run would model, and why.

use super::CliError;
use super::arguments::PlanArguments;
use super::settings::wished_model;
use super::terminal::say;

pub fn plan(raw: PlanArguments) -> Result<(), CliError> {
    let plan = wished_model(&raw.scene, &raw.wish)?.explained();
    say(&if raw.toml { plan.to_toml()? } else { plan.render() })?;
    if raw.strict && !plan.warnings.is_empty() {
        return Err(CliError::PlanWarnings { scene: raw.scene.scene, warnings: plan.warnings });
    }
    Ok(())
}
