//! Law: a checkpoint that is not what was written is refused with the reason, and nothing in the run's folder changes.

use std::fs;
use std::path::{Path, PathBuf};

use corpuscle::output::latest;

use super::program::{Case, Program, Results, published};

/// A stopped run, and its newest checkpoint.
fn stopped() -> (Case, PathBuf) {
    let case = Case::new(&published("box.toml", 500, 8e-4));
    case.run(&Program::alone(), "out", &["--checkpoint-every", "32", "--steps", "96"]).finish();
    let checkpoint = latest(&case.out("out")).unwrap();
    (case, checkpoint)
}

/// What is said; messages are broken into lines where they like.
fn refused(case: &Case, name: &str, more: &[&str]) -> String {
    let (code, stdout, stderr) = case.resume(&Program::alone(), name, more).end();
    assert!(code == Some(2) && !stdout.contains("Audit"), "{code:?} {stdout}{stderr}");
    stderr.replace(['\n', '│', ' '], "")
}

fn assert_refused(case: &Case, name: &str, reason: &str) {
    let before = Results::of(&case.out("out"));
    let said = refused(case, name, &[]);
    assert!(said.contains(&reason.replace(' ', "")), "{reason}: {said}");
    assert_eq!(before.difference(&Results::of(&case.out("out"))), None);
}

#[test]
fn what_is_not_as_it_was_written_is_refused_with_the_reason() {
    let (case, checkpoint) = stopped();
    let with = |file: &str, change: &dyn Fn(&mut Vec<u8>), reason: &str| {
        let path = checkpoint.join(file);
        let good = fs::read(&path).unwrap();
        let mut bad = good.clone();
        change(&mut bad);
        fs::write(&path, bad).unwrap();
        assert_refused(&case, "out", reason);
        fs::write(&path, good).unwrap();
    };
    with("particles-0000.bin", &|bytes| bytes.truncate(100), "has 100 bytes where");
    with("state.bin", &|bytes| bytes[20] ^= 1, "truncated or altered: its checksum");
    with("manifest.toml", &|bytes| bytes[60] ^= 1, "truncated or altered: its checksum");
    with("manifest.toml", &|bytes| *bytes = b"[package]".to_vec(), "is no checkpoint's manifest");
    let older = "resume from the one before";
    with("plan.toml", &|bytes| bytes.push(b' '), older);
    // The run's own files must be those that the checkpoint knows.
    let history = case.out("out/history.csv");
    let good = fs::read(&history).unwrap();
    fs::write(&history, &good[..good.len() / 2]).unwrap();
    assert_refused(&case, "out", "it had");
    fs::write(&history, &good).unwrap();
    // Good again: it goes on.
    case.resume(&Program::alone(), "out", &[]).finish();
    case.assert_same("out");
}

#[test]
fn what_is_no_run_or_asks_for_nothing_is_refused() {
    let (case, checkpoint) = stopped();
    assert!(refused(&case, "nowhere", &[]).contains("nowheredoesnotexist"));
    assert!(refused(&case, "whole/snapshots", &[]).contains("holdsnocompletecheckpoint"));
    assert!(refused(&case, "out", &["--steps", "96"]).contains("hasdone96stepsalready"));
    assert!(refused(&case, "out", &["--stop-after", "soon"]).contains("1:30:00"));
    // A checkpoint without the rest of its run.
    let alone = case.out("copy/checkpoints").join(checkpoint.file_name().unwrap());
    fs::create_dir_all(&alone).unwrap();
    for entry in fs::read_dir(&checkpoint).unwrap().flatten() {
        fs::copy(entry.path(), alone.join(entry.file_name())).unwrap();
    }
    assert!(refused(&case, "copy", &[]).contains("isnofolderofarun"));
}

/// The manifest with another text in it and the checksum that belongs to it.
fn forge(checkpoint: &Path, from: &str, to: &str) {
    let path = checkpoint.join("manifest.toml");
    let text = fs::read_to_string(&path).unwrap();
    let (above, last) = text.trim_end().rsplit_once('\n').unwrap();
    let above = format!("{above}\n");
    let changed = above.replacen(from, to, 1);
    assert_ne!(changed, above, "{from}");
    let head = last.rsplit_once(' ').unwrap().0;
    fs::write(&path, format!("{changed}{head} {:08x}\n", crc32fast::hash(changed.as_bytes()))).unwrap();
}

/// Another adapter, driver or version may have other bits: it goes on, with a warning.
#[test]
fn another_adapter_driver_or_version_is_warned_of() {
    let (case, checkpoint) = stopped();
    forge(&checkpoint, "\ndriver = \"", "\ndriver = \"other ");
    forge(&checkpoint, "version = \"", "version = \"9.");
    let (code, _, stderr) = case.resume(&Program::alone(), "out", &["--steps", "128"]).end();
    assert_eq!(code, Some(0), "{stderr}");
    assert!(stderr.contains("WARN the checkpoint was written by version 9."), "{stderr}");
    assert!(stderr.contains("WARN the checkpoint was computed on") && stderr.contains("(other "), "{stderr}");
    // It left a checkpoint of its own where it stopped.
    let own = latest(&case.out("out")).unwrap();
    assert_ne!(own, checkpoint);
    fs::remove_dir_all(own).unwrap();
    let (_, _, stderr) = case.resume(&Program::alone(), "out", &["--steps", "128", "-v"]).end();
    assert!(stderr.contains("WARN the checkpoint"), "the forged checkpoint is still the newest: {stderr}");
}
