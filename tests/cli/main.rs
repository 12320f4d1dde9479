//! The command line as its users see it: texts, exit codes, files.
//!
//! Texts are snapshots in `snapshots/`, which INSTA_UPDATE=always renews. Runs take 64 steps of 500 particles on
//! whatever adapter the machine has.

mod mesh;
mod pareto;
mod repeat;
mod results;
mod stability;
mod strict;
mod sweep;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use tempfile::TempDir;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The program in the root of the package, without colours.
fn corpuscle(arguments: &[&str]) -> Command {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("corpuscle");
    // Silences a warning of Mesa's device selection layer.
    command.current_dir(ROOT).env("NODEVICE_SELECT", "1").env("NO_COLOR", "1").args(arguments);
    command
}

/// Exit code, standard output and standard error.
fn outcome(arguments: &[&str]) -> (i32, String, String) {
    let output = corpuscle(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

fn printed(arguments: &[&str]) -> String {
    let (code, out, err) = outcome(arguments);
    assert_eq!(code, 0, "{arguments:?}: {err}");
    out
}

/// A short run of the smallest scene into `folder`.
fn short_run(folder: &Path, more: &[&str]) -> (i32, String, String) {
    let folder = folder.to_str().unwrap();
    let basic = ["run", "scenes/box.toml", "--particles", "500", "--steps", "64", "--out", folder];
    outcome(&[&basic, more].concat())
}

fn finished_run(folder: &Path, more: &[&str]) -> String {
    let (code, out, err) = short_run(folder, more);
    assert_eq!(code, 0, "{err}");
    out
}

/// Of all files below a folder, sorted.
fn names_below(folder: &Path) -> Vec<String> {
    let mut names = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                names.push(path.strip_prefix(folder).unwrap().to_str().unwrap().to_owned());
            }
        }
    }
    names.sort();
    names
}

/// The fault of this file, written beside the results.
fn scene_with(folder: &TempDir, from: &str, to: &str) -> PathBuf {
    let text = fs::read_to_string(Path::new(ROOT).join("scenes/box.toml")).unwrap();
    let changed = text.replace(from, to);
    assert_ne!(changed, text);
    let path = folder.path().join("changed.toml");
    fs::write(&path, changed).unwrap();
    path
}

const VERBS: [&str; 18] = [
    "run",
    "resume",
    "refine",
    "sweep",
    "verify",
    "pareto",
    "stability",
    "bench",
    "report",
    "watch",
    "render",
    "plan",
    "check",
    "mesh",
    "schema",
    "adapters",
    "completions",
    "man",
];

#[test]
fn every_verb_has_its_help() {
    let all = printed(&["--help"]);
    let listed =
        all.lines().skip_while(|line| !line.starts_with("Commands:")).skip(1).take_while(|line| !line.is_empty());
    let listed: BTreeSet<&str> = listed
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    assert_eq!(listed, VERBS.into_iter().chain(["help"]).collect(), "each verb has a golden text");
    insta::assert_snapshot!("help", all);
    for verb in VERBS {
        insta::assert_snapshot!(format!("help_{verb}"), printed(&[verb, "--help"]));
    }
}

/// Help by its other name, colours where they are asked for, and which build it is.
#[test]
fn help_colours_and_version_are_as_asked() {
    assert_eq!(printed(&["help", "check"]), printed(&["check", "--help"]));
    let bad = ["check", "tests/robustness/bad/empty.toml"];
    for (choice, coloured) in [("always", true), ("never", false), ("auto", false)] {
        for (arguments, option) in [(&bad[..], format!("--color={choice}")), (&["walk"], format!("--color={choice}"))] {
            let (code, _, err) = outcome(&[arguments, &[&option]].concat());
            assert!(code == 2 && err.contains('\u{1b}') == coloured, "{choice}: {err}");
        }
    }
    assert_eq!(outcome(&["--color", "sometimes", "schema"]).0, 2);
    let version = printed(&["--version"]);
    assert!(version.starts_with(concat!("corpuscle ", env!("CARGO_PKG_VERSION"))) && version.lines().count() == 1);
}

#[test]
fn every_scene_of_the_package_is_sound() {
    let names = ["box", "corner", "effusion", "tank", "vent"].map(|name| format!("scenes/{name}.toml"));
    let scenes: Vec<&str> = std::iter::once("check").chain(names.iter().map(String::as_str)).collect();
    insta::assert_snapshot!("check_scenes", printed(&scenes));
}

