//! Snapshots that ParaView opens: the particles as `snapshots/particles_000000.vtu`, ..., their times as
//! `snapshots/particles.pvd`, and the walls once as `snapshots/walls.vtp`.
//!
//! Each particle is a vertex cell, so that thresholds and selections work on single particles. Positions
//! are f64 because fixed-point positions hold 31 bits (method.md, "Equal bits"); what is only looked at is f32.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::OutputError;
use super::error::write_atomically;
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
        let kept: Vec<String> = (0..state.written.len()).map(file_name).collect();
        for entry in fs::read_dir(&writer.folder).map_err(OutputError::io("list", &writer.folder))? {
            let path = entry.map_err(OutputError::io("list", &writer.folder))?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if name.starts_with("particles_") && is_snapshot_file(&name) && !kept.contains(&name) {
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

    /// Writes the walls: `vertices` in m, `triangles` as vertex indices, for each triangle the index of its wall, and their names.
    ///
    /// Errors: a triangle that names no vertex, or another number of wall indices than of triangles.
    pub fn write_walls(
        &self,
        vertices: &[[f64; 3]],
        triangles: &[[u32; 3]],
        walls: &[u32],
        names: &[String],
    ) -> Result<PathBuf, OutputError> {
        if walls.len() != triangles.len() {
            return Err(OutputError::WallIndexCount { triangles: triangles.len(), indices: walls.len() });
        }
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= vertices.len()) {
                let vertices = vertices.len();
                return Err(OutputError::BadTriangle { triangle, vertex, vertices });
            }
        }
        let path = self.folder.join("walls.vtp");
        let data = wall_data(vertices, triangles, walls, names);
        write_atomically(&path, |out| data.write(out))?;
        Ok(path)
    }

    fn write_collection(&self) -> Result<(), OutputError> {
        write_atomically(&self.folder.join("particles.pvd"), |out| {
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

fn wall_data<'a>(
    vertices: &'a [[f64; 3]],
    triangles: &'a [[u32; 3]],
    walls: &'a [u32],
    names: &'a [String],
) -> DataSet<'a> {
    DataSet {
        kind: "PolyData",
        counts: format!(
            r#"NumberOfPoints="{}" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="{}""#,
            vertices.len(),
            triangles.len()
        ),
        time: None,
        names: vec![("wall_names", names)],
        sections: vec![
            Section {
                element: "CellData",
                attributes: r#" Scalars="wall""#,
                arrays: vec![Array::new("wall", "UInt32", walls.iter(), |wall| [wall.to_le_bytes()])],
            },
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
    }
}

#[cfg(test)]
mod tests;
