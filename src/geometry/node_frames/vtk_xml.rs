//! VTK's XML files, `.vtu` and `.vtp`: one piece, its arrays as text or as raw appended bytes (as the program's own
//! snapshots are), not compressed.

use super::error::Misread;
use super::vtk_frame::{Cells, VtkFrame, points};
use super::xml::{Tag, tags, text_of};

/// Begins the bytes behind the text.
const APPENDED: &[u8] = b"<AppendedData";

pub(super) fn read(bytes: &[u8]) -> Result<VtkFrame, Misread> {
    let begin = bytes.windows(APPENDED.len()).position(|window| window == APPENDED);
    let head = String::from_utf8_lossy(&bytes[..begin.unwrap_or(bytes.len())]);
    let tags = tags(&head);
    let file = File::new(&tags, begin.map(|begin| &bytes[begin..]))?;
    let pieces: Vec<&Tag> = tags.iter().filter(|tag| tag.name == "Piece").collect();
    let [piece] = pieces[..] else {
        return Err(Misread::new("", format!("{} pieces", pieces.len()), "one `Piece`"));
    };
    if piece.get("NumberOfStrips").is_some_and(|count| count != "0") {
        return Err(Misread::new(piece.place(), "strips of triangles", "triangles (ParaView's filter Triangulate)"));
    }
    let array = |section: &str, name: Option<&str>| {
        let begin = tags.iter().position(|tag| tag.name == section)?;
        let own = tags[begin..].iter().take_while(|tag| tag.name.strip_prefix('/') != Some(section));
        let is_it = |tag: &Tag| tag.name == "DataArray" && name.is_none_or(|name| tag.get("Name") == Some(name));
        own.enumerate().find(|(_, tag)| is_it(tag)).map(|(k, _)| begin + k)
    };
    let nodes = array("Points", None).ok_or_else(|| Misread::new("", "no points", "an array in `Points`"))?;
    let nodes = points(&file.numbers(nodes)?);
    let expected = piece.get("NumberOfPoints").unwrap_or_default();
    if nodes.len().to_string() != expected {
        return Err(Misread::new(piece.place(), format!("{} points", nodes.len()), format!("{expected}, as it says")));
    }
    let section = if tags.iter().any(|tag| tag.name == "Cells") { "Cells" } else { "Polys" };
    let integers = |name: &str| match array(section, Some(name)) {
        Some(at) => file.integers(at).map(Some),
        None => Ok(None),
    };
    let (connectivity, ends) =
        (integers("connectivity")?.unwrap_or_default(), integers("offsets")?.unwrap_or_default());
    let types = if section == "Cells" { integers("types")? } else { None };
    Ok(VtkFrame { nodes, triangles: Cells { connectivity, ends, types }.triangles()? })
}

struct File<'a> {
    tags: &'a [Tag<'a>],
    /// Behind the underscore that begins them.
    appended: Option<&'a [u8]>,
    /// Bytes of the length before each array there.
    header: usize,
}

impl<'a> File<'a> {
    /// `appended`: from the tag on.
    fn new(tags: &'a [Tag<'a>], appended: Option<&'a [u8]>) -> Result<File<'a>, Misread> {
        let root = tags.iter().find(|tag| tag.name == "VTKFile");
        let root = root.ok_or_else(|| Misread::new("", "no element `VTKFile`", "a VTK XML file"))?;
        let kind = root.get("type").unwrap_or_default();
        if !["UnstructuredGrid", "PolyData"].contains(&kind) {
            let found = format!("the type `{kind}`");
            return Err(Misread::new(root.place(), found, "`UnstructuredGrid` or `PolyData`"));
        }
        let Some(appended) = appended else { return Ok(File { tags, appended: None, header: 0 }) };
        let end = appended.iter().position(|&byte| byte == b'>');
        let opening = String::from_utf8_lossy(&appended[..end.map_or(appended.len(), |end| end + 1)]);
        if !opening.contains("\"raw\"") {
            let found = format!("`{}`", opening.trim());
            return Err(Misread::new("", found, "`encoding=\"raw\"`: encoded bytes are not read"));
        }
        if root.get("compressor").is_some() {
            return Err(Misread::new(root.place(), "compressed arrays", "arrays that are not compressed"));
        }
        if let Some(order) = root.get("byte_order").filter(|order| *order != "LittleEndian") {
            return Err(Misread::new(root.place(), format!("`{order}`"), "`LittleEndian`"));
        }
        let begin = appended.iter().position(|&byte| byte == b'_');
        let header = if root.get("header_type") == Some("UInt64") { 8 } else { 4 };
        Ok(File { tags, appended: begin.map(|begin| &appended[begin + 1..]), header })
    }

