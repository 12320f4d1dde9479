//! `subdomains.svg`: particles coloured by the rank that owns them, at several times, seen along the shortest axis, with
//! the outlines of the ranks' boxes.

use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;

use super::chart::PALETTE;
use super::error::write_atomically;
use super::{OutputError, grouped};

/// The particles at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// s.
    pub time: f64,
    /// All of them; `points` is a sample.
    pub particles: usize,
    /// Position (m) and owner.
    pub points: Vec<([f64; 3], u32)>,
    /// Low and high corner of each rank's box, m.
    pub boxes: Vec<[[f64; 3]; 2]>,
}

/// At most so many frames are drawn, evenly spread over those given.
const FRAMES: usize = 6;
const COLUMNS: usize = 3;
const PANEL: u32 = 600;
const TITLE: u32 = 60;
const CAPTION: u32 = 40;
const GAP: u32 = 20;

type Drawn = Result<(), Box<dyn std::error::Error>>;

/// Draws the frames into `path`.
///
/// # Errors
/// If the file cannot be written.
pub fn subdomain_chart(path: &Path, title: &str, frames: &[Frame]) -> Result<(), OutputError> {
    let mut svg = String::new();
    draw(&mut svg, title, &spread(frames))
        .map_err(|problem| OutputError::Chart { path: path.to_path_buf(), problem: problem.to_string() })?;
    write_atomically(path, |out| out.write_all(svg.as_bytes()))
}

/// The first, the last and some between.
fn spread(frames: &[Frame]) -> Vec<&Frame> {
    let drawn = frames.len().min(FRAMES);
    (0..drawn).map(|k| &frames[k * (frames.len() - 1) / (drawn - 1).max(1)]).collect()
}

fn draw(svg: &mut String, title: &str, frames: &[&Frame]) -> Drawn {
    let view = View::of(frames);
    let height = (f64::from(PANEL) * view.aspect()).ceil().max(1.0) as u32;
    let columns = frames.len().clamp(1, COLUMNS) as u32;
    let rows = frames.len().div_ceil(COLUMNS).max(1) as u32;
    let size = (columns * (PANEL + GAP) + GAP, TITLE + rows * (height + CAPTION + GAP));
    let root = SVGBackend::with_string(svg, size).into_drawing_area();
    root.fill(&WHITE)?;
    root.draw(&Text::new(title.to_owned(), (GAP as i32, TITLE as i32 / 3), ("sans-serif", 28)))?;
    for (k, frame) in frames.iter().enumerate() {
        let (column, row) = ((k % COLUMNS) as u32, (k / COLUMNS) as u32);
        let corner = ((GAP + column * (PANEL + GAP)) as i32, (TITLE + row * (height + CAPTION + GAP)) as i32);
        draw_frame(&root, frame, &view, corner, height)?;
    }
    root.present()?;
    Ok(())
}

fn draw_frame(
    root: &DrawingArea<SVGBackend<'_>, Shift>,
    frame: &Frame,
    view: &View,
    corner: (i32, i32),
    height: u32,
) -> Drawn {
    let text = format!("{:.3} ms, {} particles", 1e3 * frame.time, grouped(frame.particles as u64));
    root.draw(&Text::new(text, corner, ("sans-serif", 24)))?;
    let at = |point: &[f64; 3]| {
        let [x, y] = view.fraction(point);
        let right = corner.0 + (x * f64::from(PANEL)).round() as i32;
        let down = corner.1 + CAPTION as i32 + ((1.0 - y) * f64::from(height)).round() as i32;
        (right, down)
    };
    for (point, owner) in &frame.points {
        root.draw(&Circle::new(at(point), 2, colour(*owner).filled()))?;
    }
    for [low, high] in &frame.boxes {
        root.draw(&Rectangle::new([at(low), at(high)], RGBColor(40, 40, 40).stroke_width(2)))?;
    }
    Ok(())
}

