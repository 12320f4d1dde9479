//! Inputs that can be read but cannot be meant: each is told with quantity, value and the likely unit.
//!
//! Each row changes one line of a scene that is as it should be, which has no such warning.

use std::path::Path;

use corpuscle::plan::doubts_of;
use corpuscle::scene::parse;
use corpuscle::simulation::Model;

use super::{input, outcome};

/// In SI, and in kg, mm, ms.
pub const TANK: &str = include_str!("inputs/plausible/tank.toml");
const CAN: &str = include_str!("inputs/plausible/can.toml");
/// A heat capacity per kilogram, with the collision number that it asks for.
const PER_KILOGRAM: &str = include_str!("inputs/plausible/per_kilogram.toml");

/// What a plan warns of that no vessel has, or the error in place of a plan.
fn doubts(text: &str, folder: &Path) -> Vec<String> {
    let scene = match parse(text, "scene.toml", folder) {
        Ok(scene) => scene,
        Err(error) => return vec![format!("{:?}", miette::Report::new(error))],
    };
    let known = doubts_of(&scene);
    match Model::new(scene) {
        Ok(model) => model.plan.inventory.doubts,
        Err(error) => [known, vec![format!("{:?}", miette::Report::new(error))]].concat(),
    }
}

struct Slip {
    scene: &'static str,
    /// What stands in the scene, and what the user wrote.
    line: [&'static str; 2],
    /// All of them in one warning.
    words: &'static [&'static str],
}

const fn slip(scene: &'static str, line: [&'static str; 2], words: &'static [&'static str]) -> Slip {
    Slip { scene, line, words }
}

const PRESSURE: &str = "pressure = 101325.0\n";
const CHAMBER: &str = "[[chamber]]\nname";
const AIR: &str = "molar_mass = 0.02897\ngamma = 1.4";
const FLOW: &str = "[[0.0, 0.0], [0.002, 1.0], [0.004, 0.5]]";
const CAN_FLOW: &str = "[[0, 0], [5, 3e-3], [20, 1.5e-3], [50, 0]]";
const VENT: &str = "opening_pressure = 150000.0";