    fn integers(&self, at: usize) -> Result<Vec<i64>, Misread> {
        let numbers = self.numbers(at)?;
        match numbers.iter().find(|x| x.fract() != 0.0 || x.abs() > 1e15) {
            None => Ok(numbers.into_iter().map(|x| x as i64).collect()),
            Some(x) => Err(Misread::new(self.tags[at].place(), format!("{x}"), "whole numbers")),
        }
    }

    /// Of the array of a tag.
    fn numbers(&self, at: usize) -> Result<Vec<f64>, Misread> {
        let tag = &self.tags[at];
        match tag.get("format").unwrap_or("ascii") {
            "ascii" => {
                let text = text_of(self.tags, at);
                let number = |word: &str| {
                    let wrong = |_| Misread::new(tag.place(), format!("`{word}`"), "a number");
                    word.parse::<f64>().map_err(wrong)
                };
                text.split_whitespace().map(number).collect()
            }
            "appended" => self.raw(tag),
            other => Err(Misread::new(tag.place(), format!("the format `{other}`"), "`ascii` or `appended`")),
        }
    }

    fn raw(&self, tag: &Tag) -> Result<Vec<f64>, Misread> {
        let cut =
            |what: &str| Misread::new(tag.place(), format!("no {what} in the appended bytes"), "one: it is cut off");
        let bytes = self.appended.unwrap_or_default();
        let offset = tag.get("offset").and_then(|offset| offset.parse::<usize>().ok());
        let own = offset.and_then(|offset| bytes.get(offset..)).ok_or_else(|| cut("place of the array"))?;
        let length = own.get(..self.header).ok_or_else(|| cut("length of the array"))?;
        let length = length.iter().rev().fold(0u64, |sum, &byte| sum << 8 | u64::from(byte));
        let values = usize::try_from(length).ok().and_then(|length| own[self.header..].get(..length));
        let values = values.ok_or_else(|| cut(&format!("{length} bytes of the array")))?;
        let kind = tag.get("type").unwrap_or_default();
        decoded(kind, values).ok_or_else(|| Misread::new(tag.place(), format!("the type `{kind}`"), "numbers"))
    }
}

