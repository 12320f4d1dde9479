//! What explains a picture: title and caption, the meaning of the colours, a scale bar and the axes.

use super::camera::{Camera, Frame};
use super::colours::{INK, viridis};
use super::image::Image;
use super::lettering::Lettering;
use super::model::{Key, LengthUnit, Picture, Scale};
use crate::output::ticks::Ticks;

/// Pixels between things.
const GAP: i64 = 12;
/// Of the cross of axes.
const AXIS: f64 = 30.0;
/// Letters of a name that the key has room for.
const NAME_LETTERS: i64 = 14;
const BAR_WIDTH: i64 = 18;
const TICKS: i64 = 4;
/// Of the picture's width, at most.
const LONGEST_SCALE_BAR: f64 = 0.2;

/// Where the things of a picture are drawn: beside what explains them.
pub fn frame(size: [u32; 2], key: &Key) -> Frame {
    let lettering = Lettering::of_width(size[0]);
    let line = lettering.height();
    let right = match key {
        Key::Nothing => 2 * GAP,
        Key::Kinds(_) | Key::Values(_) => key_width(lettering) + GAP,
    };
    let margins = [2 * GAP, 2 * line + 2 * GAP, right, 2 * AXIS as i64 + 2 * GAP];
    Frame { size, margins: margins.map(|pixels| pixels as f64) }
}

fn key_width(lettering: Lettering) -> i64 {
    lettering.height() + GAP + NAME_LETTERS * lettering.width("m")
}

/// Writes all of it.
pub fn annotate(image: &mut Image, camera: &Camera, picture: &Picture) {
    let lettering = Lettering::of_width(image.size[0]);
    let room = i64::from(image.size[0]) - 2 * GAP;
    let line = lettering.height();
    lettering.write(image, [GAP, GAP / 2], &lettering.fitting(&picture.title, room), INK);
    lettering.write(image, [GAP, GAP / 2 + line], &lettering.fitting(&picture.caption, room), INK);
    let left = i64::from(image.size[0]) - key_width(lettering);
    let top = 2 * line + 2 * GAP;
    match &picture.key {
        Key::Nothing => {}
        Key::Kinds(kinds) => {
            let row_height = line + GAP / 2;
            let rows = ((i64::from(image.size[1]) - top - GAP) / row_height).max(1) as usize;
            // The last row says how many have none.
            let shown = if kinds.len() > rows { rows - 1 } else { kinds.len() };
            if shown < kinds.len() {
                let text = format!("and {} more", kinds.len() - shown);
                lettering.write(image, [left, top + shown as i64 * row_height], &text, INK);
            }
            for (row, (name, colour)) in kinds[..shown].iter().enumerate() {
                let top = top + row as i64 * row_height;
                image.fill([left, top], [line, line], *colour);
                let name = lettering.fitting(name, NAME_LETTERS * lettering.width("m"));
                lettering.write(image, [left + line + GAP / 2, top], &name, INK);
            }
        }
        Key::Values(scale) => colour_bar(image, [left, top], lettering, scale),
    }
    axes(image, camera, lettering);
    scale_bar(image, camera, lettering, picture.unit);
}

fn colour_bar(image: &mut Image, [left, top]: [i64; 2], lettering: Lettering, scale: &Scale) {
    let line = lettering.height();
    lettering.write(image, [left, top], scale.quantity, INK);
    let top = top + line + GAP;
    let height = (i64::from(image.size[1]) * 2 / 5).max(TICKS);
    for row in 0..height {
        let share = 1.0 - (row as f64 + 0.5) / height as f64;
        image.fill([left, top + row], [BAR_WIDTH, 1], viridis(share));
    }
    let ticks = Ticks::over(&scale.range);
    for tick in 0..=TICKS {
        let share = tick as f64 / TICKS as f64;
        let y = top + height - 1 - (share * (height - 1) as f64).round() as i64;
        image.fill([left + BAR_WIDTH, y], [GAP / 2, 1], INK);
        let value = scale.range.start + share * (scale.range.end - scale.range.start);
        lettering.write(image, [left + BAR_WIDTH + GAP, y - line / 2], &ticks.label(value), INK);
    }
}