const SLIPS: &[Slip] = &[
    slip(
        TANK,
        [PRESSURE, "pressure = 101.325\n"],
        &["chamber `tank`: pressure 101.325 Pa", "1000 to 1e8 Pa", "in kPa?"],
    ),
    slip(TANK, [PRESSURE, "pressure = 1013.25\n"], &["1013.25 Pa", "digits of an atmosphere", "in hPa (mbar)?"]),
    slip(TANK, [PRESSURE, "pressure = 1.013\n"], &["1.013 Pa", "in bar?"]),
    slip(TANK, [PRESSURE, "pressure = 0.1013\n"], &["0.1013 Pa", "in MPa?"]),
    slip(TANK, [PRESSURE, "pressure = 98.0\n"], &["98 Pa", "1000 to 1e8 Pa", "in kPa?"]),
    slip(TANK, [PRESSURE, "pressure = 1e29\n"], &["pressure 1e29 Pa", "1000 to 1e8 Pa"]),
    slip(TANK, ["temperature = 300.0\ngas", "temperature = 20.0\ngas"], &["20 K", "150 to 4000 K", "293.15 K"]),
    slip(
        TANK,
        ["temperature = 300.0\n[[ch", "temperature = 27.0\n[[ch"],
        &["wall `tank`: temperature 27 K", "Celsius"],
    ),
    slip(TANK, ["temperature = 700.0", "temperature = 7e5"], &["orifice `inflator`: temperature 700000 K", "4000 K"]),
    slip(
        TANK,
        [FLOW, "[[0.0, 0.0], [0.002, 1e3], [0.004, 500]]"],
        &["mass_flow up to 1000 kg/s", "100 kg/s", "in g/s?"],
    ),
    slip(
        TANK,
        ["area = 2e-4", "area = 2e-7"],
        &["mass_flow up to 1 kg/s through an area of 2.000e-7 m2", "to drive it"],
    ),
    slip(TANK, ["area = 2e-4", "area = 200.0"], &["radius of 7.979 m", "make `area` smaller"]),
    slip(TANK, [FLOW, "[[0.0, 0.0], [2.0, 1.0], [4.0, 0.5]]"], &["goes on until 4 s, 1000 times `end_time` 0.004 s"]),
    slip(
        TANK,
        ["particles = 2000", "particles = 2000\ntime_step = 1e-18"],
        &["4,000,000,000,000,000 steps", "1e8", "1e-18 s"],
    ),
    slip(TANK, ["end_time = 0.004", "end_time = 4000.0"], &["end_time 4000 s", "1e-6 to 100 s", "in us?"]),
    slip(TANK, [AIR, "molar_mass = 28.97\ngamma = 1.4"], &["gas `air`: molar_mass 28.97 kg/mol", "in g/mol?"]),
    slip(
        TANK,
        [AIR, "molar_mass = 0.02897\ncp = 1004.5"],
        &["found a molar cp of 1004.5 J/(mol K), more than any gas", "236.627 internal degrees", "per kilogram?"],
    ),
    slip(
        PER_KILOGRAM,
        ["rows = 20", "rows = 21"],
        &["cp 1004.5 J/(mol K)", "166.289 J/(mol K) (20 R): is it per kilogram?"],
    ),
    slip(TANK, [AIR, "molar_mass = 0.02897\ncv = 717.5"], &["more than 20 R", "per kilogram?"]),
    slip(TANK, [AIR, "molar_mass = 0.02897\ncp = 1.0045"], &["1.0045", "in kJ/(kg K)?", "29.1004 J/(mol K)"]),
    slip(
        TANK,
        [AIR, "molar_mass = 0.02897\ncp = [26.9, 5.9, 0.0]"],
        &["gas `air`: molar cp 1796.9", "at 300 K (20 R)"],
    ),
    slip(
        TANK,
        [AIR, "molar_mass = 0.02897\ncp = [28.98641, 1.853978, -9.647459]"],
        &["gas `air`: molar cp -867686 J/(mol K)", "(5/2 R to 20 R)", "T in K", "of T/1000, as Shomate's are?"],
    ),
    slip(
        TANK,
        [AIR, "molar_mass = 0.02897\ncp = [26.9, 5.9, 0.0]"],
        &["at 300 K (20 R)", "`cp = [26.9, 0.0059, 0]`, without what D and E add: fit three", "(line 3)"],
    ),
    slip(
        TANK,
        [AIR, "molar_mass = 0.02897\ncp = [-29.1, 5.9e-3, 0.0]"],
        &["gas `air`: molar cp -27.33 J/(mol K)", "20.7862 to 166.289", "look at their signs and powers of ten"],
    ),
    slip(
        TANK,
        [AIR, "molar_mass = 0.02897\ncp = [928.6, 0.2, 0.0]"],
        &["gas `air`: molar cp 988.6", "is it per kilogram? Multiply all coefficients by the molar mass"],
    ),
    slip(
        CAN,
        ["[[0, 300], [3, 700], [50, 500]]", "[[0, 300], [0.003, 700], [0.05, 500]]"],
        &["orifice `inflator`: its temperature ends at 0.05 ms", "until 50 ms, 1000 times that", "(line 37)"],
    ),
    slip(
        CAN,
        ["discharge = 0.7", "discharge = [[0, 0.1], [0.05, 0.7]]"],
        &["vent `burst disc`: its discharge is over at 0.05 ms", "1200 times that", "(line 46)"],
    ),
    slip(
        TANK,
        ["particles = 2000", "particles = 2000\ntime_step = 1e-9\nmethod = \"closest-approach\""],
        &["the model: time_step 1e-9 s is", "times shorter than the 1.", "4,000,000 steps in place of", "(line 50)"],
    ),
    slip(
        TANK,
        ["particles = 2000", "particles = 2000\nswitch = 5e-6"],
        &[
            "`model.switch`: particles end at 5e-6 s, and `end_time` 0.004 s is 800 times that: is one of them in another unit?",
        ],
    ),
    slip(
        CAN,
        ["radius = 80", "radius = 0.080"],
        &["probe `mid`: longest side of its region 0.16 mm, usual is 1 to 10000 mm: is it in m?"],
    ),
    slip(TANK, [PRESSURE, "pressure = 250.0\n"], &["250 Pa", "in kPa or hPa (mbar)?"]),
    slip(TANK, [PRESSURE, "pressure = 400.0\n"], &["400 Pa", "in hPa (mbar) or kPa?"]),
    slip(
        TANK,
        ["end_time = 0.004", "end_time = 4.0"],
        &["end_time 4 s is 4,469 times the 0.", "in another unit?", "`switch`"],
    ),
    slip(
        TANK,
        [FLOW, "[[0.0, 0.0], [2e-6, 1.0], [4e-6, 0.5]]"],
        &["its mass flow is over at 4e-6 s", "1000 times that"],
    ),
    slip(
        TANK,
        ["temperature = 700.0", "temperature = [[0, 300], [2, 700], [4, 500]]"],
        &["its temperature goes on until 4 s, 1000 times `end_time` 0.004 s", "in another unit?"],
    ),
    slip(
        TANK,
        ["discharge = 0.7", "discharge = [[0, 0.0], [2, 0.7]]"],
        &["vent `vent`: its discharge goes on until 2 s, 500 times"],
    ),
    slip(
        TANK,
        [CHAMBER, "[[chamber]]\nregion = { box = { min = [0, 0, 0], max = [0.2, 0.3, 0.25] } }\nname"],
        &["0.015 of its 0.03 m3 (50 %) are in no chamber", "leave out the `region`"],
    ),
    slip(
        TANK,
        [
            "[[chamber]]",
            "[[wall]]\nname = \"rod\"\nshape = \"box\"\nmin = [2, 1, 1]\nmax = [2.1, 1.1, 1.1]\ngas = \"outside\"\n[[chamber]]",
        ],
        &["wall `rod`: 100 % of its volume lies outside of what encloses the gas"],
    ),
    slip(
        TANK,
        [
            "[[chamber]]",
            "[[wall]]\nname = \"core\"\nshape = \"box\"\nmin = [0.02, 0.02, 0.1]\nmax = [0.05, 0.05, 0.2]\ngas = \"inside\"\n[[chamber]]",
        ],
        &["walls `tank`, `core`: all have the gas inside", "`gas = \"outside\"`"],
    ),
    slip(TANK, ["area = 1e-3", "area = 1000"], &["vent `vent`: area 1000 m2, usual is 1e-8 to 1 m2: is it in mm2?"]),
    slip(TANK, ["area = 2e-4", "area = 200"], &["orifice `inflator`: area 200 m2", "in mm2?"]),
    slip(CAN, ["area = 200", "area = 2e-4"], &["orifice `inflator`: area 0.0002 mm2", "in m2?"]),
    slip(TANK, ["cone_angle = 10.0", "cone_angle = 0.17"], &["cone_angle 0.17 degrees", "in radians? 9.74 degrees"]),
    slip(
        TANK,
        ["discharge = 0.7", "discharge_by_pressure = [[101325, 0.5], [2e5, 0.7]]"],
        &["vent `vent`: its curve begins at about the external pressure", "absolute?"],
    ),
    slip(TANK, ["particles = 2000", "diameter = 3.7e-10"], &["the model: diameter 3.7e-10 m: is it of molecules?"]),
    slip(
        TANK,
        ["temperature = 300.0\n[[ch", "temperature = 300.0\nheat_transfer = 5e-5\n[[ch"],
        &["heat_transfer 5e-5 W/(m2 K)", "0.1 to below 10000"],
    ),
    slip(TANK, ["max = [0.4, 0.3, 0.25]", "max = [400, 300, 250]"], &["longest side 400 m", "0.001 to 10 m", "in mm?"]),
    slip(TANK, ["discharge = 0.7", "discharge = 70"], &["vent `vent`: discharge 70", "at most 1", "per cent?"]),
    slip(TANK, [VENT, "opening_pressure = 150.0"], &["opening_pressure 150 Pa", "1000 to 1e8 Pa", "in kPa?"]),
    slip(TANK, [VENT, "external_pressure = 1.01325"], &["external_pressure 1.01325 Pa", "in bar?"]),
    slip(TANK, ["area = 1e-3", "area = 1.131e-2"], &["four times", "diameter 0.06 m", "is it the radius?"]),
    slip(TANK, ["jet = { mach = 1.0", "jet = { velocity = 0.4"], &["jet velocity 0.4 m/s", "1 to 10000 m/s"]),
    slip(CAN, [CAN_FLOW, "[[0, 0], [5, 3], [20, 1.5], [50, 0]]"], &["up to 3 kg/ms", "0.1 kg/ms", "in kg/s?"]),
    slip(CAN, ["pressure = 1.01325e-4", "pressure = 101325"], &["101325 GPa", "in Pa?"]),
    slip(CAN, ["pressure = 1.01325e-4", "pressure = 1.01325"], &["1.01325 GPa", "in bar?"]),
    slip(CAN, ["pressure = 1.01325e-4", "pressure = 0.2"], &["0.2 GPa", "1e-6 to 0.1 GPa", "is it in MPa?"]),
    slip(CAN, ["heat_transfer = 5e-8", "heat_transfer = 50"], &["heat_transfer 50 J/(ms mm2 K)", "in W/(m2 K)?"]),
    slip(CAN, ["end_time = 60.0", "end_time = 0.06"], &["goes on until 50 ms, 833.3 times `end_time` 0.06 ms"]),
    slip(CAN, ["radius = 150", "radius = 0.150"], &["not in the gas", "radius of 7.979 mm"]),
    slip(
        CAN,
        [
            "[[probe]]",
            "[[probe]]\nname = \"slice\"\nregion = { cylinder = { base = [0, 0, 200], axis = [0, 0, 1], \
        radius = 300, height = 10 } }\n[[probe]]",
        ],
        &["probe `slice`", "radius 300 mm, twice the 150 mm of wall `can`", "diameter?"],
    ),
    slip(
        TANK,
        ["discharge = 0.7", "leak_velocity = [[0, 0], [0.6, 1e5]]"],
        &["vent `vent`: leak_velocity 100000 m/s", "[pressure above the outside, velocity], are its columns swapped?"],
    ),
    slip(CAN, ["molar_mass = 0.0280134", "molar_mass = 28.0134"], &["28.0134 kg/mol", "in g/mol?"]),
];

