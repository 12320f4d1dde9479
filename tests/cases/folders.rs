//! What a run leaves in its folder, and what it never touches: locks, resumes, signals, logs.

use std::fs;
use std::io::Read;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use tempfile::TempDir;

use super::outcome;

/// Far beyond what a slow machine needs.
const PATIENCE: Duration = Duration::from_secs(120);

/// Gas at rest in a box, of a thousandth of a second, or of as many as are asked for.
fn scene(end_time: f64) -> String {
    format!(
        "# my notes\ntitle = \"Gas at rest\"\nend_time = {end_time}\n[[gas]]\nname = \"nitrogen\"\nmolar_mass = 0.028\n\
         gamma = 1.4\n[[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\n\
         gas = \"inside\"\n[[chamber]]\nname = \"box\"\npressure = 1e5\ntemperature = 300.0\ngas = \"nitrogen\"\n\
         [model]\nparticles = 1000\ntime_step = 5e-6\n[output]\nrows = 10\nsnapshots = 1\n"
    )
}

const SHORT: f64 = 1e-3;
/// Longer than any test waits.
const ENDLESS: f64 = 50.0;

/// The file of a scene in a new folder.
fn written(text: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("box.toml");
    fs::write(&path, text).unwrap();
    (folder, path)
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_corpuscle"));
    command.env("NODEVICE_SELECT", "1").env("NO_COLOR", "1").env("LP_NUM_THREADS", "0");
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

fn until(child: &mut Child, happened: impl Fn() -> bool) {
    let begun = Instant::now();
    while !happened() {
        assert!(child.try_wait().unwrap().is_none(), "the run has ended");
        assert!(begun.elapsed() < PATIENCE, "nothing happens");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn rows(out: &Path) -> usize {
    fs::read_to_string(out.join("history.csv")).map_or(0, |text| text.lines().count().saturating_sub(1))
}

/// A run that is under way; it ends with the test.
struct Running(Child);

impl Running {
    /// With rows often, so that it is soon seen to be under way.
    fn start(folder: &Path, out: &Path) -> Running {
        let path = folder.join("endless.toml");
        fs::write(&path, scene(ENDLESS).replace("rows = 10", "rows = 1000000")).unwrap();
        let mut child = program().args(["run", text(&path), "--out", text(out)]).spawn().unwrap();
        until(&mut child, || rows(out) > 0);
        Running(child)
    }

    fn signal(&self, name: &str) {
        let sent = Command::new("kill").args([&format!("-{name}"), &self.0.id().to_string()]).status().unwrap();
        assert!(sent.success());
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn refused(arguments: &[&str], parts: &[&str]) {
    let (code, out, err) = outcome(arguments);
    assert!(code == 2 && parts.iter().all(|part| err.contains(part)), "{arguments:?}: {code} {out}{err}");
}

fn done(arguments: &[&str]) -> String {
    let (code, out, err) = outcome(arguments);
    assert_eq!(code, 0, "{arguments:?}: {out}{err}");
    out
}

/// Whoever else would write into the folder of a run is told who has it. A kill frees the folder: what stays of the lock holds
/// nobody up.
#[test]
fn a_folder_is_written_into_by_one_process_until_it_dies() {
    let (folder, short) = written(&scene(SHORT));
    let (out, other) = (folder.path().join("out"), folder.path().join("other"));
    let mut running = Running::start(folder.path(), &out);
    running.signal("USR1");
    let checkpoints = out.join("checkpoints");
    let stands = |entry: fs::DirEntry| !entry.file_name().to_string_lossy().contains('.');
    let written = || fs::read_dir(&checkpoints).is_ok_and(|mut found| found.any(|entry| stands(entry.unwrap())));
    until(&mut running.0, written);
    let told = format!("is being written into by process {} of ", running.0.id());
    done(&["run", text(&short), "--checkpoint-every", "32", "--steps", "64", "--out", text(&other)]);
    for arguments in [
        &["run", text(&short), "--force", "--out", text(&out)][..],
        &["run", text(&short), "--repeat", "2", "--force", "--out", text(&out)],
        &["resume", text(&out)],
        &["refine", text(&other), "--times", "2", "--force", "--out", text(&out)],
        &["sweep", text(&short), "--devices", "1", "--force", "--out", text(&out)],
        &["pareto", "sod", "--quick", "--force", "--out", text(&out)],
        &["stability", "mach", "--quick", "--force", "--out", text(&out)],
    ] {
        refused(arguments, &[&told]);
    }
    // Another folder is another matter.
    done(&["resume", text(&other), "--steps", "96"]);
    running.0.kill().unwrap();
    running.0.wait().unwrap();
    assert!(out.join(".corpuscle-lock").exists(), "a kill leaves no time to remove it");
    let reached = rows(&out);
    done(&["resume", text(&out), "--steps", "100000000000", "--stop-after", "2s"]);
    assert!(rows(&out) > 0 && reached > 0 && !out.join(".corpuscle-lock").exists());
}

/// Runs of several seeds are no prey of the next while one of them goes on.
#[test]
fn a_seed_that_goes_on_holds_up_all_of_them() {
    let (folder, short) = written(&scene(SHORT));
    let out = folder.path().join("out");
    done(&["run", text(&short), "--repeat", "2", "--out", text(&out)]);
    let _running = Running::start(folder.path(), &out.join("seed-7"));
    refused(&["run", text(&short), "--repeat", "2", "--force", "--out", text(&out)], &["seed-7 is being written into"]);
    assert!(out.join("seed-1/history.csv").exists());
}

/// What a run has left is replaced unasked only by what says the same.
#[test]
fn an_unfinished_run_or_one_of_another_scene_is_not_replaced_unasked() {
    let (folder, short) = written(&scene(SHORT));
    let out = folder.path().join("out");
    let run = ["run", text(&short), "--out", text(&out)];
    done(&[&run[..], &["--checkpoint-every", "32", "--steps", "64"]].concat());
    let before = fs::read_dir(out.join("checkpoints")).unwrap().count();
    refused(&run, &["has not reached its end", &format!("`corpuscle resume {}`", out.display()), "--force"]);
    assert!(before > 0 && fs::read_dir(out.join("checkpoints")).unwrap().count() == before);
    // An edited scene is no run to go on with.
    refused(&[&run[..], &["--seed", "2"]].concat(), &["which `resume` keeps: `seed = 1` there, `seed = 2` in this"]);
    done(&["resume", text(&out)]);
    // The same again gives the same.
    let history = fs::read(out.join("history.csv")).unwrap();
    done(&run);
    assert_eq!(fs::read(out.join("history.csv")).unwrap(), history);
    let another = folder.path().join("another.toml");
    fs::write(&another, scene(2.0 * SHORT)).unwrap();
    refused(&["run", text(&another), "--out", text(&out)], &["`end_time = 0.001` there, `end_time = 0.002` in this"]);
    refused(&[&run[..], &["--seed", "2"]].concat(), &["`seed = 1` there, `seed = 2` in this"]);
    refused(&[&run[..], &["--repeat", "2"]].concat(), &["holds a run, this is runs of several seeds"]);
    done(&["run", text(&another), "--force", "--out", text(&out)]);
    // A run that was stopped by --steps, and has no checkpoint.
    done(&[&run[..], &["--steps", "32", "--force"]].concat());
    refused(&run, &["no checkpoint to go on from"]);
}

/// Two scenes of one file name share the default folder.
#[test]
fn scenes_of_one_name_do_not_replace_each_other() {
    let folder = tempfile::tempdir().unwrap();
    for (name, end_time) in [("a", SHORT), ("b", 2.0 * SHORT)] {
        fs::create_dir(folder.path().join(name)).unwrap();
        fs::write(folder.path().join(name).join("tank.toml"), scene(end_time)).unwrap();
    }
    let run = |scene: &str| {
        let output = super::corpuscle(&["run", scene, "-q"]).current_dir(folder.path()).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    assert_eq!(run("a/tank.toml").0, Some(0));
    let (code, err) = run("b/tank.toml");
    assert!(code == Some(2) && err.contains("results/tank holds the results of another scene"), "{err}");
    let kept = fs::read_to_string(folder.path().join("results/tank/scene.toml")).unwrap();
    assert!(kept.contains("end_time = 0.001\n"), "{kept}");
}

/// Whatever path leads to it, and by force too.
#[test]
fn the_scene_that_is_read_is_never_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let mine = folder.path().join("scene.toml");
    fs::write(&mine, scene(SHORT)).unwrap();
    symlink(folder.path(), folder.path().join("link")).unwrap();
    symlink(&mine, folder.path().join("other.toml")).unwrap();
    for (scene, out) in
        [("scene.toml", "."), ("other.toml", "."), ("scene.toml", "link"), ("link/scene.toml", "link/.")]
    {
        for more in [&["--force"][..], &["--force", "--repeat", "2"], &[]] {
            let arguments = [&["run", scene, "-q", "--out", out], more].concat();
            let output = super::corpuscle(&arguments).current_dir(folder.path()).output().unwrap();
            let err = String::from_utf8(output.stderr).unwrap();
            assert_eq!(output.status.code(), Some(2), "{arguments:?} {err}");
            assert!(err.contains("is read, and lies where the output folder"), "{err}");
            assert!(fs::read_to_string(&mine).unwrap().starts_with("# my notes"));
        }
    }
    // Beside results it may lie.
    fs::rename(&mine, folder.path().join("box.toml")).unwrap();
    fs::remove_file(folder.path().join("other.toml")).unwrap();
    let output =
        super::corpuscle(&["run", "box.toml", "-q", "--out", ".", "--force"]).current_dir(folder.path()).output();
    assert_eq!(output.unwrap().status.code(), Some(0));
    assert!(fs::read_to_string(folder.path().join("box.toml")).unwrap().starts_with("# my notes"));
}

/// A box as a mesh of 12 triangles.
const CUBE: &str = "v 0 0 0\nv 0.1 0 0\nv 0.1 0.1 0\nv 0 0.1 0\nv 0 0 0.1\nv 0.1 0 0.1\nv 0.1 0.1 0.1\nv 0 0.1 0.1\n\
    f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n";

/// A run has all that it needs to go on, whatever becomes of the files that it was started with, and of its own place.
#[test]
fn a_run_goes_on_without_the_files_that_it_came_from() {
    let box_wall = "shape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\n";
    let meshed = scene(SHORT).replace(box_wall, "shape = \"mesh\"\nfile = \"parts/cube.obj\"\n");
    let (folder, path) = written(&meshed);
    let parts = folder.path().join("parts");
    fs::create_dir(&parts).unwrap();
    fs::write(parts.join("cube.obj"), CUBE).unwrap();
    let (whole, out) = (folder.path().join("whole"), folder.path().join("out"));
    done(&["run", text(&path), "--out", text(&whole)]);
    done(&["run", text(&path), "--out", text(&out), "--checkpoint-every", "32", "--steps", "64"]);
    // Another mesh is another scene, though its name is the same.
    fs::write(parts.join("cube.obj"), CUBE.replace("0.1", "0.12")).unwrap();
    refused(&["run", text(&path), "--out", text(&whole)], &["cube.obj was another"]);
    fs::remove_dir_all(&parts).unwrap();
    fs::remove_file(&path).unwrap();
    let moved = folder.path().join("moved");
    fs::rename(&out, &moved).unwrap();
    let fine = folder.path().join("fine");
    done(&["refine", text(&moved), "--times", "2", "--out", text(&fine)]);
    done(&["resume", text(&moved)]);
    for file in ["history.csv", "audit.txt", "scene.toml", "plan.toml", "snapshots/walls.vtp"] {
        assert_eq!(fs::read(moved.join(file)).unwrap(), fs::read(whole.join(file)).unwrap(), "{file}");
    }
    fs::remove_dir_all(&whole).unwrap();
    fs::remove_dir_all(&moved).unwrap();
    done(&["resume", text(&fine), "--steps", "32"]);
    // The copy is as sound as it must be.
    let copy = fs::read_dir(fine.join("meshes")).unwrap().next().unwrap().unwrap().path();
    fs::write(&copy, "").unwrap();
    refused(&["resume", text(&fine)], &["cube.obj cannot be read", text(&copy)]);
}

/// Who has said that hanging up is nothing (nohup) is believed. (That SIGHUP stops others: tests/checkpoint.)
#[test]
fn hanging_up_is_ignored_where_it_was() {
    let (folder, _) = written("");
    let out = folder.path().join("out");
    let path = folder.path().join("long.toml");
    fs::write(&path, scene(0.008).replace("rows = 10", "rows = 1000")).unwrap();
    let mut child = Command::new("sh")
        .args(["-c", "trap '' HUP; exec \"$@\"", "sh", env!("CARGO_BIN_EXE_corpuscle")])
        .args(["run", text(&path), "--out", text(&out)])
        .envs([("NODEVICE_SELECT", "1"), ("LP_NUM_THREADS", "0")])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    until(&mut child, || rows(&out) > 0);
    Command::new("kill").args(["-HUP", &child.id().to_string()]).status().unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert!(out.join("audit.txt").exists());
}

/// What cannot be told, because the disc is full or the reader has gone, ends no run.
#[test]
fn a_run_goes_on_where_nothing_can_be_told() {
    let (folder, short) = written(&scene(SHORT));
    let out = folder.path().join("out");
    let full = || fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    // A warning of the plan comes besides.
    let run = ["run", text(&short), "--particles", "900", "-vv", "--out", text(&out)];
    let ended = program().args(run).stdout(full()).stderr(full()).status().unwrap();
    assert!(ended.code() == Some(0) && out.join("audit.txt").exists(), "{ended:?}");
    let gone = || {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        writer
    };
    let ended = program().args(run).stdout(gone()).stderr(gone()).status().unwrap();
    assert!(ended.code() == Some(0) && out.join("audit.txt").exists(), "{ended:?}");
    // An error is one all the same.
    let ended = program()
        .args(["run", text(&short), "--gpu", "no such", "--force", "--out", text(&out)])
        .stderr(full())
        .status();
    assert_eq!(ended.unwrap().code(), Some(3));
    // Who has seen enough of a plan is content; who cannot keep it is not.
    assert_eq!(program().args(["plan", text(&short)]).stdout(gone()).status().unwrap().code(), Some(0));
    assert_eq!(program().args(["plan", text(&short)]).stdout(full()).status().unwrap().code(), Some(2));
}

/// The log has what was told and when, whatever was shown; it grows where the run goes on.
#[test]
fn the_folder_has_a_log() {
    let (folder, short) = written(&scene(SHORT));
    let out = folder.path().join("out");
    let run = ["run", text(&short), "-q", "--particles", "900", "--out", text(&out)];
    let (code, said, err) = outcome(&[&run[..], &["--checkpoint-every", "32", "--steps", "64"]].concat());
    // Quiet: the folder and the warning.
    assert!(code == 0 && said.lines().eq([text(&out)]), "{said}");
    assert!(err.lines().count() == 1 && err.contains("WARN the run: particles 900"), "{err}");
    let first = fs::read_to_string(out.join("log.txt")).unwrap();
    for part in [" WARN the run: particles 900", "Gas at rest: 900 particles", " INFO checkpoint ", ", 64 steps in "] {
        assert!(first.contains(part), "{part}: {first}");
    }
    let time = first.split_whitespace().next().unwrap();
    assert!(time.len() > 19 && time.as_bytes()[10] == b'T' && time.ends_with('Z'), "{first}");
    done(&["resume", "-q", text(&out)]);
    let both = fs::read_to_string(out.join("log.txt")).unwrap();
    assert!(both.starts_with(&first) && both[first.len()..].contains(" INFO goes on from "), "{both}");
    done(&run);
    let anew = fs::read_to_string(out.join("log.txt")).unwrap();
    assert!(!anew.contains("goes on from"), "{anew}");
}

/// A path in a message can be searched for and copied.
#[test]
fn paths_in_messages_are_whole() {
    let folder = tempfile::tempdir().unwrap();
    let deep = folder
        .path()
        .join("a folder whose name is long-winded".repeat(3))
        .join("and/another-one/of many words".repeat(3));
    fs::create_dir_all(&deep).unwrap();
    let path = deep.join("nothing here.toml");
    refused(&["run", text(&path)], &[text(&path)]);
    let mut child = program().args(["check", text(&path)]).stderr(Stdio::piped()).spawn().unwrap();
    let mut told = String::new();
    child.stderr.take().unwrap().read_to_string(&mut told).unwrap();
    assert!(child.wait().unwrap().code() == Some(2) && told.contains(text(&path)), "{told}");
}
