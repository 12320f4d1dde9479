//! Dialects of STL and OBJ: each is read as the plain file is, or refused with its line and the true reason.

use super::*;

fn plain_stl() -> String {
    solid("cube", &cube([0.0; 3], [0.1; 3]))
}

#[test]
fn forms_of_stl_are_read() {
    let plain = plain_stl();
    let forms = [
        ("plain", plain.clone()),
        ("cr only", plain.replace('\n', "\r")),
        ("cr lf", plain.replace('\n', "\r\n")),
        ("end_solid", plain.replace("endsolid", "end_solid")),
        ("end solid", plain.replace("endsolid", "end solid")),
        ("blank line first", format!("\n\n{plain}")),
        ("blank first", plain.replace('\n', "\n ").replacen("solid", " solid", 1)),
        ("capitals here and there", plain.replace("endloop", "ENDLOOP").replace("vertex", "Vertex")),
        ("normal that is none", plain.replacen("normal 0 0 0", "normal nan nan nan", 1)),
        ("normal without numbers", plain.replace(" normal 0 0 0", "")),
        ("colour", plain.replacen('\n', "\n color 0.5 0.5 0.5\n", 1)),
        ("comment", plain.replacen('\n', "\n# made by hand\n", 1)),
        ("no end", plain.replace("endsolid cube\n", "")),
        ("no name", plain.replace("solid cube", "solid")),
        ("one line", plain.replacen('\n', "\u{0}", 1).replace('\n', " ").replace('\u{0}', "\n")),
        ("tabs", plain.replace(' ', "\t")),
        ("exponents", plain.replace("0.1", "1.0E-1")),
    ];
    for (form, text) in forms {
        let volume = Mesh::new("cube.stl", text).volume("inside");
        assert!(near(volume, 1.0), "{form}: {volume}");
    }
    let latin1: Vec<u8> = plain.replace("solid cube", "solid Geh\u{e4}use").chars().map(|c| c as u8).collect();
    assert!(near(Mesh::new("cube.stl", latin1).volume("inside"), 1.0));
}

#[test]
fn faults_of_stl_have_their_line() {
    let plain = plain_stl();
    let faults = [
        (plain.replacen("vertex 0 0 0", "vertex 0 0", 1), "line 4: found `vertex 0 0`, allowed: `vertex` and three"),
        (plain.replacen("vertex 0 0 0", "vertex 0 nan 0", 1), "line 4: found `vertex 0 nan 0`"),
        (plain.replacen("vertex 0 0 0", "vertx 0 0 0", 1), "line 4: found `vertx 0 0 0`"),
        (plain.replacen("   vertex 0 0 0\n", "", 1), "line 6: the facet that begins in line 2 has 2 corners"),
        (plain.replacen("  endloop\n endfacet\n", "", 1), "line 7: found `facet normal 0 0 0`"),
        (plain.replacen(" facet normal 0 0 0\n", "", 1), "line 2: found `outer loop`, allowed: `facet` before it"),
        (
            plain[..plain.rfind("  endloop").unwrap()].to_string(),
            "the file ends within the facet that begins in line 79",
        ),
    ];
    for (text, part) in faults {
        let error = Mesh::new("cube.stl", text).error("inside");
        assert!(error.contains(part), "{part}: {error}");
    }
}

/// A byte more than the header says may be a file cut or joined: the sizes are told.
#[test]
fn a_binary_file_of_another_length_is_refused_with_both() {
    let triangles = cube([0.0; 3], [0.1; 3]);
    let mut bytes = vec![b' '; 80];
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for t in &triangles {
        bytes.extend([0; 12]);
        t.iter().flatten().for_each(|c| bytes.extend((*c as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    assert!(near(Mesh::new("cube.stl", &bytes).volume("inside"), 1.0));
    bytes.push(0);
    let error = Mesh::new("cube.stl", &bytes).error("inside");
    assert!(error.contains("12 triangles of its header take 684 bytes, the file has 685"), "{error}");
}

#[test]
fn forms_of_obj_are_read() {
    let plain = cube_obj();
    let colour = plain.replace("v 0 0.1 0\n", "v 0 0.1 0 1 0 0\n");
    assert_ne!(colour, plain);
    let forms = [
        ("plain", plain.clone()),
        ("cr only", plain.replace('\n', "\r")),
        ("cr lf", plain.replace('\n', "\r\n")),
        ("colours on some", colour),
        ("four colours", plain.replace(" 0.1\nv", " 0.1 1 0 0 1\nv")),
        ("continued with a blank", plain.replace("f 1 4 ", "f 1 4 \\ \n ")),
        ("indices back", plain.replace("f 1 4 3 2", "f -8 -5 -6 -7")),
        (
            "textures in space",
            plain.replacen("f ", "vt 0 0 0\nvn 0 0 1\nf ", 1).replace("f 1 4 3 2", "f 1/1/1 4//1 3/1 2"),
        ),
        ("groups and materials", plain.replacen("f ", "o a\ng b c\nusemtl m\ns off\nf ", 1)),
        ("normals that are none", plain.replacen("f ", "vn nan nan nan\nf ", 1)),
        ("corner named twice", plain.replace("f 1 4 3 2", "f 1 1 4 3 3 2")),
    ];
    for (form, text) in forms {
        let volume = Mesh::new("cube.obj", text).volume("inside");
        assert!(near(volume, 1.0), "{form}: {volume}");
    }
    for line in ["# Geh\u{e4}use\n", "g Geh\u{e4}use\n"] {
        let latin1: Vec<u8> = format!("{line}{plain}").chars().map(|c| c as u8).collect();
        assert!(near(Mesh::new("cube.obj", latin1).volume("inside"), 1.0), "{line}");
    }
}

#[test]
fn faults_of_obj_have_their_line() {
    let plain = cube_obj();
    let faults = [
        (plain.replacen("v 0 0 0", "v 0 0 x", 1), "line 1: found `v 0 0 x`, allowed: three numbers"),
        (plain.replace("f 1 4 3 2", "f 1 4 9 2"), "line 9: found a face with vertex 9, allowed: one of the 8"),
        (plain.replace("f 1 4 3 2", "f 1 3 4 2"), "line 9: the outline of the face of 4 corners crosses"),
        (
            plain.replace("v 0 0.1 0\n", "v 0 0.1 0.05\n"),
            "line 9: the corners of the face leave its plane by 12 % of its size, allowed: at most 5 %",
        ),
        (plain.replace("f 1 4 3 2", "curv 0 1 1 2"), "line 9: no statement `curv` is read"),
    ];
    for (text, part) in faults {
        let error = Mesh::new("cube.obj", text).error("inside");
        assert!(error.contains(part), "{part}: {error}");
    }
    let utf16: Vec<u8> = plain.encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(Mesh::new("cube.obj", utf16).error("inside").contains("UTF-8"));
}
