//! Pressures outside of vents, and vents that miss their mesh.

use std::path::Path;

use super::mistakes::model;
use super::outcome;
use super::plausible::{TANK, cube};

const OPENING: &str = "opening_pressure = 150000.0";

fn notes(lines: &[[&str; 2]]) -> Vec<String> {
    let text = lines.iter().fold(TANK.to_string(), |text, [found, wanted]| {
        assert!(text.contains(found), "{found}");
        text.replacen(found, wanted, 1)
    });
    let mut notes = model(&text).notes();
    notes.retain(|note| !note.contains("probably stays shut"));
    notes
}

/// An outside of 0, meant as gauge, opens a vent at once; so does a chamber of high pressure, of which nobody is asked.
#[test]
fn a_vent_that_is_open_from_the_start_is_told() {
    let [gauge] = &notes(&[[OPENING, "opening_pressure = 50000.0\nexternal_pressure = 0.0"]])[..] else { panic!() };
    for words in [
        "vent `vent`: it is open from the start: chamber `tank` has 101325 Pa, 101325 Pa more than outside",
        "it opens at 50000 Pa more. Is `external_pressure` gauge? It is absolute (line",
    ] {
        assert!(gauge.contains(words), "{gauge}");
    }
    let [full] = &notes(&[["pressure = 101325.0\n", "pressure = 3e5\n"]])[..] else { panic!() };
    assert!(full.contains("it is open from the start") && !full.contains("gauge"), "{full}");
    assert_eq!(notes(&[]), [""; 0]);
    assert_eq!(notes(&[[OPENING, "external_pressure = 0.0"]]), [""; 0]);
}

#[test]
fn unlike_pressures_outside_of_one_chamber_are_told() {
    let other = |outside: &str| {
        let vent = format!("[[vent]]\nname = \"fabric\"\nwall = \"tank\"\ndischarge = 0.01\n{outside}\n[model]");
        notes(&[["[model]", &vent]])
    };
    let [note] = &other("external_pressure = 0.0")[..] else { panic!() };
    let words = "vents `vent` and `fabric` of chamber `tank`: outside of one are 101325 Pa, outside of the other 0 Pa";
    assert!(note.starts_with(words) && note.contains("(line "), "{note}");
    assert_eq!(other("external_pressure = 101325.0"), [""; 0]);
}

/// A mesh in mm without its scale: what misses it is refused with the suspicion.
#[test]
fn a_vent_or_an_orifice_that_misses_a_mesh_is_told_with_its_scale() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("box.obj"), cube(380.0)).unwrap();
    let vent =
        "[[vent]]\nname = \"v\"\nwall = \"m\"\nposition = [0.38, 0.19, 0.19]\ndiameter = 0.05\ndischarge = 0.7\n";
    let orifice = "[[orifice]]\nname = \"o\"\nposition = [0.38, 0.19, 0.19]\ndirection = [-1, 0, 0]\narea = 1e-4\ngas = \"air\"\n\
        temperature = 300\nmass_flow = [[0, 1e-3], [1e-3, 1e-3]]\n";
    // The orifice lies on a wall whose inside is on the other side.
    let outside = orifice.replace("[0.38, 0.19, 0.19]", "[-0.01, 0.19, 0.19]");
    for (more, fits) in [(vent, true), (outside.as_str(), false)] {
        let scene = |scale: &str| {
            let path = folder.path().join("box.toml");
            let text = format!(
                "end_time = 1e-3\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n[[wall]]\nname = \"m\"\nshape = \"mesh\"\n\
                 file = \"box.obj\"\ngas = \"inside\"\n{scale}[[chamber]]\nname = \"c\"\npressure = 101325\ntemperature = 300\n\
                 gas = \"air\"\n{more}[model]\nparticles = 2000\n"
            );
            std::fs::write(&path, text).unwrap();
            outcome(&["check", path.to_str().unwrap()])
        };
        let (code, _, err) = scene("");
        assert_eq!(code, 2, "{err}");
        assert!(err.contains("wall `m`: longest side 380 m") && err.contains("then `scale = 0.001` (line 6)"), "{err}");
        assert!(!err.contains("belongs to a box"), "{err}");
        let (code, _, err) = scene("scale = 0.001\n");
        assert!(!err.contains("longest side") && (code == 0) == fits, "{err}");
    }
}

