//! Snapshots that ParaView opens: the particles as `snapshots/particles_000000.vtu`, ..., their times as
//! `snapshots/particles.pvd`, and the walls once as `snapshots/walls.vtp`.
//!
//! Each particle is a vertex cell, so that thresholds and selections work on single particles. Positions
//! are f64 because fixed-point positions hold 31 bits (specification, section 9); what is only looked at is f32.

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
mod tests {
    use super::*;
    use std::collections::HashMap;

    /// Arrays by name with their declared type, read by offsets alone: shares nothing with the writer.
    fn appended_arrays(bytes: &[u8]) -> HashMap<String, (String, Vec<u8>)> {
        let marker = b"<AppendedData encoding=\"raw\">\n_";
        let at = bytes.windows(marker.len()).position(|w| w == marker).unwrap();
        let (xml, block) = (std::str::from_utf8(&bytes[..at]).unwrap(), &bytes[at + marker.len()..]);
        let attribute = |line: &str, name: &str| {
            let start = line.find(&format!(" {name}=\"")).unwrap() + name.len() + 3;
            line[start..].split('"').next().unwrap().to_owned()
        };
        assert_eq!(attribute(xml, "header_type"), "UInt64");
        assert_eq!(attribute(xml, "byte_order"), "LittleEndian");
        let mut end = 0;
        let arrays = xml
            .lines()
            .filter(|line| line.contains("format=\"appended\""))
            .map(|line| {
                let offset: usize = attribute(line, "offset").parse().unwrap();
                let vector = ["position", "velocity"].contains(&attribute(line, "Name").as_str());
                let components = attribute(line, "NumberOfComponents");
                assert_eq!(components, if vector { "3" } else { "1" }, "{line}");
                assert_eq!(offset, end, "arrays follow each other");
                let length = u64::from_le_bytes(block[offset..offset + 8].try_into().unwrap());
                end = offset + 8 + length as usize;
                let values = block[offset + 8..end].to_vec();
                (attribute(line, "Name"), (attribute(line, "type"), values))
            })
            .collect();
        assert_eq!(&block[end..], b"\n</AppendedData>\n</VTKFile>\n");
        arrays
    }

    fn numbers<const N: usize, T>(array: &(String, Vec<u8>), kind: &str, decode: fn([u8; N]) -> T) -> Vec<T> {
        assert_eq!(array.0, kind);
        array.1.chunks_exact(N).map(|chunk| decode(chunk.try_into().unwrap())).collect()
    }

    fn particles() -> Vec<ParticleRow> {
        (0..3u8)
            .map(|i| ParticleRow {
                id: 4_000_000_000 + u32::from(i),
                gas: i,
                position: [0.1 * f64::from(i), -2.0, 1.0 / 3.0],
                velocity: [f32::from(i), 431.5, -0.25],
                spin_energy: 1e-3 * f32::from(i),
            })
            .collect()
    }

    #[test]
    fn a_snapshot_holds_exactly_the_particles_given() {
        let dir = tempfile::tempdir().unwrap();
        let mut writer = SnapshotWriter::create(dir.path()).unwrap();
        let given = particles();
        let path = writer.write(1.25e-3, &given).unwrap();
        assert_eq!(path, dir.path().join("snapshots/particles_000000.vtu"));
        let bytes = std::fs::read(&path).unwrap();
        let arrays = appended_arrays(&bytes);
        let back = |arrays: &HashMap<String, (String, Vec<u8>)>| {
            let position = numbers(&arrays["position"], "Float64", f64::from_le_bytes);
            let velocity = numbers(&arrays["velocity"], "Float32", f32::from_le_bytes);
            let spin_energy = numbers(&arrays["spin_energy"], "Float32", f32::from_le_bytes);
            let id = numbers(&arrays["id"], "UInt32", u32::from_le_bytes);
            let gas = numbers(&arrays["gas"], "UInt8", u8::from_le_bytes);
            (0..id.len())
                .map(|i| ParticleRow {
                    id: id[i],
                    gas: gas[i],
                    position: position[3 * i..3 * i + 3].try_into().unwrap(),
                    velocity: velocity[3 * i..3 * i + 3].try_into().unwrap(),
                    spin_energy: spin_energy[i],
                })
                .collect::<Vec<_>>()
        };
        assert_eq!(back(&arrays), given);
        assert_eq!(numbers(&arrays["connectivity"], "Int64", i64::from_le_bytes), [0, 1, 2]);
        assert_eq!(numbers(&arrays["offsets"], "Int64", i64::from_le_bytes), [1, 2, 3]);
        assert_eq!(arrays["types"].1, [VTK_VERTEX; 3]);
        // The comparison can fail: one flipped bit in the block is another particle.
        let mut damaged = bytes.clone();
        let last_id = given[2].id.to_le_bytes();
        let at = damaged.windows(4).rposition(|w| w == last_id).unwrap();
        damaged[at] ^= 1;
        assert_ne!(back(&appended_arrays(&damaged)), given);
    }

