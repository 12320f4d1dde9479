use super::super::names::*;
use super::*;
use crate::output::marker::has_ended;
use crate::output::{Column, HistoryWriter, SnapshotWriter, TriangleSet};

fn claim(force: bool) -> Claim<'static> {
    Claim { content: Content::Run, scene: None, meshes: &[], inputs: &[], force }
}

fn create(path: &Path, force: bool) -> Result<OutputFolder, OutputError> {
    OutputFolder::create(path, &claim(force))
}

fn finished_run(path: &Path) {
    let folder = create(path, false).unwrap();
    HistoryWriter::create(folder.path(), &[Column::new("time", "s")]).unwrap();
    for name in [PLAN_FILE, SCENE_FILE, ENVIRONMENT_FILE, PRESSURE_CHART_FILE] {
        folder.write_text(name, "x").unwrap();
    }
    let mut snapshots = SnapshotWriter::create(folder.path()).unwrap();
    snapshots.write(0.0, &[]).unwrap();
    snapshots.write_walls(TriangleSet { vertices: &[], triangles: &[], owners: &[], names: &[] }).unwrap();
    folder.end("all is well").unwrap();
}

#[test]
fn a_run_may_replace_an_earlier_run_and_leaves_nothing_of_it() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("new/results");
    finished_run(&path);
    assert!(path.join("snapshots/particles_000000.vtu").exists());
    // A run killed while it wrote leaves a partial file, which is no obstacle either.
    fs::write(path.join("plan.toml.partial"), "half").unwrap();
    create(&path, false).unwrap();
    assert!(!path.join("snapshots/particles_000000.vtu").exists());
    assert!(!path.join(HISTORY_FILE).exists() && !path.join("plan.toml.partial").exists());
    assert!(path.join(MARKER_FILE).exists());
}

/// Checkpoints of an earlier run, whole or cut short, go with it: the new run must not be resumed from them.
#[test]
fn checkpoints_of_an_earlier_run_go_with_it() {
    let dir = tempfile::tempdir().unwrap();
    finished_run(dir.path());
    for name in ["step-0000000064", "step-0000000128.partial"] {
        let folder = dir.path().join(CHECKPOINT_FOLDER).join(name);
        fs::create_dir_all(&folder).unwrap();
        for file in ["manifest.toml", "state.bin", "particles-0003.bin"] {
            fs::write(folder.join(file), "x").unwrap();
        }
    }
    create(dir.path(), false).unwrap();
    assert_eq!(fs::read_dir(dir.path().join(CHECKPOINT_FOLDER)).unwrap().count(), 0);
    // What is not a checkpoint's is the user's.
    let mine = dir.path().join("checkpoints/step-0000000064/mine.txt");
    fs::create_dir_all(mine.parent().unwrap()).unwrap();
    fs::write(&mine, "mine").unwrap();
    let error = create(dir.path(), false).unwrap_err().to_string();
    assert!(error.contains("checkpoints/step-0000000064/mine.txt"), "{error}");
    create(dir.path(), true).unwrap();
    assert!(mine.exists());
}

/// The runs of several seeds go with the next, whatever is in their folders, but for what is the user's.
#[test]
fn the_runs_of_several_seeds_go_with_the_next() {
    let dir = tempfile::tempdir().unwrap();
    let seeds = |force| OutputFolder::create(dir.path(), &Claim { content: Content::Seeds, ..claim(force) });
    seeds(false).unwrap().write_text(HISTORY_MEAN_FILE, "x").unwrap();
    for seed in [1, 20] {
        let run = dir.path().join(seed_folder(seed));
        finished_run(&run);
        fs::create_dir_all(run.join(CHECKPOINT_FOLDER).join("step-0000000064")).unwrap();
    }
    seeds(false).unwrap();
    let left: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, [MARKER_FILE]);
    // What no run wrote is not taken for one by its name.
    fs::create_dir(dir.path().join("seed-3")).unwrap();
    assert!(create(dir.path(), false).unwrap_err().to_string().contains("seed-3"));
    fs::remove_dir(dir.path().join("seed-3")).unwrap();
    finished_run(&dir.path().join("seed-4"));
    let mine = dir.path().join("seed-4/mine.txt");
    fs::write(&mine, "mine").unwrap();
    assert!(create(dir.path(), false).unwrap_err().to_string().contains("seed-4/mine.txt"));
    create(dir.path(), true).unwrap();
    assert!(mine.exists() && !dir.path().join("seed-4").join(HISTORY_FILE).exists());
}

