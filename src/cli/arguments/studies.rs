//! The verbs that make many runs: what they take.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use super::counts::count;
use super::runs::{Balance, EXIT_CODES, MethodName, SceneArguments, TuningArguments};

/// Counts of devices that the machine has are run, others can be emulated on one of its devices.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub struct SweepArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// The counts of devices
    #[arg(long, required = true, value_name = "N,...", value_delimiter = ',', allow_negative_numbers = true, value_parser = count::<u32>(1..=4096))]
    pub devices: Vec<u32>,
    /// The ways to share the work out, each with every count
    #[arg(long, value_enum, value_name = "WAY,...", value_delimiter = ',', default_values_t = [Balance::Off, Balance::Dynamic])]
    pub balance: Vec<Balance>,
    /// The folder for the results [default: results/<name of the scene file>-sweep]
    #[arg(short, long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Also replace a sweep of another scene or a run, and write beside what no sweep wrote
    #[arg(long)]
    pub force: bool,
    /// The device, by its index or PCI id in `corpuscle adapters` [default: the first]
    #[arg(long, value_name = "INDEX|PCI")]
    pub gpu: Option<String>,
    /// Checkpoints (or folders) of a run of this scene to go on from, each for the time around it, instead of the start
    #[arg(long, value_name = "DIR,...", value_delimiter = ',', value_hint = ValueHint::DirPath, conflicts_with_all = ["weak", "particles", "seed"])]
    pub from: Vec<PathBuf>,
    #[command(flatten)]
    pub runs: RealRunArguments,
    #[command(flatten)]
    pub emulation: EmulationArguments,
    #[command(flatten)]
    pub tuning: TuningArguments,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Real runs")]
pub struct RealRunArguments {
    /// What starts a rank per device, such as "mpirun --bind-to none"; it is given `-n N` [default: none, the
    /// devices are subdomains of one process on one device]
    #[arg(long, value_name = "COMMAND")]
    pub launcher: Option<String>,
    /// Times that every count is run; medians are told [default: 3]
    #[arg(long, value_name = "TIMES", allow_negative_numbers = true, value_parser = count::<u32>(1..=1000))]
    pub repeat: Option<u32>,
    /// Stop each run after that many steps, at the end of an interval
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<u64>(1..=u64::MAX))]
    pub steps: Option<u64>,
    /// So many times the particles on so many devices: hold the particles of each device
    #[arg(long)]
    pub weak: bool,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Emulation")]
