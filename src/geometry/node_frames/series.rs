//! A series of VTK files, one for each frame: ParaView's JSON lists (`.vtk.series`, `.vtu.series`, `.vtp.series`) and
//! collections (`.pvd`).

use super::error::{FrameFault, Misread, NodeFramesError, io};
use super::frames::NodeFrames;
use super::vtk_frame::VtkFrame;
use super::xml::tags;
use super::{vtk_legacy, vtk_xml};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// ParaView's form.
#[derive(Serialize, Deserialize)]
struct List {
    #[serde(rename = "file-series-version", default)]
    version: String,
    files: Vec<Entry>,
}

/// One frame: its file, relative to the list's folder, and its time.
#[derive(Serialize, Deserialize)]
struct Entry {
    name: String,
    time: f64,
}

pub(super) fn read_json(path: &Path) -> Result<NodeFrames, NodeFramesError> {
    let text = std::fs::read_to_string(path).map_err(io("read", path))?;
    let list: List = serde_json::from_str(&text).map_err(|error| {
        let place = format!("line {}", error.line());
        Misread::new(place, error.to_string(), "`{\"files\": [{\"name\": ..., \"time\": ...}, ...]}`").of(path)
    })?;
    read_files(path, list.files)
}

pub(super) fn read_collection(path: &Path) -> Result<NodeFrames, NodeFramesError> {
    let text = std::fs::read_to_string(path).map_err(io("read", path))?;
    let mut entries = Vec::new();
    for tag in tags(&text).iter().filter(|tag| tag.name == "DataSet") {
        let misread = |found: &str, expected: &str| Misread::new(tag.place(), found, expected).of(path);
        if let Some(part) = tag.get("part").filter(|part| !["", "0"].contains(part)) {
            return Err(misread(&format!("part {part}"), "one part: a frame is one file"));
        }
        let name = tag.get("file").ok_or_else(|| misread("no file", "`file=\"...\"`"))?.to_owned();
        let time = tag.get("timestep").unwrap_or_default();
        let time = time.parse().map_err(|_| misread(&format!("the timestep `{time}`"), "a number"))?;
        entries.push(Entry { name, time });
    }
    read_files(path, entries)
}

fn read_files(path: &Path, entries: Vec<Entry>) -> Result<NodeFrames, NodeFramesError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let refused = |fault: FrameFault| {
        let file = fault.frame().and_then(|frame| entries.get(frame)).map(|entry| entry.name.clone());
        NodeFramesError::Frames { path: path.into(), file, fault }
    };
    let mut positions = Vec::new();
    let mut first: Option<(usize, Vec<[u32; 3]>)> = None;
    for (frame, entry) in entries.iter().enumerate() {
        let VtkFrame { nodes, triangles } = read_file(&folder.join(&entry.name))?;
        let (expected, of_first) = first.get_or_insert_with(|| (nodes.len(), triangles.clone()));
        let (found, expected) = (nodes.len(), *expected);
        if found != expected {
            return Err(refused(FrameFault::NodeCount { frame, found, expected }));
        }
        let (found, expected) = (triangles.len(), of_first.len());
        if found != expected {
            return Err(refused(FrameFault::TriangleCount { frame, found, expected }));
        }
        if let Some(triangle) = (0..found).find(|&k| triangles[k] != of_first[k]) {
            let (found, expected) = (triangles[triangle], of_first[triangle]);
            return Err(refused(FrameFault::Connectivity { frame, triangle, found, expected }));
        }
        positions.extend(nodes);
    }
    let (nodes, triangles) = first.unwrap_or_default();
    let times = entries.iter().map(|entry| entry.time).collect();
    NodeFrames::of_parts(times, positions, nodes, triangles).map_err(refused)
}

fn read_file(path: &Path) -> Result<VtkFrame, NodeFramesError> {
    let bytes = std::fs::read(path).map_err(io("read", path))?;
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    let frame = match ending.as_str() {
        "vtk" => vtk_legacy::read(&bytes),
        "vtu" | "vtp" => vtk_xml::read(&bytes),
        _ => Err(Misread::new("", format!("the ending `{ending}`"), "`vtk`, `vtu` or `vtp`")),
    };
    frame.map_err(|misread| misread.of(path))
}

