//! Reads the VTK XML files that [`super::vtk`] writes: raw appended data, little endian, lengths as u64.
//!
//! Only the head is held; an array is read when it is asked for. Whatever is not as it was written (a file that was cut
//! off, an array that is missing or of another kind) is an error with the file's name.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use super::OutputError;

/// Between the head and the data.
const MARK: &[u8] = b"<AppendedData encoding=\"raw\">\n_";
/// A head is no longer than this: lists of names are all that grows in it.
const LONGEST_HEAD: usize = 16 << 20;
const CHUNK: usize = 1 << 16;

/// An open file.
pub(super) struct VtkFile {
    path: PathBuf,
    file: File,
    head: String,
    /// Of the data, in the file.
    start: u64,
}

/// What the head says of an array.
struct Described<'a> {
    kind: &'a str,
    components: usize,
    offset: u64,
}

impl VtkFile {
    /// # Errors
    /// If there is none, or it is no such file.
    pub fn open(path: &Path) -> Result<VtkFile, OutputError> {
        let mut file = File::open(path).map_err(OutputError::io("open", path))?;
        let mut bytes = Vec::new();
        loop {
            let before = bytes.len();
            (&mut file).take(CHUNK as u64).read_to_end(&mut bytes).map_err(OutputError::io("read", path))?;
            let from = before.saturating_sub(MARK.len());
            if let Some(at) = bytes[from..].windows(MARK.len()).position(|window| window == MARK) {
                let head = String::from_utf8_lossy(&bytes[..from + at]).into_owned();
                let start = (from + at + MARK.len()) as u64;
                return Ok(VtkFile { path: path.to_path_buf(), file, head, start });
            }
            if bytes.len() == before || bytes.len() > LONGEST_HEAD {
                let problem = format!("{} bytes, and no `<AppendedData encoding=\"raw\">` in them", bytes.len());
                return Err(OutputError::BadSnapshot { path: path.to_path_buf(), problem });
            }
        }
    }

    pub fn bad(&self, problem: String) -> OutputError {
        OutputError::BadSnapshot { path: self.path.clone(), problem }
    }

    /// One of the counts on the piece: `NumberOfPoints`, `NumberOfPolys`.
    pub fn count(&self, name: &str) -> Result<u64, OutputError> {
        let found = attribute(&self.head, name).and_then(|text| text.parse().ok());
        found.ok_or_else(|| self.bad(format!("no number {name}")))
    }

    /// A list of names; empty if there is none.
    pub fn names(&self, array: &str) -> Vec<String> {
        let Some(list) = self.head.split(&format!("Name=\"{array}\"")).nth(1) else { return Vec::new() };
        let numbers = list.split_once('>').map_or("", |(_, rest)| rest.split('<').next().unwrap_or(""));
        let bytes: Vec<u8> = numbers.split_whitespace().filter_map(|number| number.parse().ok()).collect();
        let mut names: Vec<String> =
            bytes.split(|&byte| byte == 0).map(|name| String::from_utf8_lossy(name).into_owned()).collect();
        // What is behind the last zero.
        names.pop();
        names
    }

    pub fn has(&self, array: &str) -> bool {
        self.described(array).is_some()
    }

