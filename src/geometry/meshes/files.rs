//! Meshes as files: OBJ (a group for each part) and ASCII STL (a solid for each part).
//!
//! Numbers are written with the fewest digits that read back to the same bits. What is read keeps the numbers of its nodes:
//! of OBJ those of the file, in f64; of STL corners at equal places are one, in the order of the file.

use super::error::MeshError;
use super::mesh::TriangleMesh;
use crate::geometry::{obj, soup, stl};
use glam::DVec3;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

impl TriangleMesh {
    /// Reads an OBJ or STL file, in the units of the file. Whether it is closed is not looked at.
    ///
    /// # Errors
    /// The file cannot be read, or has no triangles.
    pub fn read(path: &Path) -> Result<TriangleMesh, MeshError> {
        let unreadable = |reason: String| MeshError::Unreadable { path: path.into(), reason };
        let read = ending(path)?;
        let bytes = std::fs::read(path).map_err(|error| MeshError::Io {
            action: "read",
            path: path.into(),
            reason: error.to_string(),
        })?;
        let mesh =
            match read {
                Ending::Obj => obj::read_mesh(&bytes).map(|obj::Mesh { nodes, triangles, parts, names }| {
                    TriangleMesh { nodes, triangles, parts, names }
                }),
                Ending::Stl => stl::read(&bytes).map(joined),
            }
            .map_err(unreadable)?;
        if mesh.triangles.is_empty() {
            return Err(unreadable("there are no triangles in it".into()));
        }
        if let Some(node) = mesh.nodes.iter().position(|node| !node.iter().all(|x| x.is_finite())) {
            return Err(unreadable(format!("node {node}: found {:?}, expected finite numbers", mesh.nodes[node])));
        }
        Ok(mesh)
    }

    /// Writes an OBJ or STL file, by its ending, with lengths over `unit` (m).
    pub fn write(&self, path: &Path, unit: f64) -> Result<(), MeshError> {
        let text = match ending(path)? {
            Ending::Obj => self.to_obj(unit),
            Ending::Stl => self.to_stl(unit),
        };
        std::fs::write(path, text).map_err(|error| MeshError::Io {
            action: "write",
            path: path.into(),
            reason: error.to_string(),
        })
    }

    fn to_obj(&self, unit: f64) -> String {
        let mut text = String::new();
        for node in &self.nodes {
            let [x, y, z] = node.map(|x| x / unit);
            let _ = writeln!(text, "v {x} {y} {z}");
        }
        let mut before = None;
        for (t, part) in self.triangles.iter().zip(&self.parts) {
            if *part != before {
                // A group without a name is none.
                let name = part.map_or("", |part| &self.names[part as usize]);
                let _ = writeln!(text, "{}", format!("g {name}").trim_end());
            }
            before = *part;
            let _ = writeln!(text, "f {} {} {}", t[0] + 1, t[1] + 1, t[2] + 1);
        }
        text
    }

    fn to_stl(&self, unit: f64) -> String {
        let mut text = String::new();
        let mut begin = 0;
        for same in self.parts.chunk_by(|a, b| a == b) {
            let name = same[0].map_or("", |part| &self.names[part as usize]);
            let _ = writeln!(text, "solid {name}");
            for t in &self.triangles[begin..begin + same.len()] {
                let corners = t.map(|v| self.nodes[v as usize].map(|x| x / unit));
                let [a, b, c] = corners.map(DVec3::from);
                let normal = (b - a).cross(c - a).normalize_or_zero();
                let _ = writeln!(text, "facet normal {} {} {}\nouter loop", normal.x, normal.y, normal.z);
                for [x, y, z] in corners {
                    let _ = writeln!(text, "vertex {x} {y} {z}");
                }
                text += "endloop\nendfacet\n";
            }
            let _ = writeln!(text, "endsolid {name}");
            begin += same.len();
        }
        text
    }
}

#[derive(Clone, Copy)]
enum Ending {
    Obj,
    Stl,
}

fn ending(path: &Path) -> Result<Ending, MeshError> {
    let found = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    match found.as_str() {
        "obj" => Ok(Ending::Obj),
        "stl" => Ok(Ending::Stl),
        _ => Err(MeshError::Ending { path: path.into(), found }),
    }
}

