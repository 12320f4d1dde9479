//! Reads the snapshots of a run: which there are, the particles and the fabric of one, and the walls.

use std::fs;
use std::path::{Path, PathBuf};

use super::OutputError;
use super::names::SNAPSHOT_FOLDER;
use super::vtk_read::VtkFile;

/// A snapshot of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct SnapshotEntry {
    /// s.
    pub time: f64,
    pub path: PathBuf,
}

/// The particles of a snapshot; all lists are of one length.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// s.
    pub time: f64,
    /// By index.
    pub gas_names: Vec<String>,
    pub ids: Vec<u32>,
    /// m.
    pub positions: Vec<[f64; 3]>,
    /// m/s.
    pub velocities: Vec<[f32; 3]>,
    pub gases: Vec<u8>,
    /// Of runs among several ranks.
    pub subdomains: Option<Vec<u32>>,
}

/// Surfaces of a run: its walls as drawn, that is at its start, or its fabric at the time of a snapshot.
#[derive(Debug, Clone, PartialEq)]
pub struct SnapshotSurfaces {
    /// m.
    pub vertices: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
    /// The wall or the fabric of each triangle.
    pub owners: Vec<u32>,
    pub names: Vec<String>,
}

/// The snapshots of the run in `dir`, in the order of time; none if it has written none.
///
/// # Errors
/// If the list cannot be read.
pub fn snapshots_of(dir: &Path) -> Result<Vec<SnapshotEntry>, OutputError> {
    let folder = dir.join(SNAPSHOT_FOLDER);
    let list = folder.join("particles.pvd");
    if !list.is_file() {
        return Ok(Vec::new());
    }
    let text = fs::read_to_string(&list).map_err(OutputError::io("read", &list))?;
    let mut entries = Vec::new();
    for line in text.lines().filter(|line| line.contains("<DataSet")) {
        let attribute = |name: &str| line.split_once(&format!("{name}=\""))?.1.split('"').next();
        let time = attribute("timestep").and_then(|time| time.parse::<f64>().ok()).filter(|time| time.is_finite());
        let (Some(time), Some(file)) = (time, attribute("file")) else {
            return Err(OutputError::BadFile { path: list, problem: format!("it has the line {:?}", line.trim()) });
        };
        entries.push(SnapshotEntry { time, path: folder.join(file) });
    }
    entries.sort_by(|a, b| a.time.total_cmp(&b.time));
    Ok(entries)
}

impl Snapshot {
    /// # Errors
    /// If the file cannot be read or is none of a snapshot.
    pub fn read(entry: &SnapshotEntry) -> Result<Snapshot, OutputError> {
        let file = VtkFile::read(&entry.path)?;
        let snapshot = Snapshot {
            time: file.time().unwrap_or(entry.time),
            gas_names: file.names("gas_names"),
            ids: file.array::<u32, 1>("id")?.into_flattened(),
            positions: file.array("position")?,
            velocities: file.array("velocity")?,
            gases: file.array::<u8, 1>("gas")?.into_flattened(),
            subdomains: match file.has("subdomain") {
                true => Some(file.array::<u32, 1>("subdomain")?.into_flattened()),
                false => None,
            },
        };
        let count = snapshot.positions.len();
        let subdomains = snapshot.subdomains.as_ref().map_or(count, Vec::len);
        if [snapshot.ids.len(), snapshot.velocities.len(), snapshot.gases.len(), subdomains] != [count; 4] {
            let problem = "its arrays are of different lengths".to_owned();
            return Err(OutputError::BadFile { path: entry.path.clone(), problem });
        }
        Ok(snapshot)
    }
}

impl SnapshotSurfaces {
    /// The walls of the run in `dir`; `None` if it has written none.
    ///
    /// # Errors
    /// If the file cannot be read or is none of walls.
    pub fn walls(dir: &Path) -> Result<Option<SnapshotSurfaces>, OutputError> {
        SnapshotSurfaces::read(&dir.join(SNAPSHOT_FOLDER).join("walls.vtp"), "wall", "wall_names")
    }

    /// The fabric beside a snapshot; `None` if it has none.
    ///
    /// # Errors
    /// If the file cannot be read or is none of fabric.
    pub fn fabric(entry: &SnapshotEntry) -> Result<Option<SnapshotSurfaces>, OutputError> {
        let name = entry.path.file_stem().unwrap_or_default().to_string_lossy().replace("particles_", "fabric_");
        SnapshotSurfaces::read(&entry.path.with_file_name(name + ".vtp"), "fabric", "fabric_names")
    }

