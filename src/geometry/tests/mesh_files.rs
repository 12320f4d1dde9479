//! Walls from files: whole ones, and every way in which a file can be wrong.

use super::*;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

type Corners = Vec<[[f32; 3]; 3]>;

/// A ball of radius 0.25 about (x, 0, 0), normals outwards.
fn ball(x: f64) -> Corners {
    let outer = Shape::Box { min: [-9.0; 3], max: [9.0; 3], thickness: None, holes: vec![] };
    let walls = [wall("tank", outer, GasSide::Inside), sphere("ball", [x, 0.0, 0.0], 0.25, 2, GasSide::Outside)];
    let vessel = Vessel::build(&walls).unwrap();
    let corner = |v: u32| vessel.vertices[v as usize].map(|c| c as f32);
    vessel.triangles.iter().filter(|t| t.wall == 1).map(|t| t.vertices.map(corner)).collect()
}

fn turned(mut corners: Corners) -> Corners {
    corners.iter_mut().for_each(|t| t.swap(0, 1));
    corners
}

fn binary_stl(corners: &Corners, header: &[u8]) -> Vec<u8> {
    let mut bytes = vec![0; 84];
    bytes[..header.len()].copy_from_slice(header);
    bytes[80..].copy_from_slice(&(corners.len() as u32).to_le_bytes());
    for t in corners {
        bytes.extend([0; 12]);
        t.iter().flatten().for_each(|c| bytes.extend(c.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn ascii_stl(corners: &Corners, first_line: &str) -> Vec<u8> {
    let mut text = format!("{first_line}\n");
    for t in corners {
        text += " facet normal 0 0 0\n  outer loop\n";
        for c in t {
            writeln!(text, "   vertex {} {} {}", c[0], c[1], c[2]).unwrap();
        }
        text += "  endloop\n endfacet\n";
    }
    (text + "endsolid\n").into_bytes()
}

/// Every triangle with its own vertices, and the texture and normal indices that many programs write.
fn obj(corners: &Corners) -> Vec<u8> {
    let mut text = String::from("mtllib missing.mtl\no ball\nvt 0 0\nvn 0 0 1\n");
    for (k, t) in corners.iter().enumerate() {
        for c in t {
            writeln!(text, "v {} {} {}", c[0], c[1], c[2]).unwrap();
        }
        writeln!(text, "f {}/1/1 {}/1/1 {}/1/1", 3 * k + 1, 3 * k + 2, 3 * k + 3).unwrap();
    }
    text.into_bytes()
}

struct Folder(TempDir);

impl Folder {
    fn new() -> Folder {
        Folder(tempfile::tempdir().unwrap())
    }

    fn file(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }
}

fn mesh(path: &Path, scale: f64, gas: GasSide) -> Wall {
    wall("mesh", Shape::Mesh { path: path.to_path_buf(), scale, parts: vec![] }, gas)
}

fn error_of(name: &str, bytes: &[u8]) -> GeometryError {
    let folder = Folder::new();
    build_error(&[mesh(&folder.file(name, bytes), 1.0, GasSide::Inside)])
}

#[test]
fn all_formats_give_the_same_vessel() {
    let folder = Folder::new();
    let corners = ball(0.0);
    let files = [
        folder.file("a.stl", &binary_stl(&corners, b"made by a test")),
        folder.file("b.STL", &binary_stl(&corners, b"solid but binary")),
        folder.file("c.stl", &ascii_stl(&corners, "solid ball")),
        folder.file("d.stl", &ascii_stl(&corners, "solid")),
        folder.file("i.stl", &[b"solid Geh\xe4use".as_slice(), &ascii_stl(&corners, "")].concat()),
        folder.file("j.stl", &ascii_stl(&corners, "solidball")),
        folder.file("k.stl", &binary_stl(&corners, b"SOLID but binary")),
        folder.file("e.obj", &obj(&corners)),
        folder.file("f.stl", ascii_stl(&corners, "solid BALL").to_ascii_uppercase().as_slice()),
        folder.file("g.obj", &[b"\xef\xbb\xbf".as_slice(), &obj(&corners)].concat()),
        folder.file("h.obj", String::from_utf8(obj(&corners)).unwrap().replace("/1/1 ", "/1/1 \\\n").as_bytes()),
    ];
    let first = Vessel::build(&[mesh(&files[0], 0.1, GasSide::Inside)]).unwrap();
    // Inscribed in a ball of 0.025 m.
    let round = 4.0 / 3.0 * std::f64::consts::PI * 0.025f64.powi(3);
    assert!(first.gas_volume() < round && first.gas_volume() > 0.93 * round);
    assert_eq!((first.vertices.len(), first.triangles.len()), (162, 320));
    assert!(first.walls[0].cavity);
    for file in &files {
        let vessel = Vessel::build(&[mesh(file, 0.1, GasSide::Inside)]).unwrap();
        assert_eq!(vessel.triangles, first.triangles, "{file:?}");
        assert_eq!(vessel.vertices, first.vertices, "{file:?}");
    }
}

#[test]
fn the_gas_is_on_the_side_that_was_asked_whatever_way_the_file_is_turned() {
    let folder = Folder::new();
    for (name, corners) in [("out.stl", ball(0.0)), ("in.stl", turned(ball(0.0)))] {
        let path = folder.file(name, &binary_stl(&corners, b""));
        let inside = Vessel::build(&[mesh(&path, 1.0, GasSide::Inside)]).unwrap();
        assert!(inside.is_gas([0.0; 3]) && !inside.is_gas([0.3, 0.0, 0.0]));
        let outer = Shape::Box { min: [-1.0; 3], max: [1.0; 3], thickness: None, holes: vec![] };
        let solid = [wall("tank", outer, GasSide::Inside), mesh(&path, 1.0, GasSide::Outside)];
        let outside = Vessel::build(&solid).unwrap();
        assert!(!outside.is_gas([0.0; 3]) && outside.is_gas([0.3, 0.0, 0.0]));
        assert!((inside.gas_volume() + outside.gas_volume() - 8.0).abs() < 1e-12);
    }
}

#[test]
fn separate_parts_are_allowed_but_not_inside_out_ones() {
    let folder = Folder::new();
    let two = [ball(0.0), ball(1.0)].concat();
    let vessel = Vessel::build(&[mesh(&folder.file("two.stl", &binary_stl(&two, b"")), 1.0, GasSide::Inside)]).unwrap();
    assert!(vessel.is_gas([0.0; 3]) && vessel.is_gas([1.0, 0.0, 0.0]) && !vessel.is_gas([0.5, 0.0, 0.0]));

    let smaller: Corners = ball(0.0).iter().map(|t| t.map(|c| c.map(|x| x / 2.0))).collect();
    // A cavity with a solid core: the core is turned the other way.
    let shell = [ball(0.0), turned(smaller.clone())].concat();
    let vessel =
        Vessel::build(&[mesh(&folder.file("shell.stl", &binary_stl(&shell, b"")), 1.0, GasSide::Inside)]).unwrap();
    assert!(!vessel.is_gas([0.0; 3]) && vessel.is_gas([0.2, 0.0, 0.0]));

    // Nested with the same orientation (one cavity in another), and one of two balls inside out.
    for parts in [[ball(0.0), smaller.clone()].concat(), [ball(0.0), turned(smaller_at(smaller, 0.6))].concat()] {
        let error = error_of("parts.stl", &binary_stl(&parts, b""));
        assert!(matches!(error, GeometryError::InsideOut { .. }), "{error}");
    }
}

fn smaller_at(mut corners: Corners, x: f32) -> Corners {
    corners.iter_mut().flatten().for_each(|c| c[0] += x);
    corners
}

#[test]
fn a_leak_names_its_edges_the_wall_and_the_file() {
    let mut corners = ball(0.0);
    corners.remove(7);
    for (name, bytes) in [("leaky.stl", binary_stl(&corners, b"")), ("leaky.obj", obj(&corners))] {
        let error = error_of(name, &bytes);
        assert!(matches!(error, GeometryError::OpenEdges { count: 3, .. }), "{error}");
        let text = error.to_string();
        assert!(text.contains("wall `mesh`") && text.contains(name) && text.contains(" to ("), "{text}");
        assert!(miette::Diagnostic::help(&error).is_some());
    }
    // One corner moved by more than rounding does.
    let mut corners = ball(0.0);
    corners[0][0][0] += 1e-5;
    assert!(matches!(error_of("shifted.stl", &binary_stl(&corners, b"")), GeometryError::OpenEdges { .. }));
    // By the least possible: the surface is closed again, and says so.
    corners[0][0][0] = 0.0f32.next_up();
    let folder = Folder::new();
    let path = folder.file("rounded.stl", &binary_stl(&corners, b""));
    let vessel = Vessel::build(&[mesh(&path, 1.0, GasSide::Inside)]).unwrap();
    assert!(vessel.walls[0].mended.is_some_and(|mended| mended.welded == 1));
}

#[test]
fn every_defect_of_a_mesh_is_its_own_error() {
    let mut one_turned = ball(0.0);
    one_turned[5].swap(1, 2);
    let doubled = [ball(0.0), ball(0.0)].concat();
    let mut not_a_number = ball(0.0);
    not_a_number[3][1][2] = f32::NAN;
    let check = |corners: &Corners| error_of("bad.stl", &binary_stl(corners, b""));
    assert!(matches!(check(&one_turned), GeometryError::Orientation { count: 3, .. }));
    assert!(matches!(check(&doubled), GeometryError::CrowdedEdges { .. }));
    assert!(matches!(check(&not_a_number), GeometryError::NotFinite { count: 1, .. }));
    assert!(matches!(check(&vec![]), GeometryError::Empty { .. }));
}

#[test]
fn files_that_are_no_meshes_are_unreadable_or_empty_and_never_panic() {
    let whole = binary_stl(&ball(0.0), b"");
    let cases: [(&str, &[u8]); 12] = [
        ("empty.stl", b""),
        ("short.stl", b"solid"),
        ("cut.stl", &whole[..whole.len() - 30]),
        ("text.stl", b"solid x\nfacet normal 0 0 z\n"),
        ("vertex.stl", b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 1 2\n"),
        ("count.stl", &[0xff; 90]),
        ("mesh.ply", b"ply"),
        ("none", b""),
        ("bounds.obj", b"v 0 0 0\nv 1 0 0\nf 1 2 9\n"),
        ("zero.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n"),
        ("words.obj", b"v a b c\n"),
        ("binary.obj", &[0xff, 0xfe, 0x00]),
    ];
    for (name, bytes) in cases {
        let error = error_of(name, bytes);
        assert!(matches!(error, GeometryError::Unreadable { .. }), "{name}: {error}");
    }
    for (name, bytes) in [("empty.obj", b"# nothing\n".as_slice()), ("line.obj", b"v 0 0 0\nv 1 0 0\nf 1 2\n")] {
        assert!(matches!(error_of(name, bytes), GeometryError::Empty { .. }), "{name}");
    }
    // What is said helps.
    let longer = [whole.as_slice(), b"xx"].concat();
    let with = |header: &str| [binary_stl(&ball(0.0), header.as_bytes()).as_slice(), b"xx"].concat();
    for (name, bytes, part) in [
        ("empty.stl", b"".as_slice(), "the file is empty"),
        ("zeros.stl", &[0; 20], "20 bytes are too few for a binary STL file"),
        ("longer.stl", &longer, "the 320 triangles of its header take 16084 bytes, the file has 16086"),
        ("cut.stl", &whole[..whole.len() - 30], "the file has 16054"),
        ("solid.stl", &with("solid x"), "the 320 triangles of its header take 16084 bytes, the file has 16086"),
        ("capitals.stl", &with("SOLID x"), "take 16084 bytes, the file has 16086"),
        ("two.obj", b"# two\n v 0 0\n", "line 2: found ` v 0 0`, allowed: three numbers"),
        ("half.obj", b"v 0 0 0\nf 1 \\\n1.5 1\n", "line 2: found `f 1  1.5 1`, allowed: numbers of vertices"),
        (
            "bounds.obj",
            b"v 0 0 0\n\nf 1/7 1 2/1/1\n",
            "line 3: found a face with vertex 2, allowed: one of the 1 in the file",
        ),
        (
            "back.obj",
            b"v 0 0 0\nf -1 -1 -2\nv 0 0 0\n",
            "line 2: found a face with vertex -2, allowed: one of the 1 before it",
        ),
        ("surface.obj", b"v 0 0 0\nsurf 0 1 0 1 1 2\n", "line 2: no statement `surf` is read"),
    ] {
        let text = error_of(name, bytes).to_string();
        assert!(text.contains(part), "{name}: {text}");
    }
    let missing = build_error(&[mesh(Path::new("no/such/file.stl"), 1.0, GasSide::Inside)]);
    assert!(missing.to_string().contains("no/such/file.stl"), "{missing}");
}
