//! Law: `corpuscle mesh` makes meshes that a scene can use and motion that fits them, and refuses what is neither.

use super::outcome;
use std::fs;
use tempfile::TempDir;

/// In a folder of its own; exit code, standard output and standard error.
fn made(folder: &TempDir, arguments: &str) -> (i32, String, String) {
    let in_folder = |word: &str| {
        let is_file = [".obj", ".stl", ".nodes", ".series", ".pvd", ".csv"].iter().any(|ending| word.ends_with(ending));
        if is_file { folder.path().join(word).to_str().unwrap().to_owned() } else { word.to_owned() }
    };
    let words: Vec<String> = arguments.split_whitespace().map(in_folder).collect();
    outcome(&[&["mesh"], &words.iter().map(String::as_str).collect::<Vec<_>>()[..]].concat())
}

fn sound(folder: &TempDir, arguments: &str) -> String {
    let (code, out, err) = made(folder, arguments);
    assert_eq!(code, 0, "{arguments}: {err}");
    out
}

/// A bag and its motion come from one command and fit; mm and SI are the same bag.
#[test]
fn a_bag_and_its_motion_are_made_together() {
    let folder = TempDir::new().unwrap();
    let motion = "--shake 5 --frames 11 --until 0.001";
    let text = sound(&folder, &format!("teabag --side 0.5 --elements 10 {motion} -o bag.obj -o bag.stl -o bag.nodes"));
    assert!(text.starts_with("teabag: 202 nodes, 400 triangles, closed, area 5.0"), "{text}");
    assert!(
        text.contains("  lower: 200 triangles") && text.contains("11 frames from 0.0000e0 s to 1.0000e-3 s"),
        "{text}"
    );
    assert!(text.contains("top speed 5.0000e0 m/s") && text.matches("written ").count() == 3, "{text}");
    let obj = fs::read_to_string(folder.path().join("bag.obj")).unwrap();
    assert_eq!(obj.lines().filter(|line| line.starts_with("g ")).collect::<Vec<_>>(), ["g upper", "g lower"]);
    let text = sound(&folder, "bag.nodes --speed-limit 4 -o bag.vtk.series");
    assert!(
        text.contains("nodes, 400 triangles, closed") && text.contains("note: 2020 times a node moves faster"),
        "{text}"
    );
    let again = sound(&folder, "bag.vtk.series -o again.nodes");
    assert!(again.contains("11 frames") && !again.contains("note"), "{again}");
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert_eq!(bytes("bag.nodes"), bytes("again.nodes"));
    let mm = "--units kg-mm-ms --gap 5 --shake 5 --frames 11 --until 1";
    let text = sound(&folder, &format!("teabag --side 500 --elements 10 {mm} -o mm.obj"));
    assert!(
        text.contains("area 5.0") && text.contains("e5 mm2") && text.contains("top speed 5.0000e0 mm/ms"),
        "{text}"
    );
}

/// A scene takes what is made as a wall: its gas is inside, and has the volume that was told.
#[test]
fn a_scene_takes_the_mesh() {
    let folder = TempDir::new().unwrap();
    let told = sound(&folder, "cylinder --radius 0.05 --height 0.1 --closed -o can.obj");
    let volume: f64 =
        told.lines().next().unwrap().split("volume ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    let scene = "end_time = 1e-3\n[[gas]]\nname = \"n\"\nmolar_mass = 0.028\ngamma = 1.4\n[[wall]]\nname = \"can\"\n\
        shape = \"mesh\"\nfile = \"can.obj\"\ngas = \"inside\"\n[[chamber]]\nname = \"can\"\npressure = 1e5\n\
        temperature = 300.0\ngas = \"n\"\n[model]\nparticles = 2000\n";
    let path = folder.path().join("can.toml");
    fs::write(&path, scene).unwrap();
    let (code, plan, err) = outcome(&["plan", path.to_str().unwrap()]);
    assert_eq!(code, 0, "{err}");
    let litres = format!("{:.3}", volume * 1e3);
    assert!((volume / (7.8540e-4 * 0.9972) - 1.0).abs() < 1e-3 && plan.contains(&litres[..4]), "{volume} {plan}");
}

#[test]
fn other_meshes_are_made_and_shaken() {
    let folder = TempDir::new().unwrap();
    assert!(sound(&folder, "cushion --radius 0.3 --rings 6 --center -1,2,0.5").contains("432 triangles, closed"));
    assert!(sound(&folder, "cylinder --radius 0.05 --height 0.1 --around 12 --along 3").contains("72 triangles, open"));
    let text = sound(
        &folder,
        "sphere --radius 0.1 --subdivisions 2 -o ball.stl --scale-to 0.5 --frames 3 --until 1 -o ball.nodes",
    );
    assert!(text.contains("320 triangles, closed") && text.contains("3 frames"), "{text}");
    assert!(sound(&folder, "ball.stl --shake 1 --frames 20 --until 0.01 -o s.nodes").contains("20 frames"));
    assert!(sound(&folder, "sphere --radius 100").contains("note: the mesh extends over 2.0000e2 m"));
}

#[test]
fn what_cannot_be_made_is_2_and_said() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("cut.nodes"), b"CORPNODE").unwrap();
    for (arguments, words) in [
        ("pillow --side 1", "`pillow` is no mesh: expected teabag, cushion, cylinder, sphere, or a file"),
        ("teabag", "teabag needs --side"),
        ("teabag --side -1", "teabag: the side: found -1 m, expected 0.000001 to 10000 m"),
        ("teabag --side 1 --rings 3", "teabag takes no --rings; it takes --center, --side, --elements, --gap"),
        ("teabag --side 1 --elements 1", "elements a side: found 1, expected 2 to 1000"),
        ("teabag --side 1 --frames 3", "a mesh without --shake or --scale-to takes no --frames"),
        ("teabag --side 1 --shake 3", "--frames"),
        ("teabag --side 1 -o bag.nodes", "found a mesh without motion, expected --shake or --scale-to"),
        ("teabag --side 1 -o bag.csv", "found the ending `csv`, expected `obj` or `stl`"),
        ("teabag --side 1 --shake 100 --frames 3 --until 1", "the amplitude: found 2.000e-3 m"),
        ("none.obj", "cannot read"),
        ("cut.nodes", "found 8 bytes, expected at least 44: it is cut off"),
        ("cut.nodes --side 1", "takes no --side; it takes --speed-limit"),
        ("cut.nodes --until 1", "takes no --until"),
        (
            "teabag --side 1 --speed-limit 1",
            "a mesh without --shake or --scale-to takes no --speed-limit; it takes none",
        ),
        ("sphere --radius 1 --center 1,2", "three numbers with commas"),
        ("sphere --radius 1 --units m", "SI, kg-mm-ms, t-mm-s are possible"),
    ] {
        let (code, _, err) = made(&folder, arguments);
        assert!(code == 2 && err.contains(words), "{arguments}: {code} {err}");
    }
}