#[test]
fn the_plan_of_the_tank_says_why() {
    insta::assert_snapshot!("plan_tank", printed(&["plan", "scenes/tank.toml"]));
}

#[test]
fn overrides_reach_the_plan() {
    let plan = |more: &[&str]| -> toml::Table {
        printed(&[&["plan", "scenes/effusion.toml", "--toml"], more].concat()).parse().unwrap()
    };
    let changed = plan(&["--particles", "7000", "--seed", "5"]);
    assert_eq!((changed["particles"].as_integer(), changed["seed"].as_integer()), (Some(7000), Some(5)));
    // Without collisions the plan has no diameter, and is TOML still.
    assert_eq!(changed["diameter"].as_float(), Some(0.0));
    assert_ne!(plan(&[])["particles"], changed["particles"]);
}

#[test]
fn the_schema_completions_and_man_pages_come_out() {
    let schema: serde_json::Value = serde_json::from_str(&printed(&["schema"])).unwrap();
    assert!(schema["properties"]["chamber"].is_object());
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let text = printed(&["completions", shell]);
        assert!(VERBS.iter().all(|verb| text.contains(verb)), "{shell}");
    }
    let page = printed(&["man"]);
    assert!(page.contains(".TH corpuscle 1") && VERBS.iter().all(|verb| page.contains(verb)), "{page}");
    assert!(printed(&["man", "run"]).contains(r"\-\-particles"));
    let (code, _, err) = outcome(&["man", "walk"]);
    assert!(code == 2 && err.contains("`walk`") && err.contains("adapters"), "{err}");
}

#[test]
fn the_adapters_are_listed_with_their_limits() {
    let text = printed(&["adapters"]);
    let facts = ["0: ", "type", "backend", "driver", "PCI id", "largest binding", "largest buffer"];
    let more = ["workgroups per dimension", "timestamps", "particles by the binding"];
    assert!(facts.iter().chain(&more).all(|fact| text.contains(fact)), "{text}");
}

/// The cases are listed, one can be run by its name, and what is no case is bad input.
#[test]
fn reference_cases_are_listed_run_and_judged() {
    let list = printed(&["verify", "--list"]);
    assert!(list.lines().count() > 8 && list.contains("wall-pressure"), "{list}");
    let folder = TempDir::new().unwrap();
    let page = folder.path().join("page.md");
    let text = printed(&["verify", "filling", "--markdown", page.to_str().unwrap()]);
    assert!(text.contains("4 of 4 pass") && text.lines().count() == 6, "{text}");
    let first = fs::read_to_string(&page).unwrap();
    assert!(first.contains("corpuscle verify filling --quick") && first.contains("4 of 4 pass"), "{first}");
    // Another case beside what the page has.
    printed(&["verify", "virial", "--markdown", page.to_str().unwrap(), "--keep"]);
    let both = fs::read_to_string(&page).unwrap();
    assert!(
        both.contains("5 of 5 pass")
            && first.lines().filter(|line| line.starts_with('|')).all(|row| both.contains(row))
    );
    fs::write(&page, "# Something else\n").unwrap();
    let (code, _, err) = outcome(&["verify", "virial", "--markdown", page.to_str().unwrap(), "--keep"]);
    assert!(code == 2 && err.contains("page.md: line 1") && err.contains("`# Accuracy`"), "{err}");
    let (code, _, err) = outcome(&["verify", "pressure"]);
    assert!(code == 2 && err.contains("`pressure`") && err.contains("wall-pressure"), "{err}");
}

#[test]
fn bad_input_is_2_and_is_shown_in_its_place() {
    let (code, out, err) = outcome(&["run", "tests/robustness/bad/unknown_key_gas.toml"]);
    assert_eq!((code, out.as_str()), (2, ""));
    assert!(err.contains("unknown_key_gas.toml:13") && err.contains("did you mean"), "{err}");
    assert!(!err.contains('\u{1b}'), "no colours where there is no terminal: {err}");
    assert_eq!(outcome(&["plan", "scenes/no_such.toml"]).0, 2);
    assert_eq!(outcome(&["run", "scenes/box.toml", "--particles", "0"]).0, 2);
    assert_eq!(outcome(&["run"]).0, 2);
    assert_eq!(outcome(&[]).0, 2);
    assert_eq!(outcome(&["walk"]).0, 2);
}

