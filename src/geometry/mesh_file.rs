//! Walls from STL (binary, ASCII) and OBJ files. Vertices at equal coordinates become one, whichever part of the file
//! they are in: patches of one surface are joined. (Not so if each part is closed alone: bodies may touch.) What is not
//! closed then is mended ([`mend`](super::mend)).

use super::closed::is_closed;
use super::soup::{PartOf, Soup};
use super::wall_mesh::WallMesh;
use super::{GeometryError, Places, mend, obj, stl};
use crate::scene::Face;
use glam::DVec3;
use std::collections::BTreeMap;
use std::path::Path;

/// That some editors begin a text with.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The corners and the triangles of a mesh file as they stand there, in its own units: nothing is mended, and it need not be closed.
///
/// # Errors
/// If the file cannot be read, has no triangle, or a coordinate that is not finite.
pub fn read_surface(path: &Path) -> Result<(Vec<DVec3>, Vec<[u32; 3]>), GeometryError> {
    let subject = path.display().to_string();
    let mesh = weld(&soup(path, &subject)?, 1.0, |_| None);
    if mesh.triangles.is_empty() {
        return Err(GeometryError::Empty { wall: subject });
    }
    let mut wrong = mesh.vertices.iter().filter(|vertex| !vertex.is_finite());
    if let Some(&first) = wrong.next() {
        return Err(GeometryError::NotFinite { wall: subject, count: 1 + wrong.count(), first: Places::one(first) });
    }
    Ok((mesh.vertices, mesh.triangles))
}

/// The triangles of a file, in file units x `scale`; whether they are closed and how they are turned is not looked at.
/// Those of the parts called `wanted` have these as faces.
pub(super) fn read(path: &Path, scale: f64, wanted: &[String], subject: &str) -> Result<WallMesh, GeometryError> {
    let soup = soup(path, subject)?;
    // A name without a triangle is no part.
    let has_some = |name: &String| soup.parts.iter().flatten().any(|&part| soup.names[part as usize] == *name);
    if let Some(missing) = wanted.iter().find(|name| !has_some(name)) {
        let known = soup.names.iter().filter(|name| has_some(name)).cloned().collect();
        return Err(GeometryError::no_part(subject, missing, known));
    }
    let faces = faces(&soup, wanted);
    let mut mesh = weld(&soup, scale, |_| None);
    if soup.names.len() > 1 && !is_closed(&mesh.triangles) {
        // Bodies that touch have corners in common, but no surface.
        let apart = weld(&soup, scale, |triangle| soup.parts[triangle]);
        if is_closed(&apart.triangles) {
            mesh = apart;
        }
    }
    mesh.faces = faces;
    mend::mend(&mut mesh);
    Ok(mesh)
}

/// The triangles of a file.
fn soup(path: &Path, subject: &str) -> Result<Soup, GeometryError> {
    let unreadable = |reason: String| GeometryError::Unreadable { wall: subject.into(), reason };
    let mut bytes = std::fs::read(path).map_err(|e| unreadable(e.to_string()))?;
    if bytes.is_empty() {
        return Err(unreadable("the file is empty".into()));
    }
    if bytes.starts_with(BYTE_ORDER_MARK) && !stl::is_binary(&bytes) {
        bytes.drain(..BYTE_ORDER_MARK.len());
    }
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("stl") => stl::read(&bytes).map_err(unreadable),
        Some("obj") => obj::read(&bytes).map_err(unreadable),
        other => Err(unreadable(format!("`{}` is neither `stl` nor `obj`", other.unwrap_or("")))),
    }
}

/// The face of each triangle.
fn faces(soup: &Soup, wanted: &[String]) -> Vec<Option<Face>> {
    let place = |name: &String| wanted.iter().position(|other| other == name).map(|k| Face::Part(k as u32));
    let of_name: Vec<Option<Face>> = soup.names.iter().map(place).collect();
    soup.parts.iter().map(|part| part.and_then(|part| of_name[part as usize])).collect()
}

/// One vertex for all corners with the same coordinates in what is one body.
fn weld(soup: &Soup, scale: f64, body: impl Fn(usize) -> PartOf) -> WallMesh {
    let mut mesh = WallMesh::default();
    let mut known: BTreeMap<(PartOf, [u32; 3]), u32> = BTreeMap::new();
    for (index, triangle) in soup.corners.iter().enumerate() {
        let ids = triangle.map(|corner| {
            // Adding zero makes -0 and +0 the same bits.
            let key = corner.map(|x| (x + 0.0).to_bits());
            *known.entry((body(index), key)).or_insert_with(|| mesh.vertex(DVec3::from(corner.map(f64::from)) * scale))
        });
        mesh.triangle(ids, None);
    }
    mesh
}
