//! The triangles of a mesh file as they stand there, and how its text is read.

/// Characters of a text that is quoted.
const LONGEST_QUOTE: usize = 40;

/// A part of a file, by its place among the names of a [`Soup`].
pub(super) type PartOf = Option<u32>;

/// The triangles of a file, each with corners of its own.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Soup {
    /// In file units.
    pub corners: Vec<[[f32; 3]; 3]>,
    /// The part of each triangle.
    pub parts: Vec<PartOf>,
    /// No two alike, in the order of the file.
    pub names: Vec<String>,
}

impl Soup {
    pub fn triangle(&mut self, corners: [[f32; 3]; 3], part: PartOf) {
        self.corners.push(corners);
        self.parts.push(part);
    }

    /// The part of this name; none has no name.
    pub fn part(&mut self, name: &str) -> PartOf {
        if name.is_empty() {
            return None;
        }
        let known = self.names.iter().position(|other| other == name);
        let place = known.unwrap_or_else(|| {
            self.names.push(name.to_string());
            self.names.len() - 1
        });
        Some(place as u32)
    }
}

/// A text in UTF-8, or else in Latin-1.
pub(super) fn decoded(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_string(),
        Err(_) => bytes.iter().map(|&byte| char::from(byte)).collect(),
    }
}

/// Lines that end in LF, CR LF or CR.
pub(super) fn lines(text: &str) -> impl Iterator<Item = &str> {
    text.split('\n').flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r'))
}

pub(super) fn quoted(text: &str) -> String {
    let quoted: String = text.chars().take(LONGEST_QUOTE).collect();
    quoted.trim_end().escape_debug().to_string()
}
