//! Gas in scenes that once gave wrong numbers: mixtures, vents, small differences of pressure, many orifices.

use std::fs;
use std::path::Path;

use super::{input, outcome};

/// Runs a scene into a folder, which must end well.
fn run(scene: &Path, folder: &Path, more: &[&str]) -> String {
    let mut arguments = vec!["run", scene.to_str().unwrap(), "--out", folder.to_str().unwrap()];
    arguments.extend(more);
    let (code, out, error) = outcome(&arguments);
    assert_eq!(code, 0, "{out}{error}");
    fs::read_to_string(folder.join("audit.txt")).unwrap()
}

/// The last number of the line of the audit that begins so.
fn last_of(audit: &str, line: &str) -> f64 {
    let found = audit.lines().find(|text| text.starts_with(line)).unwrap_or_else(|| panic!("no {line} in {audit}"));
    found.split_whitespace().next_back().unwrap().parse().unwrap()
}

/// Helium and argon at rest keep their energy, by both methods and in cells: 2 ms, in which a share of either mass that was
/// rounded in every collision alike had made 1e-5 and more of it.
#[test]
fn helium_and_argon_keep_their_energy() {
    let folder = tempfile::tempdir().unwrap();
    let scene = fs::read_to_string(input("he_ar_drift/he_ar.toml")).unwrap();
    for method in ["closest-approach", "cell"] {
        let file = folder.path().join(format!("{method}.toml"));
        let of_method = format!("[model]\nmethod = \"{method}\"\n");
        let text = scene.replace("end_time = 0.02", "end_time = 0.002").replace("[model]\n", &of_method);
        fs::write(&file, text).unwrap();
        let audit = run(&file, &folder.path().join(method), &[]);
        let drift = last_of(&audit, "energy, J");
        assert!(drift.abs() < 3e-7, "{method}: {drift:e}");
    }
}

/// A vessel that is pumped until nobody is left passes its audit: the momentum is relative to what it held.
#[test]
fn a_vessel_pumped_empty_passes_its_audit() {
    let folder = tempfile::tempdir().unwrap();
    let audit = run(&input("pumped_empty/pumped.toml"), &folder.path().join("out"), &[]);
    let particles = audit.lines().find(|line| line.starts_with("particles")).unwrap();
    assert_eq!(particles.split_whitespace().skip(1).collect::<Vec<_>>(), ["1,500", "0", "1,500", "0", "0"]);
    assert!(last_of(&audit, "  error") < 1e-6);
}

/// 24 nozzles, of which each brings .69 of a particle, bring 19 mg together within half a particle.
#[test]
fn many_small_orifices_bring_their_sum() {
    let (code, plan, error) = outcome(&["plan", input("many_orifices/nozzles.toml").to_str().unwrap(), "--toml"]);
    assert_eq!(code, 0, "{error}");
    let plan: toml::Table = plan.parse().unwrap();
    let particle = plan["moles_per_particle"].as_float().unwrap() * 0.0280134;
    let injected = plan["injected_particles"].as_integer().unwrap() as f64 * particle;
    assert!((injected - 19e-6).abs() <= 0.5 * particle, "{injected} of {particle} each");
}

/// The mean of a chamber's column is that of `time_s`: of what leaves through a vent in a window, at an even rate, half has left
/// in it. Tallies four steps late had .625 of windows of 32 steps.
#[test]
fn a_chamber_is_counted_about_the_middle_of_its_window() {
    let folder = tempfile::tempdir().unwrap();
    let scene = fs::read_to_string(input("held/vacuum.toml")).unwrap();
    let file = folder.path().join("short.toml");
    fs::write(&file, scene.replace("end_time = 0.012", "end_time = 0.0012").replace("rows = 120", "rows = 12"))
        .unwrap();
    run(&file, &folder.path().join("out"), &[]);
    let mut history = csv::Reader::from_path(folder.path().join("out/history.csv")).unwrap();
    let names = history.headers().unwrap().clone();
    let place = |name: &str| names.iter().position(|known| known == name).unwrap();
    let (all, inside) = (place("particles"), place("box:particles:n2"));
    let (mut before, mut missed, mut left) = (8000.0, 0.0, 0.0);
    for row in history.records() {
        let row = row.unwrap();
        let number = |column: usize| row[column].parse::<f64>().unwrap();
        missed += before - number(inside);
        left += before - number(all);
        before = number(all);
    }
    // Each that left is missing for a part of its window that is uniform, and seen by four tallies: sd .3 / sqrt(n).
    let share: f64 = missed / left;
    assert!(left > 500.0 && (share - 0.5).abs() < 4.0 * 0.3 / left.sqrt(), "{share} of {left}");
    assert!(0.125 > 4.0 * 0.3 / left.sqrt(), "the check can fail");
}

