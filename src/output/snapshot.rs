//! Snapshots that ParaView opens: the particles as `snapshots/particles_000000.vtu`, ..., their times as
//! `snapshots/particles.pvd`, and the walls once as `snapshots/walls.vtp`. Surfaces that deform are beside each as `snapshots/fabric_000000.vtp`, ..., with
//! `snapshots/fabric.pvd`.
//!
//! Each particle is a vertex cell, so that thresholds and selections work on single particles. Positions
//! are f64 because fixed-point positions hold 31 bits (method.md, "Equal bits"); what is only looked at is f32.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::OutputError;
use super::error::write_atomically;
use super::membrane_fields::MembraneFields;
use super::names::{SNAPSHOT_FOLDER, is_snapshot_file};
use super::vtk::{Array, DataSet, Section};

/// One particle of a snapshot, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticleRow {
    pub id: u32,
    /// Gas index.
    pub gas: u8,
    /// m.
    pub position: [f64; 3],
    /// m/s.
    pub velocity: [f32; 3],
    /// J, of the whole particle.
    pub spin_energy: f32,
}

/// Writes the snapshots of one run, numbered from zero.
#[derive(Debug)]
pub struct SnapshotWriter {
    folder: PathBuf,
    written: Vec<Written>,
    /// So many of them are surely on the disc.
    flushed: usize,
    /// By index.
    gases: Vec<String>,
}

/// One snapshot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Written {
    /// s.
    time: f64,
    bytes: u64,
}

/// How far the snapshots had got.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SnapshotState {
    written: Vec<Written>,
}

fn file_name(index: usize) -> String {
    format!("particles_{index:06}.vtu")
}

fn fabric_name(index: usize) -> String {
    format!("fabric_{index:06}.vtp")
}

/// Triangles of walls or of fabric.
#[derive(Debug, Clone, Copy)]
pub struct TriangleSet<'a> {
    /// m.
    pub vertices: &'a [[f64; 3]],
    /// Vertex indices.
    pub triangles: &'a [[u32; 3]],
    /// Of each triangle the index of what it is of.
    pub owners: &'a [u32],
    pub names: &'a [String],
}

impl TriangleSet<'_> {
    fn check(&self) -> Result<(), OutputError> {
        let &TriangleSet { vertices, triangles, owners, .. } = self;
        if owners.len() != triangles.len() {
            return Err(OutputError::WallIndexCount { triangles: triangles.len(), indices: owners.len() });
        }
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= vertices.len()) {
                let vertices = vertices.len();
                return Err(OutputError::BadTriangle { triangle, vertex, vertices });
            }
        }
        Ok(())
    }
}

impl SnapshotWriter {
    /// Makes `snapshots` in the existing output folder `dir`.
    pub fn create(dir: &Path) -> Result<SnapshotWriter, OutputError> {
        let folder = dir.join(SNAPSHOT_FOLDER);
        std::fs::create_dir_all(&folder).map_err(OutputError::io("create", &folder))?;
        Ok(SnapshotWriter { folder, written: Vec::new(), flushed: 0, gases: Vec::new() })
    }

    /// Goes on with the snapshots in `dir`: those that were written after the state are removed, and the list of them
    /// is written anew. A snapshot that is no longer there is named in a warning and stays in the list.
    ///
    /// # Errors
    /// A snapshot is not as long as it was; then nothing is changed.
    pub fn resume(dir: &Path, state: &SnapshotState) -> Result<SnapshotWriter, OutputError> {
        let mut writer = SnapshotWriter::create(dir)?;
        for (index, Written { bytes, .. }) in state.written.iter().enumerate() {
            let path = writer.folder.join(file_name(index));
            match fs::metadata(&path) {
                Ok(found) if found.len() == *bytes => {}
                Ok(found) => {
                    return Err(OutputError::SnapshotLength { path, found: found.len(), expected: *bytes });
                }
                Err(_) => tracing::warn!("{} is not there; the list of snapshots still names it", path.display()),
            }
        }
        let kept: Vec<String> =
            (0..state.written.len()).flat_map(|index| [file_name(index), fabric_name(index)]).collect();
        for entry in fs::read_dir(&writer.folder).map_err(OutputError::io("list", &writer.folder))? {
            let path = entry.map_err(OutputError::io("list", &writer.folder))?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let numbered = name.starts_with("particles_") || name.starts_with("fabric_");
            if numbered && is_snapshot_file(&name) && !kept.contains(&name) {
                fs::remove_file(&path).map_err(OutputError::io("remove", &path))?;
            }
        }
        writer.written.clone_from(&state.written);
        writer.flushed = state.written.len();
        if !writer.written.is_empty() {
            writer.write_collection()?;
        }
        Ok(writer)
    }

