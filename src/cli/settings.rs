//! From raw arguments to what they mean: scenes with their overrides, and the settings of a run.

use std::path::{Path, PathBuf};

use crate::partition::By;
use crate::plan::doubts_of;
use crate::scene::{Scene, load};
use crate::simulation::{BalanceMode, BalanceOptions, Ghosts, HaloOptions, Model, mesh_doubts};

use super::CliError;
use super::arguments::{
    Balance, BalanceBy, ExecutionArguments, GhostsThatChoose, RunArguments, SceneArguments, SharingArguments,
    TuningArguments, WishArguments,
};
use super::run::CheckpointWish;

/// The scene of the file with the overrides in it, as if the file had said so.
pub fn scene_of(raw: &SceneArguments) -> Result<Scene, CliError> {
    let mut scene = load(&raw.scene)?;
    if let Some(particles) = raw.particles {
        scene.model.particles = Some(particles);
    }
    if let Some(seed) = raw.seed {
        scene.seed = seed;
    }
    Ok(scene)
}

/// The scene, its walls and its plan. `path` stands in the message if they are not sound, with what no vessel has: it may be why.
pub fn model_of(path: &Path, scene: Scene) -> Result<Model, CliError> {
    let asked = scene.clone();
    Model::new(scene).map_err(|error| {
        let doubts = [doubts_of(&asked), mesh_doubts(&asked)].concat();
        CliError::model(path, &asked.lines, error).doubting(&doubts)
    })
}

/// The same where the command line may wish an accuracy or set budgets. A wish sets aside how many particles the file asks
/// for, unless the command line says that too.
pub fn wished_model(raw: &SceneArguments, wish: &WishArguments) -> Result<Model, CliError> {
    let mut scene = scene_of(raw)?;
    let typed = wish.accuracy.is_some() || wish.time_budget.is_some() || wish.particle_budget.is_some();
    let asked = &mut scene.model.wish;
    asked.accuracy = wish.accuracy.or(asked.accuracy);
    asked.time_budget = wish.time_budget.map(|time| time.0.as_secs_f64()).or(asked.time_budget);
    asked.particle_budget = wish.particle_budget.or(asked.particle_budget);
    asked.device_rate = wish.device_rate.map(|millions| 1e6 * millions).or(asked.device_rate);
    if raw.particles.is_some() {
        asked.particle_budget = None;
    }
    if wish.device_rate.is_some() && !asked.is_any() {
        return Err(CliError::RateWithoutWish);
    }
    let aside = if typed && raw.particles.is_none() { scene.model.particles.take() } else { None };
    let mut model = model_of(&raw.scene, scene)?;
    if let (Some(choice), Some(particles)) = (&mut model.choice, aside) {
        choice.set_aside(particles);
    }
    Ok(model)
}

/// A run as it will be done.
pub struct RunSettings {
    /// The file that it is from, for messages.
    pub scene: PathBuf,
    pub model: Model,
    pub folder: PathBuf,
    pub force: bool,
    pub execution: Execution,
}

/// How a run is done.
#[derive(Debug, Clone)]
pub struct Execution {
    /// Index or PCI bus id; `None`: the first.
    pub gpu: Option<String>,
    /// Steps per submission; `None`: a whole interval.
    pub batch: Option<u32>,
    /// Since the start of the run.
    pub stop_after_steps: Option<u64>,
    /// Warnings are errors.
    pub strict: bool,
    /// A page at the end, whatever the scene says.
    pub report: bool,
    pub sharing: Sharing,
    pub checkpoints: CheckpointWish,
}

impl Execution {
    pub fn new(raw: ExecutionArguments) -> Result<Execution, CliError> {
        let ExecutionArguments { gpu, batch, steps, strict, report, checkpoint_every, stop_after, sharing } = raw;
        let checkpoints = CheckpointWish { every: checkpoint_every, stop_after };
        let sharing = Sharing::new(&sharing)?;
        Ok(Execution { gpu, batch, stop_after_steps: steps, strict, report, sharing, checkpoints })
    }
}

/// How the work is shared out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sharing {
    /// Subdomains in this process; 1 under a launcher of several ranks.
    pub subdomains: usize,
    pub balance: BalanceOptions,
    pub halo: HaloOptions,
}

impl From<BalanceBy> for By {
    fn from(asked: BalanceBy) -> By {
        match asked {
            BalanceBy::Cost => By::Cost,
            BalanceBy::Particles => By::Particles,
        }
    }
}

impl From<&TuningArguments> for HaloOptions {
    fn from(raw: &TuningArguments) -> HaloOptions {
        let ghosts = raw.ghosts.map(|ghosts| match ghosts {
            GhostsThatChoose::Asked => Ghosts::OnDemand,
            GhostsThatChoose::All => Ghosts::All,
        });
        HaloOptions { rounds: raw.halo_rounds, ghosts }
    }
}

/// In the mode that is the default.
impl TryFrom<&TuningArguments> for BalanceOptions {
    type Error = CliError;

    fn try_from(raw: &TuningArguments) -> Result<BalanceOptions, CliError> {
        let usual = BalanceOptions::default();
        let threshold = raw.balance_threshold.unwrap_or(usual.threshold);
        if !(threshold.is_finite() && threshold >= 1.0) {
            return Err(CliError::Threshold { found: threshold });
        }
        let every = raw.balance_every.unwrap_or(usual.every);
        Ok(BalanceOptions { by: By::from(raw.balance_by), every, threshold, ..usual })
    }
}

impl Sharing {
    fn new(raw: &SharingArguments) -> Result<Sharing, CliError> {
        let mode = match raw.balance {
            Balance::Off => BalanceMode::Off,
            Balance::Initial => BalanceMode::Initial,
            Balance::Dynamic => BalanceMode::Dynamic,
        };
        Ok(Sharing {
            subdomains: raw.subdomains.unwrap_or(1) as usize,
            balance: BalanceOptions { mode, ..BalanceOptions::try_from(&raw.tuning)? },
            halo: HaloOptions::from(&raw.tuning),
        })
    }
}

impl RunSettings {
    pub fn new(raw: RunArguments) -> Result<RunSettings, CliError> {
        let path = &raw.scene.scene;
        let model = wished_model(&raw.scene, &raw.wish)?;
        let folder = raw.out.unwrap_or_else(|| default_folder(path));
        let execution = Execution::new(raw.execution)?;
        Ok(RunSettings { scene: path.clone(), model, folder, force: raw.force, execution })
    }
}

/// `results/tank` of `scenes/tank.toml`, below the working directory.
fn default_folder(scene: &Path) -> PathBuf {
    Path::new("results").join(scene.file_stem().unwrap_or(scene.as_os_str()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_folder_is_named_after_the_scene() {
        assert_eq!(default_folder(Path::new("scenes/tank.toml")), Path::new("results/tank"));
        assert_eq!(default_folder(Path::new("/a/b.c.toml")), Path::new("results/b.c"));
    }

    #[test]
    fn overrides_replace_what_the_file_says_and_nothing_else() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/box.toml");
        let raw = |particles, seed| SceneArguments { scene: path.clone(), particles, seed };
        let plain = scene_of(&raw(None, None)).unwrap();
        let other = scene_of(&raw(Some(500), Some(7))).unwrap();
        assert_eq!((other.model.particles, other.seed), (Some(500), 7));
        assert_ne!(plain, other);
        let restored = Scene { model: plain.model.clone(), seed: plain.seed, ..other };
        assert_eq!(restored, plain);
    }
}
