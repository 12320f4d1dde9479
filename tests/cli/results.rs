//! What a run leaves: its files, their bytes, and what may not be replaced.

use std::fs;
use std::path::Path;

use super::{finished_run, names_below, outcome, printed, scene_with, short_run};

const FILES: [&str; 12] = [
    ".corpuscle-run",
    "environment.json",
    "history.csv",
    "log.txt",
    "plan.toml",
    "pressure.svg",
    "scene.toml",
    "snapshots/particles.pvd",
    "snapshots/particles_000000.vtu",
    "snapshots/particles_000001.vtu",
    "snapshots/walls.vtp",
    "timing.json",
];

const HEADER: &str = "time_s,window_end_s,step_s,particles,\
    box:pressure_pa,box:reference_pressure_pa,box:temperature_k,box:reference_temperature_k,\
    box:density_kg_m3,box:velocity_x_m_s,box:velocity_y_m_s,box:velocity_z_m_s,box:particles:nitrogen,\
    walls:pressure_pa,walls:impulse_x_kg_m_s,walls:impulse_y_kg_m_s,walls:impulse_z_kg_m_s,walls:hits";

#[test]
fn a_run_leaves_exactly_its_files_and_its_path_as_the_last_line() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("deep/results");
    let text = finished_run(&out, &["--seed", "3"]);
    assert_eq!(text.lines().last(), out.to_str());
    for part in ["adapter 0: ", "Audit ", "particles", "Phase, sampled", "advect", "64 steps", "wall time "] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert_eq!(names_below(&out), FILES);

    let history = fs::read_to_string(out.join("history.csv")).unwrap();
    assert_eq!(history.lines().next(), Some(HEADER));
    let rows: Vec<Vec<f64>> =
        history.lines().skip(1).map(|line| line.split(',').map(|value| value.parse().unwrap()).collect()).collect();
    assert!(!rows.is_empty());
    // Gas at rest: the reference stays as it was, and so does the number of particles.
    assert!(
        rows.iter().all(|row| row[3] == 500.0 && (row[5] - 101_325.0).abs() < 1e-3 && row[7] == 300.0),
        "{history}"
    );

    let environment: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(out.join("environment.json")).unwrap()).unwrap();
    assert!(environment["adapter"]["limits"]["max_buffer_size"].as_u64().unwrap() > 0);
    let chart = fs::read_to_string(out.join("pressure.svg")).unwrap();
    assert!(chart.contains("largest difference") && chart.contains("of the peak"), "{chart}");

    // The scene of the results is the one that ran, and gives the plan of the results.
    let scene = out.join("scene.toml");
    let recorded = fs::read_to_string(&scene).unwrap();
    assert!(recorded.contains("seed = 3\n") && recorded.contains("particles = 500\n"), "{recorded}");
    let plan = printed(&["plan", "--toml", scene.to_str().unwrap()]);
    assert_eq!(plan, fs::read_to_string(out.join("plan.toml")).unwrap());
}

#[test]
fn results_are_replaced_and_what_is_no_result_is_not() {
    let folder = tempfile::tempdir().unwrap();
    finished_run(folder.path(), &["--quiet"]);
    let text = finished_run(folder.path(), &["--quiet", "--force"]);
    assert_eq!(text.lines().collect::<Vec<_>>(), [folder.path().to_str().unwrap()]);
    assert_eq!(names_below(folder.path()), FILES);

    let notes = folder.path().join("notes.txt");
    fs::write(&notes, "mine").unwrap();
    let (code, _, err) = short_run(folder.path(), &[]);
    assert!(code == 2 && err.contains("notes.txt") && err.contains("--force"), "{err}");
    finished_run(folder.path(), &["--force"]);
    assert_eq!(fs::read_to_string(&notes).unwrap(), "mine");
}

/// A snapshot that cannot be written stops the run, and the message names it.
#[test]
fn results_that_cannot_be_written_are_2() {
    let folder = tempfile::tempdir().unwrap();
    let blocked = folder.path().join("snapshots/particles_000000.vtu");
    fs::create_dir_all(&blocked).unwrap();
    let (code, _, err) = short_run(folder.path(), &["--force"]);
    // A message is broken into lines where it likes.
    let flat = err.replace(['\n', '│', ' '], "");
    assert!(code == 2 && flat.contains("particles_000000.vtu"), "{err}");
}

#[test]
fn equal_runs_leave_equal_bytes_however_they_are_batched() {
    let folder = tempfile::tempdir().unwrap();
    let run = |name: &str, more: &[&str]| {
        let out = folder.path().join(name);
        finished_run(&out, more);
        ["history.csv", "snapshots/particles_000001.vtu", "plan.toml", "scene.toml", "pressure.svg"]
            .map(|file| fs::read(out.join(file)).unwrap())
    };
    let first = run("first", &[]);
    assert!(first == run("again", &[]), "a second run differs");
    assert!(first == run("batched", &["--batch", "7"]), "a run in batches of 7 differs");
    // The comparison can fail: another seed is another gas.
    let other = run("other", &["--seed", "2"]);
    assert!(first[0] != other[0] && first[1] != other[1] && first[2] != other[2]);
}

