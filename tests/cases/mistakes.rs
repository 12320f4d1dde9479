//! Mistakes of those who write a scene for the first time, each told with what was probably meant.

use std::path::Path;

use corpuscle::scene::parse;
use corpuscle::simulation::Model;

use super::{input, outcome};

const TANK: &str = include_str!("inputs/plausible/tank.toml");

/// What a scene is refused with, its lines joined.
fn refused(text: &str, folder: &Path) -> String {
    let error = parse(text, "scene.toml", folder).map(|_| ()).unwrap_err();
    let report = format!("{:?}", miette::Report::new(error));
    report.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ")
}

/// What stands in the scene, what was written, and what the help says.
const SLIPS: &[[&str; 3]] = &[
    // The decimal comma.
    ["pressure = 101325.0", "pressure = 101325,0", "a decimal point: 101325.0, not 101325,0"],
    ["gamma = 1.4", "gamma = 1,4", "a decimal point: 1.4, not 1,4"],
    ["air = 0.6", "air = 0,6", "a decimal point: 0.6, not 0,6"],
    ["max = [0.4, 0.3, 0.25]", "max = [0,4, 0,3, 0,25]", "a decimal point: 0.5, not 0,5"],
    ["[0.002, 1.0]", "[0,002, 1,0]", "a decimal point: 0.002, not 0,002"],
    // Tables and lists.
    ["[[chamber]]", "[chamber]", "double brackets: [[chamber]]"],
    ["[[chamber]]", "[chamber]\nname = \"a\"\n[chamber]", "double brackets: [[chamber]]"],
    ["[[probe]]", "[probe]", "double brackets: [[probe]]"],
    ["name = \"tank\"\nshape", "name = \"a\"\nname = \"b\"\nshape", "the key \"name\" for the second time"],
    ["title = \"tank\"\nend_time = 0.004", "title = \"tank\"\n[[hole]]", "[[wall.hole]], below its [[wall]]"],
    ["rows = 20", "end_time = 0.004", "stands before the first table of the file"],
    ["rows = 20", "particles = 2000", "is a key of [model]"],
    [
        "mass_flow = [[0.0, 0.0], [0.002, 1.0], [0.004, 0.5]]",
        "mass_flow = [0.0, 0.0, 0.002, 1.0]",
        "a curve is a list of pairs",
    ],
    [
        "mass_flow = [[0.0, 0.0], [0.002, 1.0], [0.004, 0.5]]",
        "mass_flow = [[0, 0.002, 0.004], [0, 1, 0.5]]",
        "a curve is a list of pairs",
    ],
    [
        "region = { sphere = { center = [0.2, 0.15, 0.12], radius = 0.08 } }",
        "region = { min = [0, 0, 0], max = [1, 1, 1] }",
        "region = { box = {",
    ],
    ["region = { sphere = { center = [0.2, 0.15, 0.12], radius = 0.08 } }", "region = \"tank\"", "region = { box = {"],
    // Words of other programs.
    ["end_time = 0.004", "t_end = 0.004", "did you mean `end_time`?"],
    ["radius = 0.08", "diameter = 0.16", "did you mean `radius`, half of it?"],
    [
        "region = { sphere = { center = [0.2, 0.15, 0.12], radius = 0.08 } }",
        "position = [0.2, 0.15, 0.12]",
        "did you mean `region`",
    ],
    ["molar_mass = 0.02897", "molecular_weight = 0.02897", "did you mean `molar_mass`, per mole?"],
    ["particles = 2000", "dt = 1e-6", "did you mean `time_step`?"],
    ["particles = 2000", "method = \"dsmc\"", "did you mean `cell`?"],
    ["end_time = 0.004", "units = \"mm-ms-kg\"\nend_time = 4.0", "did you mean `kg-mm-ms`?"],
    ["shape = \"box\"", "shape = \"cuboid\"", "did you mean `box`?"],
    ["face = \"+z\"", "face = \"z+\"", "did you mean `+z`?"],
    [
        "mass_flow = [[0.0, 0.0], [0.002, 1.0], [0.004, 0.5]]",
        "mass_flow = [[0.0, 0.0], [1.0, 0.002], [0.5, 0.004]]",
        "a point is [time, value], are they swapped?",
    ],
    [
        "temperature = 300.0\n[[ch",
        "[[wall.part]]\nface = \"top\"\ntemperature = 300\n[[wall]]\nname = \"can\"\nshape = \"cylinder\"\n\
      base = [0, 0, 0]\naxis = [0, 0, 1]\nradius = 1\nheight = 1\ngas = \"outside\"\n[[ch",
        "the wall \"can\" has a face \"top\"",
    ],
    // Values.
    ["gamma = 1.4", "cp = -29.1", "three coefficients [a, b, c] of cp = a + b T + c T^2, T in K"],
    ["gamma = 1.4", "cp = [28.99, 1.85, -9.65, 16.6, 0.0001]", "Shomate's coefficients are of T/1000"],
    ["pressure = 101325.0", "pressure = \"101325\"", "neither quotes nor a unit"],
    ["pressure = 101325.0", "pressure = 0.0", "pressures of chambers are absolute"],
    ["mach = 1.0", "mach = 340", "a speed is a `velocity`"],
    ["particles = 2000", "switch = \"uniform\"", "found \"uniform\", allowed: a time, or \"when-uniform\""],
    [
        "[[probe]]",
        "[[opening]]\nname = \"o\"\nbetween = [\"tank\", \"outside\"]\narea = 1e-4\n[[probe]]",
        "what leads out of the scene is a [[vent]]",
    ],
];