/// The numbers of a type of VTK's.
fn decoded(kind: &str, bytes: &[u8]) -> Option<Vec<f64>> {
    fn each<const N: usize>(bytes: &[u8], of: impl Fn([u8; N]) -> f64) -> Vec<f64> {
        bytes.as_chunks::<N>().0.iter().map(|&chunk| of(chunk)).collect()
    }
    Some(match kind {
        "Float32" => each(bytes, |b| f32::from_le_bytes(b).into()),
        "Float64" => each(bytes, f64::from_le_bytes),
        "Int8" => each(bytes, |b| i8::from_le_bytes(b).into()),
        "UInt8" => each(bytes, |b| u8::from_le_bytes(b).into()),
        "Int32" => each(bytes, |b| i32::from_le_bytes(b).into()),
        "UInt32" => each(bytes, |b| u32::from_le_bytes(b).into()),
        "Int64" => each(bytes, |b| i64::from_le_bytes(b) as f64),
        "UInt64" => each(bytes, |b| u64::from_le_bytes(b) as f64),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::{ParticleRow, SnapshotWriter, TriangleSet};

    fn refused(bytes: &[u8]) -> String {
        let Misread { place, found, expected } = read(bytes).unwrap_err();
        format!("{place}: found {found}, expected {expected}")
    }

    const TEXT: &str = r#"<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="3" NumberOfCells="2"><PointData><DataArray Name="x" format="ascii">1 2 3</DataArray></PointData>
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0.5
<InformationKey name="L2_NORM_RANGE"><Value index="0">7</Value></InformationKey></DataArray></Points>
<Cells><DataArray Name="connectivity">0 1 0 1 2</DataArray><DataArray Name="offsets">2 5</DataArray>
<DataArray Name="types">3 5</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>"#;

    /// What the program itself writes: walls with their triangles, particles as points.
    #[test]
    fn own_snapshots_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let mut writer = SnapshotWriter::create(folder.path()).unwrap();
        let vertices = [[0.1, 0.2, 0.3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0 / 3.0]];
        let triangles = [[0, 1, 2], [0, 3, 1]];
        let path = writer
            .write_walls(TriangleSet {
                vertices: &vertices,
                triangles: &triangles,
                owners: &[0, 0],
                names: &["w".into()],
            })
            .unwrap();
        let bytes = std::fs::read(path).unwrap();
        let frame = read(&bytes).unwrap();
        assert_eq!((&frame.nodes[..], &frame.triangles[..]), (&vertices[..], &triangles[..]));
        let row = |id, position| ParticleRow { id, gas: 0, position, velocity: [0.0; 3], spin_energy: 0.0 };
        let path = writer.write(0.5, &[row(0, vertices[0]), row(1, vertices[3])]).unwrap();
        let frame = read(&std::fs::read(path).unwrap()).unwrap();
        assert_eq!((frame.nodes, frame.triangles), (vec![vertices[0], vertices[3]], vec![]));
        // A third array is not whole any more.
        let cut = refused(&bytes[..bytes.len() - 60]);
        assert!(cut.contains("in the appended bytes, expected one: it is cut off"), "{cut}");
    }

    #[test]
    fn arrays_as_text_are_read() {
        let frame = read(TEXT.as_bytes()).unwrap();
        assert_eq!((frame.nodes[2], frame.triangles), ([0.0, 1.0, 0.5], vec![[0, 1, 2]]));
    }

    #[test]
    fn what_is_not_read_is_told() {
        let with = |from: &str, to: &str| {
            assert!(TEXT.contains(from));
            refused(TEXT.replacen(from, to, 1).as_bytes())
        };
        assert_eq!(refused(b"solid"), ": found no element `VTKFile`, expected a VTK XML file");
        assert!(with("\"UnstructuredGrid\"", "\"ImageData\"").contains("found the type `ImageData`"));
        assert!(
            with("NumberOfPoints=\"3\"", "NumberOfPoints=\"4\"").contains("found 3 points, expected 4, as it says")
        );
        assert!(with("0 1 0 1 2<", "0 1 0 1 x<").contains("line 5, `DataArray`: found `x`, expected a number"));
        assert!(with("0 1 0 1 2<", "0 1 0 1 .5<").contains("found 0.5, expected whole numbers"));
        assert!(with("2 5<", "2 6<").contains("cell 1: found the end 6 of its points, expected one from 2 to 5"));
        assert!(with("3 5<", "3<").contains("found 1 types of cells, expected one for each of the 2 cells"));
        assert!(with("format=\"ascii\">0 0", "format=\"binary\">0 0").contains("found the format `binary`"));
        let base64 = TEXT.to_owned() + "<AppendedData encoding=\"base64\">_AAAA</AppendedData>";
        assert!(refused(base64.as_bytes()).contains("encoded bytes are not read"));
        let raw = TEXT.replace("LittleEndian\"", "LittleEndian\" compressor=\"vtkZLibDataCompressor\"");
        let raw = raw + "<AppendedData encoding=\"raw\">_AAAA</AppendedData>";
        assert!(refused(raw.as_bytes()).contains("found compressed arrays"));
    }
}