#[test]
fn what_no_vessel_has_is_told_with_its_likely_unit() {
    let mut wrong = Vec::new();
    for Slip { scene, line: [found, wanted], words } in SLIPS {
        let text = scene.replace(found, wanted);
        assert_ne!(&text, scene, "{wanted}");
        let told = doubts(&text, Path::new(""));
        // An error's lines are wrapped.
        let plain = |text: &String| text.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
        if !told.iter().any(|text| words.iter().all(|word| plain(text).contains(word))) {
            wrong.push(format!("{wanted}: {words:?} in {told:#?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A mesh in mm in a scene in metres, and one in metres in a scene in mm.
#[test]
fn a_mesh_in_another_unit_is_told_with_its_scale() {
    let folder = tempfile::tempdir().unwrap();
    for (side, units, pressure, words) in [
        (380.0, "SI", "101325", ["longest side 380 m", "is the mesh in mm? then `scale = 0.001`"]),
        (0.38, "kg-mm-ms", "1.01325e-4", ["longest side 0.38 mm", "is the mesh in m? then `scale = 1000`"]),
    ] {
        std::fs::write(folder.path().join("box.obj"), cube(side)).unwrap();
        let text = format!(
            "units = \"{units}\"\nend_time = 1e-3\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n[[wall]]\nname = \"m\"\n\
             shape = \"mesh\"\nfile = \"box.obj\"\ngas = \"inside\"\n[[chamber]]\nname = \"c\"\npressure = {pressure}\n\
             temperature = 300\ngas = \"air\"\n[model]\nparticles = 2000\n"
        );
        let told = doubts(&text, folder.path());
        assert!(told.iter().any(|text| words.iter().all(|word| text.contains(word))), "{told:#?}");
        let scale = if side > 1.0 { "scale = 1e-3" } else { "scale = 1e3" };
        let scaled = doubts(&text.replace("gas = \"inside\"", &format!("gas = \"inside\"\n{scale}")), folder.path());
        assert!(scaled.iter().all(|text| !text.contains("longest side")), "{scaled:#?}");
    }
}

/// A cube as an OBJ text, its faces outwards.
pub fn cube(side: f64) -> String {
    let mut text = String::new();
    for corner in 0..8 {
        let at = |bit: usize| if corner >> bit & 1 == 1 { side } else { 0.0 };
        text += &format!("v {} {} {}\n", at(0), at(1), at(2));
    }
    text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
}

/// What is meant has no such warning: the scenes that were changed above, near vacuum beside other gas or before an inflow, free
/// flight of thin gas, a vent into vacuum.
#[test]
fn what_is_meant_is_not_doubted() {
    let with = |scene: &str, lines: &[[&str; 2]]| {
        lines.iter().fold(scene.to_string(), |text, [found, wanted]| {
            assert!(text.contains(found), "{found}");
            text.replace(found, wanted)
        })
    };
    let receiver = "[[chamber]]\nname = \"thin\"\nregion = { box = { min = [0, 0, 0], max = [0.1, 0.3, 0.25] } }\n\
        pressure = 500.0\ntemperature = 300.0\ngas = \"air\"\n[[chamber]]";
    let here = ["face = \"+x\"\nposition", "face = \"+x\"\nchamber = \"tank\"\nposition"];
    let silent = ["[[0.0, 0.0], [0.002, 1.0], [0.004, 0.5]]", "[[0.0, 0.0], [0.004, 0.0]]"];
    for text in [
        TANK.to_string(),
        CAN.to_string(),
        with(TANK, &[["[[chamber]]", receiver], here, ["particles = 2000", "particles = 50000"]]),
        with(TANK, &[[PRESSURE, "pressure = 1e-3\n"]]),
        with(TANK, &[[PRESSURE, "pressure = 10.0\n"], ["[model]", "[model]\nmethod = \"none\""], silent]),
        with(TANK, &[[VENT, "external_pressure = 10.0"]]),
        with(TANK, &[[VENT, "external_pressure = 0.0"]]),
    ] {
        // (A vessel of hardly any gas has no particle, which is an error of its own.)
        let told: Vec<String> =
            doubts(&text, Path::new("")).into_iter().filter(|text| !text.contains("no particle")).collect();
        assert_eq!(told, [""; 0], "{text}");
    }
}

/// A vent is told as shut if neither its own chamber at the start nor all gas together reaches its pressure; the other chamber's
/// pressure is not its own.
#[test]
fn a_vent_that_no_gas_opens_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let note = |low: f64, opens_at: f64| {
        let text = format!(
            "end_time = 1e-3\n[[gas]]\nname = \"n2\"\nmolar_mass = 0.028\ngamma = 1.4\n\
             [[wall]]\nname = \"tank\"\nshape = \"box\"\nmin = [-0.2, -0.2, -0.2]\nmax = [0.2, 0.2, 0.2]\ngas = \"inside\"\n\
             [[wall]]\nname = \"inner\"\nshape = \"box\"\nmin = [-0.05, -0.05, -0.05]\nmax = [0.05, 0.05, 0.05]\nthickness = 0.005\n\
             [[chamber]]\nname = \"high\"\nregion = {{ box = {{ min = [-0.05, -0.05, -0.05], max = [0.05, 0.05, 0.05] }} }}\n\
             pressure = 8e5\ntemperature = 300.0\ngas = \"n2\"\n\
             [[chamber]]\nname = \"low\"\npressure = {low}\ntemperature = 300.0\ngas = \"n2\"\n\
             [[vent]]\nname = \"disc\"\nwall = \"tank\"\nface = \"+x\"\narea = 1e-4\ndischarge = 0.7\n\
             external_pressure = 101325.0\nopening_pressure_absolute = {opens_at}\n[model]\nparticles = 4000\n"
        );
        let path = folder.path().join("two.toml");
        std::fs::write(&path, text).unwrap();
        let (code, out, err) = outcome(&["check", path.to_str().unwrap()]);
        assert_eq!(code, 0, "{err}");
        out.contains("not reached at the start, nor by all gas together")
    };
    // The litre at 8 bar leaves all gas at 1.12 bar.
    assert!(note(101_325.0, 251_325.0) && !note(101_325.0, 1.1e5) && !note(3e5, 251_325.0));
}

/// `check` and `plan` say of each wall, chamber and vent what it is, in the scene's units; with `--strict` a warning is an error.
#[test]
fn check_and_plan_say_what_a_scene_holds() {
    let can = input("plausible/can.toml");
    let (code, out, _) = outcome(&["check", can.to_str().unwrap()]);
    assert_eq!(code, 0);
    for line in [
        "can   300.4 x 300.4 x 424.4 mm from (-150.2, -150.2, 0)",
        "all gas with all inflow  3.000e7 mm3 (30 L)  0.09789 kg  0.0006886 GPa, 690.5 K if closed, no heat lost",
        "burst disc  0.0002513 GPa (2.513 bar) absolute  0.00015 GPa",
        "warning: vent `burst disc`: largest flux",
    ] {
        assert!(out.contains(line), "{line}\n{out}");
    }
    let (_, plan, _) = outcome(&["plan", can.to_str().unwrap()]);
    assert!(plan.contains("burst disc  0.0002513 GPa (2.513 bar) absolute"), "{plan}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("slip.toml");
    std::fs::write(&path, TANK.replace(PRESSURE, "pressure = 101.325\n")).unwrap();
    let path = path.to_str().unwrap();
    for verb in ["check", "plan", "run"] {
        let (code, _, err) = outcome(&[verb, path, "--strict"]);
        assert_eq!(code, 2, "{verb}");
        assert!(err.contains("101.325 Pa") && err.contains("kPa?"), "{err}");
    }
}

/// A vent opens at one pressure, whether it is given above the outside or absolute; the run says when it opens, and at its end when
/// it did, or that it did not.
#[test]
fn a_run_says_when_a_vent_opens() {
    let folder = tempfile::tempdir().unwrap();
    let run = |name: &str, text: String, more: &[&str]| {
        let [path, out] = [format!("{name}.toml"), name.to_string()].map(|name| folder.path().join(name));
        std::fs::write(&path, text).unwrap();
        let steps = [&["run", path.to_str().unwrap(), "--out", out.to_str().unwrap()], more].concat();
        let (code, said, err) = outcome(&steps);
        assert_eq!(code, 0, "{err}");
        let read = |file: &str| std::fs::read_to_string(out.join(file)).unwrap_or_default();
        (said, err, read("audit.txt"), read("history.csv"))
    };
    let short = TANK.replace("end_time = 0.004", "end_time = 0.0004").replace(FLOW, "[[0.0, 50.0], [0.004, 50.0]]");
    let absolute = short.replace(VENT, "opening_pressure_absolute = 251325.0");
    let (said, err, audit, rows) = run("gauge", short.clone(), &[]);
    let line =
        said.lines().find(|line| line.starts_with("vent `vent` opened at 0.")).unwrap_or_else(|| panic!("{said}"));
    assert!(line.ends_with(" bar) absolute") && err.contains(line) && audit.contains(line), "{line}\n{err}\n{audit}");
    assert_eq!(run("absolute", absolute.clone(), &[]).3, rows);
    // By a control volume the pressure is that at which it opens.
    let uniform = |text: &str| text.replace("particles = 2000", "method = \"control-volume\"");
    let (said, err, audit, _) = run("uniform", uniform(&absolute), &[]);
    let line =
        said.lines().find(|line| line.starts_with("vent `vent` opened at 0.")).unwrap_or_else(|| panic!("{said}"));
    assert!(
        line.ends_with("at 251325 Pa (2.513 bar) absolute") && err.contains(line) && audit.contains(line),
        "{line}\n{err}"
    );
    let (said, _, audit, _) = run("shut", uniform(TANK), &[]);
    let shut = "vent `vent` did not open: it opens at 251325 Pa (2.513 bar) absolute, and its chamber had 1";
    assert!(said.contains(shut) && audit.contains(shut), "{said}");
}
