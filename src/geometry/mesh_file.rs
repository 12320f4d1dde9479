//! Walls from STL (binary, ASCII) and OBJ files. Vertices at equal coordinates become one; polygons become fans.

use super::GeometryError;
use super::primitives::WallMesh;
use glam::DVec3;
use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;

const STL_HEADER: usize = 84;
const STL_TRIANGLE: usize = 50;
/// That some editors begin a text with.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
/// Of a text that is quoted, characters.
const LONGEST_QUOTE: usize = 40;

/// The triangles of a file, in file units x `scale`, as they are: closedness and orientation are not looked at.
pub(super) fn read(path: &Path, scale: f64, subject: &str) -> Result<WallMesh, GeometryError> {
    let unreadable = |reason: String| GeometryError::Unreadable { wall: subject.into(), reason };
    let mut bytes = std::fs::read(path).map_err(|e| unreadable(e.to_string()))?;
    if bytes.is_empty() {
        return Err(unreadable("the file is empty".into()));
    }
    if bytes.starts_with(BYTE_ORDER_MARK) && !is_binary(&bytes) {
        bytes.drain(..BYTE_ORDER_MARK.len());
    }
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    let corners = match extension.as_deref() {
        Some("stl") => read_stl(bytes).map_err(unreadable)?,
        Some("obj") => read_obj(&bytes).map_err(unreadable)?,
        other => {
            return Err(unreadable(format!("`{}` is neither `stl` nor `obj`", other.unwrap_or(""))));
        }
    };
    Ok(weld(&corners, scale))
}

/// One vertex for all corners with the same coordinates.
fn weld(corners: &[[f32; 3]], scale: f64) -> WallMesh {
    let mut mesh = WallMesh::default();
    let mut known: BTreeMap<[u32; 3], u32> = BTreeMap::new();
    let ids: Vec<u32> = corners
        .iter()
        .map(|corner| {
            // Adding zero makes -0 and +0 the same bits.
            let key = corner.map(|x| (x + 0.0).to_bits());
            *known.entry(key).or_insert_with(|| mesh.vertex(DVec3::from(corner.map(f64::from)) * scale))
        })
        .collect();
    for t in ids.chunks_exact(3) {
        mesh.triangle([t[0], t[1], t[2]], None);
    }
    mesh
}

/// Three corners per triangle.
fn read_stl(mut bytes: Vec<u8>) -> Result<Vec<[f32; 3]>, String> {
    if is_binary(&bytes) {
        // Many programs begin a binary header with "solid", which the reader takes for ASCII.
        bytes[..5].fill(b' ');
    } else if is_text(&bytes) {
        bytes = readable(&bytes);
    } else {
        return Err(no_stl(&bytes));
    }
    let mut cursor = Cursor::new(bytes);
    let mut corners = Vec::new();
    for triangle in stl_io::create_stl_reader(&mut cursor).map_err(|e| e.to_string())? {
        corners.extend(triangle.map_err(|e| e.to_string())?.vertices.map(|v| v.0));
    }
    Ok(corners)
}

/// Whether it begins as a text and has no byte that no text has.
fn is_text(bytes: &[u8]) -> bool {
    bytes.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid")) && !bytes.contains(&0)
}

/// A text as the reader takes it for one: UTF-8, in small letters if it is in capitals, a space after the first word.
fn readable(bytes: &[u8]) -> Vec<u8> {
    let mut text = String::from_utf8_lossy(bytes).into_owned();
    if !text.starts_with("solid") {
        text.make_ascii_lowercase();
    }
    if text.as_bytes().get(5) != Some(&b' ') {
        text.insert(5, ' ');
    }
    text.into_bytes()
}

/// Of a binary file: how many triangles its header says, and how many bytes they take.
fn announced(bytes: &[u8]) -> Option<(usize, Option<usize>)> {
    let count: [u8; 4] = bytes.get(STL_HEADER - 4..STL_HEADER)?.try_into().ok()?;
    let count = u32::from_le_bytes(count) as usize;
    Some((count, count.checked_mul(STL_TRIANGLE).and_then(|n| n.checked_add(STL_HEADER))))
}

fn is_binary(bytes: &[u8]) -> bool {
    announced(bytes).is_some_and(|(_, size)| size == Some(bytes.len()))
}

/// Why what is no text is no binary file either.
fn no_stl(bytes: &[u8]) -> String {
    let size = bytes.len();
    let text = "no ASCII STL text";
    match announced(bytes) {
        None => format!("{text}, and {size} bytes are too few for a binary STL file"),
        Some((count, Some(wanted))) => format!(
            "{text}, and no binary STL file: the {count} triangles of its header take {wanted} bytes, the file has {size}"
        ),
        Some((count, None)) => {
            format!("{text}, and no binary STL file: no file has the {count} triangles of its header")
        }
    }
}

