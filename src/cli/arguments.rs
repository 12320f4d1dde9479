//! The command line as typed. Help, completions and man pages all come from these types.

mod counts;
mod studies;

use std::path::PathBuf;

use std::ffi::OsString;

use clap::{ArgAction, Args, ColorChoice, Parser, Subcommand, ValueEnum, ValueHint};

use crate::scene::{LEAST_ACCURACY, MOST_ACCURACY};
use crate::simulation::{CheckpointEvery, WallTime};

pub use counts::count;
pub use studies::{
    BenchArguments, EmulationArguments, ParetoArguments, StabilityArguments, SweepArguments, VerifyArguments,
};

const EXIT_CODES: &str = "Exit codes: 0 done, or stopped as asked by an option, 2 bad input, 3 device trouble, \
    4 the audit failed, 128 + N stopped by signal N, with a checkpoint.";

/// The program's version, and the commit of its sources where that is known.
const VERSION: &str = env!("CORPUSCLE_VERSION");

/// A GPU solver of the corpuscular particle method: gas in inflator tank tests and airbags
#[derive(Debug, Parser)]
#[command(name = "corpuscle", version = VERSION, after_help = EXIT_CODES)]
pub struct Arguments {
    #[command(subcommand)]
    pub verb: Verb,
    /// Colours on a terminal [auto: unless NO_COLOR is set]
    #[arg(long, global = true, value_enum, value_name = "WHEN", default_value = "auto", hide_default_value = true)]
    pub color: ColorChoice,
    /// Say more; -vv says all
    #[arg(short, long, global = true, action = ArgAction::Count, conflicts_with = "quiet")]
    pub verbose: u8,
    /// Say nothing but where the results are, warnings and errors
    #[arg(short, long, global = true)]
    pub quiet: bool,
}

/// The choice of colours in a command line that is not parsed yet: errors of parsing have them, too.
pub fn colour_of(words: &[OsString]) -> ColorChoice {
    let option = "--color";
    let mut choice = ColorChoice::Auto;
    for (index, word) in words.iter().enumerate().skip(1) {
        let word = word.to_string_lossy();
        let value = match word.strip_prefix(option) {
            Some("") => words.get(index + 1).map(|next| next.to_string_lossy().into_owned()),
            Some(rest) => rest.strip_prefix('=').map(str::to_owned),
            None => None,
        };
        choice = value.and_then(|value| ColorChoice::from_str(&value, false).ok()).unwrap_or(choice);
    }
    choice
}

/// How much is said on standard error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verbosity {
    Quiet,
    Normal,
    Verbose,
    All,
}

impl Arguments {
    pub fn verbosity(&self) -> Verbosity {
        match (self.quiet, self.verbose) {
            (true, _) => Verbosity::Quiet,
            (_, 0) => Verbosity::Normal,
            (_, 1) => Verbosity::Verbose,
            _ => Verbosity::All,
        }
    }
}

#[derive(Debug, Subcommand)]
pub enum Verb {
    /// Run a scene
    Run(RunArguments),
    /// Split the particles of a checkpoint into more and smaller ones; opens no device
    Refine(RefineArguments),
    /// Go on with a run from its last checkpoint, on any number of devices
    Resume(ResumeArguments),
    /// Run a scene on several counts of devices, or emulate them, and compare
    Sweep(SweepArguments),
    /// Run reference cases and compare with closed forms and published figures
    Verify(VerifyArguments),
    /// Chart error against device time over methods and settings, for a case with a known answer
    Pareto(ParetoArguments),
    /// Map where the methods fail: which quantity breaks first along an axis, and by how much
    Stability(StabilityArguments),
    /// Measure what a step costs on this device, phase by phase: time, bytes, share of what it can do
    Bench(BenchArguments),
    /// Print what a run would model, and why; opens no device
    Plan(PlanArguments),
    /// Check scenes, their walls and their plans; opens no device
    Check(CheckArguments),
    /// Print the JSON schema of scene files
    #[command(after_help = EXIT_CODES)]
    Schema,
    /// List the devices that runs can use, with the limits that matter
    #[command(after_help = EXIT_CODES)]
    Adapters,
    /// Print a shell's completions
    Completions(CompletionsArguments),
    /// Print a man page
    Man(ManArguments),
}