const TANK: &str = include_str!("inputs/plausible/tank.toml");

fn notes_of(lines: &[[&str; 2]]) -> Vec<String> {
    let text = lines.iter().fold(TANK.to_string(), |text, [found, wanted]| {
        assert!(text.contains(found), "{found}");
        text.replacen(found, wanted, 1)
    });
    // Gases of many internal degrees of freedom ask for it.
    let text = text.replace("particles = 2000", "particles = 2000\ncollision_number = 20");
    let mut notes = super::mistakes::model(&text).notes();
    notes.retain(|note| note.starts_with("gas ") || note.starts_with("orifice "));
    notes
}

const AIR: &str = "name = \"air\"\nmolar_mass = 0.02897\ngamma = 1.4";
const HELIUM: &str = "molar_mass = 0.0040026\ngamma = 1.6667";
const FLOW: &str = "[[0.0, 0.0], [0.002, 1.0], [0.004, 0.5]]";

/// By its name, or by its molar mass where the name says nothing.
#[test]
fn a_gas_that_is_not_what_it_is_called_is_told() {
    for (line, words) in [
        (
            [HELIUM, "molar_mass = 0.0040026\ngamma = 1.4"],
            &["gas `helium`: cp 29.1", "gamma 1.40, where helium has cp 20.79, gamma 1.67", "(line 7)"][..],
        ),
        ([HELIUM, "molar_mass = 0.002\ngamma = 1.6667"], &["molar_mass 0.002 kg/mol, where helium has 0.004003"]),
        ([AIR, "name = \"air\"\nmolar_mass = 0.02897\ncp = 20.8"], &["where air has cp 29.1", "is cv given for cp"]),
        ([AIR, "name = \"air\"\nmolar_mass = 0.02897\ncv = 29.1"], &["cp 37.41", "is cp given for cv"]),
        ([AIR, "name = \"air\"\nmolar_mass = 0.02897\ngamma = 1.667"], &["where air has", "the gamma of another gas?"]),
        (
            [AIR, "name = \"g\"\nmolar_mass = 0.04401\ngamma = 1.4"],
            &["where carbon dioxide, of that molar mass, has cp 37.2, gamma 1.29"],
        ),
        (
            [AIR, "name = \"SF6\"\nmolar_mass = 0.14606\ngamma = 1.4"],
            &["where sulphur hexafluoride has cp 97, gamma 1.09"],
        ),
    ] {
        // The name stands in mixtures, too.
        let name = line[1].split('"').nth(1).unwrap_or("air");
        let [chamber, mixture] = [format!("gas = \"{name}\""), format!("{{ {name} = 0.6")];
        let told = notes_of(&[line, ["gas = \"air\"", &chamber], ["{ air = 0.6", &mixture]]);
        assert!(told.iter().any(|note| words.iter().all(|word| note.contains(word))), "{words:?} in {told:?}");
    }
    for own in [
        "name = \"air\"\nmolar_mass = 0.029\ngamma = 1.38",
        "name = \"N2\"\nmolar_mass = 0.028\ncp = [26.92, 5.91e-3, -3.38e-7]",
        "name = \"O2\"\nmolar_mass = 0.032\ngamma = 1.395",
        "name = \"H2\"\nmolar_mass = 0.002\ngamma = 1.41",
        "name = \"CO\"\nmolar_mass = 0.028\ngamma = 1.4",
        "name = \"CO2\"\nmolar_mass = 0.044\ngamma = 1.29",
        "name = \"steam\"\nmolar_mass = 0.018\ngamma = 1.33",
        "name = \"NH3\"\nmolar_mass = 0.017\ngamma = 1.31",
        "name = \"CH4\"\nmolar_mass = 0.016\ngamma = 1.31",
        "name = \"SF6\"\nmolar_mass = 0.146\ngamma = 1.09",
        "name = \"Ar\"\nmolar_mass = 0.04\ngamma = 1.67",
        // Of its mass, but a gas of a model; and the gas of a generator.
        "name = \"spheres\"\nmolar_mass = 0.028\ngamma = 1.6666667",
        "name = \"generator\"\nmolar_mass = 0.0265\ngamma = 1.27",
    ] {
        let name = own.split('"').nth(1).unwrap_or("air");
        let [chamber, mixture] = [format!("gas = \"{name}\""), format!("{{ {name} = 0.6")];
        let told = notes_of(&[[AIR, own], ["gas = \"air\"", &chamber], ["{ air = 0.6", &mixture]]);
        assert_eq!(told, [""; 0], "{own}");
    }
}