    #[test]
    fn the_collection_lists_every_snapshot_with_its_time() {
        let dir = tempfile::tempdir().unwrap();
        let mut writer = SnapshotWriter::create(dir.path()).unwrap();
        writer.write(0.0, &[]).unwrap();
        let pvd = dir.path().join("snapshots/particles.pvd");
        assert!(!std::fs::read_to_string(&pvd).unwrap().contains("particles_000001"));
        writer.write(1.0 / 3.0, &particles()).unwrap();
        let text = std::fs::read_to_string(&pvd).unwrap();
        assert!(text.contains(r#"timestep="0" part="0" file="particles_000000.vtu""#), "{text}");
        assert!(text.contains(r#"timestep="0.3333333333333333" part="0" file="particles_000001.vtu""#), "{text}");
        let mut names: Vec<_> = std::fs::read_dir(dir.path().join("snapshots"))
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        assert_eq!(names, ["particles.pvd", "particles_000000.vtu", "particles_000001.vtu"]);
    }

    fn all_files(dir: &Path) -> Vec<(String, Vec<u8>)> {
        let mut files: Vec<_> = std::fs::read_dir(dir.join(SNAPSHOT_FOLDER))
            .unwrap()
            .map(|entry| entry.unwrap())
            .map(|entry| (entry.file_name().into_string().unwrap(), std::fs::read(entry.path()).unwrap()))
            .collect();
        files.sort();
        files
    }

    /// Whatever was written after the checkpoint, the folder ends as that of a run without interruption.
    #[test]
    fn resumed_snapshots_end_as_uninterrupted_ones() {
        let whole = tempfile::tempdir().unwrap();
        let mut uninterrupted = SnapshotWriter::create(whole.path()).unwrap();
        let take = |writer: &mut SnapshotWriter, k: usize| {
            writer.write(k as f64 / 3.0, &particles()[..k.min(3)]).unwrap();
        };
        (0..4).for_each(|k| take(&mut uninterrupted, k));
        for (cut, lost) in [(0, 2), (2, 0), (2, 3), (4, 1)] {
            let dir = tempfile::tempdir().unwrap();
            let mut writer = SnapshotWriter::create(dir.path()).unwrap();
            (0..cut).for_each(|k| take(&mut writer, k));
            let state = writer.state().unwrap();
            (0..lost).for_each(|k| drop(writer.write(9.0 + k as f64, &particles()).unwrap()));
            std::fs::write(dir.path().join("snapshots/particles_000007.vtu.partial"), "half").unwrap();
            let mut resumed = SnapshotWriter::resume(dir.path(), &state).unwrap();
            assert_eq!(resumed.last_time(), (cut > 0).then(|| (cut - 1) as f64 / 3.0));
            (cut..4).for_each(|k| take(&mut resumed, k));
            assert!(all_files(dir.path()) == all_files(whole.path()), "cut {cut}, lost {lost}");
        }
    }

    /// A snapshot of another length is refused and nothing is removed; one that was moved away is no obstacle.
    #[test]
    fn a_truncated_snapshot_is_refused() {
        let dir = tempfile::tempdir().unwrap();
        let mut writer = SnapshotWriter::create(dir.path()).unwrap();
        let first = writer.write(0.0, &particles()).unwrap();
        let state = writer.state().unwrap();
        let later = writer.write(1.0, &particles()).unwrap();
        let bytes = std::fs::read(&first).unwrap();
        std::fs::write(&first, &bytes[..bytes.len() - 1]).unwrap();
        let error = SnapshotWriter::resume(dir.path(), &state).unwrap_err().to_string();
        assert!(error.contains("particles_000000.vtu") && error.contains(&bytes.len().to_string()), "{error}");
        assert!(later.exists());
        std::fs::remove_file(&first).unwrap();
        SnapshotWriter::resume(dir.path(), &state).unwrap();
        assert!(!later.exists());
    }

    #[test]
    fn walls_hold_the_triangles_given_and_refuse_bad_ones() {
        let dir = tempfile::tempdir().unwrap();
        let writer = SnapshotWriter::create(dir.path()).unwrap();
        let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let triangles = [[0, 2, 1], [0, 1, 3]];
        let names = ["box".to_owned(), "lid".to_owned()];
        let path = writer.write_walls(&vertices, &triangles, &[0, 7], &names).unwrap();
        let bytes = std::fs::read(path).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        let named = r#"Name="wall_names" NumberOfTuples="2" format="ascii">98 111 120 0 108 105 100 0 </Array>"#;
        assert!(text.contains(named), "{text}");
        let arrays = appended_arrays(&bytes);
        let corners = numbers(&arrays["connectivity"], "Int64", i64::from_le_bytes);
        assert_eq!(corners, [0, 2, 1, 0, 1, 3]);
        assert_eq!(numbers(&arrays["offsets"], "Int64", i64::from_le_bytes), [3, 6]);
        assert_eq!(numbers(&arrays["wall"], "UInt32", u32::from_le_bytes), [0, 7]);
        assert_eq!(numbers(&arrays["position"], "Float64", f64::from_le_bytes), vertices.as_flattened());
        let error = writer.write_walls(&vertices, &[[0, 1, 4]], &[0], &names).unwrap_err().to_string();
        assert_eq!(error, "triangle 0 of the walls names vertex 4, but there are 4");
        assert!(writer.write_walls(&vertices, &triangles, &[0], &names).is_err());
    }
}