    fn described(&self, array: &str) -> Option<Described<'_>> {
        let named = format!("Name=\"{array}\"");
        let tag = self.head.split("<DataArray ").skip(1).map(|tag| tag.split('>').next().unwrap_or(""));
        let tag = tag.into_iter().find(|tag| tag.contains(&named) && tag.contains("format=\"appended\""))?;
        Some(Described {
            kind: attribute(tag, "type")?,
            components: attribute(tag, "NumberOfComponents")?.parse().ok()?,
            offset: attribute(tag, "offset")?.parse().ok()?,
        })
    }

    /// The values of an array of so many components, each of `N` bytes and of the kind that the head must say.
    ///
    /// # Errors
    /// If there is no such array, or not all of it.
    pub fn values<const N: usize, T>(
        &mut self,
        array: &str,
        kind: &str,
        components: usize,
        decode: impl Fn([u8; N]) -> T,
    ) -> Result<Vec<T>, OutputError> {
        let Some(found) = self.described(array) else { return Err(self.bad(format!("no array `{array}`"))) };
        if found.kind != kind || found.components != components {
            let told = format!("{} of {}", found.components, found.kind);
            return Err(self.bad(format!("array `{array}` has {told}, expected {components} of {kind}")));
        }
        let place = self.start + found.offset;
        let path = self.path.clone();
        let cut = |problem: String| OutputError::BadSnapshot { path: path.clone(), problem };
        let length = self.file.metadata().map_err(OutputError::io("measure", &path))?.len();
        self.file.seek(SeekFrom::Start(place)).map_err(OutputError::io("read", &path))?;
        let mut size = [0; 8];
        let short = || cut(format!("it is cut off after {length} bytes, within array `{array}`"));
        self.file.read_exact(&mut size).map_err(|_| short())?;
        let bytes = u64::from_le_bytes(size);
        if bytes > length.saturating_sub(place + 8) {
            return Err(short());
        }
        let mut data = vec![0; bytes as usize];
        self.file.read_exact(&mut data).map_err(|_| short())?;
        let (values, rest) = data.as_chunks::<N>();
        if !rest.is_empty() || values.len() % components != 0 {
            return Err(cut(format!("array `{array}` has {bytes} bytes, no multiple of {}", N * components)));
        }
        Ok(values.iter().map(|&value| decode(value)).collect())
    }
}

/// The value of `name="..."` in a text.
fn attribute<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    text.split(&format!("{name}=\"")).nth(1)?.split('"').next()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::{ParticleRow, SnapshotWriter};

    fn row(id: u32) -> ParticleRow {
        let x = f64::from(id);
        ParticleRow { id, gas: 1, position: [x, 0.5, -x], velocity: [1.5, 0.0, 2.0], spin_energy: 0.25 }
    }

    #[test]
    fn what_was_written_is_read_and_what_was_cut_off_is_refused() {
        let dir = tempfile::tempdir().unwrap();
        let names = ["air", "helium: \"He\""].map(str::to_owned);
        let mut writer = SnapshotWriter::create(dir.path()).unwrap().naming(names.clone());
        let path = writer.write_among(0.125, &[row(3), row(7)], Some(&[0, 5])).unwrap();
        let mut file = VtkFile::open(&path).unwrap();
        assert_eq!(file.count("NumberOfPoints").unwrap(), 2);
        assert_eq!(file.names("gas_names"), names);
        assert_eq!(file.values("id", "UInt32", 1, u32::from_le_bytes).unwrap(), [3, 7]);
        assert_eq!(
            file.values("position", "Float64", 3, f64::from_le_bytes).unwrap(),
            [3.0, 0.5, -3.0, 7.0, 0.5, -7.0]
        );
        assert_eq!(file.values("subdomain", "UInt32", 1, u32::from_le_bytes).unwrap(), [0, 5]);
        assert!(file.has("velocity") && !file.has("volume"));
        let other = file.values("velocity", "Float64", 3, f64::from_le_bytes).unwrap_err().to_string();
        assert!(other.contains("3 of Float32, expected 3 of Float64"), "{other}");
        assert!(file.values("volume", "Float64", 1, f64::from_le_bytes).is_err());

        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(&path, &bytes[..bytes.len() - 60]).unwrap();
        let error = VtkFile::open(&path).unwrap().values("types", "UInt8", 1, u8::from_le_bytes).unwrap_err();
        assert!(error.to_string().contains("cut off") && error.to_string().contains("particles_000000.vtu"), "{error}");
        std::fs::write(&path, "<VTKFile>").unwrap();
        assert!(VtkFile::open(&path).is_err());
    }
}