pub struct EmulationArguments {
    /// Measure the subdomains one at a time on one device, and model the time on so many
    #[arg(long)]
    pub emulate: bool,
    /// Also run these counts, and set the model beside them; more than 1 needs --launcher
    #[arg(long, requires = "emulate", value_name = "N,...", value_delimiter = ',', allow_negative_numbers = true, value_parser = count::<u32>(1..=4096))]
    pub validate: Vec<u32>,
    /// Intervals of three steps that are measured
    #[arg(long, requires = "emulate", value_name = "N", default_value_t = 3, allow_negative_numbers = true, value_parser = count::<u32>(1..=10000))]
    pub intervals: u32,
    /// Assumed: microseconds of an exchange with all neighbours
    #[arg(long, requires = "emulate", value_name = "US", default_value_t = 5.0)]
    pub latency_us: f64,
    /// Assumed: microseconds of each message in an exchange, beside those of the exchange
    #[arg(long, requires = "emulate", value_name = "US", default_value_t = 1.0)]
    pub message_us: f64,
    /// Assumed: gigabytes per second that a device sends
    #[arg(long, requires = "emulate", value_name = "GB/S", default_value_t = 10.0)]
    pub bandwidth_gbs: f64,
    /// Assumed of a GPU: nanoseconds per unit of work, that of a mean particle's step
    #[arg(long, requires = "emulate", value_name = "NS", default_value_t = 1.0)]
    pub gpu_particle_ns: f64,
    /// Assumed of a GPU: microseconds per pass
    #[arg(long, requires = "emulate", value_name = "US", default_value_t = 10.0)]
    pub gpu_pass_us: f64,
    /// Assumed of a GPU: microseconds until the host knows that it is done, in each exchange
    #[arg(long, requires = "emulate", value_name = "US", default_value_t = 20.0)]
    pub gpu_wait_us: f64,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub struct VerifyArguments {
    /// The cases to run; unless named all, with --quick those of laws, not of the prototype's figures
    #[arg(value_name = "CASE")]
    pub cases: Vec<String>,
    /// As much as minutes allow (the default)
    #[arg(long, conflicts_with = "full")]
    pub quick: bool,
    /// More particles and more cases: hours on a CPU
    #[arg(long)]
    pub full: bool,
    /// Cases that run at a time; changes no result
    #[arg(long, value_name = "N", default_value_t = 3, allow_negative_numbers = true, value_parser = count::<u32>(1..=64))]
    pub jobs: u32,
    /// Only say which cases there are
    #[arg(long, conflicts_with_all = ["quick", "full", "markdown", "gpu"])]
    pub list: bool,
    /// Also write the table as a page in Markdown
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub markdown: Option<PathBuf>,
    /// Keep what the page has of the cases that are not run; it must be of this device
    #[arg(long, requires = "markdown")]
    pub keep: bool,
    /// The device, by its index or PCI id in `corpuscle adapters` [default: the first]
    #[arg(long, value_name = "INDEX|PCI")]
    pub gpu: Option<String>,
}

/// What no other setting beats in both is the front.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub struct ParetoArguments {
    /// The case; --list says which there are and what each compares
    #[arg(value_name = "CASE", required_unless_present = "list")]
    pub case: Option<String>,
    /// Only these methods [default: all that the case has]
    #[arg(long, value_enum, value_name = "METHOD,...", value_delimiter = ',')]
    pub methods: Vec<MethodName>,
    /// Run every setting with so many seeds: means, with error bars
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true, value_parser = count::<u32>(1..=1000))]
    pub repeat: u32,
    /// A few small settings, to see that it works
    #[arg(long, conflicts_with = "full")]
    pub quick: bool,
    /// More particles and finer ranges: for a GPU
    #[arg(long)]
    pub full: bool,
    /// Only say which cases there are
    #[arg(long, conflicts_with_all = ["case", "quick", "full", "gpu", "out", "methods"])]
    pub list: bool,
    /// The folder for the results [default: results/pareto-<case>]
    #[arg(short, long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Write into a folder that holds more than an earlier chart
    #[arg(long)]
    pub force: bool,
    /// The device, by its index or PCI id in `corpuscle adapters` [default: the first]
    #[arg(long, value_name = "INDEX|PCI")]
    pub gpu: Option<String>,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub struct StabilityArguments {
    /// The axes to map, or `all`
    #[arg(value_name = "CASE", required_unless_present = "list")]
    pub cases: Vec<String>,
    /// Few values, known badly: to see that it works
    #[arg(long, conflicts_with = "full")]
    pub quick: bool,
    /// More values and more particles: hours on a CPU
    #[arg(long)]
    pub full: bool,
    /// Only say which axes there are
    #[arg(long, conflicts_with_all = ["cases", "quick", "full", "markdown", "gpu", "out", "go_on"])]
    pub list: bool,
    /// Keep the axes that the folder's stability.csv has whole: after an interruption
    #[arg(long)]
    pub go_on: bool,
    /// Also write the maps as a page in Markdown
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub markdown: Option<PathBuf>,
    /// The folder for the results [default: results/stability]
    #[arg(short, long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Write into a folder that holds more than earlier results
    #[arg(long)]
    pub force: bool,
    /// The device, by its index or PCI id in `corpuscle adapters` [default: the first]
    #[arg(long, value_name = "INDEX|PCI")]
    pub gpu: Option<String>,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub struct BenchArguments {
    /// Published scenes at their start: box, tank, corner
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', default_value = "box,tank,corner")]
    pub scene: Vec<String>,
    /// Particles at the end of the scene, initial and injected
    #[arg(long, value_name = "N,...", value_delimiter = ',', default_value = "1e5", allow_negative_numbers = true, value_parser = count::<u64>(1..=(1 << 27) - 1))]
    pub particles: Vec<u64>,
    /// Methods of collision
    #[arg(
        long,
        value_enum,
        value_name = "METHOD,...",
        value_delimiter = ',',
        default_value = "closest-approach,cell,none"
    )]
    pub methods: Vec<MethodName>,
    /// Steps of each run
    #[arg(long, value_name = "N", default_value_t = 64, allow_negative_numbers = true, value_parser = count::<u64>(1..=u64::MAX))]
    pub steps: u64,
    /// Also write all numbers into this file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub json: Option<PathBuf>,
    /// The device, by its index or PCI id in `corpuscle adapters` [default: the first]
    #[arg(long, value_name = "INDEX|PCI")]
    pub gpu: Option<String>,
}