/// Walls and plan: their message names the scene and keeps its help.
#[test]
fn walls_and_plans_that_are_not_sound_are_2() {
    let folder = tempfile::tempdir().unwrap();
    let nowhere = "name = \"box\"\nregion = { sphere = { center = [9.0, 9.0, 9.0], radius = 1.0 } }\npressure";
    let path = scene_with(&folder, "name = \"box\"\npressure", nowhere);
    let (code, _, err) = outcome(&["check", path.to_str().unwrap()]);
    assert!(code == 2 && err.contains("changed.toml") && err.contains("help:"), "{err}");
}

/// What only the set-up of a run can tell, a check tells in the same words: here that no place is found for the gas of a
/// chamber which is a ten-millionth of its bounding box.
#[test]
fn a_check_goes_through_the_set_up_of_a_run() {
    let folder = tempfile::tempdir().unwrap();
    let chambers = "name = \"most\"\n\
                    region = { box = { min = [0.0, 0.0, 0.0], max = [0.1, 0.1, 0.099999999] } }\n\
                    pressure = 101325.0\ntemperature = 300.0\ngas = \"nitrogen\"\n\n\
                    [[chamber]]\nname = \"sliver\"\npressure = 1e11 # Pa";
    let path = scene_with(&folder, "name = \"box\"\npressure = 101325.0", chambers);
    let (path, out) = (path.to_str().unwrap(), folder.path().join("out"));
    let run = outcome(&["run", path, "--steps", "1", "--out", out.to_str().unwrap()]);
    let check = outcome(&["check", path]);
    for (code, _, err) in [&run, &check] {
        assert!(*code == 2 && err.contains("no gas found in chamber 1") && err.contains("help:"), "{err}");
    }
    assert!(check.2.contains("changed.toml"), "{}", check.2);
    // The check can fail: with a sliver a hundred thousand times as thick there is room.
    let thick = fs::read_to_string(path).unwrap().replace("0.099999999", "0.0999").replace("1e11", "1e6");
    fs::write(path, thick).unwrap();
    assert_eq!(outcome(&["check", path]).0, 0);
}

#[test]
fn a_check_goes_on_after_a_bad_scene() {
    let (code, out, err) = outcome(&["check", "tests/robustness/bad/empty.toml", "scenes/box.toml"]);
    assert_eq!(code, 2);
    assert!(out.starts_with("ok scenes/box.toml: 8,000 particles"), "{out}");
    assert!(err.contains("empty.toml") && err.contains("1 of 2 scenes"), "{err}");
}

#[test]
fn an_unknown_device_is_3_and_touches_no_earlier_results() {
    let folder = tempfile::tempdir().unwrap();
    finished_run(folder.path(), &[]);
    let before = names_below(folder.path());
    let (code, _, err) = short_run(folder.path(), &["--force", "--gpu", "no such"]);
    assert!(code == 3 && err.contains("no adapter `no such`"), "{err}");
    assert_eq!(names_below(folder.path()), before);
}