/// Neighbouring ranks have colours that stay apart; from the eighth on they come again, lighter or darker.
fn colour(owner: u32) -> RGBColor {
    let [r, g, b] = PALETTE[owner as usize % PALETTE.len()];
    let shade = |channel: u8| match owner as usize / PALETTE.len() % 3 {
        0 => channel,
        1 => channel / 2,
        _ => 128 + channel / 2,
    };
    RGBColor(shade(r), shade(g), shade(b))
}

/// The plane of the two longest axes, the longer to the right.
struct View {
    axes: [usize; 2],
    low: [f64; 3],
    extent: [f64; 3],
}

impl View {
    fn of(frames: &[&Frame]) -> View {
        let corners = || frames.iter().flat_map(|frame| frame.boxes.iter().flatten().copied());
        let points = || frames.iter().flat_map(|frame| frame.points.iter().map(|(point, _)| *point));
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for point in corners().chain(points()) {
            for axis in 0..3 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        // Nothing to see, or a plane: an extent all the same.
        let extent = std::array::from_fn(|axis| (high[axis] - low[axis]).max(1e-12));
        let low = low.map(|value| if value.is_finite() { value } else { 0.0 });
        let mut axes = [0, 1, 2];
        axes.sort_by(|&a: &usize, &b| extent[b].total_cmp(&extent[a]).then(a.cmp(&b)));
        View { axes: [axes[0], axes[1]], low, extent }
    }

    /// Height over width.
    fn aspect(&self) -> f64 {
        self.extent[self.axes[1]] / self.extent[self.axes[0]]
    }

    fn fraction(&self, point: &[f64; 3]) -> [f64; 2] {
        self.axes.map(|axis| (point[axis] - self.low[axis]) / self.extent[axis])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(time: f64) -> Frame {
        Frame {
            time,
            particles: 1_234,
            points: vec![([0.1, 0.5, 1.0], 0), ([0.1, 0.5, 3.0], 1), ([0.1, 0.2, 3.5], 1)],
            boxes: vec![[[0.0; 3], [0.2, 1.0, 2.0]], [[0.0, 0.0, 2.0], [0.2, 1.0, 4.0]]],
        }
    }

    fn chart(frames: &[Frame]) -> String {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("subdomains.svg");
        subdomain_chart(&path, "Tank: owners", frames).unwrap();
        std::fs::read_to_string(path).unwrap()
    }

    #[test]
    fn points_have_their_owners_colours_and_boxes_their_outlines() {
        let svg = chart(&[frame(0.0), frame(1e-3)]);
        let circles = |[r, g, b]: [u8; 3]| svg.matches(&format!("fill=\"#{r:02X}{g:02X}{b:02X}\"")).count();
        assert_eq!((circles(PALETTE[0]), circles(PALETTE[1])), (2, 4));
        assert_eq!(svg.matches("<rect").count(), 1 + 4);
        assert!(svg.contains("1.000 ms, 1,234 particles") && svg.contains("Tank: owners"));
    }

    /// The longest axis goes to the right, the next upwards.
    #[test]
    fn the_view_is_on_the_two_longest_axes() {
        let frame = frame(0.0);
        let view = View::of(&[&frame]);
        assert_eq!((view.axes, view.aspect()), ([2, 1], 0.25));
        assert_eq!(view.fraction(&[0.1, 0.5, 3.0]), [0.75, 0.5]);
    }

    #[test]
    fn many_frames_are_thinned_and_none_make_a_drawing() {
        let many: Vec<Frame> = (0..11).map(|k| frame(f64::from(k))).collect();
        let times: Vec<f64> = spread(&many).iter().map(|frame| frame.time).collect();
        assert_eq!(times, [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert!(chart(&[]).contains("Tank: owners"));
        let empty = Frame { points: Vec::new(), boxes: Vec::new(), ..frame(0.0) };
        assert!(!chart(&[empty]).contains("NaN"));
    }
}
