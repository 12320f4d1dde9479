//! `corpuscle sweep` as its users see it: files, columns, tables, errors. Sweeps are of a few steps of 2,000 particles.

use std::fs;
use std::path::Path;

use super::outcome;

fn sweep(out: &Path, more: &[&str]) -> (i32, String, String) {
    let basic = ["sweep", "scenes/corner.toml", "--particles", "2000", "--out", out.to_str().unwrap()];
    outcome(&[&basic, more].concat())
}

fn finished(out: &Path, more: &[&str]) -> String {
    let (code, text, err) = sweep(out, more);
    assert_eq!(code, 0, "{err}");
    text
}

/// A value by row and column.
struct Table(Vec<Vec<String>>);

impl Table {
    fn of(out: &Path) -> Table {
        let text = fs::read_to_string(out.join("sweep.csv")).unwrap();
        Table(text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect())
    }

    fn text(&self, row: usize, column: &str) -> &str {
        let at = self.0[0].iter().position(|head| head == column).unwrap_or_else(|| panic!("{column}"));
        &self.0[row][at]
    }

    fn value(&self, row: usize, column: &str) -> f64 {
        self.text(row, column).parse().unwrap_or_else(|_| panic!("{column} of row {row}: {:?}", self.0[row]))
    }

    fn cases(&self) -> Vec<(&str, &str, &str)> {
        let rows = 1..self.0.len();
        rows.map(|row| (self.text(row, "kind"), self.text(row, "devices"), self.text(row, "balance"))).collect()
    }
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_sweep_of_real_runs_leaves_its_table_and_its_curve() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let options = ["--devices", "2,1", "--balance", "dynamic,off", "--steps", "32", "--repeat", "2"];
    let text = finished(&out, &options);
    assert_eq!(text.lines().last(), out.to_str());
    assert!(text.contains("## Measured") && text.contains("subdomains of one process"), "{text}");
    assert!(!text.contains("odelled"), "{text}");
    assert_eq!(names(&out), [".corpuscle-run", "scene.toml", "sweep.csv", "sweep.svg", "sweep.txt"]);
    let table = Table::of(&out);
    // One device has nothing to share out.
    let cases = [("measured", "1", "dynamic"), ("measured", "2", "dynamic"), ("measured", "2", "off")];
    assert_eq!(table.cases(), cases);
    for row in 1..=3 {
        assert_eq!((table.value(row, "turns"), table.value(row, "steps")), (2.0, 32.0));
        let [least, median, most] = ["seconds_min", "seconds", "seconds_max"].map(|name| table.value(row, name));
        assert!(0.0 < least && least <= median && median <= most);
        let (efficiency, devices) = (table.value(row, "efficiency"), table.value(row, "devices"));
        assert!((table.value(row, "speed_up") - efficiency * devices).abs() < 1e-9);
    }
    assert_eq!(table.value(1, "efficiency"), 1.0);
    // Again into the same folder, and not into one that holds something else.
    finished(&out, &["--devices", "1", "--balance", "off", "--steps", "32", "--repeat", "1"]);
    assert_eq!(Table::of(&out).0.len(), 2);
    fs::write(out.join("notes.txt"), "mine").unwrap();
    let (code, _, err) = sweep(&out, &options);
    assert!(code == 2 && err.contains("notes.txt"), "{err}");
}

#[test]
fn a_weak_sweep_holds_the_particles_of_a_device() {
    let folder = tempfile::tempdir().unwrap();
    let options = ["--devices", "1,2", "--balance", "off", "--steps", "32", "--repeat", "1", "--weak"];
    let text = finished(folder.path(), &options);
    assert!(text.contains("particles of each device are held"), "{text}");
    let table = Table::of(folder.path());
    let per_step =
        |row: usize| table.value(row, "particle_steps_per_s") * table.value(row, "seconds") / table.value(row, "steps");
    assert!((per_step(1) - 2000.0).abs() < 1.0 && (per_step(2) - 4000.0).abs() < 2.0, "{:?}", table.0);
}

