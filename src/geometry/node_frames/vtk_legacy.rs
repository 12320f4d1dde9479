//! Legacy VTK files as text: points and triangles of `POLYDATA` and `UNSTRUCTURED_GRID`, of versions to 5.1.

use super::error::Misread;
use super::frames::NodeFrames;
use super::vtk_frame::{Cells, VtkFrame, points};
use crate::geometry::soup::{decoded, lines, quoted};
use std::fmt::Write;
use std::str::FromStr;

pub(super) fn read(bytes: &[u8]) -> Result<VtkFrame, Misread> {
    let text = decoded(bytes);
    let mut words = Words::new(&text);
    let head = words.line().unwrap_or_default();
    if !head.to_ascii_lowercase().starts_with("# vtk datafile") {
        return Err(Misread::new("line 1", format!("`{}`", quoted(head)), "`# vtk DataFile Version ...`"));
    }
    words.line();
    words.keyword(&["ASCII"], "`ASCII`: binary legacy files are not read")?;
    words.keyword(&["DATASET"], "`DATASET`")?;
    words.keyword(&["POLYDATA", "UNSTRUCTURED_GRID"], "`POLYDATA` or `UNSTRUCTURED_GRID`")?;
    let (mut frame, mut cells) = (VtkFrame::default(), Cells::default());
    while let Some(word) = words.next() {
        match word.to_ascii_uppercase().as_str() {
            "POINTS" => {
                let count: usize = words.number()?;
                words.next();
                frame.nodes = points(&words.numbers(count.saturating_mul(3))?);
            }
            "POLYGONS" | "CELLS" => {
                let lists = words.lists()?;
                (cells.connectivity, cells.ends) = (lists.connectivity, lists.ends);
            }
            "VERTICES" | "LINES" => _ = words.lists()?,
            "CELL_TYPES" => {
                let count = words.number()?;
                cells.types = Some(words.numbers(count)?);
            }
            "FIELD" => words.field()?,
            "METADATA" => words.skip_to_empty_line(),
            "POINT_DATA" | "CELL_DATA" => break,
            _ => {
                let expected = "`POINTS`, `POLYGONS`, `CELLS` or `CELL_TYPES`";
                return Err(Misread::new(words.place(), format!("`{}`", quoted(word)), expected));
            }
        }
    }
    frame.triangles = cells.triangles()?;
    Ok(frame)
}

/// The words of a text with their lines.
struct Words<'a> {
    lines: Box<dyn Iterator<Item = &'a str> + 'a>,
    line: usize,
    rest: std::iter::Peekable<std::str::SplitWhitespace<'a>>,
}

impl<'a> Words<'a> {
    fn new(text: &'a str) -> Words<'a> {
        Words { lines: Box::new(lines(text)), line: 0, rest: "".split_whitespace().peekable() }
    }

    fn place(&self) -> String {
        format!("line {}", self.line)
    }

    /// The next whole line.
    fn line(&mut self) -> Option<&'a str> {
        let line = self.lines.next()?;
        self.line += 1;
        self.rest = "".split_whitespace().peekable();
        Some(line)
    }

    fn peek(&mut self) -> Option<&'a str> {
        while self.rest.peek().is_none() {
            let line = self.line()?;
            self.rest = line.split_whitespace().peekable();
        }
        self.rest.peek().copied()
    }

    fn next(&mut self) -> Option<&'a str> {
        self.peek()?;
        self.rest.next()
    }

    fn skip_to_empty_line(&mut self) {
        while self.line().is_some_and(|line| !line.trim().is_empty()) {}
    }

    fn keyword(&mut self, allowed: &[&str], expected: &str) -> Result<(), Misread> {
        let word = self.next();
        if word.is_some_and(|word| allowed.iter().any(|own| word.eq_ignore_ascii_case(own))) {
            return Ok(());
        }
        Err(self.wrong(word, expected))
    }

    fn wrong(&self, word: Option<&str>, expected: &str) -> Misread {
        let found = word.map_or("the end of the file".into(), |word| format!("`{}`", quoted(word)));
        Misread::new(self.place(), found, expected)
    }

    fn number<T: FromStr>(&mut self) -> Result<T, Misread> {
        let word = self.next();
        word.and_then(|word| word.parse().ok()).ok_or_else(|| self.wrong(word, "a number"))
    }

    /// Grows as they are read: a count of the file alone takes no memory.
    fn numbers<T: FromStr>(&mut self, count: usize) -> Result<Vec<T>, Misread> {
        (0..count).map(|_| self.number()).collect()
    }

    /// Cells as two numbers and lists that begin with their length, or as offsets and connectivity.
    fn lists(&mut self) -> Result<Cells, Misread> {
        let (count, size): (usize, usize) = (self.number()?, self.number()?);
        let mut cells = Cells::default();
        if self.peek().is_some_and(|word| word.eq_ignore_ascii_case("OFFSETS")) {
            self.next();
            self.next();
            let offsets: Vec<i64> = self.numbers(count)?;
            cells.ends = offsets.into_iter().skip(1).collect();
            self.keyword(&["CONNECTIVITY"], "`CONNECTIVITY`")?;
            self.next();
            cells.connectivity = self.numbers(size)?;
            return Ok(cells);
        }
        for _ in 0..count {
            let corners: usize = self.number()?;
            cells.connectivity.extend(self.numbers::<i64>(corners)?);
            cells.ends.push(cells.connectivity.len() as i64);
        }
        Ok(cells)
    }

    /// Arrays of numbers that say nothing of where nodes are.
    fn field(&mut self) -> Result<(), Misread> {
        self.next();
        let arrays: usize = self.number()?;
        for _ in 0..arrays {
            self.next();
            let (components, tuples): (usize, usize) = (self.number()?, self.number()?);
            self.next();
            for _ in 0..components.saturating_mul(tuples) {
                if self.next().is_none() {
                    return Err(self.wrong(None, "the values of a field"));
                }
            }
        }
        Ok(())
    }
}