/// One node for all corners at the same place.
fn joined(soup: soup::Soup) -> TriangleMesh {
    let mut mesh = TriangleMesh { parts: soup.parts, names: soup.names, ..TriangleMesh::default() };
    let mut known: BTreeMap<[u32; 3], u32> = BTreeMap::new();
    for corners in soup.corners {
        let triangle = corners.map(|corner| {
            // Adding zero makes -0 and +0 the same bits.
            let key = corner.map(|x| (x + 0.0).to_bits());
            *known.entry(key).or_insert_with(|| mesh.node(DVec3::from(corner.map(f64::from))))
        });
        mesh.triangles.push(triangle);
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::meshes::MeshShape;

    const BAG: MeshShape = MeshShape::Teabag { side: 0.37, elements: 5, gap: 0.003 };
    const CAN: MeshShape = MeshShape::Cylinder { radius: 0.1, height: 0.3, around: 9, along: None, closed: true };

    #[test]
    fn an_obj_file_reads_back_to_the_same_bits() {
        let folder = tempfile::tempdir().unwrap();
        for (shape, name) in [(BAG, "bag.obj"), (CAN, "can.OBJ")] {
            let (mesh, path) = (shape.mesh([0.1, 0.2, 0.3]).unwrap(), folder.path().join(name));
            mesh.write(&path, 1.0).unwrap();
            assert_eq!(TriangleMesh::read(&path).unwrap(), mesh);
        }
    }

    #[test]
    fn triangles_of_no_part_stay_so() {
        let folder = tempfile::tempdir().unwrap();
        let mut mesh = BAG.mesh([0.0; 3]).unwrap();
        mesh.parts[60..].fill(None);
        for name in ["bag.obj", "bag.stl"] {
            let path = folder.path().join(name);
            mesh.write(&path, 1.0).unwrap();
            assert_eq!(TriangleMesh::read(&path).unwrap().parts, mesh.parts, "{name}");
        }
        let parts = mesh.measures();
        assert_eq!((parts[1].triangles, parts[2].name.as_str(), parts[2].triangles), (10, "", 40));
    }

    /// STL has no numbers; joined in the order of the file, nodes get those of the mesh.
    #[test]
    fn an_stl_file_gives_nodes_the_same_numbers() {
        let folder = tempfile::tempdir().unwrap();
        for shape in [BAG, CAN, MeshShape::Sphere { radius: 0.2, subdivisions: 2 }] {
            let (mesh, path) = (shape.mesh([0.0; 3]).unwrap(), folder.path().join("mesh.stl"));
            mesh.write(&path, 1e-3).unwrap();
            let read = TriangleMesh::read(&path).unwrap();
            assert_eq!((&read.triangles, &read.parts, &read.names), (&mesh.triangles, &mesh.parts, &mesh.names));
            for (found, node) in read.nodes.iter().flatten().zip(mesh.nodes.iter().flatten()) {
                assert!((found / 1e3 - node).abs() < 1e-7, "{found} {node}");
            }
        }
    }

    /// Walls of scenes read the same files: they find them closed, with nothing to mend.
    #[test]
    fn walls_take_these_files_as_they_are() {
        let folder = tempfile::tempdir().unwrap();
        for (shape, name) in [(BAG, "bag.obj"), (BAG, "bag.stl"), (CAN, "can.obj"), (CAN, "can.stl")] {
            let (mesh, path) = (shape.mesh([0.0; 3]).unwrap(), folder.path().join(name));
            mesh.write(&path, 1.0).unwrap();
            let wall = crate::geometry::mesh_file::read(&path, 1.0, &mesh.names, "wall").unwrap();
            assert_eq!((&wall.triangles, wall.mended), (&mesh.triangles, None), "{name}");
            assert!(wall.faces.iter().all(Option::is_some));
        }
    }

    #[test]
    fn what_is_no_mesh_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let read = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).unwrap();
            TriangleMesh::read(&path).unwrap_err().to_string()
        };
        assert!(read("a.ply", "ply").contains("found the ending `ply`, expected `obj` or `stl`"));
        assert!(read("a.obj", "v 0 0 0\n").contains("no triangles"));
        assert!(read("b.obj", "v 0 0\n").contains("line 1: found `v 0 0`, allowed: three numbers"));
        assert!(read("c.obj", "v 0 0 0\nf 1 2 3\n").contains("found a face with vertex 3"));
        assert!(read("d.stl", "solid\nfacet\n").contains("ends within the facet"));
        assert!(TriangleMesh::read(Path::new("/none/none.obj")).unwrap_err().to_string().contains("cannot read"));
    }
}
