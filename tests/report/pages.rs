//! What stands in the file of a page.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde_json::Value;

use super::{bag, reported, run, scene, short_run};

/// The file without the script of another's that draws the charts.
fn own_part(path: &Path) -> String {
    let html = fs::read_to_string(path).unwrap();
    match html.split_once("plotly.js v") {
        None => html,
        Some((before, rest)) => {
            let (script, after) = rest.split_once("</script>").unwrap();
            assert!(script.len() > 1_000_000);
            format!("{before}{after}")
        }
    }
}

fn data(path: &Path) -> Value {
    let html = own_part(path);
    let (_, rest) = html.split_once("<script type=\"application/json\" id=\"data\">").unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

/// What a browser would load from elsewhere.
fn foreign(html: &str) -> Vec<String> {
    let named = ["src=\"", "href=\"", "url(", "@import", "http:", "https:", "fetch("];
    let found = named.iter().flat_map(|mark| html.split(mark).skip(1).map(move |rest| (mark, rest)));
    let here = |rest: &str| ["#", "data:"].iter().any(|start| rest.starts_with(start));
    found
        .filter(|(_, rest)| !here(rest))
        .map(|(mark, rest)| format!("{mark}{}", rest.chars().take(40).collect::<String>()))
        .collect()
}

#[test]
fn a_page_is_whole_and_loads_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let run = short_run(&folder.path().join("run"), &["--report", "--subdomains", "2"]);
    let path = run.join("report.html");
    let html = own_part(&path);
    assert_eq!(foreign(&html), [""; 0]);
    assert!(html.contains("default-src 'none'"));
    assert!(fs::metadata(&path).unwrap().len() < 8_000_000);
    // The check can fail.
    assert_eq!(foreign("<img src=\"https://a.b/c\"><a href=\"#x\">").len(), 2);
    // Stopped after 64 steps: no audit.
    for words in [
        "has not reached its end",
        "What was modelled, and why",
        "Phases of the step",
        "Balance of the ranks",
        "aria-label",
    ] {
        assert!(html.contains(words), "{words}");
    }
    let picture = html.split("Particles by the rank that owns them").count();
    assert!(picture > 1, "no picture of the subdomains");
}

/// Each column of the history is on the page, and in a chart that can be switched; the time is the axis of all.
#[test]
fn every_column_is_a_curve() {
    let folder = tempfile::tempdir().unwrap();
    let run = short_run(&folder.path().join("run"), &[]);
    let data = data(&reported(&[run.to_str().unwrap()]));
    let history = fs::read_to_string(run.join("history.csv")).unwrap();
    let heads: BTreeSet<&str> = history.lines().next().unwrap().split(',').collect();
    let packed = data["series"][0]["columns"].as_array().unwrap();
    let on_page: BTreeSet<&str> = packed.iter().map(|column| column["head"].as_str().unwrap()).collect();
    assert_eq!(on_page, heads);
    let figures = data["figures"].as_array().unwrap();
    let curves = || figures.iter().flat_map(|figure| figure["curves"].as_array().unwrap());
    let drawn: BTreeSet<&str> = curves()
        .filter(|curve| curve["series"] == 0)
        .map(|curve| packed[curve["column"].as_u64().unwrap() as usize]["head"].as_str().unwrap())
        .collect();
    let expected: BTreeSet<&str> = heads.into_iter().filter(|head| *head != "time_s").collect();
    assert_eq!(drawn, expected);
    let html = own_part(&run.join("report.html"));
    assert_eq!(html.matches("data-curve=").count(), curves().count());
    // One for the state at the start, and what `--steps` has stopped at.
    assert_eq!(data["view"]["frames"].as_array().unwrap().len(), 2);
    assert_eq!(data["view"]["walls"][0]["name"], "box");
}

/// The fabric of each snapshot is on the page, where it was then.
#[test]
fn fabric_is_in_every_frame() {
    let folder = tempfile::tempdir().unwrap();
    let path = bag(folder.path()).join("report.html");
    let data = data(&path);
    let frames = data["view"]["frames"].as_array().unwrap();
    let meshes: Vec<&Value> = frames.iter().map(|frame| &frame["fabric"][0]).collect();
    assert!(frames.len() == 6 && meshes.iter().all(|mesh| mesh["name"] == "bag"));
    assert!(meshes.windows(2).all(|pair| pair[0]["vertices"] != pair[1]["vertices"]), "it is squeezed");
    assert!(meshes.windows(2).all(|pair| pair[0]["triangles"] == pair[1]["triangles"]));
    let html = own_part(&path);
    assert!(html.contains("<legend>Walls, fabric</legend>") && !html.contains("drawn coarser"));
    // One that is cut off leaves its snapshot out, and the page says so.
    let fabric = folder.path().join("bag/snapshots/fabric_000002.vtp");
    let bytes = fs::read(&fabric).unwrap();
    fs::write(&fabric, &bytes[..bytes.len() / 2]).unwrap();
    let html = own_part(&reported(&[folder.path().join("bag").to_str().unwrap()]));
    assert!(html.contains("left out: ") && html.contains("fabric_000002.vtp"));
}

/// A box of air at rest in kg, mm, ms.
const IN_MM: &str = r#"
units = "kg-mm-ms"
end_time = 1.0
[[gas]]
name = "air"
molar_mass = 0.02897
gamma = 1.4
[[wall]]
name = "box"
shape = "box"
min = [0.0, 0.0, 0.0]
max = [100.0, 100.0, 100.0]
gas = "inside"
[[chamber]]
name = "box"
pressure = 1.01325e-4
temperature = 293.0
gas = "air"
[model]
method = "control-volume"
"#;

