//! OBJ files: positions and faces, and the names of groups and objects. Normals, textures, colours and materials say
//! nothing of where a wall is.
//!
//! A face of more than three corners becomes triangles in its own plane ([`facet`](super::facet)). A part is a group
//! (`g`, all of its line), or an object (`o`) where no group was named in it.

use super::facet::{Fault, triangulated};
use super::soup::{PartOf, Soup, lines, quoted};
use glam::DVec3;

/// First words of the lines of OBJ files that say nothing of where a wall is.
const BESIDE: [&str; 17] = [
    "vt",
    "vn",
    "vp",
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

struct Face {
    line: usize,
    /// Places of its corners in the file, from 0.
    corners: Vec<usize>,
    part: PartOf,
}

/// The mesh of a file with the numbers of its nodes, in file units.
pub(super) struct Mesh {
    pub nodes: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
    pub parts: Vec<PartOf>,
    /// No two alike, in the order of the file.
    pub names: Vec<String>,
}

/// What of a file is a mesh: as `f32`, corners by their place.
pub(super) fn read(bytes: &[u8]) -> Result<Soup, String> {
    let mut file = parse(bytes)?;
    for face in std::mem::take(&mut file.faces) {
        for triangle in triangles_of(&file.places, &face)? {
            file.soup.triangle(triangle.map(|k| file.places[k]), face.part);
        }
    }
    Ok(file.soup)
}

/// The same as `f64`, corners by their number.
pub(super) fn read_mesh(bytes: &[u8]) -> Result<Mesh, String> {
    let File { places, exact, faces, soup } = parse(bytes)?;
    let mut mesh = Mesh { nodes: exact, triangles: Vec::new(), parts: Vec::new(), names: soup.names };
    for face in &faces {
        for triangle in triangles_of(&places, face)? {
            mesh.triangles.push(triangle.map(|k| k as u32));
            mesh.parts.push(face.part);
        }
    }
    Ok(mesh)
}

/// A file before its faces are triangles.
struct File {
    places: Vec<[f32; 3]>,
    /// The same, as precise as they are written.
    exact: Vec<[f64; 3]>,
    faces: Vec<Face>,
    /// Has the names of the parts.
    soup: Soup,
}

fn parse(bytes: &[u8]) -> Result<File, String> {
    if bytes.contains(&0) {
        return Err("no OBJ text: it has bytes of value 0 (save it as UTF-8)".into());
    }
    let mut soup = Soup::default();
    let (mut places, mut exact): (Vec<[f32; 3]>, Vec<[f64; 3]>) = (Vec::new(), Vec::new());
    let mut faces: Vec<Face> = Vec::new();
    let (mut object, mut group) = (None, None);
    // The face that names the vertex farthest ahead: its line, and the vertex.
    let mut ahead: Option<(usize, i64)> = None;
    for (line, statement) in statements(&super::soup::decoded(bytes)) {
        let mut words = statement.split_whitespace();
        let wrong = |allowed: &str| format!("line {line}: found `{}`, allowed: {allowed}", quoted(&statement));
        match words.next() {
            Some("v") => {
                let mut number = || {
                    let word = words.next()?;
                    word.parse::<f32>().ok().filter(|x| x.is_finite()).zip(word.parse::<f64>().ok())
                };
                let place = (|| Some([number()?, number()?, number()?]))();
                let place = place.ok_or_else(|| wrong("three numbers"))?;
                places.push(place.map(|(single, _)| single));
                exact.push(place.map(|(_, double)| double));
            }
            Some("f") => {
                let mut corners = Vec::new();
                for word in words {
                    let index = word.split('/').next().and_then(|index| index.parse::<i64>().ok());
                    let index = index.filter(|&index| index != 0 && i32::try_from(index).is_ok());
                    let index = index.ok_or_else(|| wrong("numbers of vertices, from 1, or from the last with -1"))?;
                    let place = if index > 0 { index - 1 } else { places.len() as i64 + index };
                    if place < 0 {
                        let before = places.len();
                        return Err(format!(
                            "line {line}: found a face with vertex {index}, allowed: one of the {before} before it"
                        ));
                    }
                    if place as usize >= places.len() && ahead.is_none_or(|(_, most)| index > most) {
                        ahead = Some((line, index));
                    }
                    corners.push(place as usize);
                }
                faces.push(Face { line, corners, part: group.or(object) });
            }
            Some("o") => (object, group) = (soup.part(&joined(words)), None),
            Some("g") => group = soup.part(&joined(words)),
            Some(word) if !BESIDE.contains(&word) => {
                let word = quoted(word);
                return Err(format!("line {line}: no statement `{word}` is read; walls are of `v` and `f`"));
            }
            _ => {}
        }
    }
    if let Some((line, index)) = ahead.filter(|(_, index)| *index > places.len() as i64) {
        let count = places.len();
        return Err(format!("line {line}: found a face with vertex {index}, allowed: one of the {count} in the file"));
    }
    Ok(File { places, exact, faces, soup })
}

fn joined<'a>(words: impl Iterator<Item = &'a str>) -> String {
    words.collect::<Vec<_>>().join(" ")
}

/// Triangles of places in the file.
fn triangles_of(places: &[[f32; 3]], face: &Face) -> Result<Vec<[usize; 3]>, String> {
    let corners: Vec<DVec3> = face.corners.iter().map(|&k| DVec3::from(places[k].map(f64::from))).collect();
    let triangles = triangulated(&corners).map_err(|fault| {
        let (line, count) = (face.line, face.corners.len());
        match fault {
            Fault::Crossed => format!(
                "line {line}: the outline of the face of {count} corners crosses or touches itself, allowed: a simple polygon"
            ),
            Fault::Warped { off } => format!(
                "line {line}: the corners of the face leave its plane by {:.0} % of its size, allowed: at most {:.0} % (split it into triangles)",
                100.0 * off,
                100.0 * super::facet::MOST_WARP
            ),
        }
    })?;
    Ok(triangles.into_iter().map(|triangle| triangle.map(|k| face.corners[k])).collect())
}

/// The statements of an OBJ file, each with its line, from 1; one that ends with a backslash goes on in the next line.
fn statements(text: &str) -> Vec<(usize, String)> {
    let mut all: Vec<(usize, String)> = Vec::new();
    let mut goes_on = false;
    for (index, line) in lines(text).enumerate() {
        let line = line.split('#').next().unwrap_or_default().trim_end();
        let (line, more) = line.strip_suffix('\\').map_or((line, false), |line| (line, true));
        match all.last_mut().filter(|_| goes_on) {
            Some((_, statement)) => statement.extend([" ", line]),
            None => all.push((index + 1, line.to_string())),
        }
        goes_on = more;
    }
    all
}
