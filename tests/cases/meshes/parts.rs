//! Named parts of walls as surfaces and as places of vents.

use super::*;
use corpuscle::scene::to_toml;

fn area_of(vessel: &Vessel, scene: &Scene, surface: usize) -> f64 {
    let corner = |v: u32| glam::DVec3::from(vessel.vertices[v as usize]);
    let own = |t: &&corpuscle::geometry::Triangle| {
        t.wall as usize == scene.surfaces[surface].wall && t.face == scene.surfaces[surface].face
    };
    let area = |t: &corpuscle::geometry::Triangle| {
        let [a, b, c] = t.vertices.map(corner);
        (b - a).cross(c - a).length() / 2.0
    };
    vessel.triangles.iter().filter(own).map(area).sum()
}

fn surface(face: &str) -> String {
    format!("[[surface]]\nname = \"{}\"\nwall = \"v\"\nface = \"{face}\"\n", face.replace(['+', '.'], "p"))
}

/// The areas (cm2) of the parts called so.
fn areas(mesh: &Mesh, faces: &[&str]) -> Vec<f64> {
    let scene = mesh.scene("inside", &faces.iter().map(|face| surface(face)).collect::<String>());
    // What is written of the scene reads back as the same.
    assert_eq!(parse(&to_toml(&scene), "again.toml", Path::new("")).unwrap(), scene);
    let vessel = Vessel::build(&scene.walls).unwrap();
    (0..faces.len()).map(|k| 1e4 * area_of(&vessel, &scene, k)).collect()
}

fn close(found: &[f64], expected: &[f64]) -> bool {
    found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| near(*a, *b))
}

#[test]
fn solids_groups_and_objects_are_parts() {
    let box_of = cube([0.0; 3], [0.1, 0.1, 0.2]);
    let patches = solid("floor", &box_of[..2]) + &solid("lid", &box_of[2..4]) + &solid("my walls", &box_of[4..]);
    let stl = Mesh::new("box.stl", patches);
    assert!(close(&areas(&stl, &["lid", "my walls", "floor"]), &[100.0, 800.0, 100.0]));
    let faces: Vec<String> = cube_obj().lines().filter(|line| line.starts_with('f')).map(str::to_string).collect();
    let vertices: String = cube_obj().lines().filter(|l| l.starts_with('v')).map(|l| format!("{l}\n")).collect();
    let obj = format!(
        "{vertices}o vessel\n{}\n{}\ng side faces\n{}\n{}\n{}\no door\n{}\n",
        faces[0], faces[1], faces[2], faces[3], faces[4], faces[5]
    );
    let obj = Mesh::new("box.obj", obj);
    assert!(close(&areas(&obj, &["door", "vessel", "side faces"]), &[100.0, 200.0, 300.0]));
}

#[test]
fn an_unknown_part_is_refused_with_those_that_are_known() {
    let box_of = cube([0.0; 3], [0.1; 3]);
    let mesh = Mesh::new("box.stl", solid("floor", &box_of[..2]) + &solid("lid", &box_of[2..]));
    let scene = mesh.scene("inside", &surface("led"));
    let error = Vessel::build(&scene.walls).map(|v| v.gas_volume()).unwrap_err().to_string();
    assert!(error.contains("no part is called `led`; known: `floor`, `lid`"), "{error}");
    let cylinder = "shape = \"cylinder\"\nbase = [0, 0, 0]\naxis = [0, 0, 1]\nradius = 0.05\nheight = 0.1\n";
    let text = mesh.scene_text("inside", &surface("tip")).replace("shape = \"mesh\"\nfile = \"box.stl\"\n", cylinder);
    let error = parse(&text, "test.toml", Path::new("")).unwrap_err().to_string();
    assert!(error.contains("allowed: a face of a cylinder: `base`, `top`, `side`"), "{error}");
}

