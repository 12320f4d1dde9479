//! The lines of the file on which the entries of a scene stand, for warnings of what is read well and may not be meant.

/// How a sentence about each entry begins, and the entry's line, from 1. A scene that is of no file has none.
#[derive(Debug, Clone, Default)]
pub struct Lines(pub(super) Vec<(String, usize)>);

/// A scene is the same wherever its entries stand in the file.
impl PartialEq for Lines {
    fn eq(&self, _: &Lines) -> bool {
        true
    }
}

impl Lines {
    /// The sentence with the line of the entry that it begins with, if it begins with one.
    pub fn told(&self, sentence: String) -> String {
        match self.0.iter().find(|(start, _)| sentence.starts_with(start.as_str())) {
            Some((_, line)) => format!("{sentence} (line {line})"),
            None => sentence,
        }
    }

    /// The line of the entry that an error begins with.
    pub fn of_error(&self, error: &str) -> Option<usize> {
        let plain = error.replace('"', "`");
        self.0.iter().find(|(start, _)| plain.starts_with(start.as_str())).map(|(_, line)| *line)
    }

    /// Whether the file has an entry of which sentences begin so.
    pub fn holds(&self, start: &str) -> bool {
        self.0.iter().any(|(own, _)| own == start)
    }
}
