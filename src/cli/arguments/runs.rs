//! The arguments of the verbs about one scene.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use super::counts::count;
use crate::plan::significant;
use crate::scene::{LEAST_ACCURACY, MOST_ACCURACY, MOST_DEVICE_RATE};
use crate::simulation::{CheckpointEvery, WallTime};

pub(super) const EXIT_CODES: &str = "Exit codes: 0 done, or stopped as asked by an option, 2 bad input, 3 device trouble, \
    4 the audit failed, 128 + N stopped by signal N, with a checkpoint.";

/// A scene, and what is to be different in it.
#[derive(Debug, Args)]
pub struct SceneArguments {
    /// The scene, a TOML file
    #[arg(value_hint = ValueHint::FilePath)]
    pub scene: PathBuf,
    /// Particles at the end of the run, initial and injected together
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<u64>(1..=(1 << 27) - 1))]
    pub particles: Option<u64>,
    /// Another seed is another sample of the same gas
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = count::<u64>(0..=(1 << 56) - 1))]
    pub seed: Option<u64>,
}

/// What a run shall be worth, or may cost; docs/explanation/planner.md.
#[derive(Debug, Default, Args)]
#[command(next_help_heading = "What the plan shall choose by")]
pub struct WishArguments {
    /// Largest predicted error of a pressure, relative (0.02): the plan chooses the cheapest run that reaches it
    #[arg(long, value_name = "ERROR", allow_negative_numbers = true, value_parser = accuracy)]
    pub accuracy: Option<f64>,
    /// Device time that the run may take (90s, 10m, 2h): the plan chooses the most accurate run, if no accuracy is wished
    #[arg(long, allow_negative_numbers = true, value_name = "TIME")]
    pub time_budget: Option<WallTime>,
    /// The most particles that the plan may choose
    #[arg(long, value_name = "N", conflicts_with = "particles", allow_negative_numbers = true, value_parser = count::<u64>(1..=(1 << 27) - 1))]
    pub particle_budget: Option<u64>,
    /// Million particle-steps per second of the device, for the predicted time [default: 3, lavapipe on two cores]
    #[arg(long, value_name = "MILLIONS", allow_negative_numbers = true, value_parser = rate)]
    pub device_rate: Option<f64>,
}

fn accuracy(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(error) if (LEAST_ACCURACY..=MOST_ACCURACY).contains(&error) => Ok(error),
        _ => Err(format!("a relative error from {LEAST_ACCURACY} to {MOST_ACCURACY} is possible")),
    }
}

fn rate(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(millions) if millions > 0.0 && millions <= MOST_DEVICE_RATE => Ok(millions),
        Ok(all) if all > 0.0 && all.is_finite() => Err(format!(
            "it is in million particle-steps per second, at most {MOST_DEVICE_RATE}: is it without the million? {text} are {} million",
            significant(1e-6 * all)
        )),
        _ => Err("a number above 0 is possible".into()),
    }
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub struct RunArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// The folder for the results [default: results/<name of the scene file>]
    #[arg(short, long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Also replace a run that has not ended or is of another scene, and write beside what no run wrote
    #[arg(long)]
    pub force: bool,
    /// Run it with N seeds, the scene's and the N - 1 after it, each in a folder of its own; mean and spread of the
    /// histories in history_mean.csv
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<u32>(2..=1000), conflicts_with_all = ["steps", "checkpoint_every", "stop_after"])]
    pub repeat: Option<u32>,
    // Headings hold for all that follows: what has one goes last.
    #[command(flatten)]
    pub execution: ExecutionArguments,
    #[command(flatten)]
    pub wish: WishArguments,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub struct ResumeArguments {
    /// The folder of the run, or one of its checkpoints
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub from: PathBuf,
    #[command(flatten)]
    pub execution: ExecutionArguments,
}