/// First words of the lines of OBJ files that say nothing of where a wall is.
const BESIDE: [&str; 19] = [
    "vt",
    "vn",
    "vp",
    "o",
    "g",
    "s",
    "mg",
    "l",
    "p",
    "mtllib",
    "usemtl",
    "maplib",
    "usemap",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
];

fn read_obj(bytes: &[u8]) -> Result<Vec<[f32; 3]>, String> {
    let text = std::str::from_utf8(bytes).map_err(|e| e.to_string())?;
    // Positions and faces are all that matters here: no material files, normals or texture coordinates.
    let mut kept = String::new();
    let mut vertices = 0;
    // Each face's line, the vertices before it, and what it says.
    let mut faces = Vec::new();
    for (first, line) in statements(text) {
        match line.split_whitespace().next() {
            Some("v" | "f") => {
                let wrong = |wanted: &str| format!("line {first}: found `{}`, allowed: {wanted}", shortened(&line));
                sound(&line).map_err(wrong)?;
                kept.extend([line.as_str(), "\n"]);
                if line.split_whitespace().next() == Some("v") {
                    vertices += 1;
                } else {
                    faces.push((first, vertices, line));
                }
            }
            Some(word) if !BESIDE.contains(&word) => {
                let word = shortened(word);
                return Err(format!("line {first}: no statement `{word}` is read; walls are of `v` and `f`"));
            }
            _ => {}
        }
    }
    for (first, before, line) in &faces {
        if let Some(index) = vertices_of(line).find(|&index| !is_there(index, *before, vertices)) {
            let there = if index > 0 { format!("{vertices} in the file") } else { format!("{before} before it") };
            return Err(format!("line {first}: found a face with vertex {index}, allowed: one of the {there}"));
        }
    }
    let options =
        tobj::LoadOptions { triangulate: true, ignore_points: true, ignore_lines: true, ..Default::default() };
    let (models, _) = tobj::load_obj_buf(&mut kept.as_bytes(), &options, |_| Err(tobj::LoadError::OpenFileFailed))
        .map_err(|e| e.to_string())?;
    let mut corners = Vec::new();
    for model in &models {
        for &index in &model.mesh.indices {
            let first = 3 * index as usize;
            let position =
                model.mesh.positions.get(first..first + 3).ok_or("a face names a vertex that is not there")?;
            corners.push([position[0], position[1], position[2]]);
        }
    }
    Ok(corners)
}

/// The statements of an OBJ file, each with its line, from 1; one that ends with a backslash goes on in the next line.
fn statements(text: &str) -> Vec<(usize, String)> {
    let mut all: Vec<(usize, String)> = Vec::new();
    let mut goes_on = false;
    for (index, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default();
        let (line, more) = line.strip_suffix('\\').map_or((line, false), |line| (line, true));
        match all.last_mut().filter(|_| goes_on) {
            Some((_, statement)) => statement.extend([" ", line]),
            None => all.push((index + 1, line.to_string())),
        }
        goes_on = more;
    }
    all
}

/// Whether a `v` or `f` can be read, or what it should be.
fn sound(line: &str) -> Result<(), &'static str> {
    let mut words = line.split_whitespace();
    if words.next() == Some("v") {
        let numbers = words.take(3).filter(|word| word.parse::<f32>().is_ok_and(f32::is_finite)).count();
        return if numbers == 3 { Ok(()) } else { Err("three numbers") };
    }
    let named = |word: &str| word.split('/').next().and_then(|index| index.parse::<i32>().ok()).is_some_and(|i| i != 0);
    if words.all(named) { Ok(()) } else { Err("numbers of vertices, from 1, or from the last with -1") }
}

/// The numbers of a face's vertices, without those of their textures and normals.
fn vertices_of(face: &str) -> impl Iterator<Item = i64> {
    face.split_whitespace().skip(1).filter_map(|word| word.split('/').next().and_then(|index| index.parse().ok()))
}

/// Numbers count from 1, or back from the last before the face with -1.
fn is_there(index: i64, before: usize, all: usize) -> bool {
    index.unsigned_abs() as usize <= if index > 0 { all } else { before }
}

fn shortened(text: &str) -> String {
    let quoted: String = text.chars().take(LONGEST_QUOTE).collect();
    quoted.trim_end().escape_debug().to_string()
}
