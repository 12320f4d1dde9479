//! Mistakes in first scenes that read well, and that no single number shows: each is told, and what is meant is not.

use std::path::Path;

use corpuscle::scene::parse;
use corpuscle::simulation::Model;

use super::mistakes::{AIR, chamber, metre, model};
use super::outcome;
use super::plausible::TANK;

fn changed(text: &str, lines: &[[&str; 2]]) -> String {
    lines.iter().fold(text.to_string(), |text, [found, wanted]| {
        assert!(text.contains(found), "{found}");
        text.replacen(found, wanted, 1)
    })
}

/// All that a plan tells.
fn told(text: &str) -> Vec<String> {
    let model = model(text);
    [model.notes(), model.plan.told()].concat()
}

fn find<'a>(told: &'a [String], start: &str) -> Option<&'a String> {
    told.iter().find(|text| text.starts_with(start))
}

const OPENING: &str = "opening_pressure = 150000.0";

/// 20 kPa that are meant above the outside, beside a vent that is open or not; near vacuum, and gas of the pressure outside, are none.
#[test]
fn a_chamber_below_the_outside_of_its_vent_is_told() {
    let start = "vent `vent`: chamber `tank` has ";
    let notes = |pressure: &str, vent: &str| told(&changed(TANK, &[["101325.0", pressure], [OPENING, vent]]));
    for vent in ["opening_pressure = 0.0", OPENING] {
        let told = notes("20000.0", vent);
        let note = find(&told, start).unwrap_or_else(|| panic!("{told:?}"));
        for words in ["20000 Pa at the start, less than the 101325 Pa outside", "gauge? It is absolute", "(line "] {
            assert!(note.contains(words), "{note}");
        }
    }
    for pressure in ["101325.0", "100500.0", "1000.0", "120000.0"] {
        assert_eq!(find(&notes(pressure, "opening_pressure = 0.0"), start), None, "{pressure}");
    }
    assert_eq!(find(&notes("20000.0", "external_pressure = 0.0"), start), None);
}

/// A fabric that is measured from some pressure on leaks as much without any.
#[test]
fn a_leak_without_pressure_is_told() {
    let start = "vent `vent`: its leak_velocity begins with ";
    let notes = |curve: &str| {
        let leak = format!("leak_velocity = {curve}");
        told(&changed(TANK, &[["discharge = 0.7", &leak], ["area = 1e-3\n", ""], [OPENING, ""]]))
    };
    let told = notes("[[1e4, 0.2], [1e5, 0.8]]");
    let note = find(&told, start).unwrap_or_else(|| panic!("{told:?}"));
    assert!(note.contains("0.2 m/s at 10000 Pa, and holds that") && note.contains("begin with [0, 0]"), "{note}");
    for curve in ["[[0.0, 0.0], [1e4, 0.2], [1e5, 0.8]]", "[[0.0, 0.2], [1e5, 0.8]]", "[[1e4, 0.0], [1e5, 0.8]]"] {
        assert_eq!(find(&notes(curve), start), None, "{curve}");
    }
}

/// A jet that is faster than its gas can be is told with the largest velocity: of a gamma of 1.4 sqrt(2 cp T0) = 1135 m/s at 620 K, and
/// Mach 20 a little less.
#[test]
fn the_largest_velocity_of_a_jet_is_told() {
    let jet = |velocity: &str| {
        let lines = [
            ["molar_mass = 0.02897", "molar_mass = 0.0280134"],
            ["gas = { air = 0.6, helium = 0.4 }", "gas = \"air\""],
            ["temperature = 700.0", "temperature = 620.0"],
            ["mach = 1.0", velocity],
        ];
        match Model::new(parse(&changed(TANK, &lines), "scene.toml", Path::new("")).unwrap()) {
            Ok(_) => String::new(),
            Err(error) => error.to_string(),
        }
    };
    let told = jet("velocity = 1500.0");
    for words in
        ["a jet of 1500 m/s", "faster than gas of that temperature can flow, sqrt(2 cp T0)", "Mach 20, 1128 m/s,"]
    {
        assert!(told.contains(words), "{told}");
    }
    assert!(jet("velocity = 1131.0").contains("would have Mach number"), "{}", jet("velocity = 1131.0"));
    assert_eq!(jet("velocity = 1120.0"), "");
}

const HALVES: &str = "box = { min = [0, 0, 0], max = [0.5, 1, 1] }";