impl Verb {
    /// The name of one that measures or writes by itself: several processes of it would do all of it several times, into one folder.
    pub fn of_one_process(&self) -> Option<&'static str> {
        match self {
            Verb::Refine(_) => Some("refine"),
            Verb::Sweep(_) => Some("sweep"),
            Verb::Verify(_) => Some("verify"),
            Verb::Pareto(_) => Some("pareto"),
            Verb::Stability(_) => Some("stability"),
            Verb::Bench(_) => Some("bench"),
            Verb::Run(_)
            | Verb::Resume(_)
            | Verb::Plan(_)
            | Verb::Check(_)
            | Verb::Schema
            | Verb::Adapters
            | Verb::Completions(_)
            | Verb::Man(_) => None,
        }
    }
}

/// A scene, and what is to be different in it.
#[derive(Debug, Args)]
pub struct SceneArguments {
    /// The scene, a TOML file
    #[arg(value_hint = ValueHint::FilePath)]
    pub scene: PathBuf,
    /// Particles at the end of the run, initial and injected together
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<u64>(1..=(1 << 28) - 1))]
    pub particles: Option<u64>,
    /// Another seed is another sample of the same gas
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = count::<u64>(0..=(1 << 56) - 1))]
    pub seed: Option<u64>,
}

/// What a run shall be worth, or may cost; docs/planner.md.
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
    #[arg(long, value_name = "N", conflicts_with = "particles", allow_negative_numbers = true, value_parser = count::<u64>(1..=(1 << 28) - 1))]
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
        Ok(millions) if millions > 0.0 && millions.is_finite() => Ok(millions),
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
    #[arg(long, value_name = "K", allow_negative_numbers = true, value_parser = count::<u64>(2..=(1 << 28) - 1))]
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

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub struct CompletionsArguments {
    pub shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub struct ManArguments {
    /// The page of this verb instead of the program's
    pub verb: Option<String>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_definition_is_sound() {
        Arguments::command().debug_assert();
    }

    /// A run of several seeds has no one state to stop at or to go on from.
    #[test]
    fn runs_of_several_seeds_have_no_checkpoints() {
        let parse = |more: &[&str]| {
            Arguments::try_parse_from([&["corpuscle", "run", "s.toml", "--repeat", "3"], more].concat())
        };
        assert!(parse(&[]).is_ok() && parse(&["--seed", "5"]).is_ok());
        for more in [["--steps", "64"], ["--checkpoint-every", "64"], ["--stop-after", "90s"]] {
            assert!(parse(&more).is_err(), "{more:?}");
        }
    }

    /// A negative number is a value that is refused, and no unknown option.
    #[test]
    fn negative_numbers_are_refused_as_values() {
        for (option, value, words) in [
            ("--particles", "-3", "a whole number from 1 to 268435455, such as 2000, 2_000 or 2e3, is possible"),
            ("--particles", "2.5", "a whole number from 1 to 268435455"),
            ("--seed", "-1", "a whole number from 0 to 72057594037927935"),
            ("--steps", "0", "a whole number from 1 on is possible"),
            ("--accuracy", "-0.1", "a relative error from 0.0001 to 0.5"),
            ("--checkpoint-every", "-5", "neither a number of steps"),
        ] {
            let error = Arguments::try_parse_from(["corpuscle", "run", "s.toml", option, value]).unwrap_err();
            assert!(error.to_string().contains(words), "{error}");
        }
    }

    #[test]
    fn values_out_of_range_are_refused() {
        let parse =
            |option: &str, value: &str| Arguments::try_parse_from(["corpuscle", "run", "s.toml", option, value]);
        for (option, value) in [
            ("--particles", "0"),
            ("--particles", "268435456"),
            ("--seed", "72057594037927936"),
            ("--batch", "0"),
            ("--steps", "-1"),
            ("--checkpoint-every", "0"),
            ("--checkpoint-every", "often"),
            ("--stop-after", "90"),
            ("--repeat", "1"),
            ("--particles", "2.5"),
        ] {
            assert!(parse(option, value).is_err(), "{option} {value}");
        }
        for (option, value) in [
            ("--particles", "268435455"),
            ("--particles", "2e3"),
            ("--steps", "1_000"),
            ("--checkpoint-every", "5e3"),
            ("--seed", "0"),
            ("--batch", "1"),
            ("--steps", "1"),
            ("--stop-after", "90s"),
        ] {
            assert!(parse(option, value).is_ok(), "{option} {value}");
        }
    }
}
