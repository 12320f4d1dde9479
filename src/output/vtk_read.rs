//! Reads back the VTK files that [`vtk`](super::vtk) writes: XML lines, then arrays in one block of raw little-endian bytes.

use std::path::{Path, PathBuf};

use super::OutputError;

/// Before the block of arrays.
const MARK: &[u8] = b"<AppendedData encoding=\"raw\">\n_";

/// A number of an array, and what VTK calls its type.
pub(super) trait Number: bytemuck::Pod {
    const KIND: &'static str;
}

impl Number for f32 {
    const KIND: &'static str = "Float32";
}

impl Number for f64 {
    const KIND: &'static str = "Float64";
}

impl Number for u8 {
    const KIND: &'static str = "UInt8";
}

impl Number for u32 {
    const KIND: &'static str = "UInt32";
}

impl Number for i64 {
    const KIND: &'static str = "Int64";
}

/// A file as read.
pub(super) struct VtkFile {
    path: PathBuf,
    xml: String,
    block: Vec<u8>,
}

impl VtkFile {
    /// # Errors
    /// If the file cannot be read or is none of a run's.
    pub fn read(path: &Path) -> Result<VtkFile, OutputError> {
        let mut bytes = std::fs::read(path).map_err(OutputError::io("read", path))?;
        let broken = |problem: &str| OutputError::BadFile { path: path.to_path_buf(), problem: problem.to_owned() };
        let at = bytes.windows(MARK.len()).position(|window| window == MARK);
        let at = at.ok_or_else(|| broken("it has no block of raw arrays"))?;
        let block = bytes.split_off(at + MARK.len());
        let xml = String::from_utf8(bytes).map_err(|_| broken("its head is no UTF-8"))?;
        Ok(VtkFile { path: path.to_path_buf(), xml, block })
    }

    /// s.
    pub fn time(&self) -> Option<f64> {
        self.content("Name=\"TimeValue\"")?.trim().parse().ok()
    }

    /// A list of names, empty if the file has none.
    pub fn names(&self, array: &str) -> Vec<String> {
        let numbers = self.content(&format!("Name=\"{array}\"")).unwrap_or_default().split_whitespace();
        let bytes: Vec<u8> = numbers.map_while(|number| number.parse().ok()).collect();
        let names = bytes.split(|&byte| byte == 0).map(|name| String::from_utf8_lossy(name).into_owned());
        let count = bytes.iter().filter(|&&byte| byte == 0).count();
        names.take(count).collect()
    }

    /// What stands in the element with this attribute.
    fn content(&self, attribute: &str) -> Option<&str> {
        let after = self.xml.split_once(attribute)?.1;
        after.split_once('>')?.1.split('<').next()
    }

    pub fn has(&self, name: &str) -> bool {
        self.head(name).is_some()
    }

    /// The line that describes an array of the block.
    fn head(&self, name: &str) -> Option<&str> {
        let name = format!(" Name=\"{name}\"");
        self.xml.lines().find(|line| line.contains("format=\"appended\"") && line.contains(&name))
    }

    /// The values of an array, C of each item.
    ///
    /// # Errors
    /// If there is no such array of this type and as many components.
    pub fn array<T: Number, const C: usize>(&self, name: &str) -> Result<Vec<[T; C]>, OutputError>
    where
        [T; C]: bytemuck::Pod,
    {
        let broken = |problem: String| OutputError::BadFile { path: self.path.clone(), problem };
        let head = self.head(name).ok_or_else(|| broken(format!("it has no array `{name}`")))?;
        let found = ["type", "NumberOfComponents"].map(|key| attribute(head, key).unwrap_or_default());
        if found != [T::KIND, &C.to_string()] {
            let expected = format!("{C} of {}", T::KIND);
            return Err(broken(format!("its array `{name}` has {} of {}, expected {expected}", found[1], found[0])));
        }
        let bytes = attribute(head, "offset").and_then(|offset| self.bytes(offset.parse().ok()?));
        let bytes = bytes.ok_or_else(|| broken(format!("it ends within its array `{name}`")))?;
        if !bytes.len().is_multiple_of(size_of::<[T; C]>()) {
            return Err(broken(format!("its array `{name}` has {} bytes, no whole number of items", bytes.len())));
        }
        Ok(bytemuck::pod_collect_to_vec(bytes))
    }

    /// The array that begins there in the block, behind its length.
    fn bytes(&self, offset: usize) -> Option<&[u8]> {
        let start = offset.checked_add(size_of::<u64>())?;
        let length = u64::from_le_bytes(self.block.get(offset..start)?.try_into().ok()?);
        self.block.get(start..start.checked_add(usize::try_from(length).ok()?)?)
    }
}

fn attribute<'a>(line: &'a str, name: &str) -> Option<&'a str> {
    line.split_once(&format!(" {name}=\""))?.1.split('"').next()
}
