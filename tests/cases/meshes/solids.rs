//! Several solids in a file, rounding of their corners, and corners in the middle of edges.

use super::*;

const OUTER: ([f64; 3], [f64; 3]) = ([0.0; 3], [0.1; 3]);

#[test]
fn all_solids_of_a_file_are_walls() {
    let (first, second) = (cube([0.01; 3], [0.03; 3]), cube([0.05; 3], [0.09; 3]));
    let one = solid("one", &[first.clone(), second.clone()].concat());
    let two = solid("first", &first) + &solid("second", &second);
    let [one, two] = [one, two].map(|text| Mesh::new("bodies.stl", text));
    assert!(near(one.volume("outside"), 0.928) && near(two.volume("outside"), 0.928));
    let [one, two] = [one, two].map(|mesh| mesh.vessel("outside").unwrap());
    assert_eq!((one.vertices, one.triangles), (two.vertices, two.triangles));
    // The first alone would leave this.
    assert!(near(Mesh::new("first.stl", solid("first", &first)).volume("outside"), 0.992));
}

#[test]
fn a_solid_within_another_is_a_core_whichever_comes_first() {
    let outer = solid("outer", &cube(OUTER.0, OUTER.1));
    let core = solid("core", &turned(cube([0.03; 3], [0.05; 3])));
    for text in [outer.clone() + &core, core + &outer] {
        assert!(near(Mesh::new("vessel.stl", text).volume("inside"), 0.992));
    }
}

#[test]
fn patches_of_one_surface_are_joined() {
    let triangles = cube(OUTER.0, OUTER.1);
    let patches: String = triangles.chunks(2).enumerate().map(|(k, patch)| solid(&format!("p{k}"), patch)).collect();
    assert!(near(Mesh::new("patches.stl", patches).volume("inside"), 1.0));
    let lacking: String = triangles.chunks(2).skip(1).map(|patch| solid("", patch)).collect();
    assert!(Mesh::new("patches.stl", lacking).error("inside").contains("leaks: 4 edges"));
}

/// Corners that differ by 1e-18 m, and in the last digit of an f32.
#[test]
fn rounding_is_no_leak() {
    for name in ["cad_noise/noise_1e-18.stl", "cad_noise/noise_last_digit.stl"] {
        let mesh = kept(name);
        assert!(near(mesh.volume("inside"), 1.0), "{name}");
        let notes = mesh.vessel("inside").unwrap().notes(Default::default());
        assert!(notes.len() == 1 && notes[0].contains("corners welded"), "{notes:?}");
    }
    // A corner that is off by a thousandth is one.
    let mut triangles = cube(OUTER.0, OUTER.1);
    triangles[0][0][0] -= 1e-4;
    assert!(Mesh::new("leak.stl", solid("", &triangles)).error("inside").contains("leaks"));
}

/// A corner in the middle of an edge of its neighbour, in STL and OBJ, and where the neighbour's face has it as well.
#[test]
fn corners_in_the_middle_of_edges_are_accepted() {
    let middle = [0.05, 0.0, 0.0];
    let mut triangles = cube(OUTER.0, OUTER.1);
    // The first one of -y has the edge from the first corner to the second, as one of -z has.
    let [a, b, c] = triangles[4];
    triangles[4] = [a, middle, c];
    triangles.push([middle, b, c]);
    let mesh = Mesh::new("t.stl", solid("", &triangles));
    assert!(near(mesh.volume("inside"), 1.0));
    assert!(mesh.vessel("inside").unwrap().notes(Default::default())[0].contains("1 edges split"));
    let with_middle = cube_obj().replacen("f ", "v 0.05 0 0\nf ", 1).replace("f 1 2 6 5", "f 1 9 2 6 5");
    assert!(near(Mesh::new("t.obj", &with_middle).volume("inside"), 1.0));
    let both = with_middle.replace("f 1 4 3 2", "f 1 4 3 2 9");
    let vessel = Mesh::new("both.obj", both).vessel("inside").unwrap();
    assert!(vessel.walls[0].mended.is_none() && near(1e3 * vessel.gas_volume(), 1.0));
}

/// In the scene's unit, with few digits; where the file has another one, in its own numbers too.
#[test]
fn leaks_are_told_in_the_units_of_the_scene() {
    let triangles = &cube([0.0; 3], [100.0 / 3.0; 3])[1..];
    let mesh = Mesh::new("leak.stl", solid("", triangles));
    let text = mesh.scene_text("inside", "").replacen("end_time", "units = \"kg-mm-ms\"\nend_time", 1);
    let path = mesh.folder.path().join("mm.toml");
    let told = |scale: &str| {
        let text = text
            .replace("pressure = 1e5", "pressure = 1e-4")
            .replace("shape = \"mesh\"", &format!("shape = \"mesh\"\n{scale}"));
        std::fs::write(&path, text).unwrap();
        let (code, _, error) = crate::outcome(&["check", path.to_str().unwrap()]);
        assert_eq!(code, 2);
        error.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ")
    };
    let error = told("");
    assert!(
        error.contains("3 edges")
            && error.contains("in mm: (0, 0, 0) to (")
            && error.contains("(0, 33.333, 0)")
            && !error.contains("of the file"),
        "{error}"
    );
    let error = told("scale = 10");
    let own = "in the numbers of the file: (0, 0, 0) to (";
    assert!(error.contains("(0, 333.33, 0)") && error.contains(own) && error.contains("33.333"), "{error}");
}

#[test]
fn the_folder_that_is_meant_is_told() {
    let mesh = Mesh::new("there.stl", "");
    let text = mesh.scene_text("inside", "").replace("there.stl", "else/where.stl");
    let error = parse(&text, "test.toml", mesh.folder.path()).unwrap_err();
    let help = miette::Diagnostic::help(&error).map(|help| help.to_string()).unwrap_or_default();
    assert!(help.contains(&mesh.folder.path().join("else/where.stl").display().to_string()), "{help}");
}

/// Two vessels in one file are two spaces, which is no fault, but told.
#[test]
fn separate_spaces_are_a_note() {
    let two = [cube([0.0; 3], [0.1; 3]), cube([0.2; 3], [0.3; 3])].concat();
    let path = Mesh::new("two.stl", solid("two", &two));
    let scene = path.scene_file("inside", "");
    let (code, said, _) = crate::outcome(&["check", scene.to_str().unwrap()]);
    assert!(code == 0 && said.contains("note") && said.contains("2 separate gas spaces"), "{said}");
    let one = Mesh::new("one.stl", solid("one", &cube([0.0; 3], [0.1; 3])));
    let (_, said, _) = crate::outcome(&["check", one.scene_file("inside", "").to_str().unwrap()]);
    assert!(!said.contains("note"), "{said}");
}

/// A foil of 1e-7 m in a room of 1 m, and one of 1 mm.
#[test]
fn a_body_thinner_than_positions_tell_is_warned_of() {
    let warned = |thickness: f64| {
        let foil = cube([0.2, 0.2, 0.5], [0.8, 0.8, 0.5 + thickness]);
        let mesh = Mesh::new("foil.stl", solid("foil", &foil));
        let text = mesh.scene_text("outside", "").replace("max = [0.1, 0.1, 0.1]", "max = [1, 1, 1]");
        let path = mesh.folder.path().join("scene.toml");
        std::fs::write(&path, text).unwrap();
        let (code, said, error) = crate::outcome(&["plan", path.to_str().unwrap()]);
        assert_eq!(code, 0, "{error}");
        said.contains("the thinnest body")
    };
    assert!(warned(2e-7) && !warned(1e-3));
}