/// Each face of a cylinder has its area, and the mean pressure of a gas at rest; a vent on its top opens there.
#[test]
fn faces_of_a_cylinder_are_measured() {
    let mesh = Mesh::new("none.stl", "");
    let cylinder = "shape = \"cylinder\"\nbase = [0, 0, 0]\naxis = [0, 0, 1]\nradius = 0.05\nheight = 0.1\n";
    let more = ["base", "top", "side"].map(surface).concat();
    let text = mesh.scene_text("inside", &more).replace("shape = \"mesh\"\nfile = \"none.stl\"\n", cylinder);
    let text = text.replace("particles = 2000", "particles = 4000");
    let scene = parse(&text, "test.toml", Path::new("")).unwrap();
    let vessel = Vessel::build(&scene.walls).unwrap();
    let angle = std::f64::consts::TAU / 48.0;
    // The ends keep the area of the circle.
    let end = 25.0 * std::f64::consts::PI;
    let corner = 5.0 * (angle / angle.sin()).sqrt();
    let side = 48.0 * 10.0 * 2.0 * corner * (angle / 2.0).sin();
    let found: Vec<f64> = (0..3).map(|k| 1e4 * area_of(&vessel, &scene, k)).collect();
    assert!(close(&found, &[end, end, side]), "{found:?}");
    let (path, out) = (mesh.folder.path().join("scene.toml"), mesh.folder.path().join("out"));
    std::fs::write(&path, text).unwrap();
    let (code, _, error) = crate::outcome(&["run", path.to_str().unwrap(), "--out", out.to_str().unwrap(), "-q"]);
    assert_eq!(code, 0, "{error}");
    let history = std::fs::read_to_string(out.join("history.csv")).unwrap();
    let mut rows = history.lines();
    let names: Vec<&str> = rows.next().unwrap().split(',').collect();
    let rows: Vec<Vec<f64>> = rows.map(|row| row.split(',').map(|x| x.parse().unwrap_or(f64::NAN)).collect()).collect();
    for face in ["base", "top", "side"] {
        let column = names.iter().position(|name| *name == format!("{face}:pressure_pa")).unwrap();
        let later: Vec<f64> = rows.iter().map(|row| row[column]).filter(|p| *p > 0.0).collect();
        let mean = later.iter().sum::<f64>() / later.len() as f64;
        // 4000 particles hit an end some 600 times in the run: 6 % of noise.
        assert!((mean / 1e5 - 1.0).abs() < 0.25, "{face}: {mean}");
    }
}

/// The place of a vent: its area is that of the part.
#[test]
fn a_vent_has_a_part_as_its_place() {
    let box_of = cube([0.0; 3], [0.1; 3]);
    let mesh = Mesh::new("box.stl", solid("floor", &box_of[..2]) + &solid("rest", &box_of[2..]));
    let vent = "[[vent]]\nname = \"out\"\nwall = \"v\"\nface = \"floor\"\ndischarge = 0.1\n";
    let (code, said, error) = crate::outcome(&["plan", mesh.scene_file("inside", vent).to_str().unwrap()]);
    assert_eq!(code, 0, "{error}");
    assert!(said.contains("100 of 100 cm2"), "{said}");
}

/// Solids with surfaces of their own: both read back, also beside a measured one, and a name that the file does not have is
/// refused.
#[test]
fn solids_have_surfaces_of_their_own() {
    let box_of = cube([0.0; 3], [0.1; 3]);
    let mesh = Mesh::new("box.stl", solid("floor", &box_of[..2]) + &solid("rest", &box_of[2..]));
    let part = |face: &str, keys: &str| format!("[[wall.part]]\nface = \"{face}\"\n{keys}\n");
    let parts = part("rest", "friction = 0.5") + &part("floor", "temperature = 600.0");
    let scene = mesh.scene("inside", &(surface("floor") + &parts));
    assert_eq!(parse(&to_toml(&scene), "again.toml", Path::new("")).unwrap(), scene);
    let names: Vec<String> = scene.surface_ids().map(|id| scene.surface_name(id)).collect();
    assert_eq!(names, ["v", "v/rest", "v/floor"]);
    assert_eq!(scene.surfaces[0].face, Some(scene.walls[0].parts[1].face));
    let unknown = mesh.scene_file("inside", &part("flor", "temperature = 600.0"));
    let (code, said, error) = crate::outcome(&["check", unknown.to_str().unwrap()]);
    assert_ne!(code, 0, "{said}");
    let told: String = error.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(told.contains("no part is called `flor`; known: `floor`, `rest`"), "{error}");
}