/// A plate across a metre's tank, with or without holes.
fn plate(holes: &str) -> String {
    format!(
        "[[wall]]\nname = \"plate\"\nshape = \"plane\"\ncenter = [0.5, 0.5, 0.5]\nnormal = [1, 0, 0]\nu = [0, 1, 0]\nsize = [1.2, 1.2]\n\
         thickness = 0.01\n{holes}"
    )
}

const HOLES: &str = "[[wall.hole]]\nname = \"up\"\ncenter = [0.2, 0]\ndiameter = 0.1\n\
    [[wall.hole]]\nname = \"down\"\ncenter = [-0.2, 0]\ndiameter = 0.1\n";

/// An opening with the area of a hole, or of both, is warned of; with another it may be meant, and is noted; without holes it is no matter.
#[test]
fn an_opening_beside_holes_is_told() {
    let scene = |holes: &str, area: f64| {
        let opening = format!("[[opening]]\nname = \"pass\"\nbetween = [\"right\", \"left\"]\narea = {area}");
        let chambers = chamber("left", HALVES, AIR) + &chamber("right", "", AIR);
        model(&metre(&plate(holes), &chambers, &opening))
    };
    let hole = 0.25 * std::f64::consts::PI * 0.01;
    for area in [hole, 2.01 * hole] {
        let doubts = scene(HOLES, area).plan.inventory.doubts;
        let told =
            find(&doubts, "opening `pass`: holes `up`, `down` of the walls join chambers `right` and `left` already");
        assert!(told.is_some_and(|told| told.contains("count beside them") && told.contains("(line ")), "{doubts:?}");
    }
    let other = scene(HOLES, 5.0 * hole);
    assert_eq!(find(&other.plan.inventory.doubts, "opening `pass`: holes"), None);
    assert!(find(&other.notes(), "opening `pass`: holes").is_some(), "{:?}", other.notes());
    let without = scene("", hole);
    assert_eq!(find(&[without.notes(), without.plan.told()].concat(), "opening `pass`: hole"), None);
}

/// A plate that is let into the walls and has no hole parts the gas, and a chamber on both its sides.
#[test]
fn separate_spaces_are_told_where_walls_overlap() {
    let both = chamber("left", HALVES, AIR) + &chamber("right", "", AIR);
    let one = chamber("all", "", AIR);
    let notes = |walls: &str, chambers: &str| model(&metre(walls, chambers, "")).notes();
    assert_eq!(notes(&plate(""), &both), ["2 separate gas spaces: no gas flows between them"]);
    let split = notes(&plate(""), &one);
    let words = "chamber `all`: its gas lies in 2 spaces that no gas flows between, of ";
    assert!(split.len() == 2 && find(&split, words).is_some_and(|note| note.contains("(line ")), "{split:?}");
    let small = "[[wall.hole]]\nname = \"pore\"\ncenter = [0.2, 0.1]\ndiameter = 0.004\n";
    for holes in [HOLES, small] {
        let told = notes(&plate(holes), &both);
        assert!(told.iter().all(|note| !note.contains("separate") && !note.contains("spaces")), "{told:?}");
    }
    // One that leaves a gap parts nothing.
    let short = plate("").replace("size = [1.2, 1.2]", "size = [1.2, 0.9]");
    assert!(notes(&short, &both).iter().all(|note| !note.contains("separate")), "{:?}", notes(&short, &both));
}

/// A piston of so many m that goes on by .5 m in 1 ms, its front at the wall of a metre's tank.
fn piston(length: f64, course: &str) -> Vec<String> {
    let body = format!(
        "[[wall]]\nname = \"piston\"\nshape = \"box\"\nmin = [{}, -0.1, -0.1]\nmax = [0.02, 1.1, 1.1]\ngas = \"outside\"",
        0.02 - length
    );
    let motion = format!("[[motion]]\nwall = \"piston\"\ndirection = [1, 0, 0]\n{course}");
    model(&metre(&body, &chamber("all", "", AIR), &motion)).plan.inventory.doubts
}