/// Emulated too, each device has as many particles as one device of the scene, and a speed-up is that of their number.
#[test]
fn an_emulated_weak_sweep_holds_the_particles_of_a_device() {
    let folder = tempfile::tempdir().unwrap();
    let options = ["--devices", "2,4", "--balance", "dynamic", "--balance-by", "particles", "--intervals", "1"];
    let text = finished(folder.path(), &[&options[..], &["--weak", "--emulate"]].concat());
    assert!(text.contains("as many more as there are more devices"), "{text}");
    let table = Table::of(folder.path());
    assert_eq!(table.cases(), [("modelled", "2", "dynamic"), ("modelled", "4", "dynamic")]);
    let owned = [1, 2].map(|row| table.value(row, "owned_max"));
    for (owned, row) in owned.into_iter().zip(1..) {
        let mean = owned / table.value(row, "owned_imbalance");
        assert!((mean - 2000.0).abs() < 2.0, "{mean}");
    }
    let expected = 2.0 * owned[0] / owned[1];
    assert!((table.value(2, "owned_speed_up") - expected).abs() < 1e-9 * expected && expected > 1.5, "{expected}");
}

/// With the method `half-turn`, whose boxes are of whole tiles and have no ghosts: real runs and emulated ones.
#[test]
fn half_turn_can_be_swept_and_emulated() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("corner.toml");
    let text = fs::read_to_string("scenes/corner.toml").unwrap().replace("\"closest-approach\"", "\"half-turn\"");
    fs::write(&scene, text).unwrap();
    let out = folder.path().join("out");
    let basic = ["sweep", scene.to_str().unwrap(), "--particles", "8000", "--out", out.to_str().unwrap()];
    let options = ["--devices", "2", "--balance", "dynamic", "--balance-by", "particles"];
    let all = |more: &[&'static str]| {
        let (code, _, err) = outcome(&[&basic[..], &options, more].concat());
        assert_eq!(code, 0, "{err}");
        Table::of(&out)
    };
    let table = all(&["--steps", "64", "--repeat", "1"]);
    assert_eq!(table.cases().last(), Some(&("measured", "2", "dynamic")));
    let table = all(&["--emulate", "--intervals", "1"]);
    assert_eq!(table.cases().last(), Some(&("modelled", "2", "dynamic")));
    let row = table.0.len() - 1;
    // All gas is in a corner of few tiles: the fuller half is the nearest plane of tiles.
    assert!(table.value(row, "owned_max") < 8000.0 && table.value(row, "ghosts_per_owned") == 0.0, "{:?}", table.0);
}