/// What several ranks have to tell stands beside the same results, and a rank alone has nothing to tell.
#[test]
fn several_ranks_leave_their_records_besides() {
    let folder = tempfile::tempdir().unwrap();
    let (alone, among) = (folder.path().join("alone"), folder.path().join("among"));
    finished_run(&alone, &[]);
    finished_run(&among, &["--subdomains", "2", "--balance", "off"]);
    let read = |out: &Path, name: &str| fs::read(out.join(name)).unwrap();
    assert_eq!(read(&alone, "history.csv"), read(&among, "history.csv"));
    let more: Vec<String> = names_below(&among).into_iter().filter(|name| !FILES.contains(&name.as_str())).collect();
    assert_eq!(more, ["balance.csv", "subdomains.svg"]);
    let lossy = |out: &Path| String::from_utf8_lossy(&read(out, "snapshots/particles_000001.vtu")).into_owned();
    let array = "Name=\"subdomain\"";
    assert!(lossy(&among).contains(array) && !lossy(&alone).contains(array));

    let balance = String::from_utf8(read(&among, "balance.csv")).unwrap();
    let rows: Vec<Vec<&str>> = balance.lines().map(|line| line.split(',').collect()).collect();
    let value = |row: usize, name: &str| {
        let at = rows[0].iter().position(|head| *head == name).unwrap();
        rows[row][at].parse::<f64>().unwrap()
    };
    assert_eq!((rows.len(), value(1, "step"), value(2, "step"), value(2, "ranks")), (3, 32.0, 64.0, 2.0));
    // Particles at rest in two halves of a box.
    assert_eq!(value(2, "owned_mean"), 250.0);
    assert_eq!(value(2, "imbalance_particles"), value(2, "owned_max") / 250.0);
    assert!(value(2, "ghosts_min") > 0.0 && value(2, "bytes") > 0.0 && value(2, "moved") > 0.0);
    assert_eq!(value(2, "rebalanced"), 0.0);
    let timing: serde_json::Value = serde_json::from_slice(&read(&among, "timing.json")).unwrap();
    assert_eq!((timing["steps"].as_u64(), timing["ranks"].as_array().unwrap().len()), (Some(64), 2));
    assert!(timing["stepping_seconds"].as_f64().unwrap() > 0.0);
}

/// The method `control-volume` runs on no device (the one asked for here is none), by the same columns; resumed, the run
/// has ended; there are no particles to share out.
#[test]
fn a_control_volume_leaves_a_history_without_a_device() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene_with(&folder, "occupancy = 0.1", "method = \"control-volume\"");
    let (scene, out) = (scene.to_str().unwrap(), folder.path().join("out"));
    let (code, text, err) = outcome(&["run", scene, "--gpu", "no such", "--out", out.to_str().unwrap()]);
    assert!(code == 0 && err.contains("it needs no --gpu"), "{err}");
    assert_eq!(text.lines().last(), out.to_str());
    assert!(text.contains("energy, J"), "{text}");
    let files = [
        ".corpuscle-run",
        "audit.txt",
        "environment.json",
        "history.csv",
        "log.txt",
        "plan.toml",
        "pressure.svg",
        "scene.toml",
        "timing.json",
    ];
    assert_eq!(names_below(&out), files);
    let history = fs::read_to_string(out.join("history.csv")).unwrap();
    assert_eq!(history.lines().next(), Some(HEADER));
    let rows: Vec<Vec<f64>> =
        history.lines().skip(1).map(|line| line.split(',').map(|value| value.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), 44);
    for row in &rows {
        assert!((row[4] / 101_325.0 - 1.0).abs() < 1e-9 && (row[4] / row[5] - 1.0).abs() < 1e-9, "{row:?}");
        // The wall is pressed by the gas; all of it is counted.
        assert!((row[13] / 101_325.0 - 1.0).abs() < 1e-9 && (row[12] - 8000.0).abs() < 1e-5, "{row:?}");
    }
    let (code, text, _) = outcome(&["resume", out.to_str().unwrap()]);
    assert!(code == 0 && text.contains("reached its end"), "{text}");
    let plan = printed(&["plan", scene]);
    assert!(plan.contains("control-volume  asked for") && !plan.contains("steps"), "{plan}");
    let (code, _, err) =
        outcome(&["sweep", scene, "--devices", "1,2", "--out", folder.path().join("s").to_str().unwrap()]);
    assert!(code == 2 && err.contains("no particles"), "{code} {err}");
}
