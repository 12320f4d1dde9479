//! Laws of ranks that are processes: under MPI, with real launches of `mpirun`, and without it.
//!
//! The same program is the test, which launches itself, and the rank that is launched: a variable of the
//! environment says which. Therefore it has a `main` of its own; words among its arguments choose tests by name.

#[cfg(feature = "mpi")]
mod launched;

use corpuscle::ranks::conformance::CHECKS;
use corpuscle::ranks::{Communicator, RankError, agree, from_environment};
use std::process::{Command, ExitCode};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Says which of [`ROLES`] a rank plays.
const ROLE: &str = "CORPUSCLE_TEST_ROLE";

/// What a rank does.
type Role = (&'static str, fn(&dyn Communicator));

const ROLES: &[Role] =
    &[("suite", suite), ("failing", failing), ("panicking", panicking), ("disagreeing", disagreeing), ("dying", dying)];

const TESTS: &[(&str, fn())] = &[
    ("a_process_without_a_launcher_is_alone_and_starts_no_mpi", alone),
    ("one_of_several_ranks_does_not_take_itself_for_the_only_one", lone_rank_is_told),
];

fn main() -> ExitCode {
    if let Ok(role) = std::env::var(ROLE) {
        return play(&role);
    }
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    #[cfg(feature = "mpi")]
    let launched = launched::TESTS;
    #[cfg(not(feature = "mpi"))]
    let launched = &[];
    let mut chosen = TESTS.iter().chain(launched).collect::<Vec<_>>();
    chosen.retain(|(name, _)| words.iter().all(|word| name.contains(word.as_str())));
    let next = AtomicUsize::new(0);
    // Two together, since launches wait most of the time. A test that fails is a panic here once the others have ended.
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some((name, test)) = chosen.get(next.fetch_add(1, Ordering::Relaxed)) {
                    test();
                    println!("test {name} ... ok");
                }
            });
        }
    });
    ExitCode::SUCCESS
}

fn play(role: &str) -> ExitCode {
    let Some((_, role)) = ROLES.iter().find(|(name, _)| *name == role) else { panic!("there is no role `{role}`") };
    match from_environment() {
        Ok(comm) => role(comm.as_ref()),
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

fn suite(comm: &dyn Communicator) {
    // All are on this machine.
    assert_eq!((comm.node_rank(), comm.node_size()), (comm.rank(), comm.size()));
    assert!(!comm.in_process());
    for (law, check) in CHECKS {
        if let Err(message) = check(comm) {
            comm.fail(&format!("{law}: {message}"), 1);
        }
    }
    if comm.rank() == 0 {
        println!("{} ranks conform", comm.size());
    }
}

/// Rank 1 fails; the others wait for it, each in a way of its own.
fn failing(comm: &dyn Communicator) {
    if comm.rank() == 1 {
        comm.fail("out of gas", 3);
    }
    wait(comm);
}

fn panicking(comm: &dyn Communicator) {
    assert_ne!(comm.rank(), 1, "one is one too many");
    wait(comm);
}

fn dying(comm: &dyn Communicator) {
    if comm.rank() == 1 {
        std::process::abort();
    }
    wait(comm);
}

fn wait(comm: &dyn Communicator) {
    let result = match comm.rank() {
        0 => comm.receive(1).map(drop),
        2 => comm.sum(vec![1]).map(drop),
        _ => comm.barrier(),
    };
    println!("rank {} went on: {result:?}", comm.rank());
}

fn disagreeing(comm: &dyn Communicator) {
    let particles = if comm.rank() == 2 { "20000" } else { "10000" };
    let error = agree(comm, &[("version", "0.1.0".to_owned()), ("number of particles", particles.to_owned())]);
    let told = matches!(&error, Err(RankError::Disagreement { rank: 2, .. }));
    // Rank 0 tells of it, once it knows that all know.
    if comm.sum(vec![u64::from(told)]) == Ok(vec![comm.size() as u64]) && comm.rank() == 0 {
        comm.fail(&format!("all know: {}", error.unwrap_err()), 2);
    }
    wait(comm);
}

fn alone() {
    let comm = from_environment().unwrap();
    assert_eq!((comm.rank(), comm.size()), (0, 1));
    #[cfg(feature = "mpi")]
    assert!(!mpi::environment::is_initialized());
}

/// Started by a launcher that this program's MPI does not know, or built without MPI: processes that each believe
/// themselves alone would all write the same files.
fn lone_rank_is_told() {
    let mut rank = Command::new(std::env::current_exe().unwrap());
    let ended = rank.env(ROLE, "suite").env("PMI_SIZE", "3").env("PMI_RANK", "0").output().unwrap();
    let stderr = String::from_utf8_lossy(&ended.stderr);
    assert!(!ended.status.success(), "{stderr}");
    let reason = if cfg!(feature = "mpi") { ", of which MPI finds 1" } else { " but built without MPI" };
    assert!(stderr.contains(&format!("started as one of several ranks (PMI_SIZE = 3){reason}")), "{stderr}");
}