#[test]
fn an_emulation_says_what_is_measured_and_what_is_modelled() {
    let folder = tempfile::tempdir().unwrap();
    let counts = ["--emulate", "--devices", "1,2,5", "--validate", "1", "--steps", "32", "--repeat", "1"];
    let options = ["--intervals", "2", "--latency-us", "100", "--bandwidth-gbs", "0.5", "--gpu-particle-ns", "1000"];
    // By particles: cuts by cost follow the times of a busy machine.
    let by = ["--balance-by", "particles"];
    let text = finished(folder.path(), &[&counts[..], &options, &by].concat());
    for part in [
        "## Measured",
        "## Modelled: work alone",
        "## Modelled: time, with the fixed costs of",
        "100 us per exchange, 1 us per message and 0.5 GB/s (assumed)",
        "measured: s, ",
        "## Modelled: time on an assumed GPU",
        "## The model beside real runs",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(folder.path().join("sweep_modelled.svg").exists());
    let table = Table::of(folder.path());
    let modelled = |devices: &'static str, balance: &'static str| ("modelled", devices, balance);
    let of_each = ["2", "5"].map(|n| [modelled(n, "off"), modelled(n, "dynamic")]);
    let all = [&[("measured", "1", "off"), modelled("1", "off")], of_each.as_flattened()].concat();
    assert_eq!(table.cases(), all);
    assert_eq!((table.text(2, "work_max"), table.value(2, "messages_ms")), ("", 0.0));
    for row in 3..=6 {
        let devices = table.value(row, "devices");
        let [own, messages, whole] = ["own_ms", "messages_ms", "ms_per_step"].map(|name| table.value(row, name));
        assert!(own > 0.0 && (own + messages - whole).abs() < 1e-9 * whole);
        // At least one exchange of particles and the bytes of the halo in it.
        assert!(messages > 0.1, "{messages}");
        // The fullest owns no less than the mean, and no more than all; the work has its ghosts besides.
        let (owned, imbalance) = (table.value(row, "owned_max"), table.value(row, "owned_imbalance"));
        assert!(owned >= 2000.0 / devices && owned <= 2000.0, "{owned}");
        assert!((imbalance - owned * devices / 2000.0).abs() < 1e-6 * imbalance, "{imbalance}");
        assert!(table.value(row, "ghosts_per_owned") > 0.0 && table.value(row, "gpu_ms") > 0.0);
    }
    // All the gas is in a corner: equal boxes leave half of it with one of five, cuts that follow it do not.
    assert!(table.value(5, "owned_imbalance") > 1.5 * table.value(6, "owned_imbalance"), "{:?}", table.0);
    assert!(table.value(6, "weight_imbalance_after") >= 1.0);
    assert_eq!(table.text(5, "weight_imbalance_after"), "");
}

/// All gas in a corner, cut for two devices by particles and by cost: what was balanced is even within 3 % right after. With 150,000
/// particles the corner is 40 planes of cells, and the nearest is within 1/80 of the whole of what is wanted, which is 2.5 % of a half,
/// whatever the costs are that were measured (of 20,000 it is 21, so 4.8 %: too few for this law).
#[test]
fn gas_in_a_corner_is_shared_evenly() {
    for by in ["particles", "cost"] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().to_str().unwrap();
        let counts =
            ["--particles", "150000", "--emulate", "--devices", "2", "--balance", "dynamic", "--intervals", "1"];
        let (code, _, err) =
            outcome(&[&["sweep", "scenes/corner.toml", "--out", out, "--balance-by", by], &counts[..]].concat());
        assert_eq!(code, 0, "{err}");
        let after = Table::of(folder.path()).value(1, "weight_imbalance_after");
        assert!((1.0..1.03).contains(&after), "by {by}: {after}");
    }
}

#[test]
fn what_cannot_be_swept_is_refused_with_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |options: &[&str], code: i32, part: &str| {
        let (found, _, err) = sweep(&folder.path().join("out"), options);
        // A message is broken into lines where it likes.
        let flat = err.replace('│', " ").split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(found == code && flat.contains(part), "{options:?}: {found} {err}");
    };
    refused(&[], 2, "--devices");
    for list in ["0", "1,0", "", "2,two", "1;2", "5000", "-1"] {
        refused(&[&format!("--devices={list}")], 2, "'--devices");
    }
    refused(&["--devices", "1", "--balance", "sometimes"], 2, "'sometimes'");
    refused(&["--devices", "1", "--repeat", "0"], 2, "--repeat");
    refused(&["--devices", "1", "--weak", "--from", "here"], 2, "cannot be used with");
    refused(&["--devices", "1", "--emulate", "--message-us=-1"], 2, "--message-us -1");
    refused(&["--devices", "1", "--validate", "1"], 2, "--emulate");
    refused(&["--devices", "1", "--latency-us", "3"], 2, "--emulate");
    refused(&["--devices", "4", "--emulate", "--validate", "2"], 2, "--launcher");
    refused(&["--devices", "4", "--emulate", "--validate", "1"], 2, "among --devices");
    refused(&["--devices", "4", "--emulate", "--steps", "32"], 2, "--steps: an emulation makes no runs");
    refused(&["--devices", "4", "--emulate", "--balance-every", "32"], 2, "--balance-every: an emulation");
    refused(&["--devices", "4", "--emulate", "--latency-us=-1"], 2, "--latency-us -1");
    refused(&["--devices", "4", "--emulate", "--bandwidth-gbs=0"], 2, "above 0");
    refused(&["--devices", "1", "--balance-threshold", "0.5"], 2, "--balance-threshold");
    refused(&["--devices", "1", "--launcher", " "], 2, "--launcher is empty");
    refused(&["--devices", "1", "--gpu", "no such", "--emulate"], 3, "no such");
    assert!(!folder.path().join("out").join("sweep.csv").exists());
}

