//! The arguments of the verbs that look at results.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use super::counts::count;
use super::runs::EXIT_CODES;

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub struct ReportArguments {
    /// The folder of a run or a study; of several runs, to lay them side by side
    #[arg(required = true, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub folders: Vec<PathBuf>,
    /// The file of the page [default: report.html in the folder; of several comparison.html]
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub struct WatchArguments {
    /// The folder of the run
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
    /// Print once and end; also without a terminal
    #[arg(long)]
    pub once: bool,
    /// Seconds between two looks at the files
    #[arg(long, value_name = "SECONDS", default_value_t = 2, allow_negative_numbers = true, value_parser = count::<u64>(1..=3600))]
    pub every: u64,
}
