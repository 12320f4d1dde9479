//! `corpuscle plan`: what a run would model, and why.

use super::CliError;
use super::arguments::PlanArguments;
use super::settings::{model_of, scene_of};
use super::terminal::say;

pub fn plan(raw: PlanArguments) -> Result<(), CliError> {
    let plan = model_of(&raw.scene.scene, scene_of(&raw.scene)?)?.plan;
    say(&if raw.toml { plan.to_toml()? } else { plan.render() })?;
    if raw.strict && !plan.warnings.is_empty() {
        return Err(CliError::PlanWarnings { scene: raw.scene.scene, warnings: plan.warnings });
    }
    Ok(())
}