/// Gas that a piston squeezes until its speeds are beyond what tallies hold: the run stops, says so, and leaves what it
/// has. (No scene is known whose audit fails at the end; what a failed one says and gives is tested beside its error.)
#[test]
fn a_run_that_cannot_be_trusted_is_4_and_leaves_its_history() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("squeezed.toml");
    let text = "end_time = 8.6e-4\n[[gas]]\nname = \"nitrogen\"\nmolar_mass = 0.028\ngamma = 1.4\n\
        [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
        [[wall]]\nname = \"piston\"\nshape = \"box\"\nmin = [-0.11, -0.01, -0.01]\nmax = [0.0, 0.11, 0.11]\n\
        gas = \"outside\"\n[[motion]]\nwall = \"piston\"\ndirection = [1.0, 0.0, 0.0]\nvelocity = 116.1\n\
        [[chamber]]\nname = \"box\"\npressure = 1e5\ntemperature = 300.0\ngas = \"nitrogen\"\n\
        [model]\nparticles = 1000\nmethod = \"none\"\n[output]\nrows = 40\nsnapshots = 2\n";
    fs::write(&path, text).unwrap();
    let out = folder.path().join("out");
    let (code, _, err) = outcome(&["run", path.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert!(code == 4 && err.contains("beyond the range of a tally") && err.contains("moving wall"), "{code} {err}");
    assert!(fs::read_to_string(out.join("history.csv")).unwrap().lines().count() > 20);
    assert!(out.join("snapshots/particles_000001.vtu").exists());
}

/// A scene of the package of which the plan decides the method.
fn without_method(folder: &TempDir, name: &str) -> String {
    let text = fs::read_to_string(Path::new(ROOT).join("scenes").join(name)).unwrap();
    let path = folder.path().join(name);
    fs::write(&path, text.replace("method = \"closest-approach\"\n", "")).unwrap();
    path.to_str().unwrap().to_owned()
}

/// A wish of the command line chooses another plan for another accuracy, with reasons, and sets `particles` of the file aside;
/// a time that is too short and a speed that nothing asks for are refused.
#[test]
fn a_wish_chooses_the_plan() {
    let folder = TempDir::new().unwrap();
    let tank = without_method(&folder, "tank.toml");
    let planned = |accuracy: &str| printed(&["plan", &tank, "--accuracy", accuracy]);
    let (coarse, fine) = (planned("0.05"), planned("0.01"));
    let particles = |text: &str| -> u64 {
        let line = text.lines().find(|line| line.starts_with("particles counted")).unwrap();
        line.split_whitespace().nth(2).unwrap().replace(',', "").parse().unwrap()
    };
    assert!(particles(&fine) > 3 * particles(&coarse), "{coarse}\n{fine}");
    for text in [&coarse, &fine] {
        for part in
            ["wish ", "set aside", "predicted error", "predicted cost", "next cheaper", "next better", "hole vent"]
        {
            assert!(text.contains(part), "{part} is not in\n{text}");
        }
    }
    let kept = printed(&["plan", &tank, "--accuracy", "0.2", "--particles", "30000"]);
    assert!(particles(&kept).abs_diff(30_000) < 3 && !kept.contains("set aside"), "{kept}");
    let (code, _, err) = outcome(&["plan", &tank, "--accuracy", "0.0003"]);
    assert!(code == 2 && err.contains("no plan is predicted to be within 0.0003"), "{err}");
    let (code, _, err) = outcome(&["plan", &tank, "--device-rate", "5"]);
    assert!(code == 2 && err.contains("--device-rate without a wish"), "{err}");
    assert_eq!(outcome(&["plan", &tank, "--accuracy", "2"]).0, 2);
}

/// What a wish chose is in the run's scene: repeated, stopped and resumed, or refined, it is a run like any other.
#[test]
fn a_chosen_run_can_be_repeated_resumed_and_refined() {
    let folder = TempDir::new().unwrap();
    let [wished, again, halves, fine] = ["wished", "again", "halves", "fine"].map(|name| folder.path().join(name));
    let done = |arguments: &[&str], out: &Path| {
        let (code, _, err) = outcome(&[arguments, &[out.to_str().unwrap()]].concat());
        assert_eq!(code, 0, "{arguments:?}: {err}");
    };
    let corner = without_method(&folder, "corner.toml");
    let wish = ["run", &corner, "--particle-budget", "3000"];
    done(&[&wish[..], &["--steps", "128", "--out"]].concat(), &wished);
    let text = |folder: &Path, name: &str| fs::read_to_string(folder.join(name)).unwrap();
    let scene = text(&wished, "scene.toml");
    assert!(scene.contains("particles = 3000") && !scene.contains("budget"), "{scene}");
    assert!(text(&wished, "plan.toml").contains("[forecast]"));
    let file = wished.join("scene.toml");
    done(&["run", file.to_str().unwrap(), "--steps", "128", "--out"], &again);
    assert_eq!(text(&wished, "history.csv"), text(&again, "history.csv"));
    assert!(!text(&again, "plan.toml").contains("[forecast]"));
    done(&[&wish[..], &["--steps", "64", "--checkpoint-every", "64", "--out"]].concat(), &halves);
    let half = text(&halves, "history.csv");
    done(&["refine", halves.to_str().unwrap(), "--times", "2", "--out"], &fine);
    done(&["resume", "--steps", "128"], &halves);
    assert!(half.len() < text(&halves, "history.csv").len(), "there were rows to come");
    assert_eq!(text(&wished, "history.csv"), text(&halves, "history.csv"));
    done(&["resume", "--steps", "96"], &fine);
    assert!(text(&fine, "scene.toml").contains("particles = 6000"), "{}", text(&fine, "scene.toml"));
}

/// A bench prints its tables, and its JSON has the same runs with all their phases.
#[test]
fn a_bench_measures_each_scene_and_method() {
    let folder = tempfile::tempdir().unwrap();
    let json = folder.path().join("bench.json");
    let path = json.to_str().unwrap();
    let text = printed(&[
        "bench",
        "--scene",
        "box,tank",
        "--particles",
        "2e3",
        "--steps",
        "32",
        "--methods",
        "closest-approach,cell,none",
        "--json",
        path,
    ]);
    for part in ["GB/s", "of the copy", "of the arithmetic", "of the target", "32 steps after 32"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    // The tests' device is the CPU.
    assert!(text.contains("host: not measurable: the device is the CPU"), "{text}");
    // At the end a line for each run, whose last column is the ratio to its target.
    let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
    let methods = ["closest-approach", "cell", "none"];
    let all: Vec<_> = ["box", "tank"].iter().flat_map(|&scene| methods.map(|method| (scene, method))).collect();
    for (line, &(scene, method)) in lines[lines.len() - all.len()..].iter().zip(&all) {
        assert_eq!(line[..2], [scene, method], "{text}");
        let numbers: [f64; 5] = std::array::from_fn(|k| line[line.len() - 5 + k].parse().unwrap());
        let [collisions, at_ceilings, rate, target, ratio] = numbers;
        assert_eq!(collisions > 0.0, method != "none", "{text}");
        assert!(at_ceilings > 0.0, "{text}");
        assert!(rate > 0.0 && (ratio - rate / target).abs() < 0.01 / target + 0.001, "{text}");
    }
    let value: serde_json::Value = serde_json::from_str(&fs::read_to_string(&json).unwrap()).unwrap();
    assert!(value["copy_bytes_per_second"].as_f64().unwrap() > 0.0);
    let runs = value["runs"].as_array().unwrap();
    let names: Vec<_> = runs.iter().map(|run| (run["scene"].as_str(), run["method"].as_str())).collect();
    assert_eq!(names, all.iter().map(|&(scene, method)| (Some(scene), Some(method))).collect::<Vec<_>>());
    for run in runs {
        let phases = run["phases"].as_array().unwrap();
        for (phase, method) in [("collide", "cell"), ("lost", "closest-approach")] {
            assert_eq!(phases.iter().any(|own| own["phase"] == phase), run["method"] == method, "{phase}: {phases:?}");
        }
        let number = |of: &serde_json::Value, key: &str| of[key].as_f64().unwrap();
        let least = |phase: &serde_json::Value| {
            number(phase, "device_seconds") * number(phase, "share_of_copy").max(number(phase, "share_of_arithmetic"))
        };
        // (A phase that moves nothing has no share.)
        let seconds: f64 = phases.iter().filter(|phase| phase["share_of_copy"].is_number()).map(least).sum();
        let at_ceilings = number(run, "particle_steps") / seconds;
        let told = number(run, "particle_steps_per_second_at_ceilings");
        assert!((told / at_ceilings - 1.0).abs() < 1e-9, "{told} {at_ceilings}");
        // Every phase is counted, as often as it is in one interval.
        let counts = ["bytes", "floating_operations", "integer_operations", "share_of_copy", "share_of_arithmetic"];
        assert!(phases.iter().all(|phase| counts.iter().all(|&count| phase[count].is_number())), "{phases:#?}");
        for phase in phases {
            let times = match phase["phase"].as_str().unwrap() {
                "lost" | "blocks" => 1,
                "tally" => 4,
                // In each of two rounds.
                "choose" | "settle" => 64,
                _ => 32,
            };
            assert_eq!(phase["dispatches"], times, "{phase:#?}");
        }
        assert!(run["host_cores"].is_null() && run["steps"] == 32 && run["steps_before"] == 32, "{run:#?}");
    }
    for (key, of_text) in
        [("date", true), ("build", true), ("sources", true), ("version", true), ("cpu_threads", false)]
    {
        assert!(if of_text { value[key].is_string() } else { value[key].is_u64() }, "{key}");
    }
    assert!(value.get("cpu").is_some() && value.get("commit").is_some() && value.get("lp_num_threads").is_some());
    for (arguments, part) in [
        (&["bench", "--scene", "sphere"][..], "sphere"),
        (&["bench", "--methods", "control-volume"][..], "no steps of particles"),
        (&["bench", "--particles", "1.5"][..], "1.5"),
    ] {
        let (code, _, err) = outcome(arguments);
        assert!(code == 2 && err.contains(part), "{arguments:?}: {err}");
    }
}