#[test]
fn what_was_meant_is_told() {
    let mut wrong = Vec::new();
    for [found, wanted, words] in SLIPS {
        let text = TANK.replacen(found, wanted, 1);
        assert_ne!(text, TANK, "{found}");
        let told = refused(&text, Path::new(""));
        if !told.contains(words) {
            wrong.push(format!("{wanted}: {words:?} in {told}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Numbers in t, mm, s where the scene says kg, mm, ms, and the other way round; with `gamma` there is no error, but a warning. One value alone
/// is no other system.
#[test]
fn numbers_of_another_unit_system_are_told() {
    let scene = |units: &str, heat: &str, [molar_mass, pressure]: [&str; 2]| {
        format!(
            "{units}\nend_time = 0.06\n[[gas]]\nname = \"n2\"\nmolar_mass = {molar_mass}\n{heat}\n[[wall]]\nname = \"can\"\n\
             shape = \"cylinder\"\nbase = [0, 0, 0]\naxis = [0, 0, 1]\nradius = 150\nheight = 424.4\ngas = \"inside\"\n\
             [[chamber]]\nname = \"can\"\npressure = {pressure}\ntemperature = 300\ngas = \"n2\"\n"
        )
    };
    let kg = "units = \"kg-mm-ms\"";
    let told = refused(&scene(kg, "cp = 29100", ["2.80134e-5", "0.101325"]), Path::new(""));
    assert!(told.contains("both are with `units = \"t-mm-s\"`"), "{told}");
    let told = refused(&scene("units = \"t-mm-s\"", "cp = 29.1", ["0.0280134", "1.01325e-4"]), Path::new(""));
    assert!(told.contains("`units = \"SI\"` or `units = \"kg-mm-ms\"`"), "{told}");
    let doubts = |text: &str| corpuscle::plan::doubts_of(&parse(text, "scene.toml", Path::new("")).unwrap());
    let other = |text: &str| doubts(text).first().filter(|text| text.starts_with("the scene: ")).cloned();
    let tonnes = ["2.80134e-5", "0.101325"];
    let told = other(&scene(kg, "gamma = 1.4", tonnes)).unwrap();
    assert!(told.contains("none would be with `units = \"t-mm-s\"`"), "{told}");
    // The line `units` is forgotten.
    let told = other(&scene("", "gamma = 1.4", ["0.0280134", "1.01325e-4"])).unwrap();
    assert!(told.contains("none would be with `units = \"kg-mm-ms\"`"), "{told}");
    assert_eq!(other(&scene(kg, "gamma = 1.4", ["0.0280134", "0.201325"])), None);
    assert_eq!(doubts(&scene("units = \"t-mm-s\"", "gamma = 1.4", tonnes)), [""; 0]);
}

/// The nearest name of a mesh in the folder, none that is like it in its ending only.
#[test]
fn a_misspelt_mesh_file_is_traced() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["can.stl", "lid.obj", "notes.txt", "x.stl"] {
        std::fs::write(folder.path().join(name), "").unwrap();
    }
    let told = |file: &str| {
        let text = TANK.replacen("shape = \"box\"", &format!("shape = \"mesh\"\nfile = \"{file}\""), 1);
        let text = text.replace("min = [0.0, 0.0, 0.0]\nmax = [0.4, 0.3, 0.25]\n", "").replace("face = \"+z\"\n", "");
        refused(&text.replace("face = \"+x\"\n", ""), folder.path())
    };
    for (file, near) in
        [("cann.stl", "can.stl"), ("Can.obj", "can.stl"), ("lids.obj", "lid.obj"), ("LID.OBJ", "lid.obj")]
    {
        let text = told(file);
        assert!(text.contains(&format!("did you mean `{near}`?")), "{file}: {text}");
    }
    for file in ["vessel.stl", "y.stl", "note.stl"] {
        let text = told(file);
        assert!(text.contains("relative to the folder of the scene file") && !text.contains("did you mean"), "{text}");
    }
}

/// What a path is that no run can go on from.
#[test]
fn resume_says_what_it_was_given() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    std::fs::create_dir(&run).unwrap();
    std::fs::write(folder.path().join("notes.txt"), "").unwrap();
    let told = |path: &Path| {
        let (code, _, err) = outcome(&["resume", path.to_str().unwrap()]);
        assert_eq!(code, 2, "{err}");
        err
    };
    let text = told(&folder.path().join("rum"));
    assert!(text.contains("rum does not exist") && text.contains("help: name a run's folder"), "{text}");
    let text = told(&input("plausible/tank.toml"));
    assert!(
        text.contains("tank.toml is a scene file, not the folder of a run") && text.contains("`corpuscle run`"),
        "{text}"
    );
    let text = told(&folder.path().join("notes.txt"));
    assert!(text.contains("notes.txt is a file, not the folder of a run"), "{text}");
    assert!(told(&run).contains("holds no complete checkpoint"));
    std::fs::write(run.join(".corpuscle-run"), "").unwrap();
    assert!(told(&run).contains("the run has written none"));
}

/// How much of a solid sticks out of the vessel stands beside its volume; one that is within, or a plate let into walls a little, has none.
#[test]
fn a_solid_that_sticks_out_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let row = |high: f64| {
        let rod = format!(
            "[[wall]]\nname = \"rod\"\nshape = \"box\"\nmin = [0.02, 0.02, 0.1]\nmax = [0.05, 0.05, {high}]\ngas = \"outside\"\n[[chamber]]"
        );
        let path = folder.path().join("rod.toml");
        std::fs::write(&path, TANK.replacen("[[chamber]]", &rod, 1)).unwrap();
        let (code, out, err) = outcome(&["check", path.to_str().unwrap()]);
        assert_eq!(code, 0, "{err}");
        out.lines().find(|line| line.trim_start().starts_with("rod ")).unwrap().to_string()
    };
    // .15 of .3 m is within the .25 m of the tank.
    assert!(row(0.4).ends_with("solid, 50 % of it outside of the vessel"), "{}", row(0.4));
    assert!(row(0.2).ends_with("solid") && row(0.251).ends_with("solid"), "{}", row(0.251));
}

/// A tank of a metre, and what stands in it.
pub fn metre(walls: &str, chambers: &str, more: &str) -> String {
    format!(
        "end_time = 1e-3\n[[gas]]\nname = \"n2\"\nmolar_mass = 0.028\ngamma = 1.4\n[[gas]]\nname = \"he\"\nmolar_mass = 0.004\n\
         gamma = 1.6667\n[[wall]]\nname = \"tank\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\ngas = \"inside\"\n{walls}\n\
         {chambers}\n{more}\n[model]\nparticles = 2000\n"
    )
}

pub fn chamber(name: &str, region: &str, state: &str) -> String {
    let region = if region.is_empty() { String::new() } else { format!("region = {{ {region} }}\n") };
    format!("[[chamber]]\nname = \"{name}\"\n{region}{state}\n")
}

pub const AIR: &str = "pressure = 1e5\ntemperature = 300\ngas = \"n2\"";
pub const LEFT: &str = "box = { min = [0, 0, 0], max = [0.5, 1, 1] }";

pub fn model(text: &str) -> Model {
    Model::new(parse(text, "scene.toml", Path::new("")).unwrap()).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// A wall that moves beside the vessel; one that comes in, one that is wholly in the gas and one that recedes are none.
#[test]
fn a_wall_that_moves_without_gas_is_told() {
    let doubts = |[low, high]: [f64; 2], far: f64| {
        let piston = format!(
            "[[wall]]\nname = \"piston\"\nshape = \"box\"\nmin = [{low}, -0.1, -0.1]\nmax = [{high}, 1.1, 1.1]\ngas = \"outside\""
        );
        let motion =
            format!("[[motion]]\nwall = \"piston\"\ndirection = [1, 0, 0]\ndisplacement = [[0, 0], [1e-3, {far}]]");
        let mut doubts = model(&metre(&piston, &chamber("all", "", AIR), &motion)).plan.inventory.doubts;
        doubts.retain(|doubt| doubt.contains("no gas before it at any time of the run"));
        doubts
    };
    let told = doubts([-0.5, -0.3], 0.1);
    assert!(told[0].starts_with("motion of wall `piston`: ") && told[0].ends_with("(line 28)"), "{told:?}");
    // Flush with the vessel's wall, and away from it.
    assert_eq!(doubts([-0.2, 0.0], -0.1).len(), 1);
    for (place, far) in
        [([-0.5, -0.3], 0.5), ([-0.2, 0.0], 0.1), ([-0.2, 0.1], 0.1), ([-0.2, 0.1], -0.1), ([0.4, 0.5], 0.1)]
    {
        assert_eq!(doubts(place, far), [""; 0], "{place:?}");
    }
}

/// A surface that another wall covers for all of the run; one that a piston uncovers is none.
#[test]
fn a_covered_surface_is_told() {
    let doubts = |far: f64| {
        let piston = "[[wall]]\nname = \"piston\"\nshape = \"box\"\nmin = [-0.2, -0.1, -0.1]\nmax = [0.1, 1.1, 1.1]\ngas = \"outside\"";
        let more = format!(
            "[[motion]]\nwall = \"piston\"\ndirection = [1, 0, 0]\ndisplacement = [[0, 0], [1e-3, {far}]]\n\
             [[surface]]\nname = \"left\"\nwall = \"tank\"\nface = \"-x\"\n[[surface]]\nname = \"all\"\nwall = \"tank\"\n"
        );
        let mut doubts = model(&metre(piston, &chamber("all", "", AIR), &more)).plan.inventory.doubts;
        doubts.retain(|doubt| doubt.starts_with("surface "));
        doubts
    };
    let told = doubts(0.1);
    assert!(told.len() == 1 && told[0].contains("surface `left`: no gas lies before it"), "{told:?}");
    assert_eq!(doubts(-0.15), [""; 0]);
}

/// Keys of scenes, and what other programs call them, given as options; and a scene without a verb.
#[test]
fn a_command_line_that_cannot_be_read_is_explained() {
    for (arguments, words) in [
        (
            vec!["run", "two.toml", "--end-time", "5"],
            &["`end_time` is a key of the scene: set it in the file, before its tables", "--steps N, or --stop-after"]
                [..],
        ),
        (vec!["run", "two.toml", "--end-time=5"], &["`end_time` is a key of the scene"]),
        (vec!["run", "two.toml", "--t-end", "5"], &["`end_time` is a key of the scene"]),
        (vec!["run", "two.toml", "--dt", "5"], &["`time_step` is a key of the scene: set it in the file, in [model]"]),
        (
            vec!["plan", "two.toml", "--method", "cell"],
            &["`method` is a key of the scene: set it in the file, in [model]"],
        ),
        (vec!["run", "two.toml", "--rows", "5"], &["`rows`", "in [output]"]),
        (
            vec!["check", "two.toml", "--particles", "5"],
            &["in [model]. The verbs with an option --particles are `run`"],
        ),
        (vec!["run", "two.toml", "--np", "5"], &["`particles` is a key", "The option is --particles"]),
        (vec!["resume", "two", "--seed", "5"], &["`seed` is a key", "an option --seed are `run`"]),
        (vec!["two.toml"], &["did you mean `corpuscle run two.toml`, or `corpuscle check two.toml`?"]),
    ] {
        let (code, _, err) = outcome(&arguments);
        assert_eq!(code, 2, "{err}");
        assert!(words.iter().all(|words| err.contains(words)) && !err.contains("similar"), "{arguments:?}: {err}");
    }
    // What is like an option of the verb is clap's to tell.
    let (_, _, err) = outcome(&["run", "two.toml", "--particle-budgets", "5"]);
    assert!(err.contains("--particle-budget"), "{err}");
    let (_, _, err) = outcome(&["rum"]);
    assert!(err.contains("'run'") && !err.contains("did you mean"), "{err}");
}
