//! What can go wrong between ranks.

/// The longest message, and the longest sum of an [`Communicator::all_gather`]: what MPI can count.
pub const LONGEST_MESSAGE: usize = i32::MAX as usize;

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, miette::Diagnostic)]
pub enum RankError {
    /// A rank has called `fail`, or panicked: the first to do so.
    #[error("rank {rank}: {message}")]
    Failed { rank: usize, message: String },
    #[error("there is no rank {rank}: the ranks are 0 to {}", size - 1)]
    NoSuchRank { rank: usize, size: usize },
    #[error("rank {rank} exchanges messages with itself")]
    Oneself { rank: usize },
    #[error("a message of {bytes} bytes is longer than the {LONGEST_MESSAGE} that can be sent at once")]
    TooLong { bytes: usize },
    #[error(
        "the ranks reduce lists of different lengths: {shortest_sums} to {longest_sums} sums and \
             {shortest_maxima} to {longest_maxima} maxima"
    )]
    Lengths { shortest_sums: u64, longest_sums: u64, shortest_maxima: u64, longest_maxima: u64 },
    #[error("reduction {finished} is finished before reduction {next}, which was started earlier")]
    Order { finished: u64, next: u64 },
    #[error("rank {rank} calls {found} where another rank calls {expected}")]
    Sequence { rank: usize, found: &'static str, expected: &'static str },
    /// Only seen among the threads of one process; elsewhere it is a hang.
    #[error("every rank waits for another: {waits}")]
    Stuck { waits: String },
    #[error("the ranks disagree on the {name}: rank 0 has {expected}, rank {rank} has {found}")]
    #[diagnostic(help("start every rank with the same program, scene and options, on the same kind of device"))]
    Disagreement { name: String, expected: String, rank: usize, found: String },
    #[error("rank {rank} sent facts that cannot be read")]
    Garbled { rank: usize },
    #[error("the thread of rank {rank} cannot be started: {reason}")]
    Thread { rank: usize, reason: String },
    #[error("started as one of several ranks ({variable} = {value}) but built without MPI")]
    #[diagnostic(help("build with `--features mpi`, or start a single process"))]
    WithoutMpi { variable: String, value: String },
    #[error("started as one of several ranks ({variable} = {value}), of which MPI finds {found}")]
    #[diagnostic(help("start the program with the launcher of the MPI library that it was built with"))]
    Launcher { variable: String, value: String, found: usize },
    #[error("MPI is already running in this process")]
    AlreadyRunning,
}