/// Scene of a filled bag: all gas together has 4.56 bar, and what it loses through its fabric leaves about 3 bar.
const BAG: &str = include_str!("../../scenes/vent.toml");
const LATE: &str = "opening_pressure = 20000.0";
const DISCHARGE: &str = "discharge = 0.7";
const LEAK: &str = "[[0.0, 0.0], [100000.0, 0.8]]";

/// What stands in a scene, and what is written instead.
type Lines<'a> = &'a [[&'a str; 2]];

fn notes_of(text: &str, lines: Lines<'_>) -> Vec<String> {
    let changed = lines.iter().fold(text.to_string(), |text, [found, wanted]| {
        assert!(text.contains(found), "{found}");
        text.replacen(found, wanted, 1)
    });
    model(&changed).notes()
}

#[test]
fn a_pressure_of_opening_that_looks_absolute_is_told() {
    let slips: &[(&str, Lines<'_>, &[&str])] = &[
        // An atmosphere and a round number.
        (
            BAG,
            &[[LATE, "opening_pressure = 121325.0"]],
            &["opening_pressure 121325 Pa is the outside and 20000 Pa more: is it absolute?", "(line 61)"],
        ),
        (BAG, &[[LATE, "opening_pressure = 101325.0"]], &["101325 Pa is the outside: is it absolute?"]),
        // All gas together would open it, but not with what is lost.
        (
            BAG,
            &[[LATE, "opening_pressure = 250000.0"]],
            &[
                "it opens at 351325 Pa absolute, and with what walls and vents take its chamber has at most ",
                "as a control volume: it probably stays shut. `opening_pressure` is above the outside: is it absolute?",
            ],
        ),
        // Nothing opens it, but 1.1 bar absolute would have been reached.
        (
            TANK,
            &[
                [OPENING, "opening_pressure = 110000.0"],
                ["mass_flow = [[0.0, 0.0], [0.002, 1.0]", "mass_flow = [[0.0, 0.0], [0.002, 2.0]"],
            ],
            &["it probably stays shut. `opening_pressure` is above the outside: is it absolute?"],
        ),
    ];
    for (text, lines, words) in slips {
        let told = notes_of(text, lines);
        assert!(told.iter().any(|note| words.iter().all(|word| note.contains(word))), "{words:?} in {told:#?}");
    }
    let meant: &[Lines<'_>] = &[
        &[],
        &[[LATE, "opening_pressure = 150000.0"]],
        &[[LATE, "opening_pressure_absolute = 121325.0"]],
        &[[LATE, "opening_pressure_absolute = 202650.0"]],
        &[[LATE, "opening_pressure = 1e5\nexternal_pressure = 1e5"]],
    ];
    for lines in meant {
        let told = notes_of(BAG, lines);
        assert!(told.iter().all(|note| !note.contains("absolute?")), "{lines:?}: {told:?}");
    }
}

/// Columns that are swapped, pressures in another unit, more area than wall, nothing at all.
#[test]
fn curves_and_areas_that_no_vent_has_are_told() {
    let can = include_str!("inputs/plausible/can.toml");
    let slips: &[(&str, [&str; 2], &[&str])] = &[
        (
            can,
            [DISCHARGE, "discharge_by_pressure = [[0.3, 0], [0.5, 1e-4], [0.7, 3e-4]]"],
            &["coefficients of at most 0.0003 at pressures up to 0.7 GPa", "are its columns swapped?", "(line 46)"],
        ),
        (
            BAG,
            [DISCHARGE, "discharge_by_pressure = [[0, 0.3], [100, 0.5], [200, 0.7]]"],
            &["discharge_by_pressure ends at 200 Pa", "are its pressures in kPa? This scene has Pa"],
        ),
        (BAG, [LEAK, "[[0.0, 0.0], [100.0, 0.8]]"], &["leak_velocity ends at 100 Pa", "in kPa?"]),
        (
            BAG,
            ["area = 0.0012", "area = 0.1"],
            &["vent `vent`: its area 0.1 is more than the 0.007854 m2 of its disc: is it an area"],
        ),
        (BAG, [DISCHARGE, "discharge = 0"], &["is 0 throughout: nothing passes it"]),
    ];
    for (text, line, words) in slips {
        let told = notes_of(text, &[*line]);
        assert!(told.iter().any(|note| words.iter().all(|word| note.contains(word))), "{words:?} in {told:#?}");
    }
    let swapped = BAG.replace(DISCHARGE, "discharge_by_pressure = [[0.3, 0], [0.7, 2e5]]");
    let told = model(&swapped).plan.told();
    assert!(
        told.iter().any(|text| text.contains("[pressure above the outside, coefficient], are its columns swapped?"))
    );
    let silent: &[(&str, [&str; 2])] = &[
        (can, [DISCHARGE, "discharge_by_pressure = [[0, 0.02], [1e-4, 0.04], [1e-3, 0.05]]"]),
        (BAG, [DISCHARGE, "discharge_by_pressure = [[0, 0.3], [1e5, 0.5], [1e6, 0.7]]"]),
        (BAG, [DISCHARGE, "discharge = [[0, 0], [0.01, 0.7]]"]),
        // All of it at once.
        (BAG, [LEAK, "[[0.0, 0.0], [1.0, 0.8]]"]),
        (BAG, [LEAK, "[[0.0, 0.0], [5000.0, 0.2], [100000.0, 0.8]]"]),
        (BAG, ["area = 0.0012", "area = 0.0078"]),
    ];
    for (text, line) in silent {
        assert_eq!(notes_of(text, &[*line]), [""; 0], "{line:?}");
    }
}

/// A vent in a plate between two chambers, and in a thin body; not one on the vessel, nor on a body that is thick.
#[test]
fn a_vent_with_gas_behind_it_is_told() {
    let piston = include_str!("inputs/walls/piston.toml");
    let on = |wall: &str, place: &str| {
        let vent = format!("[[vent]]\nname = \"v\"\nwall = \"{wall}\"\ndischarge = 0.7\n{place}\n[model]");
        let mut told = notes_of(piston, &[["[model]", &vent]]);
        told.retain(|note| note.contains("leaves the model"));
        told
    };
    let [note] = &on("plate", "face = \"front\"\nposition = [102, 0, 18]\ndiameter = 8")[..] else { panic!() };
    let words = "vent `v`: behind wall `plate` is the gas of chamber `left`, and what passes a vent leaves the model";
    assert!(note.starts_with(words) && note.contains("[[wall.hole]]") && note.ends_with("(line 56)"), "{note}");
    assert_eq!(on("duct", "face = \"+x\""), [""; 0]);
    let body = |thickness: f64| {
        let body = format!(
            "[[wall]]\nname = \"body\"\nshape = \"box\"\nmin = [0.1, 0.1, 0.1]\nmax = [0.2, 0.2, {}]\ngas = \"outside\"\n[[chamber]]",
            0.1 + thickness
        );
        let vent = "[[vent]]\nname = \"v\"\nwall = \"body\"\nface = \"+z\"\ndischarge = 0.7\n[model]";
        let mut told = notes_of(TANK, &[["[[chamber]]", &body], ["[model]", vent]]);
        told.retain(|note| note.contains("leaves the model"));
        told.len()
    };
    assert_eq!([0.005, 0.08].map(body), [1, 0]);
}

/// What a run says of its vents is in the scene's unit, also where it went on from a checkpoint, whose scene is in SI.
#[test]
fn a_vent_that_stays_shut_is_told_in_the_scenes_unit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("can.toml");
    let short = include_str!("inputs/plausible/can.toml").replace("end_time = 60.0", "end_time = 0.2");
    std::fs::write(&path, short.replace("particles = 4000", "particles = 1500")).unwrap();
    let audit = |name: &str, first: &[&str]| {
        let out = folder.path().join(name);
        let out = out.to_str().unwrap();
        let (code, _, err) = outcome(&[&["run", path.to_str().unwrap(), "--out", out], first].concat());
        assert_eq!(code, 0, "{err}");
        if !first.is_empty() {
            let (code, _, err) = outcome(&["resume", out]);
            assert_eq!(code, 0, "{err}");
        }
        std::fs::read_to_string(Path::new(out).join("audit.txt")).unwrap()
    };
    let whole = audit("whole", &[]);
    let words = "vent `burst disc` did not open: it opens at 0.0002513 GPa (2.513 bar) absolute, and its chamber had ";
    assert!(whole.contains(words), "{whole}");
    assert_eq!(audit("resumed", &["--checkpoint-every", "1000000", "--steps", "20"]), whole);
}
