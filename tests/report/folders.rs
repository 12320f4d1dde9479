//! Whether a page is written at the end of a run, and folders that have none to give.

use std::fs;
use std::path::Path;

use super::{outcome, reported, run, scene, short_run};

/// Nobody sees a run of a test: unless the scene or the command line asks there is no page.
#[test]
fn a_run_writes_its_page_if_it_is_asked_to() {
    let folder = tempfile::tempdir().unwrap();
    let uniform = ("occupancy = 0.1", "method = \"control-volume\"");
    let plain = scene(folder.path(), "box.toml", "1e-3", &[uniform]);
    let has_page = |out: &str, scene: &Path, more: &[&str]| {
        run(scene, &folder.path().join(out), more).join("report.html").exists()
    };
    assert!(!has_page("plain", &plain, &[]));
    assert!(has_page("asked", &plain, &["--report"]));
    let text = fs::read_to_string(&plain).unwrap();
    assert!(text.contains("[output]"));
    let wishing = folder.path().join("wishing.toml");
    fs::write(&wishing, text.replace("[output]", "[output]\nreport = true")).unwrap();
    assert!(has_page("wishing", &wishing, &[]));
    // A run may replace the page of an earlier one.
    assert!(has_page("wishing", &wishing, &[]));
    fs::write(&wishing, text.replace("[output]", "[output]\nreport = false")).unwrap();
    assert!(!has_page("refused", &wishing, &[]) && has_page("both", &wishing, &["--report"]));
}

#[test]
fn a_killed_run_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let run = short_run(&folder.path().join("run"), &[]);
    let history = fs::read_to_string(run.join("history.csv")).unwrap();
    fs::write(run.join("history.csv"), &history[..history.len() - 9]).unwrap();
    for file in ["timing.json", "environment.json", "pressure.svg", "plan.toml"] {
        fs::remove_file(run.join(file)).unwrap();
    }
    let html = fs::read_to_string(reported(&[run.to_str().unwrap()])).unwrap();
    assert!(html.contains("This run has not reached its end") && html.contains("is cut off"));
    assert!(html.contains("its history ends at 0."), "how far it has got");
    // Before its first row.
    fs::write(run.join("history.csv"), format!("{}\n", history.lines().next().unwrap())).unwrap();
    fs::remove_dir_all(run.join("snapshots")).unwrap();
    let html = fs::read_to_string(reported(&[run.to_str().unwrap()])).unwrap();
    assert!(html.contains("has no rows yet") && html.contains("has no snapshots"));
}

/// What is broken is refused with the file's name, the place and what is wrong; nothing panics, nothing is written.
#[test]
fn broken_folders_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let run = short_run(&folder.path().join("run"), &[]);
    let refused = |path: &Path| {
        let (code, _, err) = outcome(&["report", path.to_str().unwrap()]);
        assert_eq!(code, 2, "{err}");
        assert!(!path.join("report.html").exists());
        err
    };
    let empty = folder.path().join("empty");
    fs::create_dir(&empty).unwrap();
    let told = refused(&empty);
    assert!(told.contains("has nothing to report: no history.csv") && told.contains("--out"), "{told}");
    assert!(refused(&folder.path().join("none")).contains("none"));
    for (file, text, expected) in [
        ("history.csv", "time_s,a\n1,2\n1,x\n", "history.csv:3: column \"a\" holds \"x\""),
        ("history.csv", "", "history.csv"),
        ("history.csv", "step_s\n1\n", "no column `time_s`"),
        ("scene.toml", "title = 3\n", "scene.toml"),
        ("plan.toml", "a = ", "plan.toml"),
        ("timing.json", "{", "timing.json"),
        ("environment.json", "[]", "environment.json"),
        ("snapshots/particles.pvd", "<DataSet timestep=\"x\"", "particles.pvd"),
        ("snapshots/walls.vtp", "<VTKFile>", "walls.vtp"),
    ] {
        let path = run.join(file);
        let kept = fs::read(&path).unwrap();
        fs::write(&path, text).unwrap();
        let told = refused(&run);
        assert!(told.contains(expected), "{file}: {told}");
        fs::write(&path, kept).unwrap();
    }
    // A snapshot that is cut off is left out, and the page says so.
    let snapshot = run.join("snapshots/particles_000001.vtu");
    let bytes = fs::read(&snapshot).unwrap();
    fs::write(&snapshot, &bytes[..bytes.len() / 4]).unwrap();
    let html = fs::read_to_string(reported(&[run.to_str().unwrap()])).unwrap();
    assert!(html.contains("left out: ") && html.contains("particles_000001.vtu"));
    // One that is not a page is not written over.
    fs::write(run.join("mine.html"), "mine").unwrap();
    let mine = run.join("mine.html");
    let (code, _, err) = outcome(&["report", run.to_str().unwrap(), "--out", mine.to_str().unwrap()]);
    assert!(code == 2 && err.contains("no report") && fs::read_to_string(&mine).unwrap() == "mine", "{err}");
    let (code, _, err) = outcome(&["report", run.to_str().unwrap(), empty.to_str().unwrap()]);
    assert!(code == 2 && err.contains("empty"), "{err}");
}