#[test]
fn a_page_has_the_units_of_its_scene() {
    let folder = tempfile::tempdir().unwrap();
    let si = scene(folder.path(), "box.toml", "2e-3", &[("occupancy = 0.1", "method = \"control-volume\"")]);
    let mm = folder.path().join("mm.toml");
    fs::write(&mm, IN_MM).unwrap();
    let titles = |scene: &Path, out: &str| {
        let path = run(scene, &folder.path().join(out), &["--report"]).join("report.html");
        let data = data(&path);
        let title = data["figures"][0]["title"].as_str().unwrap().to_owned();
        (data["time"].as_str().unwrap().to_owned(), title, data["figures"][0]["alt"].as_str().unwrap().to_owned())
    };
    let (time, title, alt) = titles(&si, "a");
    assert!(time == "s" && title == "Pressure, Pa" && alt.contains(" 1.0132e5"), "{time} {title} {alt}");
    let (time, title, alt) = titles(&mm, "b");
    assert!(time == "ms" && title == "Pressure, GPa" && alt.contains(" 1.0132e-4"), "{time} {title} {alt}");
}

/// A wished accuracy has a forecast; a run to its end has a verdict.
#[test]
fn a_page_says_what_the_run_is_worth() {
    let folder = tempfile::tempdir().unwrap();
    let scene =
        scene(folder.path(), "vent.toml", "1e-3", &[("particles = 20000", "particles = 20000\naccuracy = 0.2")]);
    let text = fs::read_to_string(&scene).unwrap().replace("particles = 20000\n", "");
    fs::write(&scene, text).unwrap();
    let run = run(&scene, &folder.path().join("run"), &["--report"]);
    let html = own_part(&run.join("report.html"));
    assert!(html.contains("Predicted before the run"), "no forecast");
    assert!(html.contains("The audit is clean"), "no verdict");
    assert!(fs::read_to_string(run.join("audit.txt")).unwrap().contains("verdict: the account closes"));
    assert!(html.contains("as its law asks") && html.contains("Mass flow, kg/s"));
    // An audit that failed is told as such.
    let audit = fs::read_to_string(run.join("audit.txt")).unwrap();
    let failed = audit.replace("verdict: the account closes", "failed: the mass is off by 2e-3 of it; 1e-6 is allowed");
    fs::write(run.join("audit.txt"), failed).unwrap();
    let html = own_part(&reported(&[run.to_str().unwrap()]));
    assert!(html.contains("The audit failed") && html.contains("the mass is off by 2e-3"));
}

#[test]
fn runs_lie_side_by_side_with_what_differs() {
    let folder = tempfile::tempdir().unwrap();
    let one = short_run(&folder.path().join("one"), &[]);
    let other = short_run(&folder.path().join("other"), &["--seed", "7"]);
    let out = folder.path().join("both.html");
    let [one, other] = [&one, &other].map(|path| path.to_str().unwrap());
    let path = reported(&[one, other, "--out", out.to_str().unwrap()]);
    let html = own_part(&path);
    assert_eq!(foreign(&html), [""; 0]);
    for words in
        ["Comparison of 2 runs", "<th scope=\"row\">seed</th><td>1</td><td>7</td>", "Differences of curves", "Costs"]
    {
        assert!(html.contains(words), "{words}");
    }
    assert!(!html.contains("<th scope=\"row\">title</th>"), "what is the same is no difference");
    let data = data(&path);
    assert_eq!(data["series"].as_array().unwrap().len(), 2);
    let labels: Vec<&str> =
        data["figures"][0]["curves"].as_array().unwrap().iter().map(|curve| curve["label"].as_str().unwrap()).collect();
    assert!(labels.len() == 3 && labels[0].starts_with("1: ") && labels[1].starts_with("2: "), "{labels:?}");
}

/// The folder of several seeds is a comparison of them.
#[test]
fn seeds_are_compared() {
    let folder = tempfile::tempdir().unwrap();
    for seed in ["10", "9"] {
        short_run(&folder.path().join(format!("seed-{seed}")), &["--seed", seed]);
    }
    let path = reported(&[folder.path().to_str().unwrap()]);
    assert_eq!(path, folder.path().join("report.html"));
    let data = data(&path);
    let names: Vec<&str> = data["series"].as_array().unwrap().iter().map(|one| one["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["seed-9", "seed-10"]);
}

/// A study has its table, its text and its charts.
#[test]
fn a_study_has_a_page() {
    for (name, title) in [
        ("sweep", "Sweep over counts"),
        ("pareto", "Error against device time"),
        ("stability", "Where the methods fail"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let write = |ending: &str, text: &str| fs::write(folder.path().join(format!("{name}.{ending}")), text).unwrap();
        write("csv", "setting,error\n\"cell, <8>\",0.5\nnone,0.25\n");
        let path = reported(&[folder.path().to_str().unwrap()]);
        let html = own_part(&path);
        assert!(html.contains(title) && html.contains("<th scope=\"row\">cell, &lt;8&gt;</th><td>0.5</td>"), "{name}");
        assert!(html.contains("has not reached its end") && !html.contains("<img"), "{name}");
        write("txt", "a table");
        write("svg", "<svg xmlns='http://www.w3.org/2000/svg'/>");
        let html = own_part(&reported(&[folder.path().to_str().unwrap()]));
        assert!(html.contains("a table") && html.contains("<img alt=") && foreign(&html).is_empty(), "{name}");
        assert!(html.len() < 100_000, "no chart is drawn by scripts");
    }
}