#[test]
fn only_a_runs_folder_can_be_gone_on_with() {
    let dir = tempfile::tempdir().unwrap();
    assert!(matches!(OutputFolder::open(dir.path()), Err(OutputError::NotARun { .. })));
    finished_run(dir.path());
    let first = OutputFolder::open(dir.path()).unwrap();
    assert!(matches!(OutputFolder::open(dir.path()), Err(OutputError::InUse { .. })));
    assert!(matches!(create(dir.path(), true), Err(OutputError::InUse { .. })));
    drop(first);
    OutputFolder::open(dir.path()).unwrap();
    assert!(dir.path().join(HISTORY_FILE).exists());
}

/// The audit is there from the end of a run until it goes on or another takes its place.
#[test]
fn only_an_ended_run_has_its_audit() {
    let dir = tempfile::tempdir().unwrap();
    let folder = create(dir.path(), false).unwrap();
    assert!(!has_ended(dir.path()));
    folder.go_on().unwrap();
    folder.end("all is well").unwrap();
    assert!(has_ended(dir.path()));
    folder.go_on().unwrap();
    assert!(!has_ended(dir.path()));
    folder.end("all is well").unwrap();
    drop(folder);
    create(dir.path(), false).unwrap();
    assert!(!has_ended(dir.path()));
}

#[test]
fn a_folder_with_anything_else_is_refused_with_path_and_remedy_and_left_alone() {
    let dir = tempfile::tempdir().unwrap();
    finished_run(dir.path());
    let notes = dir.path().join("snapshots/notes.txt");
    fs::write(&notes, "mine").unwrap();
    let error = create(dir.path(), false).unwrap_err().to_string();
    assert!(error.contains(&dir.path().display().to_string()), "{error}");
    assert!(error.contains("snapshots/notes.txt") && error.contains("--force"), "{error}");
    assert!(dir.path().join(HISTORY_FILE).exists(), "a refusal changes nothing");
    create(dir.path(), true).unwrap();
    assert_eq!(fs::read_to_string(&notes).unwrap(), "mine");
    assert!(!dir.path().join(HISTORY_FILE).exists());
}

#[test]
fn a_users_own_scene_file_is_not_taken_for_a_result() {
    let dir = tempfile::tempdir().unwrap();
    let scene = dir.path().join(SCENE_FILE);
    fs::write(&scene, "title = 'mine'").unwrap();
    let error = create(dir.path(), false).unwrap_err().to_string();
    assert!(error.contains("scene.toml"), "{error}");
    assert_eq!(fs::read_to_string(&scene).unwrap(), "title = 'mine'");
}

#[test]
fn a_file_in_the_folders_place_is_an_error() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("file");
    fs::write(&path, "").unwrap();
    assert!(matches!(create(&path, true), Err(OutputError::NotAFolder { .. })));
}

/// What has not ended, is of another kind or of another scene is replaced by force alone; what says the same is replaced.
#[test]
fn only_the_same_results_are_replaced_unasked() {
    let dir = tempfile::tempdir().unwrap();
    let of = |scene: &'static str, content| Claim { content, scene: Some(scene), ..claim(false) };
    let told = |claim: &Claim<'_>| OutputFolder::create(dir.path(), claim).map(drop).map_err(|error| error.to_string());
    finished_run(dir.path());
    fs::write(dir.path().join(SCENE_FILE), "title = \"a\"\nend_time = 1.0\n").unwrap();
    let error = told(&of("title = \"a\"\nend_time = 2.0\n", Content::Run)).unwrap_err();
    assert!(
        error.contains("`end_time = 1.0` there, `end_time = 2.0` in this one") && error.contains("--force"),
        "{error}"
    );
    let same = of("title = \"a\"\nend_time = 1.0\n", Content::Run);
    let error = told(&Claim { content: Content::Sweep, ..same }).unwrap_err();
    assert!(error.contains("holds a run, this is a sweep"), "{error}");
    fs::remove_file(dir.path().join(AUDIT_FILE)).unwrap();
    fs::write(dir.path().join(HISTORY_FILE), "time_s\n1.0\n").unwrap();
    let error = told(&same).unwrap_err();
    assert!(error.contains("(1 row of history, no checkpoint to go on from)"), "{error}");
    fs::create_dir_all(dir.path().join("checkpoints/step-0000000064")).unwrap();
    let error = told(&same).unwrap_err();
    assert!(error.contains(&format!("`corpuscle resume {}`", dir.path().display())), "{error}");
    assert!(dir.path().join(PLAN_FILE).exists(), "a refusal changes nothing");
    told(&Claim { force: true, ..same }).unwrap();
    // A run that has left no row is nothing to lose.
    HistoryWriter::create(dir.path(), &[Column::new("time", "s")]).unwrap();
    told(&same).unwrap();
}