/// From whatever names the checkpoint; what the run wrote at its end, or after that checkpoint, is not taken for the sweep's. A failed
/// sweep before leaves nothing to go on with.
#[test]
fn a_sweep_goes_on_from_a_run_that_has_ended() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    let path = |path: &Path| path.to_str().unwrap().to_owned();
    let basic = ["run", "scenes/corner.toml", "--quiet", "--particles", "2000", "--steps", "96"];
    let (code, _, err) = outcome(&[&basic[..], &["--checkpoint-every", "32", "--out", &path(&run)]].concat());
    assert_eq!(code, 0, "{err}");
    // As if the scene had ended there.
    fs::write(run.join("audit.txt"), "all is well").unwrap();
    let timing = fs::read(run.join("timing.json")).unwrap();
    let out = folder.path().join("out");
    let sweep = |from: &Path, more: &[&str]| {
        let basic = ["sweep", "scenes/corner.toml", "--out", out.to_str().unwrap(), "--from", from.to_str().unwrap()];
        outcome(&[&basic[..], &["--devices", "1,2", "--balance", "off", "--repeat", "1"], more].concat())
    };
    let (code, _, err) = sweep(&run, &["--steps", "32", "--gpu", "no such"]);
    assert!(code == 3 && out.join("runs/1-off-1-state-1").exists(), "{err}");
    let checkpoints = run.join("checkpoints");
    for (from, done) in [(run.clone(), 96), (checkpoints.clone(), 96), (checkpoints.join("step-0000000064"), 64)] {
        let (code, text, err) = sweep(&from, &["--steps", "32", "--force"]);
        assert_eq!(code, 0, "{} steps: {err}", done);
        let table = Table::of(&out);
        assert_eq!(table.cases(), [("measured", "1", "off"), ("measured", "2", "off")], "{text}");
        for row in 1..=2 {
            let share =
                table.value(row, "particle_steps_per_s") * table.value(row, "seconds") / table.value(row, "steps");
            assert!((share - 2000.0).abs() < 2.0, "{share} particles in each step");
        }
    }
    assert_eq!(fs::read(run.join("timing.json")).unwrap(), timing, "the run's own folder is not touched");
}

/// The message of what failed reaches the user, with the code of whose fault it was.
#[test]
fn a_run_that_fails_ends_the_sweep() {
    let folder = tempfile::tempdir().unwrap();
    let out = |name: &str| folder.path().join(name);
    let (code, _, err) = sweep(&out("a"), &["--devices", "1", "--launcher", "no-such-launcher --flag"]);
    assert!(code == 2 && err.contains("no-such-launcher"), "{err}");
    let (code, _, err) = sweep(&out("b"), &["--devices", "1", "--gpu", "no such", "--steps", "32"]);
    assert!(code == 3 && err.contains("no adapter `no such`"), "{code} {err}");
    // A launcher that starts something else leaves no results.
    let (code, _, err) = sweep(&out("c"), &["--devices", "1", "--launcher", "true"]);
    assert!(code == 2 && err.contains("history.csv"), "{code} {err}");
}