/// A cross of the axes in the lower left corner.
fn axes(image: &mut Image, camera: &Camera, lettering: Lettering) {
    let centre = [GAP as f64 + AXIS, f64::from(image.size[1]) - GAP as f64 - AXIS];
    for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
        let [right, up] = [camera.axes[0][k], camera.axes[1][k]];
        // One that leads to the viewer or away from him has its name in the middle.
        let end = [centre[0] + 0.6 * AXIS * right, centre[1] - 0.6 * AXIS * up];
        image.line(centre, end, INK);
        let letter = [centre[0] + AXIS * right, centre[1] - AXIS * up];
        if right.hypot(up) > 0.15 {
            let corner = [lettering.width(name), lettering.height()];
            let corner = [0, 1].map(|k| letter[k].round() as i64 - corner[k] / 2);
            lettering.write(image, corner, name, INK);
        }
    }
}

fn scale_bar(image: &mut Image, camera: &Camera, lettering: Lettering, unit: LengthUnit) {
    let longest = LONGEST_SCALE_BAR * f64::from(image.size[0]) / camera.scale;
    let length = round_below(longest);
    let pixels = (length * camera.scale).round() as i64;
    let left = 2 * GAP + 2 * AXIS as i64 + GAP;
    let bottom = i64::from(image.size[1]) - 2 * GAP;
    image.fill([left, bottom - 2], [pixels.max(1), 3], INK);
    for end in [left, left + pixels - 1] {
        image.fill([end, bottom - 6], [1, 11], INK);
    }
    lettering.write(image, [left, bottom - GAP - lettering.height()], &length_label(length, unit), INK);
}

/// The largest of 1, 2 and 5 times a power of ten that is not above a positive value.
pub fn round_below(value: f64) -> f64 {
    let exponent = value.log10().floor() as i32;
    let digits = [5.0, 2.0, 1.0].into_iter();
    // A negative power of ten is no binary fraction: dividing keeps the digits.
    let scaled = |digit: f64| if exponent < 0 { digit / 10f64.powi(-exponent) } else { digit * 10f64.powi(exponent) };
    let mut fitting = digits.map(scaled).filter(|&candidate| candidate <= value * (1.0 + 1e-12));
    fitting.next().unwrap_or_else(|| scaled(1.0))
}

fn length_label(length: f64, unit: LengthUnit) -> String {
    let rounded = |value: f64| {
        let text = format!("{value:.3e}").parse::<f64>().unwrap_or(value);
        if (1e-3..1e5).contains(&text) { text.to_string() } else { format!("{text:e}") }
    };
    match unit {
        LengthUnit::OfFile => format!("{} in the unit of the file", rounded(length)),
        LengthUnit::Metre if length < 1e-3 => format!("{} µm", rounded(1e6 * length)),
        LengthUnit::Metre if length < 1.0 => format!("{} mm", rounded(1e3 * length)),
        LengthUnit::Metre => format!("{} m", rounded(length)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scale_bar_has_a_round_length() {
        for (value, round) in [(0.0831, 0.05), (0.2, 0.2), (4.99, 2.0), (1.0, 1.0), (730.0, 500.0), (1e-6, 1e-6)] {
            assert!((round_below(value) / round - 1.0).abs() < 1e-9, "{value} {}", round_below(value));
        }
        let labels = [2e-5, 0.05, 0.1, 2.0].map(|length| length_label(length, LengthUnit::Metre));
        assert_eq!(labels, ["20 µm", "50 mm", "100 mm", "2 m"]);
        assert_eq!(length_label(200.0, LengthUnit::OfFile), "200 in the unit of the file");
    }
}
