//! Law: a run that is asked for a checkpoint writes one and goes on; one that a signal stops writes one, ends with 128 and the number
//! of the signal, says how to go on, and loses nothing; one that its wall time stops ends with 0.

use std::fs;

#[cfg(feature = "mpi")]
use super::program::signal;
use super::program::{Case, Program, newest, published, tank};

/// A row has been written: the time loop is under way.
fn rows(case: &Case) -> usize {
    fs::read_to_string(case.out("out/history.csv")).map_or(0, |text| text.lines().count().saturating_sub(1))
}

/// SIGUSR1, then another signal through `stop`, by which the run ends with `code`; and on to the end.
fn asked(program: &Program, next: &Program, code: i32, stop: impl FnOnce(&super::program::Running)) {
    let case = Case::new(&tank(0.012));
    let mut running = case.run(program, "out", &[]);
    let long = "the run must be longer for this test";
    assert!(running.until(|| rows(&case) >= 1), "{long}");
    assert_eq!(newest(&case.out("out")), None, "nobody has asked for a checkpoint");
    running.signal("USR1");
    assert!(running.until(|| newest(&case.out("out")).is_some()), "{long}");
    let first = newest(&case.out("out"));
    // It has gone on.
    let before = rows(&case);
    assert!(running.until(|| rows(&case) > before), "{long}");
    stop(&running);
    let (ended, stdout, stderr) = running.end();
    assert_eq!(ended, Some(code), "{stdout}{stderr}");
    let hint = format!("corpuscle resume {}", case.out("out").display());
    assert!(stdout.contains("stopped as asked") && stdout.contains(&hint), "{stdout}");
    assert!(stderr.contains("INFO checkpoint "), "{stderr}");
    assert!(newest(&case.out("out")) > first && !case.out("out/audit.txt").exists());
    case.resume(next, "out", &[]).finish();
    case.assert_same("out");
}

#[test]
fn a_process_goes_on_after_sigusr1_and_stops_after_sigterm() {
    asked(&Program::sharing(2), &Program::alone(), 143, |running| running.signal("TERM"));
}

#[test]
fn a_process_stops_after_ctrl_c() {
    asked(&Program::alone(), &Program::sharing(2), 130, |running| running.signal("INT"));
}

/// Whether hanging up is nothing to this process, and so to those that it starts (nohup).
fn hanging_up_is_ignored() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask & 1 == 1)
}

/// Its terminal is gone.
#[test]
fn a_process_stops_when_it_is_hung_up() {
    if hanging_up_is_ignored() {
        eprintln!("skipped: SIGHUP is ignored here, as under nohup");
        return;
    }
    asked(&Program::alone(), &Program::alone(), 129, |running| running.signal("HUP"));
}

/// The launcher hands SIGUSR1 on to all ranks; SIGTERM may reach any one of them.
#[cfg(feature = "mpi")]
#[test]
fn ranks_go_on_after_sigusr1_and_stop_after_sigterm_to_one_of_them() {
    asked(&Program::mpi(2), &Program::alone(), 143, |running| {
        let ranks = running.processes();
        assert_eq!(ranks.len(), 2);
        signal("TERM", ranks[1]);
    });
}

/// Again and again in short jobs: each gets further than the one before.
#[test]
fn a_run_stops_before_its_wall_time_and_goes_on_in_the_next_job() {
    // Far longer than a job.
    let scene = published("tank.toml", 4000, 1.0);
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), corpuscle::scene::to_toml(&scene)).unwrap();
    let out = folder.path().join("out");
    let mut reached = 0;
    for job in 0..3 {
        let program = Program::sharing(1 + job % 2);
        let limit = ["--stop-after", "3s"];
        let running = match job {
            0 => program.run(folder.path(), "out", &limit),
            _ => program.start(&[&["resume", out.to_str().unwrap()], &limit[..]].concat()),
        };
        let said = running.finish();
        assert!(said.contains("stopped as asked"), "{said}");
        let step = newest(&out).unwrap();
        assert!(step > reached, "{step} after {reached}");
        reached = step;
    }
}