    /// Names the gases, in the order of their indices, in each snapshot.
    pub fn naming(self, gases: impl IntoIterator<Item = String>) -> SnapshotWriter {
        SnapshotWriter { gases: gases.into_iter().collect(), ..self }
    }

    /// How far they have got, all of them on the disc.
    pub fn state(&mut self) -> Result<SnapshotState, OutputError> {
        for index in self.flushed..self.written.len() {
            let path = self.folder.join(file_name(index));
            fs::File::open(&path).and_then(|file| file.sync_all()).map_err(OutputError::io("flush", &path))?;
        }
        self.flushed = self.written.len();
        Ok(SnapshotState { written: self.written.clone() })
    }

    /// s, of the last one.
    pub fn last_time(&self) -> Option<f64> {
        self.written.last().map(|written| written.time)
    }

    /// Writes the particles at `time` (s) in the order given and lists the file in the collection.
    /// Returns the new file's path.
    pub fn write(&mut self, time: f64, particles: &[ParticleRow]) -> Result<PathBuf, OutputError> {
        self.write_among(time, particles, None)
    }

    /// The same with the subdomain of each particle, as an array of that name.
    pub fn write_among(
        &mut self,
        time: f64,
        particles: &[ParticleRow],
        subdomains: Option<&[u32]>,
    ) -> Result<PathBuf, OutputError> {
        let path = self.folder.join(file_name(self.written.len()));
        let mut data = particle_data(time, particles, &self.gases);
        if let Some(subdomains) = subdomains {
            let array = Array::new("subdomain", "UInt32", subdomains.iter(), |rank| [rank.to_le_bytes()]);
            data.sections[0].arrays.push(array);
        }
        write_atomically(&path, |out| data.write(out))?;
        let bytes = fs::metadata(&path).map_err(OutputError::io("measure", &path))?.len();
        self.written.push(Written { time, bytes });
        self.write_collection()?;
        Ok(path)
    }