/// The mass that has come in so far, and one in another unit; a flow that rises and stays is none.
#[test]
fn a_mass_that_is_given_for_its_flow_is_told() {
    let so_far = "[[0, 0], [0.001, 0.2], [0.002, 0.8], [0.003, 1.0], [0.0035, 1.05], [0.004, 1.05]]";
    let [note] = &notes_of(&[[FLOW, so_far]])[..] else { panic!() };
    assert!(
        note.contains("never falls, and levels off at 1.05 kg/s: is it the mass that has come in so far?"),
        "{note}"
    );
    for (short, words) in [
        (
            "[[0, 0], [0.001, 0.002], [0.002, 0.0045], [0.003, 0.0063], [0.004, 0.0063]]",
            "levels off at 0.0063 kg/s: is it",
        ),
        ("[[0, 0], [0.002, 0.0063], [0.004, 0.0063]]", "levels off at 0.0063 kg/s: is it"),
        ("[[0, 0], [0.001, 0.002], [0.002, 0.0045], [0.003, 0.0063]]", "ends at 0.0063 kg/s: is it"),
        ("[[0, 0], [0.004, 0.0063]]", "ends at 0.0063 kg/s: is it"),
    ] {
        let [note] = &notes_of(&[[FLOW, short]])[..] else { panic!("{short}") };
        assert!(note.contains("its mass_flow never falls") && note.contains(words), "{note}");
    }
    let [note] = &notes_of(&[[FLOW, "[[0.0, 0.0], [0.002, 1e-3], [0.004, 5e-4]]"]])[..] else { panic!() };
    assert!(note.contains("% of the gas that is there: are `mass_flow` and its times in the units"), "{note}");
    for flow in [
        FLOW,
        "[[0, 0], [0.001, 0.5], [0.002, 1.0], [0.004, 1.0]]",
        "[[0, 1.0], [0.004, 1.0]]",
        // One that falls, one that goes on after the end, one that is steady, one that was never nothing.
        "[[0, 0], [0.002, 0.02], [0.004, 0.01]]",
        "[[0, 0], [0.002, 0.02], [0.008, 0.04]]",
        "[[0, 0.02], [0.004, 0.02]]",
        "[[0, 0.02], [0.004, 0.03]]",
    ] {
        assert_eq!(notes_of(&[[FLOW, flow]]), [""; 0], "{flow}");
    }
}

/// `check` says which chamber an orifice blows into, and how much.
#[test]
fn what_orifices_bring_is_said() {
    let (code, out, err) = outcome(&["check", input("plausible/can.toml").to_str().unwrap()]);
    assert_eq!(code, 0, "{err}");
    assert!(out.contains("inflator  can           0.06375 kg, 0.003 kg/ms           300 to 700 K"), "{out}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("short.toml");
    let short = fs::read_to_string(input("plausible/can.toml")).unwrap().replace("end_time = 60.0", "end_time = 5.0");
    fs::write(&path, short).unwrap();
    let (_, out, _) = outcome(&["check", path.to_str().unwrap()]);
    assert!(out.contains("inflator  can           0.0075 kg of 0.06375 kg, 0.003 kg/ms"), "{out}");
}
