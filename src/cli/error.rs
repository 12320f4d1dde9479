//! What can go wrong with a command, and the exit code that says so.

use std::path::{Path, PathBuf};

use miette::Diagnostic;

use crate::geometry::{MeshError, NodeFramesError};
use crate::gpu::GpuError;
use crate::output::picture::PictureError;
use crate::output::{CheckpointError, OutputError};
use crate::ranks::RankError;
use crate::scene::{Lines, SceneError};
use crate::simulation::{ModelError, RefineError, SimulationError};
use crate::study::StudyError;
use crate::study::verify::page::PageError;

pub const BAD_INPUT: u8 = 2;
pub const DEVICE_TROUBLE: u8 = 3;
pub const AUDIT_FAILED: u8 = 4;

#[derive(Debug, thiserror::Error, Diagnostic)]
pub enum CliError {
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    /// Built by [`CliError::model`].
    #[error("{}{}: {error}", path.display(), line.map_or(String::new(), |line| format!(", line {line}")))]
    Model {
        path: PathBuf,
        line: Option<usize>,
        error: Box<ModelError>,
        #[help]
        help: Option<String>,
    },
    /// Built by [`CliError::set_up`].
    #[error("{}: {error}", path.display())]
    SetUp {
        path: PathBuf,
        error: Box<SimulationError>,
        #[help]
        help: Option<String>,
    },
    #[error("{failed} of {checked} scenes cannot be run")]
    Check { failed: usize, checked: usize },
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error("cannot write the plan as TOML: {0}")]
    PlanToml(#[from] toml::ser::Error),
    #[error("cannot write the schema as JSON: {0}")]
    SchemaJson(#[from] serde_json::Error),
    #[error("cannot write to standard output: {0}")]
    StandardOutput(std::io::Error),
    #[error("{}: {error}", path.display())]
    #[diagnostic(help("without --keep the page is written anew, with the cases that are run"))]
    Page { path: PathBuf, error: PageError },
    #[error("there is no verb `{asked}`; there are: {}", known.join(", "))]
    UnknownVerb { asked: String, known: Vec<String> },
    #[error(transparent)]
    #[diagnostic(help("`corpuscle adapters` lists what runs can use"))]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Simulation(#[from] SimulationError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Checkpoint(#[from] CheckpointError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Refine(#[from] RefineError),
    #[error("{}: this is the folder of the run to be refined", path.display())]
    #[diagnostic(help("name another with --out: the refined run is a run of its own"))]
    RefinedOntoItself { path: PathBuf },
    #[error(transparent)]
    #[diagnostic(transparent)]
    Picture(PictureError),
    #[error("{}: there is no such folder or file", path.display())]
    #[diagnostic(help("name the folder of a run, as it was given as --out, or a mesh (OBJ, STL)"))]
    NoSubject { path: PathBuf },
    #[error("{option} with {}: it is for pictures of runs, and this is a file", path.display())]
    #[diagnostic(help("leave it out, or name the folder of a run"))]
    OptionOfRuns { option: &'static str, path: PathBuf },
    #[error("--steps {asked}: the run has done {done} steps already")]
    #[diagnostic(help("--steps counts from the start of the run; leave it out to go on to the end of the scene"))]
    StepsDone { asked: u64, done: u64 },
    #[error("the system does not let signals be caught: {0}")]
    Signals(std::io::Error),
    #[error("--balance-threshold {found}: expected a number of at least 1")]
    Threshold { found: f64 },
    #[error("--device-rate without a wish: it scales the predicted cost of the plan's choices")]
    #[diagnostic(help("add --accuracy, --time-budget or --particle-budget"))]
    RateWithoutWish,
    #[error("{option} {found}: expected {expected}")]
    SweepFigure { option: &'static str, found: f64, expected: &'static str },
    #[error("--balance initial with --from: a run that goes on from a checkpoint knows no start to cut by")]
    #[diagnostic(help("leave out `initial`, or only emulate"))]
    InitialFrom,
    #[error("{}: the checkpoint is of another scene than {}", from.display(), scene.display())]
    OtherScene { from: PathBuf, scene: PathBuf },
    #[error("--launcher is empty: expected a program and its arguments, such as \"mpirun --bind-to none\"")]
    NoLauncher,
    #[error(
        "--validate {devices} without --launcher: subdomains of one process share one device, the model has {devices}"
    )]
    #[diagnostic(help("add --launcher \"mpirun --bind-to none\", or validate 1"))]
    ValidateOnOne { devices: u32 },
    #[error("--validate {devices}: the model has no {devices} to be set beside a run")]
    #[diagnostic(help("name the count among --devices, too"))]
    ValidateOther { devices: u32 },
    #[error("{option}: an emulation makes no runs that it would change")]
    #[diagnostic(help("leave it out, or make runs beside the emulation with --validate"))]
    NoRuns { option: &'static str },
    #[error(transparent)]
    #[diagnostic(transparent)]
    Study(#[from] StudyError),
    #[error("--subdomains {asked} under a launcher of {ranks} ranks: each rank has one subdomain")]
    #[diagnostic(help("leave out --subdomains, or start the program without the launcher"))]
    SubdomainsOfRanks { asked: usize, ranks: usize },
    #[error("`{verb}` is the work of one process, and a launcher has started several ({variable} = {value})")]
    #[diagnostic(help("start it without the launcher; only `run` and `resume` share their work among ranks"))]
    OneProcess { verb: &'static str, variable: &'static str, value: String },
    #[error(transparent)]
    #[diagnostic(help("docs/how-to/restart-and-clusters.md says how ranks are started"))]
    Rank(#[from] RankError),
    #[error("there is no case `{asked}`; there are: {}", known.join(", "))]
    UnknownCase { asked: String, known: Vec<String> },
    #[error("case `{case}` has no `{method}`; it has: {}", known.join(", "))]
    MethodOfCase { case: String, method: &'static str, known: Vec<&'static str> },
    #[error("--repeat with the method `control-volume`: it draws nothing, so that all seeds give the same")]
    #[diagnostic(help("leave out --repeat, or ask for particles with another `method` in [model]"))]
    NothingToRepeat,
    #[error("--repeat of a scene with `switch`: each seed would have other rows")]
    #[diagnostic(help("leave out --repeat, or `switch` in [model]"))]
    RepeatedSwitch,
    #[error("the method `control-volume` has no steps of particles to measure")]
    #[diagnostic(help("leave it out of --methods"))]
    NothingToBench,
    #[error("--repeat {times} from seed {first} on: seeds are below {}", 1u64 << 56)]
    SeedsBeyond { first: u64, times: u32 },
    #[error("{failed} of {checks} checks do not pass")]
    #[diagnostic(help(
        "FAIL: off by more than the tolerance; UNCLEAR: the run knows too little. Please report it with the adapter and driver"
    ))]
    Verification { failed: usize, checks: usize },
    #[error("{}: --strict, and the plan warns:{}", scene.display(), list(warnings))]
    #[diagnostic(help("each warning says what to change; without --strict the run would start"))]
    PlanWarnings { scene: PathBuf, warnings: Vec<String> },
    #[error("--strict, and the run warns:{}", list(warnings))]
    #[diagnostic(help("the results are written; without --strict this would be no error"))]
    RunWarnings { warnings: Vec<String> },
    #[error(transparent)]
    #[diagnostic(transparent)]
    Mesh(#[from] MeshError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    NodeFrames(#[from] NodeFramesError),
    #[error("`{found}` is no mesh: expected {}, or a file with the ending obj, stl, nodes, series or pvd", shapes.join(", "))]
    MeshSource { found: String, shapes: Vec<&'static str> },
    #[error("{source_name} needs {option}")]
    MeshNeeds { source_name: String, option: &'static str },
    #[error("{source_name} takes no {option}; it takes {}", if takes.is_empty() { "none".into() } else { takes.join(", ") })]
    MeshOption { source_name: String, option: &'static str, takes: Vec<&'static str> },
    #[error("{}: found {found}, expected {expected}", path.display())]
    #[diagnostic(help("meshes are .obj or .stl files; frames, of --shake or --scale-to, .nodes or .vtk.series files"))]
    MeshOutput { path: PathBuf, found: &'static str, expected: &'static str },
    #[error("the audit failed:{}", list(failures))]
    #[diagnostic(help("the results are written, and cannot be trusted; please report it with the scene"))]
    Audit { failures: Vec<String> },
}

fn list(failures: &[String]) -> String {
    failures.iter().map(|failure| format!("\n- {failure}")).collect()
}

impl CliError {
    /// With the line of the entry that the error is about.
    pub fn model(path: &Path, lines: &Lines, error: ModelError) -> CliError {
        let help = error.help().map(|help| help.to_string());
        CliError::Model {
            path: path.to_path_buf(),
            line: lines.of_error(&error.to_string()),
            error: Box::new(error),
            help,
        }
    }

    pub fn set_up(path: &Path, error: SimulationError) -> CliError {
        let help = error.help().map(|help| help.to_string());
        CliError::SetUp { path: path.to_path_buf(), error: Box::new(error), help }
    }

    /// The same with what no vessel has before the help: what else would help follows from it.
    pub fn doubting(self, doubts: &[String]) -> CliError {
        match self {
            CliError::Model { path, line, error, help } if !doubts.is_empty() => {
                let told = format!("the cause may be a value that no vessel has:{}", list(doubts));
                let help = Some(help.map_or(told.clone(), |help| format!("{told}\nif it is meant: {help}")));
                CliError::Model { path, line, error, help }
            }
            other => other,
        }
    }

    pub fn exit_code(&self) -> u8 {
        match self {
            CliError::Study(error) => study_code(error),
            CliError::Gpu(_)
            | CliError::Rank(_)
            | CliError::Picture(PictureError::Gpu(_))
            | CliError::Simulation(
                SimulationError::Gpu(_)
                | SimulationError::Rank(_)
                | SimulationError::Message { .. }
                | SimulationError::Dealt { .. },
            ) => DEVICE_TROUBLE,
            CliError::Audit { .. }
            | CliError::RunWarnings { .. }
            | CliError::Verification { .. }
            | CliError::Simulation(
                SimulationError::Lost { .. }
                | SimulationError::LostNodes { .. }
                | SimulationError::OverPlane { .. }
                | SimulationError::InsideOut { .. }
                | SimulationError::Ladder { .. }
                | SimulationError::Guard { .. },
            ) => AUDIT_FAILED,
            CliError::Simulation(
                SimulationError::Geometry(_)
                | SimulationError::Fill(_)
                | SimulationError::State(_)
                | SimulationError::Cells(_)
                | SimulationError::Membrane(_)
                | SimulationError::Partition(_)
                | SimulationError::Checkpoint(_)
                | SimulationError::Resume(_)
                | SimulationError::NoChamber { .. }
                | SimulationError::NoParticles
                | SimulationError::Observer(_),
            )
            | CliError::Scene(_)
            | CliError::Model { .. }
            | CliError::SetUp { .. }
            | CliError::Check { .. }
            | CliError::PlanWarnings { .. }
            | CliError::Output(_)
            | CliError::Page { .. }
            | CliError::Checkpoint(_)
            | CliError::Refine(_)
            | CliError::RefinedOntoItself { .. }
            | CliError::StepsDone { .. }
            | CliError::Signals(_)
            | CliError::Threshold { .. }
            | CliError::RateWithoutWish
            | CliError::SweepFigure { .. }
            | CliError::NoLauncher
            | CliError::InitialFrom
            | CliError::OtherScene { .. }
            | CliError::ValidateOnOne { .. }
            | CliError::ValidateOther { .. }
            | CliError::NoRuns { .. }
            | CliError::SubdomainsOfRanks { .. }
            | CliError::OneProcess { .. }
            | CliError::PlanToml(_)
            | CliError::SchemaJson(_)
            | CliError::StandardOutput(_)
            | CliError::UnknownVerb { .. }
            | CliError::MethodOfCase { .. }
            | CliError::NothingToRepeat
            | CliError::RepeatedSwitch
            | CliError::NothingToBench
            | CliError::SeedsBeyond { .. }
            | CliError::Picture(_)
            | CliError::NoSubject { .. }
            | CliError::OptionOfRuns { .. }
            | CliError::Mesh(_)
            | CliError::NodeFrames(_)
            | CliError::MeshSource { .. }
            | CliError::MeshNeeds { .. }
            | CliError::MeshOption { .. }
            | CliError::MeshOutput { .. }
            | CliError::UnknownCase { .. } => BAD_INPUT,
        }
    }
}

/// A run that failed says itself whose fault it was.
fn study_code(error: &StudyError) -> u8 {
    match error {
        StudyError::Bits { .. } => AUDIT_FAILED,
        StudyError::Run { code, .. } => match code {
            Some(2) => BAD_INPUT,
            Some(4) => AUDIT_FAILED,
            // It was stopped by a signal, and so is the study.
            Some(code @ 129..=255) => *code as u8,
            _ => DEVICE_TROUBLE,
        },
        StudyError::Simulation(
            SimulationError::Gpu(_)
            | SimulationError::Rank(_)
            | SimulationError::Message { .. }
            | SimulationError::Dealt { .. },
        )
        | StudyError::Device(_)
        | StudyError::Rank(_) => DEVICE_TROUBLE,
        StudyError::Simulation(SimulationError::Lost { .. } | SimulationError::Ladder { .. }) => AUDIT_FAILED,
        StudyError::Start { .. }
        | StudyError::TooShort { .. }
        | StudyError::Model { .. }
        | StudyError::PlanToml(_)
        | StudyError::Table(_)
        | StudyError::Scene(_)
        | StudyError::Checkpoint(_)
        | StudyError::Output(_)
        | StudyError::Simulation(_) => BAD_INPUT,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::LadderError;

    /// What a user can mend is 2, what the machine refuses 3, what cannot be trusted 4. The causes of 4 do not
    /// occur in a sound program, so no command shows them.
    #[test]
    fn the_exit_code_tells_whose_fault_it_is() {
        let hang = || GpuError::Trouble { reason: "it hangs".into() };
        let cases = [
            (CliError::Audit { failures: vec!["2 particles are outside the vessel".into()] }, 4),
            (SimulationError::Lost { time: 0.1, what: "a particle".into() }.into(), 4),
            (
                SimulationError::Ladder {
                    time: 0.1,
                    source: LadderError { needed: 1e-9, smallest: 1e-8, ratio: 10.0 },
                }
                .into(),
                4,
            ),
            (CliError::Gpu(hang()), 3),
            (SimulationError::Gpu(hang()).into(), 3),
            (SimulationError::Observer("cannot write history.csv: no space left".into()).into(), 2),
            (CliError::Check { failed: 1, checked: 2 }, 2),
        ];
        for (error, code) in cases {
            assert_eq!(error.exit_code(), code, "{error}");
        }
    }

    #[test]
    fn a_failed_audit_says_all_that_failed() {
        let failures = vec!["the mass is off".to_string(), "2 flights".to_string()];
        assert_eq!(CliError::Audit { failures }.to_string(), "the audit failed:\n- the mass is off\n- 2 flights");
    }
}