    /// Writes the walls.
    ///
    /// Errors: a triangle that names no vertex, or another number of wall indices than of triangles.
    pub fn write_walls(&self, walls: TriangleSet<'_>) -> Result<PathBuf, OutputError> {
        walls.check()?;
        let path = self.folder.join("walls.vtp");
        let data = surface_data(["wall", "wall_names", r#" Scalars="wall""#], None, walls, None);
        write_atomically(&path, |out| data.write(out))?;
        Ok(path)
    }

    /// Writes the fabric of the last snapshot beside it, of elastic fabric with its fields.
    ///
    /// Errors: as of walls, or fields of other fabric.
    pub fn write_fabric(&self, fabric: TriangleSet<'_>, fields: Option<&MembraneFields>) -> Result<(), OutputError> {
        let Some(last) = self.written.last() else { return Ok(()) };
        fabric.check()?;
        fields.map_or(Ok(()), |fields| fields.check(fabric.vertices.len(), fabric.triangles.len()))?;
        let path = self.folder.join(fabric_name(self.written.len() - 1));
        let data = surface_data(["fabric", "fabric_names", r#" Scalars="fabric""#], Some(last.time), fabric, fields);
        write_atomically(&path, |out| data.write(out))?;
        self.write_list("fabric.pvd", fabric_name)
    }

    fn write_collection(&self) -> Result<(), OutputError> {
        self.write_list("particles.pvd", file_name)
    }

    fn write_list(&self, list: &str, file_name: impl Fn(usize) -> String) -> Result<(), OutputError> {
        write_atomically(&self.folder.join(list), |out| {
            writeln!(out, r#"<?xml version="1.0"?>"#)?;
            writeln!(out, r#"<VTKFile type="Collection" version="1.0">"#)?;
            writeln!(out, "<Collection>")?;
            for (index, Written { time, .. }) in self.written.iter().enumerate() {
                let name = file_name(index);
                writeln!(out, r#"<DataSet timestep="{time}" part="0" file="{name}"/>"#)?;
            }
            writeln!(out, "</Collection>\n</VTKFile>")
        })
    }
}

/// VTK's number for a cell of one point.
const VTK_VERTEX: u8 = 1;

fn particle_data<'a>(time: f64, particles: &'a [ParticleRow], gases: &'a [String]) -> DataSet<'a> {
    let count = particles.len();
    let rows = || particles.iter();
    let index = |i: usize| (i as i64).to_le_bytes();
    DataSet {
        kind: "UnstructuredGrid",
        counts: format!(r#"NumberOfPoints="{count}" NumberOfCells="{count}""#),
        time: Some(time),
        names: vec![("gas_names", gases)],
        sections: vec![
            Section {
                element: "PointData",
                attributes: r#" Scalars="gas" Vectors="velocity""#,
                arrays: vec![
                    Array::new("velocity", "Float32", rows(), |p| p.velocity.map(f32::to_le_bytes)).in_unit("m/s"),
                    Array::new("gas", "UInt8", rows(), |p| [[p.gas]]),
                    Array::new("spin_energy", "Float32", rows(), |p| [p.spin_energy.to_le_bytes()]).in_unit("J"),
                    Array::new("id", "UInt32", rows(), |p| [p.id.to_le_bytes()]),
                ],
            },
            Section {
                element: "Points",
                attributes: "",
                arrays: vec![
                    Array::new("position", "Float64", rows(), |p| p.position.map(f64::to_le_bytes)).in_unit("m"),
                ],
            },
            Section {
                element: "Cells",
                attributes: "",
                arrays: vec![
                    Array::new("connectivity", "Int64", 0..count, move |i| [index(i)]),
                    Array::new("offsets", "Int64", 0..count, move |i| [index(i + 1)]),
                    Array::new("types", "UInt8", 0..count, |_| [[VTK_VERTEX]]),
                ],
            },
        ],
    }
}

/// `array` is called the number of what a triangle is of, and `list` their names.
fn surface_data<'a>(
    [array, list, attributes]: [&'static str; 3],
    time: Option<f64>,
    surfaces: TriangleSet<'a>,
    fields: Option<&'a MembraneFields>,
) -> DataSet<'a> {
    let TriangleSet { vertices, triangles, owners, names } = surfaces;
    let owner = Array::new(array, "UInt32", owners.iter(), |owner| [owner.to_le_bytes()]);
    let of_triangles = std::iter::once(owner).chain(fields.into_iter().flat_map(MembraneFields::of_triangles));
    let mut data = DataSet {
        kind: "PolyData",
        counts: format!(
            r#"NumberOfPoints="{}" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="{}""#,
            vertices.len(),
            triangles.len()
        ),
        time,
        names: vec![(list, names)],
        sections: vec![
            Section { element: "CellData", attributes, arrays: of_triangles.collect() },
            Section {
                element: "Points",
                attributes: "",
                arrays: vec![
                    Array::new("position", "Float64", vertices.iter(), |vertex| vertex.map(f64::to_le_bytes))
                        .in_unit("m"),
                ],
            },
            Section {
                element: "Polys",
                attributes: "",
                arrays: vec![
                    // One list of indices: VTK refuses triples here.
                    Array::new("connectivity", "Int64", triangles.as_flattened().iter(), |&vertex| {
                        [i64::from(vertex).to_le_bytes()]
                    }),
                    Array::new("offsets", "Int64", 0..triangles.len(), |i| [(3 * (i as i64 + 1)).to_le_bytes()]),
                ],
            },
        ],
    };
    if let Some(fields) = fields {
        data.sections.insert(0, fields.of_nodes());
    }
    data
}

#[cfg(test)]
mod tests;