/// Writes the list `NAME.vtk.series`, and beside it `NAME_0000.vtk` and so on.
pub(super) fn write(frames: &NodeFrames, path: &Path) -> Result<(), NodeFramesError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let Some(stem) = name.strip_suffix(".vtk.series") else {
        return Err(Misread::new("", format!("frames to be written as `{name}`"), "`.nodes` or `.vtk.series`").of(path));
    };
    let digits = (frames.frame_count() - 1).to_string().len().max(4);
    let mut files = Vec::new();
    for (frame, &time) in frames.times().iter().enumerate() {
        let name = format!("{stem}_{frame:0digits$}.vtk");
        let file = path.with_file_name(&name);
        std::fs::write(&file, vtk_legacy::text(frames, frame)).map_err(io("write", &file))?;
        files.push(Entry { name, time });
    }
    let list = List { version: "1.0".into(), files };
    let text = serde_json::to_string_pretty(&list).map_err(std::io::Error::other).map_err(io("write", path))?;
    std::fs::write(path, text + "\n").map_err(io("write", path))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{MeshShape, Motion, Precision};
    use std::fs;

    fn shaken() -> NodeFrames {
        let mesh = MeshShape::Teabag { side: 0.3, elements: 4, gap: 0.02 }.mesh([0.0; 3]).unwrap();
        Motion::Shake { speed: 3.0, amplitude: None, seed: 1 }.frames(&mesh, 5, 1e-3).unwrap()
    }

    #[test]
    fn a_series_reads_back_to_the_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bag.vtk.series");
        shaken().write(&path, Precision::Double).unwrap();
        assert_eq!(NodeFrames::read(&path).unwrap(), shaken());
        // The same files as a collection.
        let sets: Vec<String> = (0..5)
            .map(|k| format!("<DataSet timestep=\"{}\" file=\"bag_000{k}.vtk\"/>", shaken().times()[k]))
            .collect();
        let path = folder.path().join("bag.pvd");
        fs::write(&path, format!("<VTKFile type=\"Collection\"><Collection>{}</Collection></VTKFile>", sets.concat()))
            .unwrap();
        assert_eq!(NodeFrames::read(&path).unwrap(), shaken());
        let bare = NodeFrames::new(vec![0.0], vec![vec![[1.0, 2.0, 3.0]]], vec![]).unwrap();
        let path = folder.path().join("bare.vtk.series");
        bare.write(&path, Precision::Double).unwrap();
        assert_eq!(NodeFrames::read(&path).unwrap(), bare);
    }

    /// Each with the file and frame that it is in.
    #[test]
    fn frames_that_do_not_fit_name_their_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bag.vtk.series");
        let refused = |name: &str, from: &str, to: &str| {
            shaken().write(&path, Precision::Double).unwrap();
            let file = folder.path().join(name);
            let text = fs::read_to_string(&file).unwrap();
            assert!(text.contains(from), "{text}");
            fs::write(&file, text.replacen(from, to, 1)).unwrap();
            NodeFrames::read(&path).unwrap_err().to_string()
        };
        let error = refused("bag_0002.vtk", "3 0 1 2", "3 1 0 2");
        let words = "(bag_0002.vtk): frame 2, triangle 0: found nodes [1, 0, 2], expected [0, 1, 2] as in frame 0";
        assert!(error.ends_with(words), "{error}");
        let error = refused("bag_0003.vtk", "POLYGONS 64 256\n3 0 1 2", "POLYGONS 63 252");
        assert!(error.ends_with("(bag_0003.vtk): frame 3: found 63 triangles, expected 64 as in frame 0"), "{error}");
        let error = refused("bag_0001.vtk", "POINTS 34 double", "POINTS 35 double\n0 0 0");
        assert!(error.ends_with("(bag_0001.vtk): frame 1: found 35 nodes, expected 34 as in frame 0"), "{error}");
        let error = refused("bag_0001.vtk", "POINTS 34 double\n", "POINTS 34 double\nnan ");
        assert!(error.contains("bag_0001.vtk"), "{error}");
        let error = refused("bag.vtk.series", "\"time\": 0.0005", "\"time\": 0.0001");
        let words = "(bag_0002.vtk): frame 2: found the time 0.0001, expected a finite one after 0.00025";
        assert!(error.contains(words), "{error}");
        let error = refused("bag.vtk.series", "bag_0004.vtk", "none.vtk");
        assert!(error.contains("cannot read") && error.contains("none.vtk"), "{error}");
        let error = refused("bag.vtk.series", "bag_0004.vtk", "bag.vtk.series");
        assert!(error.contains("found the ending `series`, expected `vtk`, `vtu` or `vtp`"), "{error}");
        let error = refused("bag.vtk.series", "\"files\"", "\"file\"");
        assert!(error.contains("missing field `files`"), "{error}");
    }

    #[test]
    fn what_cannot_be_written_or_listed_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let write = |name: &str| shaken().write(&path(name), Precision::Double).unwrap_err().to_string();
        assert!(write("bag.pvd").ends_with("expected `.nodes` or `.vtk.series`"));
        assert!(write("bag.vtu.series").ends_with("expected `.nodes` or `.vtk.series`"));
        assert!(write("bag.csv").contains("found the ending `csv`"));
        let read = |name: &str, text: &str| {
            fs::write(path(name), text).unwrap();
            NodeFrames::read(&path(name)).unwrap_err().to_string()
        };
        assert!(read("a.pvd", "").ends_with("a.pvd: found no frame, expected at least one"));
        assert!(read("b.pvd", "<DataSet timestep=\"x\" file=\"f\"/>").contains("found the timestep `x`"));
        assert!(read("c.pvd", "<DataSet timestep=\"0\" part=\"1\" file=\"f\"/>").contains("found part 1"));
        assert!(read("d.vtk.series", "{\"files\": []}").contains("found no frame"));
    }
}
