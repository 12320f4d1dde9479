//! STL files, binary and ASCII: three corners a triangle. Of a text all `solid`s are read, and each is a part with
//! its name.
//!
//! The ASCII form is read word by word: words in small letters or capitals, lines that end in LF, CR LF or CR, blanks
//! and blank lines anywhere. Normals are not looked at: which side a triangle faces is found from the surface. Lines
//! between facets that say something else (`color ...`, comments) are passed over; within a facet they are errors.

use super::soup::{PartOf, Soup, quoted};

const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// What of a file is a mesh, or why it is none.
pub(super) fn read(bytes: &[u8]) -> Result<Soup, String> {
    if is_binary(bytes) {
        Ok(read_binary(bytes))
    } else if is_text(bytes) {
        read_text(&super::soup::decoded(bytes))
    } else {
        Err(no_stl(bytes))
    }
}

/// Whether a file has just the length that a binary header says.
pub(super) fn is_binary(bytes: &[u8]) -> bool {
    announced(bytes).is_some_and(|(_, size)| size == Some(bytes.len()))
}

/// How many triangles the header of a binary file says, and how many bytes such a file has.
fn announced(bytes: &[u8]) -> Option<(usize, Option<usize>)> {
    let count: [u8; 4] = bytes.get(HEADER - 4..HEADER)?.try_into().ok()?;
    let count = u32::from_le_bytes(count) as usize;
    Some((count, count.checked_mul(TRIANGLE).and_then(|n| n.checked_add(HEADER))))
}

/// Whether it begins as a text and has no byte that no text has.
fn is_text(bytes: &[u8]) -> bool {
    let begins = bytes.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    begins && !bytes.contains(&0)
}

/// Why what is no text is no binary file either.
fn no_stl(bytes: &[u8]) -> String {
    let size = bytes.len();
    let text = "no ASCII STL text";
    match announced(bytes) {
        None => format!("{text}, and {size} bytes are too few for a binary STL file"),
        Some((count, Some(wanted))) => format!(
            "{text}, and no binary STL file: the {count} triangles of its header take {wanted} bytes, the file has {size}"
        ),
        Some((count, None)) => {
            format!("{text}, and no binary STL file: no file has the {count} triangles of its header")
        }
    }
}

fn read_binary(bytes: &[u8]) -> Soup {
    let mut soup = Soup::default();
    for record in bytes[HEADER..].chunks_exact(TRIANGLE) {
        let number = |k: usize| f32::from_le_bytes(std::array::from_fn(|byte| record[12 + 4 * k + byte]));
        let corner = |k: usize| [number(3 * k), number(3 * k + 1), number(3 * k + 2)];
        soup.triangle([corner(0), corner(1), corner(2)], None);
    }
    soup
}

/// A facet that has begun: its line, and the corners that were read.
struct Facet {
    line: usize,
    corners: Vec<[f32; 3]>,
}

fn read_text(text: &str) -> Result<Soup, String> {
    let mut soup = Soup::default();
    let mut part: PartOf = None;
    let mut facet: Option<Facet> = None;
    let mut ended = false;
    for (index, text) in super::soup::lines(text).enumerate() {
        let line = index + 1;
        let wrong = |allowed: &str| format!("line {line}: found `{}`, allowed: {allowed}", quoted(text.trim()));
        let mut rest = text;
        while let Some(word) = next_word(&mut rest) {
            match (word.to_ascii_lowercase().as_str(), &mut facet) {
                ("endsolid" | "end_solid", None) => {
                    (part, ended) = (None, true);
                    rest = "";
                }
                ("end", None) if rest.trim_start().to_ascii_lowercase().starts_with("solid") => {
                    (part, ended) = (None, true);
                    rest = "";
                }
                (solid, None) if solid.starts_with("solid") => {
                    // Some programs leave no blank before the name.
                    let name = format!("{}{rest}", &word["solid".len()..]);
                    part = soup.part(name.trim());
                    rest = "";
                }
                ("facet", None) => {
                    facet = Some(Facet { line, corners: Vec::new() });
                    // The normal, whatever it is.
                    let mut ahead = rest;
                    if next_word(&mut ahead).is_some_and(|word| word.eq_ignore_ascii_case("normal")) {
                        (0..3).for_each(|_| _ = next_word(&mut ahead));
                        rest = ahead;
                    }
                }
                ("outer" | "loop", Some(_)) => {}
                ("vertex", Some(facet)) => {
                    let mut number = || next_word(&mut rest)?.parse::<f32>().ok().filter(|x| x.is_finite());
                    let corner = (|| Some([number()?, number()?, number()?]))();
                    let corner = corner.ok_or_else(|| wrong("`vertex` and three finite numbers"))?;
                    facet.corners.push(corner);
                }
                ("endloop", Some(facet)) => {
                    <[[f32; 3]; 3]>::try_from(facet.corners.as_slice()).map_err(|_| {
                        let (first, count) = (facet.line, facet.corners.len());
                        format!("line {line}: the facet that begins in line {first} has {count} corners, allowed: 3")
                    })?;
                }
                ("endfacet", Some(open)) => {
                    let corners = <[[f32; 3]; 3]>::try_from(open.corners.as_slice()).map_err(|_| {
                        let (first, count) = (open.line, open.corners.len());
                        format!("line {line}: the facet that begins in line {first} has {count} corners, allowed: 3")
                    })?;
                    soup.triangle(corners, part);
                    facet = None;
                }
                (_, Some(open)) => {
                    let first = open.line;
                    return Err(wrong(&format!(
                        "`outer loop`, `vertex`, `endloop` or `endfacet` within the facet that begins in line {first}"
                    )));
                }
                ("outer" | "loop" | "vertex" | "endloop" | "endfacet", None) => return Err(wrong("`facet` before it")),
                // A colour, a comment or another word of a program's own.
                (_, None) => rest = "",
            }
        }
    }
    match facet {
        Some(Facet { line, .. }) => Err(format!("the file ends within the facet that begins in line {line}")),
        None if soup.corners.is_empty() && !ended => Err("the text ends before its first `facet`".into()),
        None => Ok(soup),
    }
}

fn next_word<'a>(rest: &mut &'a str) -> Option<&'a str> {
    let text = rest.trim_start();
    let end = text.find(char::is_whitespace).unwrap_or(text.len());
    let (word, after) = text.split_at(end);
    *rest = after;
    (!word.is_empty()).then_some(word)
}
