//! Walls from STL (binary, ASCII) and OBJ files. Vertices at equal coordinates become one; polygons become fans.

use super::GeometryError;
use super::primitives::WallMesh;
use glam::DVec3;
use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;

const STL_HEADER: usize = 84;
const STL_TRIANGLE: usize = 50;

/// The triangles of a file, in file units x `scale`, as they are: closedness and orientation are not looked at.
pub(super) fn read(path: &Path, scale: f64, subject: &str) -> Result<WallMesh, GeometryError> {
    let unreadable = |reason: String| GeometryError::Unreadable { wall: subject.into(), reason };
    let bytes = std::fs::read(path).map_err(|e| unreadable(e.to_string()))?;
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    let corners = match extension.as_deref() {
        Some("stl") => read_stl(bytes).map_err(|e| unreadable(e.to_string()))?,
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
fn read_stl(mut bytes: Vec<u8>) -> std::io::Result<Vec<[f32; 3]>> {
    if is_binary(&bytes) {
        // Many programs begin a binary header with "solid", which the reader takes for ASCII.
        bytes[..5].fill(b' ');
    } else if bytes.starts_with(b"solid") && bytes.get(5).is_some_and(|b| matches!(b, b'\n' | b'\r' | b'\t')) {
        // A name is optional, but the reader wants a space.
        bytes.insert(5, b' ');
    }
    let mut cursor = Cursor::new(bytes);
    let mut corners = Vec::new();
    for triangle in stl_io::create_stl_reader(&mut cursor)? {
        corners.extend(triangle?.vertices.map(|v| v.0));
    }
    Ok(corners)
}

fn is_binary(bytes: &[u8]) -> bool {
    let Some(count) = bytes.get(STL_HEADER - 4..STL_HEADER) else {
        return false;
    };
    let count = u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize;
    count.checked_mul(STL_TRIANGLE).and_then(|n| n.checked_add(STL_HEADER)) == Some(bytes.len())
}

fn read_obj(bytes: &[u8]) -> Result<Vec<[f32; 3]>, String> {
    let text = std::str::from_utf8(bytes).map_err(|e| e.to_string())?;
    // Positions and faces are all that matters here: no material files, normals or texture coordinates.
    let kept: String = text
        .lines()
        .filter(|line| matches!(line.split_whitespace().next(), Some("v" | "f")))
        .flat_map(|line| [line, "\n"])
        .collect();
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
