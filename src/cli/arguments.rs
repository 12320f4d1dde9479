//! The command line as typed. Help, completions and man pages all come from these types.

mod counts;
mod looks;
mod meshes;
mod pictures;
mod runs;
mod studies;

use std::ffi::OsString;

use clap::{ArgAction, Args, ColorChoice, Parser, Subcommand, ValueEnum};

use runs::EXIT_CODES;

pub use looks::{ReportArguments, WatchArguments};
pub use meshes::{MeshArguments, MotionArguments, ShapeArguments};
pub use pictures::RenderArguments;
pub use runs::{
    Balance, BalanceBy, CheckArguments, ExecutionArguments, GhostsThatChoose, MethodName, PlanArguments,
    RefineArguments, ResumeArguments, RunArguments, SceneArguments, SharingArguments, TuningArguments, WishArguments,
};
pub use studies::{
    BenchArguments, EmulationArguments, ParetoArguments, StabilityArguments, SweepArguments, VerifyArguments,
};

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
    /// Write the page of a run, of several runs side by side, or of a study: one HTML file; opens no device
    Report(ReportArguments),
    /// Watch a run that goes on elsewhere, by its files
    Watch(WatchArguments),
    /// Run reference cases and compare with closed forms and published figures
    Verify(VerifyArguments),
    /// Chart error against device time over methods and settings, for a case with a known answer
    Pareto(ParetoArguments),
    /// Map where the methods fail: which quantity breaks first along an axis, and by how much
    Stability(StabilityArguments),
    /// Measure what a step costs on this device, phase by phase: time, bytes, share of what it can do
    Bench(BenchArguments),
    /// Draw a run's snapshot, or a mesh, as a PNG picture
    Render(RenderArguments),
    /// Print what a run would model, and why; opens no device
    Plan(PlanArguments),
    /// Check scenes, their walls and their plans; opens no device
    Check(CheckArguments),
    /// Make a mesh (a bag of two sheets, a cylinder, a sphere) or motion of its nodes; convert and check their files
    Mesh(MeshArguments),
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
            Verb::Report(_) => Some("report"),
            Verb::Sweep(_) => Some("sweep"),
            Verb::Verify(_) => Some("verify"),
            Verb::Pareto(_) => Some("pareto"),
            Verb::Stability(_) => Some("stability"),
            Verb::Bench(_) => Some("bench"),
            Verb::Render(_) => Some("render"),
            Verb::Mesh(_) => Some("mesh"),
            Verb::Run(_)
            | Verb::Resume(_)
            | Verb::Plan(_)
            | Verb::Check(_)
            | Verb::Watch(_)
            | Verb::Schema
            | Verb::Adapters
            | Verb::Completions(_)
            | Verb::Man(_) => None,
        }
    }
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
    /// Print the reference of all verbs, as Markdown
    #[arg(long, conflicts_with = "verb")]
    pub markdown: bool,
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
            ("--particles", "-3", "a whole number from 1 to 134217727, such as 2000, 2_000 or 2e3, is possible"),
            ("--particles", "2.5", "a whole number from 1 to 134217727"),
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
            ("--particles", "134217728"),
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
            ("--particles", "134217727"),
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
