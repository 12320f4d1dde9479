//! Maps as SVG: rows of cells, each coloured by what is wrong with it.

use std::fmt::Write;
use std::path::Path;

use super::OutputError;
use super::chart::PALETTE;
use super::error::write_atomically;

/// A row of cells, or the heads of the columns below it.
pub struct MapRow {
    pub title: String,
    pub heads: Vec<String>,
    pub cells: Vec<MapCell>,
}

pub struct MapCell {
    pub text: String,
    /// `None`: unknown; `Some(None)`: nothing is; `Some(Some(kind))`: a colour of the palette.
    pub broken: Option<Option<usize>>,
}

const LEFT: usize = 150;
const CELL: [usize; 2] = [132, 24];
const TOP: usize = 48;

/// # Errors
/// If the file cannot be written.
pub fn map_chart(path: &Path, title: &str, rows: &[MapRow]) -> Result<(), OutputError> {
    let columns = rows.iter().map(|row| row.cells.len().max(row.heads.len())).max().unwrap_or(0);
    let (width, height) = (LEFT + CELL[0] * columns.max(5) + 20, TOP + CELL[1] * rows.len() + 20);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" font-family=\"sans-serif\" \
         font-size=\"12\" fill=\"#282828\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n\
         <text x=\"10\" y=\"26\" font-size=\"15\">{}</text>\n",
        escaped(title)
    );
    for (index, row) in rows.iter().enumerate() {
        let y = TOP + CELL[1] * index;
        let weight = if row.heads.is_empty() { "normal" } else { "bold" };
        let mut word = |x: usize, text: &str| {
            let _ = writeln!(svg, "<text x=\"{x}\" y=\"{}\" font-weight=\"{weight}\">{}</text>", y + 16, escaped(text));
        };
        word(10, &row.title);
        for (column, head) in row.heads.iter().enumerate() {
            word(LEFT + CELL[0] * column + 6, head);
        }
        for (column, cell) in row.cells.iter().enumerate() {
            let x = LEFT + CELL[0] * column;
            let fill = match cell.broken {
                None => "#e6e6e6".to_owned(),
                Some(None) => "#f4faf4".to_owned(),
                Some(Some(kind)) => {
                    // Light, so that words on it can be read.
                    let [r, g, b] = PALETTE[kind % PALETTE.len()].map(|c| 255 - (255 - c) / 2);
                    format!("rgb({r},{g},{b})")
                }
            };
            let _ = writeln!(
                svg,
                "<rect x=\"{x}\" y=\"{y}\" width=\"{}\" height=\"{}\" fill=\"{fill}\" stroke=\"white\"/>\
                 <text x=\"{}\" y=\"{}\" font-size=\"11\">{}</text>",
                CELL[0],
                CELL[1],
                x + 6,
                y + 16,
                escaped(&cell.text)
            );
        }
    }
    svg += "</svg>\n";
    write_atomically(path, |out| out.write_all(svg.as_bytes()))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
