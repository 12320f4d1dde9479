//! Orifices that no inflator has, and what `check` shows of them.

use super::{input, outcome};

const TANK: &str = include_str!("inputs/plausible/tank.toml");
const JET: &str = "jet = { mach = 1.0, cone_angle = 10.0 }";
const HOT: &str = "temperature = 700.0";

fn changed(lines: &[[&str; 2]]) -> String {
    lines.iter().fold(TANK.to_string(), |text, [found, wanted]| {
        assert!(text.contains(found), "{found}");
        text.replacen(found, wanted, 1)
    })
}

fn notes(lines: &[[&str; 2]]) -> Vec<String> {
    let mut notes = super::mistakes::model(&changed(lines)).notes();
    notes.retain(|note| note.starts_with("orifice"));
    notes
}

/// Gas that is colder than what it flows into, or than any; not gas as warm as the room, nor gas that only ends cold.
#[test]
fn cold_gas_of_an_inflator_is_told() {
    let cold_tank = ["temperature = 300.0\ngas", "temperature = 220.0\ngas"];
    for (lines, words) in [
        (
            &[[HOT, "temperature = 280.0"]][..],
            "its gas has 280 K, colder than the 300 K of chamber `tank`: is it in degrees Celsius? 280 C are 553.15 K (line 23)",
        ),
        (&[[HOT, "temperature = [[0, 200], [0.004, 280]]"]], "its gas has at most 280 K, colder than"),
        (&[[HOT, "temperature = 240.0"], cold_tank], "its gas has 240 K: is it in degrees Celsius? 240 C are 513.15 K"),
    ] {
        let told = notes(lines);
        assert!(told.len() == 1 && told[0].starts_with("orifice `inflator`: ") && told[0].contains(words), "{told:?}");
    }
    for temperature in ["temperature = 295.0", "temperature = [[0, 700], [0.004, 220]]"] {
        assert_eq!(notes(&[[HOT, temperature]]), [""; 0], "{temperature}");
    }
    assert_eq!(notes(&[[HOT, "temperature = 260.0"], cold_tank]), [""; 0]);
}

/// A Mach number that is given for a velocity: a note, and a warning where no jet is as slow.
#[test]
fn a_mach_number_for_a_velocity_is_told() {
    let jet = |velocity: &str| format!("jet = {{ velocity = {velocity}, cone_angle = 10.0 }}");
    let told = notes(&[[JET, &jet("1.5")]]);
    let words = "orifice `inflator`: its jet has a velocity of 1.5 m/s: is it a Mach number? That is `mach` (line 23)";
    assert_eq!(told, [words]);
    let doubts = super::mistakes::model(&changed(&[[JET, &jet("0.5")]])).plan.inventory.doubts;
    assert!(
        doubts
            .iter()
            .any(|doubt| doubt.contains("jet velocity 0.5 m/s, usual is 1 to 10000 m/s: is it a Mach number?"))
    );
    assert_eq!(notes(&[[JET, &jet("12.0")]]), [""; 0]);
}

/// A diameter that is given for an area: a choked jet would have less pressure than what it flows into.
#[test]
fn a_jet_without_pressure_is_told() {
    let told = notes(&[["area = 2e-4", "area = 0.016"]]);
    let words = "orifice `inflator`: 1 kg/s at Mach 1 through 0.016 m2 come from ";
    assert!(told.len() == 1 && told[0].starts_with(words), "{told:?}");
    assert!(
        told[0].contains("and chamber `tank` has 101325 Pa: is `area` a diameter") && told[0].ends_with("(line 23)")
    );
    // G/A sqrt(R T0/(gamma M)) (1 + (gamma-1)/2)^((gamma+1)/(2 (gamma-1))), gamma 1.4762, M 18.983 g/mol.
    let found: f64 = told[0][words.len()..].split(' ').next().unwrap().parse().unwrap();
    let expected = 1.0 / 0.016 * (8.314_463_f64 * 700.0 / (1.4762 * 0.018_983)).sqrt() * 1.742_45;
    assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
    for area in ["area = 2e-3", "area = 5e-3"] {
        assert_eq!(notes(&[["area = 2e-4", area]]), [""; 0], "{area}");
    }
    assert_eq!(notes(&[["area = 2e-4", "area = 0.016"], [JET, "jet = { mach = 0.5 }"]]), [""; 0]);
}

/// The species of an inflator, each with the flow of all; not if the flows, the places or the directions differ.
#[test]
fn a_flow_that_is_given_twice_is_told() {
    let twin = |position: &str, direction: &str, flow: &str| {
        let twin = format!(
            "[[orifice]]\nname = \"twin\"\nposition = [{position}]\ndirection = [{direction}]\narea = 2e-4\nmass_flow = {flow}\n\
             temperature = 700.0\ngas = \"helium\"\n[[probe]]"
        );
        notes(&[["[[probe]]", &twin]])
    };
    let [here, up, same] = ["0.2, 0.15, 0.0", "0, 0, 1", "[[0.0, 0.0], [0.002, 1.0], [0.004, 0.5]]"];
    let told = twin(here, up, same);
    let words = "orifices `inflator` and `twin`: they have one place and one mass_flow, and each brings all of it";
    assert!(told.len() == 1 && told[0].starts_with(words) && told[0].ends_with("(line 23)"), "{told:?}");
    assert_eq!(twin("0.25, 0.15, 0.0", up, same), [""; 0]);
    assert_eq!(twin(here, up, "[[0.0, 0.0], [0.002, 0.4], [0.004, 0.2]]"), [""; 0]);
}

/// The jet of an orifice by Mach number or velocity, with its cone; orifices without one have no column.
#[test]
fn check_shows_jets() {
    let (code, out, err) = outcome(&["check", input("plausible/tank.toml").to_str().unwrap()]);
    assert_eq!(code, 0, "{err}");
    let ends =
        |start: &str, end: &str| out.lines().any(|line| line.trim_start().starts_with(start) && line.ends_with(end));
    assert!(ends("orifice ", "  jet") && ends("inflator ", "  Mach 1, cone_angle 10 degrees"), "{out}");
    let render = |jet: &str| super::mistakes::model(&changed(&[[JET, jet]])).plan.inventory.render();
    let text = render("jet = { velocity = 300.0 }");
    assert!(text.contains("  300 m/s, cone_angle 0 degrees"), "{text}");
    let text = render("");
    assert!(!text.contains("jet"), "{text}");
}