/// How a run is done; changes no result.
#[derive(Debug, Args)]
pub struct ExecutionArguments {
    /// The device, by its index or PCI id in `corpuscle adapters` [default: the first]
    #[arg(long, value_name = "INDEX|PCI")]
    pub gpu: Option<String>,
    /// Steps per submission to the device; changes no result
    #[arg(long, value_name = "STEPS", allow_negative_numbers = true, value_parser = count::<u32>(1..=u64::from(u32::MAX)))]
    pub batch: Option<u32>,
    /// Stop after that many steps since the start of the run, at the end of an interval
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<u64>(1..=u64::MAX))]
    pub steps: Option<u64>,
    /// Stop at the first warning, of the plan or of the run, as an error
    #[arg(long)]
    pub strict: bool,
    /// Write report.html at the end, whatever the scene says [default: of a run in a terminal]
    #[arg(long)]
    pub report: bool,
    /// Write a checkpoint every so many steps (5000), or so often (90s, 10m, 2h, 1:30:00)
    #[arg(long, allow_negative_numbers = true, value_name = "STEPS|WALLTIME")]
    pub checkpoint_every: Option<CheckpointEvery>,
    /// Write a checkpoint and stop before the program has run so long (3h50m, 3:50:00)
    #[arg(long, allow_negative_numbers = true, value_name = "WALLTIME")]
    pub stop_after: Option<WallTime>,
    #[command(flatten)]
    pub sharing: SharingArguments,
}

/// How the work is shared out; changes no result.
#[derive(Debug, Args)]
#[command(next_help_heading = "Sharing the work (changes no result)")]
pub struct SharingArguments {
    /// Subdomains in this one process, on one device (under mpirun each rank has one)
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<u32>(1..=4096))]
    pub subdomains: Option<u32>,
    /// Who owns which part of the space: equal boxes, boxes balanced at the start, or balanced as the gas moves
    #[arg(long, value_enum, default_value_t = Balance::Dynamic)]
    pub balance: Balance,
    #[command(flatten)]
    pub tuning: TuningArguments,
}

/// When and by what the work is shared out anew.
#[derive(Debug, Args)]
#[command(next_help_heading = "Sharing the work (changes no result)")]
pub struct TuningArguments {
    /// Steps between two looks at the balance [default: 64]
    #[arg(long, value_name = "STEPS", allow_negative_numbers = true, value_parser = count::<u64>(1..=u64::MAX))]
    pub balance_every: Option<u64>,
    /// The load of the fullest rank over the mean from which on the space is cut anew, if that pays [default: 1.1]
    #[arg(long, allow_negative_numbers = true, value_name = "RATIO")]
    pub balance_threshold: Option<f64>,
    /// What is balanced: the measured cost, or the number of particles
    #[arg(long, value_enum, default_value_t = BalanceBy::Cost)]
    pub balance_by: BalanceBy,
    /// Rounds of collisions between two exchanges of borders: more are fewer messages and wider borders [default: what proves fastest]
    #[arg(long, value_name = "ROUNDS", allow_negative_numbers = true, value_parser = count::<u32>(1..=8))]
    pub halo_rounds: Option<u32>,
    /// Which particles of others choose partners here: those that an own one has chosen, or all within reach [default: what proves faster]
    #[arg(long, value_enum)]
    pub ghosts: Option<GhostsThatChoose>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum GhostsThatChoose {
    Asked,
    All,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Balance {
    Off,
    Initial,
    Dynamic,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum BalanceBy {
    Cost,
    Particles,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub struct RefineArguments {
    /// The folder of the run, or one of its checkpoints
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub from: PathBuf,
    /// How many particles each becomes
    #[arg(long, value_name = "K", allow_negative_numbers = true, value_parser = count::<u64>(2..=(1 << 27) - 1))]
    pub times: u64,
    /// The folder of the refined run [default: beside the run's, as <name>-x<K>]
    #[arg(short, long, value_name = "NEWDIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Also replace a run that has not ended or is of another scene, and write beside what no run wrote
    #[arg(long)]
    pub force: bool,
}

/// As scenes write them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum MethodName {
    ClosestApproach,
    HardSphere,
    Cell,
    HalfTurn,
    None,
    ControlVolume,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub struct PlanArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// As TOML, with everything that is in the plan.toml of a run
    #[arg(long)]
    pub toml: bool,
    /// Warnings are errors
    #[arg(long)]
    pub strict: bool,
    #[command(flatten)]
    pub wish: WishArguments,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub struct CheckArguments {
    /// The scenes, TOML files
    #[arg(required = true, value_name = "SCENE", value_hint = ValueHint::FilePath)]
    pub scenes: Vec<PathBuf>,
    /// Warnings are errors
    #[arg(long)]
    pub strict: bool,
}
