//! Why a checkpoint cannot be written or taken up.

use std::io;
use std::path::{Path, PathBuf};

/// Says file, what was found, what was expected and what can be done.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum CheckpointError {
    #[error("cannot {action} {path}: {source}", path = path.display())]
    Io { action: &'static str, path: PathBuf, source: io::Error },
    #[error("{path} holds no complete checkpoint", path = path.display())]
    #[diagnostic(help("name a run's folder, its `checkpoints` or one of the folders `step-...` in there"))]
    None { path: PathBuf },
    #[error("{path} does not exist", path = path.display())]
    #[diagnostic(help(
        "name a run's folder (that of its `--out`), its `checkpoints` or one of the folders `step-...` in there"
    ))]
    Absent { path: PathBuf },
    #[error("{path} is {what}, not the folder of a run", path = path.display())]
    #[diagnostic(help("{help}"))]
    NoFolder { path: PathBuf, what: &'static str, help: &'static str },
    #[error("{path} holds no complete checkpoint: it is a run's folder, but the run has written none", path = path.display())]
    #[diagnostic(help(
        "a run writes one when it is stopped by a signal or `--stop-after`, or every so often with `--checkpoint-every`; start the run anew with `corpuscle run --force`"
    ))]
    NoneYet { path: PathBuf },
    #[error("{path} is missing from the checkpoint", path = path.display())]
    #[diagnostic(help("the folder was copied in part, or changed; copy all of it again"))]
    Missing { path: PathBuf },
    #[error("{path} is no checkpoint's manifest: it begins {found:?}, where {expected:?} should stand", path = path.display())]
    Foreign { path: PathBuf, found: String, expected: String },
    #[error("{path} is of checkpoint format {found}, this program reads format {expected}", path = path.display())]
    #[diagnostic(help("resume with the version of the program that wrote it: its `version` line says which"))]
    OtherFormat { path: PathBuf, found: u64, expected: u32 },
    #[error("{path} has {found} bytes where {expected} were written: it was truncated or altered", path = path.display())]
    #[diagnostic(help("copy the checkpoint again if this is a copy"))]
    Length { path: PathBuf, found: u64, expected: u64 },
    #[error("{path} was truncated or altered: its checksum is {found:08x}, {expected} was written", path = path.display())]
    #[diagnostic(help("copy the checkpoint again if this is a copy"))]
    Checksum { path: PathBuf, found: u32, expected: String },
    #[error("{path} does not hold what it should: {problem}", path = path.display())]
    Content { path: PathBuf, problem: String },
    #[error("{path} cannot be used: {source}", path = path.display())]
    #[diagnostic(help("{}", remedy(older.as_deref())))]
    Broken {
        path: PathBuf,
        #[source]
        source: Box<CheckpointError>,
        /// The complete checkpoint before it.
        older: Option<PathBuf>,
    },
    #[error(
        "the mesh {path} {found}, and the copy of it {copy} is not there as it was; the run began with {expected}",
        path = path.display(),
        copy = copy.display()
    )]
    #[diagnostic(help("put one of the two back"))]
    Mesh { path: PathBuf, copy: PathBuf, found: String, expected: String },
    #[error("this program plans the scene otherwise than {version} did: {found:?} where {expected:?} stood")]
    #[diagnostic(help("resume with version {version} of the program"))]
    OtherPlan { version: String, found: String, expected: String },
    #[error("{found} particles were handed over for a checkpoint of {expected}")]
    Particles { found: u64, expected: u64 },
    #[error("cannot put {what} into a checkpoint: {problem}")]
    Encode { what: &'static str, problem: String },
}

fn remedy(older: Option<&Path>) -> String {
    match older {
        Some(older) => format!("copy it again if it is a copy, or resume from the one before: {}", older.display()),
        None => "copy it again if it is a copy; there is no older one beside it".to_owned(),
    }
}

impl CheckpointError {
    /// For `map_err`: what was being done to which file.
    pub(in crate::output) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> CheckpointError {
        move |source| CheckpointError::Io { action, path: path.to_path_buf(), source }
    }

    /// As [`CheckpointError::io`], of a file that a checkpoint must have.
    pub(super) fn reading(path: &Path) -> impl FnOnce(io::Error) -> CheckpointError {
        move |source| match source.kind() {
            io::ErrorKind::NotFound => CheckpointError::Missing { path: path.to_path_buf() },
            _ => CheckpointError::Io { action: "read", path: path.to_path_buf(), source },
        }
    }
}
