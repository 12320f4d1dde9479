//! Pressures outside of vents, and vents that miss their mesh.

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
