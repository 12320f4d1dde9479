//! `corpuscle watch` beside a run.

use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::{ROOT, outcome, short_run};

/// A run of another process is seen while it goes on, and once it is killed it is not taken for one that goes on.
#[test]
fn a_run_is_watched_until_it_is_killed() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let mut running = Command::new(assert_cmd::cargo::cargo_bin!("corpuscle"))
        .current_dir(ROOT)
        .env("NODEVICE_SELECT", "1")
        .args(["run", "scenes/tank.toml", "--particles", "1000", "--out", out.to_str().unwrap()])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let since = Instant::now();
    let rows = || fs::read_to_string(out.join("history.csv")).unwrap_or_default().lines().count();
    while rows() < 3 {
        assert!(since.elapsed() < Duration::from_secs(120) && running.try_wait().unwrap().is_none(), "no rows");
        std::thread::sleep(Duration::from_millis(100));
    }
    let seen = || outcome(&["watch", out.to_str().unwrap()]);
    let (code, text, err) = seen();
    assert_eq!(code, 0, "{err}");
    let holder = format!("Tank test, 60 L: goes on (process {} of ", running.id());
    assert!(text.starts_with(&holder), "{text}");
    for words in [
        " % ",
        " of 0.1000 s",
        "rows ",
        " of 100, snapshots 1 of 11",
        "inner pressure, Pa",
        "▁",
        "warning in the plan: ",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    running.kill().unwrap();
    running.wait().unwrap();
    let (code, text, _) = seen();
    assert!(code == 0 && text.starts_with("Tank test, 60 L: This run has not reached its end\n"), "{text}");
    assert!(text.contains("corpuscle resume"), "{text}");
}

#[test]
fn what_is_no_run_cannot_be_watched() {
    let folder = tempfile::tempdir().unwrap();
    let (code, _, err) = outcome(&["watch", folder.path().to_str().unwrap()]);
    assert!(code == 2 && err.contains("is no folder of a run"), "{err}");
    let run = short_run(&folder.path().join("run"), &[]);
    fs::remove_file(run.join("history.csv")).unwrap();
    let (code, text, _) = outcome(&["watch", run.to_str().unwrap(), "--once"]);
    assert!(code == 0 && text.contains("no history yet"), "{text}");
}
