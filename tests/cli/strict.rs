//! `--strict`: what a plan or a run warns of is an error.

use std::fs;

use super::outcome;

/// A plan that warns is 2, before any device is opened; the plan itself is printed. Without warnings nothing changes.
#[test]
fn a_plan_that_warns_is_2_with_strict() {
    let few = ["scenes/box.toml", "--particles", "900"];
    let (code, out, err) = outcome(&[&["plan", "--strict"], &few[..]].concat());
    assert!(code == 2 && out.contains("warning: the run: particles 900, at least 1000"), "{code} {out}");
    assert!(err.contains("--strict, and the plan warns") && err.contains("particles 900, at least 1000"), "{err}");
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().join("out");
    let (code, _, err) =
        outcome(&[&["run", "--strict", "--gpu", "no such", "--out", to.to_str().unwrap()], &few[..]].concat());
    assert!(code == 2 && err.contains("the plan warns") && !err.contains("no such"), "{code} {err}");
    assert!(!to.exists());
    assert_eq!(outcome(&["plan", "--strict", "scenes/box.toml"]).0, 0);
}

/// Gas that flows into a thinner half, where a probe has few particles until then.
const FILLING: &str = r#"
    end_time = 0.0044
    gas = [{ name = "nitrogen", molar_mass = 0.028, gamma = 1.4 }]
    model = { particles = 3000, method = "closest-approach" }
    output = { rows = 1000, snapshots = 0 }
    wall = [{ name = "box", shape = "box", min = [0.0, 0.0, 0.0], max = [0.1, 0.1, 0.1], gas = "inside" }]
    probe = [{ name = "far", region = { box = { min = [0.06, 0.03, 0.032], max = [0.09, 0.07, 0.066] } } }]
    [[chamber]]
    name = "left"
    region = { box = { min = [0.0, 0.0, 0.0], max = [0.05, 0.1, 0.1] } }
    pressure = 1e5
    temperature = 300.0
    gas = "nitrogen"
    [[chamber]]
    name = "right"
    pressure = 5.5e4
    temperature = 300.0
    gas = "nitrogen"
"#;

/// A run that leaves a limit tells it once, with time and value, and goes on; with `--strict` it is 4, and what was written
/// until then stays. Both are the same on one subdomain and on two.
#[test]
fn a_run_that_warns_is_4_with_strict() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("filling.toml");
    fs::write(&scene, FILLING).unwrap();
    let run = |name: &str, more: &[&str]| {
        let out = folder.path().join(name);
        let basic = ["run", scene.to_str().unwrap(), "--steps", "128", "--out", out.to_str().unwrap()];
        let (code, text, err) = outcome(&[&basic, more].concat());
        (code, text, err, fs::read_to_string(out.join("history.csv")).unwrap())
    };
    let (code, text, err, whole) = run("lenient", &[]);
    assert_eq!(code, 0, "{err}");
    let told: Vec<&str> = text.lines().filter(|line| line.starts_with("warning at ")).collect();
    assert_eq!(told.len(), 1, "{text}");
    assert!(told[0].contains("ms: probe `far`: particles in it ") && told[0].contains(", at least 100: "), "{told:?}");
    assert!(err.contains("probe `far`"), "{err}");
    let two = run("two", &["--subdomains", "2"]);
    assert_eq!((two.0, &two.3), (0, &whole));
    assert!(two.1.contains(told[0]), "{} is not in {}", told[0], two.1);
    for more in [&["--strict"][..], &["--strict", "--subdomains", "2"]] {
        let (code, _, err, part) = run("strict", &[more, &["--force"]].concat());
        assert!(code == 4 && err.contains("--strict, and the run warns at "), "{code} {err}");
        assert!(whole.starts_with(&part) && part.lines().count() == 2 && whole.lines().count() > 2, "{part}\n{whole}");
    }
}