    fn read(path: &Path, owners: &str, names: &str) -> Result<Option<SnapshotSurfaces>, OutputError> {
        if !path.is_file() {
            return Ok(None);
        }
        let file = VtkFile::read(path)?;
        let broken = |problem: &str| OutputError::BadFile { path: path.to_path_buf(), problem: problem.to_owned() };
        let vertices: Vec<[f64; 3]> = file.array("position")?;
        let corners = file.array::<i64, 1>("connectivity")?.into_flattened();
        let corner = |&corner: &i64| u32::try_from(corner).ok().filter(|&corner| (corner as usize) < vertices.len());
        let corners: Option<Vec<u32>> = corners.iter().map(corner).collect();
        let corners = corners.ok_or_else(|| broken("a triangle names a vertex that is not there"))?;
        let owners = file.array::<u32, 1>(owners)?.into_flattened();
        let (triangles, rest) = corners.as_chunks::<3>();
        if !rest.is_empty() || owners.len() != triangles.len() {
            return Err(broken("its arrays are of different lengths"));
        }
        let triangles = triangles.to_vec();
        Ok(Some(SnapshotSurfaces { triangles, owners, names: file.names(names), vertices }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::{ParticleRow, SnapshotWriter, TriangleSet};

    fn row(id: u32) -> ParticleRow {
        let x = f64::from(id);
        ParticleRow {
            id,
            gas: id as u8 % 2,
            position: [x, -2.0, 1.0 / 3.0],
            velocity: [id as f32, 431.5, -0.25],
            spin_energy: 1e-3,
        }
    }

    #[test]
    fn what_was_written_is_read() {
        let dir = tempfile::tempdir().unwrap();
        assert_eq!(snapshots_of(dir.path()).unwrap(), []);
        assert_eq!(SnapshotSurfaces::walls(dir.path()).unwrap(), None);
        let names = ["air".to_owned(), "CO2 <hot>".to_owned()];
        let mut writer = SnapshotWriter::create(dir.path()).unwrap().naming(names.clone());
        let rows: Vec<ParticleRow> = (0..5).map(row).collect();
        writer.write(0.0, &[]).unwrap();
        writer.write_among(2.5e-3, &rows, Some(&[0, 1, 1, 0, 2])).unwrap();
        let (vertices, triangles) = ([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]], [[0, 1, 2], [2, 1, 0]]);
        let walls = TriangleSet { vertices: &vertices, triangles: &triangles, owners: &[0, 1], names: &names };
        writer.write_walls(walls).unwrap();

        let list = snapshots_of(dir.path()).unwrap();
        assert_eq!(list.iter().map(|entry| entry.time).collect::<Vec<_>>(), [0.0, 2.5e-3]);
        assert_eq!(Snapshot::read(&list[0]).unwrap().positions.len(), 0);
        let read = Snapshot::read(&list[1]).unwrap();
        assert_eq!((read.time, &read.gas_names[..]), (2.5e-3, &names[..]));
        assert_eq!(read.positions, rows.iter().map(|row| row.position).collect::<Vec<_>>());
        assert_eq!(read.velocities, rows.iter().map(|row| row.velocity).collect::<Vec<_>>());
        assert_eq!((read.gases, read.ids), (vec![0, 1, 0, 1, 0], vec![0, 1, 2, 3, 4]));
        assert_eq!(read.subdomains, Some(vec![0, 1, 1, 0, 2]));
        let walls = SnapshotSurfaces::walls(dir.path()).unwrap().unwrap();
        let expected = SnapshotSurfaces {
            vertices: vertices.to_vec(),
            triangles: triangles.to_vec(),
            owners: vec![0, 1],
            names: names.to_vec(),
        };
        assert_eq!(walls, expected);

        // Fabric has a file of the same form beside each snapshot.
        assert_eq!(SnapshotSurfaces::fabric(&list[1]).unwrap(), None);
        let bytes = fs::read(dir.path().join("snapshots/walls.vtp")).unwrap();
        let text =
            bytes.iter().map(|&byte| char::from(byte)).collect::<String>().replace("Name=\"wall", "Name=\"fabric");
        let bytes: Vec<u8> = text.chars().map(|c| c as u8).collect();
        fs::write(dir.path().join("snapshots/fabric_000001.vtp"), bytes).unwrap();
        assert_eq!(SnapshotSurfaces::fabric(&list[1]).unwrap(), Some(expected));
    }

    #[test]
    fn a_broken_file_is_named_with_what_is_wrong() {
        let dir = tempfile::tempdir().unwrap();
        let mut writer = SnapshotWriter::create(dir.path()).unwrap();
        let path = writer.write(0.0, &(0..5).map(row).collect::<Vec<_>>()).unwrap();
        let entry = SnapshotEntry { time: 0.0, path: path.clone() };
        let whole = fs::read(&path).unwrap();
        let told = |bytes: &[u8]| {
            fs::write(&path, bytes).unwrap();
            Snapshot::read(&entry).unwrap_err().to_string()
        };
        let replaced = |from: &str, to: &str| {
            let text: Vec<u8> = whole.clone();
            let at = text.windows(from.len()).position(|window| window == from.as_bytes()).unwrap();
            [&text[..at], to.as_bytes(), &text[at + from.len()..]].concat()
        };
        assert!(told(b"<VTKFile>").contains("it has no block of raw arrays"));
        assert!(told(&whole[..whole.len() - 400]).contains("it ends within its array"));
        assert!(told(&replaced("\"velocity\" NumberOf", "\"speed\" NumberOf")).contains("no array `velocity`"));
        let kinds = told(&replaced("\"Float64\" Name=\"position\"", "\"Float32\" Name=\"position\""));
        assert!(kinds.contains("3 of Float32, expected 3 of Float64"), "{kinds}");
        let list = dir.path().join("snapshots/particles.pvd");
        fs::write(&list, "<DataSet timestep=\"soon\" file=\"x\"/>").unwrap();
        assert!(snapshots_of(dir.path()).unwrap_err().to_string().contains("soon"));
    }
}