/// What is read is never removed: by its path, through links on either side, in a folder that is read.
#[test]
fn what_is_read_is_not_removed_by_whatever_path() {
    use std::os::unix::fs::symlink;
    let dir = tempfile::tempdir().unwrap();
    let (run, elsewhere) = (dir.path().join("run"), dir.path().join("elsewhere"));
    finished_run(&run);
    fs::create_dir(&elsewhere).unwrap();
    let (scene, mine) = (run.join(SCENE_FILE), elsewhere.join("mine.toml"));
    symlink(&scene, &mine).unwrap();
    symlink(&run, elsewhere.join("link")).unwrap();
    let checkpoint = run.join("checkpoints/step-0000000064");
    fs::create_dir_all(&checkpoint).unwrap();
    fs::write(checkpoint.join("state.bin"), "x").unwrap();
    let relative = run.join("snapshots/../scene.toml");
    for input in [scene.clone(), mine.clone(), elsewhere.join("link/scene.toml"), relative, checkpoint] {
        let inputs = [input];
        let refused = OutputFolder::create(&run, &Claim { inputs: &inputs, ..claim(true) });
        assert!(matches!(refused, Err(OutputError::OverInput { .. })), "{inputs:?}");
    }
    // A link in the place of a result goes; what it leads to stays.
    fs::write(elsewhere.join("scene.toml"), "mine").unwrap();
    fs::remove_file(run.join(HISTORY_FILE)).unwrap();
    symlink(elsewhere.join("scene.toml"), run.join(HISTORY_FILE)).unwrap();
    assert!(create(&run, false).unwrap_err().to_string().contains(HISTORY_FILE));
    let inputs = [elsewhere.join("scene.toml")];
    assert!(OutputFolder::create(&run, &Claim { inputs: &inputs, ..claim(true) }).is_err());
    create(&run, true).unwrap();
    assert_eq!(fs::read_to_string(elsewhere.join("scene.toml")).unwrap(), "mine");
    assert!(!run.join(HISTORY_FILE).exists() && !scene.exists());
}

/// What kills have left half written goes when the run goes on; checkpoints that stand do not.
#[test]
fn a_run_that_goes_on_removes_what_is_half_written() {
    let dir = tempfile::tempdir().unwrap();
    finished_run(dir.path());
    let checkpoints = dir.path().join(CHECKPOINT_FOLDER);
    for name in ["step-0000000064", "step-0000000128.partial", "step-0000000032.removed"] {
        fs::create_dir_all(checkpoints.join(name)).unwrap();
        fs::write(checkpoints.join(name).join("state.bin"), "x").unwrap();
    }
    let half = ["plan.toml.partial", "snapshots/particles_000001.vtu.partial"].map(|name| dir.path().join(name));
    half.iter().for_each(|path| fs::write(path, "half").unwrap());
    OutputFolder::open(dir.path()).unwrap().go_on().unwrap();
    assert!(half.iter().all(|path| !path.exists()));
    let left: Vec<_> = fs::read_dir(&checkpoints).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["step-0000000064"]);
}

/// A folder that was made for a run which is then refused does not stay.
#[test]
fn a_claim_that_comes_to_nothing_leaves_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("new");
    let folder = OutputFolder::claim(&path, &claim(false)).unwrap();
    assert!(path.is_dir());
    drop(folder);
    assert!(!path.exists());
}
