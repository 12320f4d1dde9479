//! Law: nothing is lost. A run that is killed at random moments, and resumed after each, ends with the files of one that
//! was never interrupted.
//!
//! A kill is SIGKILL: to the process, or to one rank's process under `mpirun`, which then ends the others. What is killed
//! before it has a checkpoint is started anew, as its user would.

use std::time::Duration;

use super::program::{Case, Numbers, Program, newest, signal, tank};

/// Runs until so many kills have met a process at work; at most three kills a run. A line for each kill.
fn killed(kills: usize, seed: u64, programs: &[Program]) {
    let case = Case::new(&tank(0.006));
    let mut numbers = Numbers(seed);
    let mut told = Vec::new();
    let every = ["--checkpoint-every", "32"];
    for run in 0.. {
        if told.len() >= kills {
            break;
        }
        assert!(run < 20 * kills, "runs end before they can be killed");
        let name = format!("run-{run}");
        let out = case.out(&name);
        let mut lines = Vec::new();
        let planned = numbers.between(1, 4).min((kills - told.len()) as u64);
        let mut ended = false;
        for _ in 0..planned {
            let program = &programs[numbers.between(0, programs.len() as u64) as usize];
            let before = newest(&out);
            let mut running = match before {
                None => case.run(program, &name, &every),
                Some(_) => case.resume(program, &name, &every),
            };
            // Mostly anywhere in what is left, while it computes and writes; sometimes while it sets up or reads.
            if numbers.between(0, 5) > 0 {
                let target = numbers.between(before.unwrap_or(0), case.steps - 32);
                running.until(|| newest(&out) > before.max(Some(target)));
            }
            std::thread::sleep(Duration::from_millis(numbers.between(0, 200)));
            let processes = running.processes();
            ended = running.has_ended();
            if ended || processes.is_empty() {
                running.end();
                break;
            }
            let one = numbers.between(0, processes.len() as u64) as usize;
            signal("KILL", processes[one]);
            let (code, ..) = running.end();
            ended = code == Some(0);
            if ended {
                break;
            }
            let whom = match processes.len() {
                1 => "the process".to_owned(),
                ranks => format!("rank {one} of {ranks}"),
            };
            let from = newest(&out).map_or("the start".to_owned(), |step| format!("step {step}"));
            lines.push(format!("{whom} killed at row {}, goes on from {from}", rows(&out)));
        }
        if !ended {
            let program = &programs[numbers.between(0, programs.len() as u64) as usize];
            match newest(&out) {
                None => case.run(program, &name, &[]).finish(),
                Some(_) => case.resume(program, &name, &[]).finish(),
            };
        }
        case.assert_same(&name);
        told.extend(lines.into_iter().map(|line| format!("{line}; in the end the same")));
    }
    for (kill, line) in told.iter().enumerate() {
        println!("kill {}: {line}", kill + 1);
    }
    println!("nothing lost in {} of {} kills", told.len(), told.len());
    assert!(told.len() >= kills);
}

/// Of the history, as far as it can be read.
fn rows(out: &std::path::Path) -> usize {
    let text = std::fs::read_to_string(out.join("history.csv")).unwrap_or_default();
    text.lines().count().saturating_sub(1)
}

#[test]
fn nothing_is_lost_in_two_kills_of_a_process() {
    killed(2, 5, &[Program::alone(), Program::sharing(2)]);
}

#[cfg(feature = "mpi")]
#[test]
fn nothing_is_lost_when_a_rank_is_killed() {
    killed(1, 6, &[Program::mpi(2)]);
}

#[test]
#[ignore = "takes minutes; ./scripts/test.sh --long runs it"]
fn nothing_is_lost_in_twelve_kills_of_a_process() {
    killed(12, 7, &[Program::alone(), Program::sharing(2), Program::sharing(3)]);
}

#[cfg(feature = "mpi")]
#[test]
#[ignore = "takes minutes; ./scripts/test.sh --long runs it"]
fn nothing_is_lost_in_twelve_kills_of_ranks() {
    killed(12, 8, &[Program::mpi(2), Program::mpi(3), Program::alone()]);
}