/// A frame as such a file.
pub(super) fn text(frames: &NodeFrames, frame: usize) -> String {
    let (nodes, triangles) = (frames.frame(frame), frames.triangles());
    let mut text = format!("# vtk DataFile Version 3.0\ntime {}\nASCII\nDATASET POLYDATA\n", frames.times()[frame]);
    let _ = writeln!(text, "POINTS {} double", nodes.len());
    for [x, y, z] in nodes {
        let _ = writeln!(text, "{x} {y} {z}");
    }
    if triangles.is_empty() {
        // Or viewers show nothing.
        let _ = writeln!(text, "VERTICES {} {}", nodes.len(), 2 * nodes.len());
        (0..nodes.len()).for_each(|node| _ = writeln!(text, "1 {node}"));
    } else {
        let _ = writeln!(text, "POLYGONS {} {}", triangles.len(), 4 * triangles.len());
        triangles.iter().for_each(|[a, b, c]| _ = writeln!(text, "3 {a} {b} {c}"));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "# vtk DataFile Version 5.1\nvtk output\nASCII\n";
    const POINTS: &str = "POINTS 4 float\n0 0 0 1 0 0\n1 1 0 0 1 0.5\n\n";

    fn read_text(rest: &str) -> Result<VtkFrame, Misread> {
        read(format!("{HEAD}{rest}").as_bytes())
    }

    fn refused(rest: &str) -> String {
        let Misread { place, found, expected } = read_text(rest).unwrap_err();
        format!("{place}: found {found}, expected {expected}")
    }

    /// Lists with their lengths, offsets as ParaView writes them, and a grid with lines among its cells.
    #[test]
    fn the_forms_of_cells_are_the_same() {
        let metadata = "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1\n\n";
        let field = "FIELD FieldData 1\nTimeValue 1 1 double\n0.25\n";
        let old = format!("DATASET POLYDATA\n{POINTS}POLYGONS 2 8\n3 0 1 2\n3 0 2 3\nPOINT_DATA 4\nanything");
        let new = format!(
            "DATASET POLYDATA\n{field}{POINTS}{metadata}POLYGONS 3 6\nOFFSETS vtktypeint64\n0 3 6\nCONNECTIVITY vtktypeint64\n0 1 2 0 2 3\n"
        );
        let grid = format!(
            "DATASET UNSTRUCTURED_GRID\r\n{POINTS}CELLS 3 11\n3 0 1 2\n2 0 1\n3 0 2 3\n\nCELL_TYPES 3\n5\n3\n5\n"
        );
        for text in [old, new, grid] {
            let frame = read_text(&text).unwrap();
            assert_eq!(frame.triangles, [[0, 1, 2], [0, 2, 3]], "{text}");
            assert_eq!((frame.nodes.len(), frame.nodes[3]), (4, [0.0, 1.0, 0.5]));
        }
    }

    #[test]
    fn what_is_no_frame_is_told_with_its_line() {
        assert!(read(b"solid").unwrap_err().found.contains("solid"));
        let binary = read(b"# vtk DataFile Version 3.0\nt\nBINARY\n").unwrap_err();
        assert_eq!((binary.place.as_str(), binary.found.as_str()), ("line 3", "`BINARY`"));
        let words = "line 4: found `STRUCTURED_POINTS`, expected `POLYDATA` or `UNSTRUCTURED_GRID`";
        assert_eq!(refused("DATASET STRUCTURED_POINTS"), words);
        assert_eq!(refused("DATASET POLYDATA\nPOINTS 1 float\n0 x"), "line 6: found `x`, expected a number");
        let cut = refused("DATASET POLYDATA\nPOINTS 99999999999 float\n0 0");
        assert_eq!(cut, "line 6: found the end of the file, expected a number");
        let square = refused(&format!("DATASET POLYDATA\n{POINTS}POLYGONS 1 5\n4 0 1 2 3"));
        assert!(square.starts_with("cell 0: found a cell with 4 points, expected triangles"), "{square}");
        let square = refused(&format!("DATASET UNSTRUCTURED_GRID\n{POINTS}CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n9"));
        assert!(square.starts_with("cell 0: found a cell of the type 9 with 4 points"), "{square}");
        let below = refused(&format!("DATASET POLYDATA\n{POINTS}POLYGONS 1 4\n3 0 1 -2"));
        assert_eq!(below, "cell 0: found point -2, expected a number from 0 on");
        let strips = refused(&format!("DATASET POLYDATA\n{POINTS}TRIANGLE_STRIPS 1 5\n4 0 1 2 3"));
        assert!(strips.starts_with("line 9: found `TRIANGLE_STRIPS`"), "{strips}");
    }
}
