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
    let path = writer
        .write_walls(TriangleSet { vertices: &vertices, triangles: &triangles, owners: &[0, 7], names: &names })
        .unwrap();
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
    let error = writer
        .write_walls(TriangleSet { vertices: &vertices, triangles: &[[0, 1, 4]], owners: &[0], names: &names })
        .unwrap_err()
        .to_string();
    assert_eq!(error, "triangle 0 of the walls names vertex 4, but there are 4");
    assert!(
        writer
            .write_walls(TriangleSet { vertices: &vertices, triangles: &triangles, owners: &[0], names: &names })
            .is_err()
    );
}