/// One that is shorter than its way leaves a vacuum behind, from the time on when its back comes in; one that is longer leaves none, nor
/// does one with gas behind, or one that gas flows round.
#[test]
fn a_vacuum_behind_a_piston_is_told() {
    let start = "motion of wall `piston`: from ";
    let doubts = piston(0.22, "velocity = 500.0");
    let told = find(&doubts, start).unwrap_or_else(|| panic!("{doubts:?}"));
    // .2 m at 500 m/s; .3 m are left.
    for words in ["from 0.0004", " s on a space opens behind it", "a vacuum", "(line "] {
        assert!(told.contains(words), "{told}");
    }
    let further = told.split("longer by more than ").nth(1).and_then(|rest| rest.split(' ').next());
    let further: f64 = further.and_then(|text| text.parse().ok()).unwrap_or(0.0);
    assert!((further - 0.3).abs() < 1e-3, "{told}");
    assert_eq!(piston(0.55, "velocity = 500.0"), [""; 0]);
    let inside = |half: f64| {
        let body = format!(
            "[[wall]]\nname = \"piston\"\nshape = \"box\"\nmin = [0.0, {}, {}]\nmax = [0.2, {}, {}]\ngas = \"outside\"",
            0.5 - half,
            0.5 - half,
            0.5 + half,
            0.5 + half
        );
        let motion = "[[motion]]\nwall = \"piston\"\ndirection = [1, 0, 0]\nvelocity = 500.0";
        model(&metre(&body, &chamber("all", "", AIR), motion)).plan.inventory.doubts
    };
    // A block that lifts off its wall.
    assert_eq!(inside(0.3), [""; 0]);
    assert!(find(&inside(0.6), start).is_some(), "{:?}", inside(0.6));
}

/// A motion with the wrong sign.
#[test]
fn a_piston_that_goes_the_wrong_way_is_told() {
    let away = piston(0.3, "velocity = -100.0");
    let told = find(&away, "motion of wall `piston`: from 0.00025 s on the wall has no gas before it");
    assert!(told.is_some_and(|told| told.contains("direction") && told.contains("sign")), "{away:?}");
    let flush = |sign: f64| {
        let body = "[[wall]]\nname = \"piston\"\nshape = \"box\"\nmin = [-0.5, -0.1, -0.1]\nmax = [0, 1.1, 1.1]\ngas = \"outside\"";
        let motion = format!("[[motion]]\nwall = \"piston\"\ndirection = [1, 0, 0]\nvelocity = {}", 100.0 * sign);
        model(&metre(body, &chamber("all", "", AIR), &motion)).plan.inventory.doubts
    };
    let away = flush(-1.0);
    let told = find(&away, "motion of wall `piston`: the wall has no gas before it at any time");
    assert!(told.is_some_and(|told| told.contains("The gas lies on the other side")), "{away:?}");
    assert_eq!(flush(1.0), [""; 0]);
}

/// The closed surface of a box, from a corner to the opposite one; `turned`: with its normals inwards.
fn shell(low: f64, high: f64, turned: bool, first: usize) -> String {
    let mut text = String::new();
    for k in 0..8 {
        let at = |bit: usize| if k >> bit & 1 == 1 { high } else { low };
        text += &format!("v {} {} {}\n", at(0), at(1), at(2));
    }
    for face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        let mut face = face.map(|corner: usize| (corner + first).to_string());
        if turned {
            face.reverse();
        }
        text += &format!("f {}\n", face.join(" "));
    }
    text
}

/// A mesh of the metal of a vessel, whose gas would be in the metal, is told, also in the error of an orifice that looks into the vessel; a
/// body in the gas is none.
#[test]
fn a_mesh_of_metal_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let scene = |thickness: f64, more: &str| {
        let mesh = shell(-thickness, 1.0 + thickness, false, 1) + &shell(0.0, 1.0, true, 9);
        std::fs::write(folder.path().join("can.obj"), mesh).unwrap();
        let text = metre("", &chamber("all", "", AIR), more);
        let mesh = "shape = \"mesh\"\nfile = \"can.obj\"\n";
        let text = changed(&text, &[["shape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n", mesh]]);
        parse(&text, "scene.toml", folder.path()).unwrap()
    };
    let doubts = |thickness: f64| Model::new(scene(thickness, "")).unwrap().plan.inventory.doubts;
    let told = doubts(0.01);
    let words = "wall `tank`: its gas is a shell of about 0.009999 m between two surfaces, round 1000 L without gas";
    assert!(find(&told, words).is_some_and(|told| told.contains("only the inner surface")), "{told:?}");
    assert_eq!(doubts(0.2), [""; 0]);
    let orifice = "[[orifice]]\nname = \"in\"\nposition = [0.5, 0.5, 0]\ndirection = [0, 0, 1]\narea = 1e-3\ngas = \"n2\"\n\
        temperature = 400\nmass_flow = [[0, 0.01], [1, 0.01]]";
    let error = |thickness: f64| {
        let error = Model::new(scene(thickness, orifice)).map(|_| ()).unwrap_err();
        format!("{:?}", miette::Report::new(error)).split_whitespace().collect::<Vec<_>>().join(" ")
    };
    assert!(
        error(0.01).contains("leave only the inner surface") && !error(0.01).contains("round: it is"),
        "{}",
        error(0.01)
    );
    assert!(error(0.2).contains("turn `direction` round"), "{}", error(0.2));
}

