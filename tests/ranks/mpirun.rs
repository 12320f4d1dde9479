//! Laws of ranks under MPI, with real launches of `mpirun`.
//!
//! The same program is the test, which launches itself, and the rank that is launched: a variable of the
//! environment says which. Therefore it has a `main` of its own; words among its arguments choose tests by name.

use corpuscle::ranks::conformance::CHECKS;
use corpuscle::ranks::{Communicator, RankError, agree, from_environment};
use std::io::Read;
use std::process::{Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

/// Says which of [`ROLES`] a rank plays.
const ROLE: &str = "CORPUSCLE_TEST_ROLE";

/// What a rank does.
type Role = (&'static str, fn(&dyn Communicator));

const ROLES: &[Role] =
    &[("suite", suite), ("failing", failing), ("panicking", panicking), ("disagreeing", disagreeing), ("dying", dying)];

const TESTS: &[(&str, fn())] = &[
    ("a_process_without_a_launcher_is_alone_and_starts_no_mpi", alone),
    ("ranks_of_mpi_conform", conforming),
    ("a_failure_ends_all_with_its_rank_message_and_code", failure_ends_all),
    ("a_panic_ends_all_with_its_rank_and_message", panic_ends_all),
    ("a_dead_process_ends_all", death_ends_all),
    ("differing_facts_are_told", differing_facts_are_told),
    ("a_launcher_of_another_mpi_is_told", foreign_launcher_is_told),
];

fn main() -> ExitCode {
    if let Ok(role) = std::env::var(ROLE) {
        return play(&role);
    }
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    for (name, test) in TESTS.iter().filter(|(name, _)| words.iter().all(|word| name.contains(word.as_str()))) {
        test();
        println!("test {name} ... ok");
    }
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

struct Ended {
    code: Option<i32>,
    stdout: String,
    stderr: String,
}

/// Launches so many ranks in a role, and waits for the end.
fn mpirun(ranks: usize, role: &str, environment: &[(&str, &str)]) -> Ended {
    let mut child = Command::new("mpirun")
        .args(["--bind-to", "none", "-n", &ranks.to_string()])
        .arg(std::env::current_exe().unwrap())
        .env(ROLE, role)
        .envs(environment.iter().copied())
        .env("RUST_BACKTRACE", "0")
        // More ranks than cores, also as root.
        .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
        .env("OMPI_MCA_rmaps_base_oversubscribe", "1")
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("mpirun can be started");
    let (stdout, stderr) = (child.stdout.take().unwrap(), child.stderr.take().unwrap());
    let [stdout, stderr] = [Box::new(stdout) as Box<dyn Read + Send>, Box::new(stderr)].map(|mut pipe| {
        std::thread::spawn(move || {
            let mut text = Vec::new();
            pipe.read_to_end(&mut text).unwrap();
            String::from_utf8_lossy(&text).into_owned()
        })
    });
    let begun = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        // Far beyond what a slow machine needs: the ranks wait for each other.
        if begun.elapsed() > Duration::from_secs(120) {
            child.kill().unwrap();
            panic!("{ranks} ranks in the role `{role}` hang");
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    Ended { code: status.code(), stdout: stdout.join().unwrap(), stderr: stderr.join().unwrap() }
}

fn alone() {
    let comm = from_environment().unwrap();
    assert_eq!((comm.rank(), comm.size()), (0, 1));
    assert!(!mpi::environment::is_initialized());
}

fn conforming() {
    for ranks in 1..=4 {
        let ended = mpirun(ranks, "suite", &[]);
        assert_eq!(ended.code, Some(0), "{}{}", ended.stdout, ended.stderr);
        assert!(ended.stdout.contains(&format!("{ranks} ranks conform")), "{}", ended.stdout);
    }
}

fn failure_ends_all() {
    let ended = mpirun(4, "failing", &[]);
    assert_eq!(ended.code, Some(3), "{}{}", ended.stdout, ended.stderr);
    assert!(ended.stderr.contains("rank 1: out of gas"), "{}", ended.stderr);
    assert!(!ended.stdout.contains("went on"), "{}", ended.stdout);
}

fn panic_ends_all() {
    let ended = mpirun(4, "panicking", &[]);
    assert_eq!(ended.code, Some(101), "{}{}", ended.stdout, ended.stderr);
    assert!(ended.stderr.contains("rank 1: panicked: "), "{}", ended.stderr);
    assert!(ended.stderr.contains("one is one too many"), "{}", ended.stderr);
    assert!(!ended.stdout.contains("went on"), "{}", ended.stdout);
}

fn death_ends_all() {
    let ended = mpirun(4, "dying", &[]);
    assert_ne!(ended.code, Some(0), "{}{}", ended.stdout, ended.stderr);
    assert!(!ended.stdout.contains("went on"), "{}", ended.stdout);
}

fn differing_facts_are_told() {
    let ended = mpirun(4, "disagreeing", &[]);
    assert_eq!(ended.code, Some(2), "{}{}", ended.stdout, ended.stderr);
    let expected = "rank 0: all know: the ranks disagree on the number of particles: \
                    rank 0 has `10000`, rank 2 has `20000`";
    assert!(ended.stderr.contains(expected), "{}", ended.stderr);
}

/// Processes that each believe themselves alone would all write the same files.
fn foreign_launcher_is_told() {
    let mut rank = Command::new(std::env::current_exe().unwrap());
    let ended = rank.env(ROLE, "suite").env("PMI_SIZE", "3").env("PMI_RANK", "0").output().unwrap();
    let stderr = String::from_utf8_lossy(&ended.stderr);
    assert!(!ended.status.success(), "{stderr}");
    assert!(stderr.contains("started as one of several ranks (PMI_SIZE = 3), of which MPI finds 1"), "{stderr}");
}
