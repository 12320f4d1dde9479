//! With MPI: launches by `mpirun`, from the outside.

use super::ROLE;
use std::io::Read;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

pub const TESTS: &[(&str, fn())] = &[
    ("ranks_of_mpi_conform", conforming),
    ("a_failure_ends_all_with_its_rank_message_and_code", failure_ends_all),
    ("a_panic_ends_all_with_its_rank_and_message", panic_ends_all),
    ("a_dead_process_ends_all", death_ends_all),
    ("differing_facts_are_told", differing_facts_are_told),
    ("ranks_of_different_scenes_stop_at_the_start", different_scenes_stop),
    ("ranks_with_different_options_stop_at_the_start", different_options_stop),
    ("an_error_of_a_rank_keeps_its_place_and_its_remedy", errors_are_whole),
    ("what_is_the_work_of_one_process_is_not_started_several_times", one_process),
];

struct Ended {
    code: Option<i32>,
    stdout: String,
    stderr: String,
}

/// Launches so many ranks in a role, and waits for the end.
fn mpirun(ranks: usize, role: &str, environment: &[(&str, &str)]) -> Ended {
    let mut command = Command::new("mpirun");
    command
        .args(["--bind-to", "none", "-n", &ranks.to_string()])
        .arg(std::env::current_exe().unwrap())
        .env(ROLE, role)
        .envs(environment.iter().copied());
    ended(command, &format!("{ranks} ranks in the role `{role}`"))
}

fn ended(mut command: impl std::borrow::BorrowMut<Command>, who: &str) -> Ended {
    let mut child = command
        .borrow_mut()
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
            panic!("{who} hang");
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    Ended { code: status.code(), stdout: stdout.join().unwrap(), stderr: stderr.join().unwrap() }
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

/// Also where one of them would not wait for the others.
fn different_scenes_stop() {
    let folder = tempfile::tempdir().unwrap();
    let text = include_str!("../../scenes/box.toml");
    let uniform = text.replace("occupancy = 0.1", "method = \"control-volume\"").replace("particles = 8000\n", "");
    let mut command = Command::new("mpirun");
    command.args(["--bind-to", "none"]).current_dir(folder.path());
    for (name, text) in [("particles.toml", text), ("uniform.toml", &uniform)] {
        std::fs::write(folder.path().join(name), text).unwrap();
        let colon = if name.starts_with('p') { None } else { Some(":") };
        command.args(colon).args(["-n", "1", env!("CARGO_BIN_EXE_corpuscle"), "run", name]);
    }
    let ended = ended(command, "ranks of different scenes");
    assert_eq!(ended.code, Some(3), "{}{}", ended.stdout, ended.stderr);
    assert!(ended.stderr.contains("the ranks disagree on the scene"), "{}", ended.stderr);
    assert!(!folder.path().join("results").exists(), "nothing was begun");
}

/// Ranks that stop after different steps, or of which one goes on with a run, would wait for each other for ever.
fn different_options_stop() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("box.toml"), include_str!("../../scenes/box.toml")).unwrap();
    let program = env!("CARGO_BIN_EXE_corpuscle");
    let first = ["run", "box.toml", "--steps", "32"];
    for (other, told) in [
        (["run", "box.toml", "--steps", "64"], "the ranks disagree on the options"),
        (["resume", "results/box", "--steps", "32"], "the ranks disagree on the verb"),
    ] {
        let mut command = Command::new("mpirun");
        command.args(["--bind-to", "none"]).current_dir(folder.path());
        command.args(["-n", "1", program]).args(first).args([":", "-n", "1", program]).args(other);
        let ended = ended(command, "ranks with different options");
        assert_eq!(ended.code, Some(3), "{}{}", ended.stdout, ended.stderr);
        assert!(ended.stderr.contains(told), "{}", ended.stderr);
        assert!(!folder.path().join("results").exists(), "nothing was begun");
    }
}

fn errors_are_whole() {
    let folder = tempfile::tempdir().unwrap();
    let text = include_str!("../../scenes/box.toml").replace("particles = 8000", "particels = 8000");
    std::fs::write(folder.path().join("box.toml"), text).unwrap();
    let mut command = Command::new("mpirun");
    command.args(["--bind-to", "none", "-n", "2", env!("CARGO_BIN_EXE_corpuscle"), "run", "box.toml"]);
    let ended = ended(command.current_dir(folder.path()), "ranks of a scene with an error");
    assert_eq!(ended.code, Some(2), "{}{}", ended.stdout, ended.stderr);
    for part in ["unknown key \"particels\"", "[box.toml:", "did you mean `particles`?"] {
        assert!(ended.stderr.contains(part), "{part}: {}", ended.stderr);
    }
}

fn one_process() {
    let folder = tempfile::tempdir().unwrap();
    for verb in [&["refine", "run", "--times", "2", "--out", "out"][..], &["bench", "--particles", "100"]] {
        let mut command = Command::new("mpirun");
        command.args(["--bind-to", "none", "-n", "2", env!("CARGO_BIN_EXE_corpuscle")]).args(verb);
        let ended = ended(command.current_dir(folder.path()), "processes of one verb");
        assert_eq!(ended.code, Some(2), "{}{}", ended.stdout, ended.stderr);
        assert!(ended.stderr.contains("the work of one process"), "{}", ended.stderr);
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "nothing was begun");
}