/// A rate of particle-steps where millions of them are asked for.
#[test]
fn a_device_rate_without_the_million_is_refused() {
    let tank = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/tank.toml");
    let (code, _, err) = outcome(&["plan", tank, "--accuracy", "0.1", "--device-rate", "460000"]);
    let words = "at most 300000: is it without the million? 460000 are 0.46 million";
    assert!(code == 2 && err.split_whitespace().collect::<Vec<_>>().join(" ").contains(words), "{err}");
    let (code, out, err) = outcome(&["plan", tank, "--accuracy", "0.1", "--device-rate", "46000"]);
    assert!(code == 0 && out.contains("at 46000 million a second") && !out.contains(" 0 s "), "{out}{err}");
    let text = changed(TANK, &[["particles = 2000", "accuracy = 0.1\ndevice_rate = 4.6e5"]]);
    let error =
        format!("{:?}", miette::Report::new(parse(&text, "scene.toml", Path::new("")).map(|_| ()).unwrap_err()));
    assert!(error.contains("million particle-steps per second"), "{error}");
}

/// Wall hits that the plan's own step has too many of: the step that the warning names has no more than the limit.
#[test]
fn the_step_that_a_warning_names_is_short_enough() {
    let narrow = "units = \"t-mm-s\"\nend_time = 0.010\n[[gas]]\nname = \"air\"\nmolar_mass = 2.897e-5\ngamma = 1.4\n\
        [[wall]]\nname = \"tube\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [200, 20, 20]\ngas = \"inside\"\n\
        [[wall]]\nname = \"piston\"\nshape = \"box\"\nmin = [30, -2, -2]\nmax = [240, 22, 22]\ngas = \"outside\"\n\
        [[motion]]\nwall = \"piston\"\ndirection = [1, 0, 0]\ndisplacement = [[0, 0], [0.010, 110.0]]\n\
        [[chamber]]\nname = \"tube\"\npressure = 0.101325\ntemperature = 293\ngas = \"air\"\n\
        [model]\nmethod = \"closest-approach\"\nparticles = 2000\n";
    let hits =
        |text: &str| model(text).plan.warnings.into_iter().find(|text| text.starts_with("the time step: wall hits"));
    let warning = hits(narrow).unwrap();
    let step = warning.split("a `time_step` of ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
    let with =
        |micros: f64| narrow.replace("particles = 2000", &format!("particles = 2000\ntime_step = {:e}", 1e-6 * micros));
    let step: f64 = step.parse().unwrap_or_else(|_| panic!("{warning}"));
    assert_eq!(hits(&with(step)), None, "{warning}");
    assert!(hits(&with(1.03 * step)).is_some(), "{warning}");
}

/// A leaking side of a box that a plate divides: only the gas of its chamber leaves, though both chambers border on its triangles.
#[test]
fn a_leaking_face_empties_its_chamber_only() {
    let folder = tempfile::tempdir().unwrap();
    for (own, other) in [("low", "high"), ("high", "low")] {
        let state = "pressure = 2e5\ntemperature = 300\ngas = \"n2\"";
        let leak = format!(
            "[[vent]]\nname = \"leak\"\nwall = \"tank\"\nface = \"+z\"\nchamber = \"{own}\"\narea = 0.1\ndischarge = 0.7\n\
             [output]\nrows = 2\nsnapshots = 0"
        );
        let chambers = chamber("low", HALVES, state) + &chamber("high", "", state);
        let path = folder.path().join(format!("{own}.toml"));
        std::fs::write(&path, metre(&plate(""), &chambers, &leak)).unwrap();
        let out = folder.path().join(own);
        let (code, _, err) = outcome(&["run", path.to_str().unwrap(), "--out", out.to_str().unwrap()]);
        assert_eq!(code, 0, "{err}");
        let text = std::fs::read_to_string(out.join("history.csv")).unwrap();
        let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
        let count = |chamber: &str| -> f64 {
            let column = rows[0].iter().position(|head| *head == format!("{chamber}:particles:n2")).unwrap();
            rows[rows.len() - 1][column].parse().unwrap()
        };
        let at_start = model(&metre(&plate(""), &chambers, &leak)).plan.chambers;
        let start = |index: usize| at_start[index].particles[0] as f64;
        let index = usize::from(own == "high");
        assert!((count(other) - start(1 - index)).abs() < 1e-6, "{own}: {}", count(other));
        assert!(count(own) < 0.99 * start(index), "{own}: {} of {}", count(own), start(index));
    }
}
