//! What can go wrong while results are written or read.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    #[error("cannot {action} {path}: {source}", path = path.display())]
    Io { action: &'static str, path: PathBuf, source: io::Error },
    #[error(
        "the output folder {path} holds {foreign}, which no earlier run wrote; \
         choose another folder, or pass --force to write into this one (what is not a result stays)",
        path = path.display()
    )]
    FolderInUse { path: PathBuf, foreign: String },
    #[error(
        "the output folder {path} is being written into by {holder}; \
         wait for its end, stop it, or choose another folder with --out",
        path = path.display()
    )]
    InUse { path: PathBuf, holder: String },
    #[error(
        "the output folder {path} holds {state}; choose another folder with --out, or pass --force to replace it",
        path = path.display()
    )]
    Unfinished { path: PathBuf, state: String },
    #[error(
        "the output folder {path} holds {found}, this is {wanted}; \
         choose another folder with --out, or pass --force to replace it",
        path = path.display()
    )]
    OtherContent { path: PathBuf, found: &'static str, wanted: &'static str },
    #[error(
        "the output folder {path} holds the results of another scene: {difference}; \
         choose another folder with --out, or pass --force to replace them",
        path = path.display()
    )]
    OtherScene { path: PathBuf, difference: String },
    #[error(
        "{input} is read, and lies where the output folder {path} has results: it would be removed; \
         choose another folder with --out",
        path = path.display(),
        input = input.display()
    )]
    OverInput { path: PathBuf, input: PathBuf },
    #[error("{path} is a file, not a folder; choose another output folder", path = path.display())]
    NotAFolder { path: PathBuf },
    #[error("{path} is no folder of a run: it has no {marker}; name the folder that the run was given as --out",
        path = path.display())]
    NotARun { path: PathBuf, marker: &'static str },
    #[error(
        "{path} has {found} bytes, it had {expected} when the checkpoint was written; \
         put the file of that run back, or start the run anew",
        path = path.display()
    )]
    Shorter { path: PathBuf, found: u64, expected: u64 },
    #[error(
        "the first {bytes} bytes of {path} were altered since the checkpoint was written; \
         put the file of that run back, or start the run anew",
        path = path.display()
    )]
    Altered { path: PathBuf, bytes: u64 },
    #[error(
        "{path} has {found} rows in what the checkpoint keeps of it, there were {expected}; \
         the checkpoint is of another run",
        path = path.display()
    )]
    RowCount { path: PathBuf, found: u64, expected: u64 },
    #[error(
        "the columns of {path} are not those of the scene; the checkpoint is of another run",
        path = path.display()
    )]
    OtherColumns { path: PathBuf },
    #[error(
        "{path} has {found} bytes, it was written with {expected}; \
         put the file of that run back, or remove it to go on without it",
        path = path.display()
    )]
    SnapshotLength { path: PathBuf, found: u64, expected: u64 },
    #[error("{path} is not as a run writes it: {problem}", path = path.display())]
    BadFile { path: PathBuf, problem: String },
    #[error("the history has two columns called {header:?}")]
    DuplicateColumn { header: String },
    #[error("a history row has {found} values, the table has {expected} columns")]
    RowLength { found: usize, expected: usize },
    #[error("{path}:{line}: {problem}", path = path.display())]
    BadRow { path: PathBuf, line: u64, problem: String },
    #[error("{path}:{line}: column {header:?} holds {found:?}, which is not a number", path = path.display())]
    BadValue { path: PathBuf, line: u64, header: String, found: String },
    #[error(
        "{path} has nothing to report: no {expected}; name the folder that the run or the study was given as --out",
        path = path.display()
    )]
    NothingToReport { path: PathBuf, expected: String },
    #[error("{path} is there and no report; name another file with --out, or remove it", path = path.display())]
    OverForeign { path: PathBuf },
    #[error("triangle {triangle} of the walls names vertex {vertex}, but there are {vertices}")]
    BadTriangle { triangle: usize, vertex: u32, vertices: usize },
    #[error("{triangles} wall triangles came with {indices} wall indices")]
    WallIndexCount { triangles: usize, indices: usize },
    #[error("the fields of fabric are of {found} {what}, and there are {expected}")]
    FieldCount { what: &'static str, found: usize, expected: usize },
    #[error("{found} runs have no spread: two are the least")]
    NoSpread { found: usize },
    #[error("the histories of {one} and {other} {what}")]
    Unlike { one: String, other: String, what: String },
    #[error("cannot draw {path}: {problem}", path = path.display())]
    Chart { path: PathBuf, problem: String },
}

impl OutputError {
    /// For `map_err`: what was being done to which file.
    pub(super) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> OutputError {
        move |source| OutputError::Io { action, path: path.to_path_buf(), source }
    }
}

/// Writes `path` through a sibling that is renamed into place: a killed run leaves the old file or the
/// new one, never half of one.
pub(super) fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), OutputError> {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(PARTIAL_SUFFIX);
    let partial = path.with_file_name(name);
    let file = std::fs::File::create(&partial).map_err(OutputError::io("create", &partial))?;
    let mut out = BufWriter::with_capacity(1 << 20, file);
    write(&mut out).and_then(|()| out.flush()).map_err(OutputError::io("write", &partial))?;
    std::fs::rename(&partial, path).map_err(OutputError::io("replace", path))
}

/// Ends the name of a file that is still being written.
pub(super) const PARTIAL_SUFFIX: &str = ".partial";
