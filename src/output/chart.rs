//! Line charts as SVG.
//!
//! A value that is not finite breaks its line and is not drawn otherwise; a chart without any finite point
//! says so. The legend stands above the plot, where it hides no data.

use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::OutputError;
use super::error::write_atomically;
use super::ticks::Ticks;

/// Colours that stay apart for colour-blind readers and in print (Okabe and Ito, 2008).
pub const PALETTE: [[u8; 3]; 7] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [86, 180, 233], [90, 90, 90]];

/// One line of a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    pub name: String,
    /// (x, y) in the units of the axis labels.
    pub points: Vec<[f64; 2]>,
    /// For references beside what was computed: dashed, and darker, so that it shows on top of a line of the same colour.
    pub dashed: bool,
    pub colour: [u8; 3],
}

/// Units of the drawing; the image is shown at half of it, so that lines fall on half pixels.
pub(super) const SIZE: (u32, u32) = (1840, 1080);
pub(super) const MARGIN: i32 = 40;
const TITLE_HEIGHT: i32 = 60;
const LEGEND_LINE: i32 = 46;
pub(super) const TEXT: f64 = 34.0;
/// Mean width of a letter. No font is at hand to measure; this is that of wide sans-serif fonts.
pub(super) const LETTER: f64 = 0.43 * TEXT;
pub(super) const INK: RGBColor = RGBColor(40, 40, 40);

/// Draws `series` over each other into `path`. Errors: the file cannot be written.
pub fn line_chart(
    path: &Path,
    title: &str,
    x_label: &str,
    y_label: &str,
    series: &[Series],
) -> Result<(), OutputError> {
    save(path, SIZE, |svg| draw(svg, title, x_label, y_label, series))
}

/// Writes what is drawn in units of `size`, shown at half of it.
pub(super) fn save(path: &Path, size: (u32, u32), draw: impl FnOnce(&mut String) -> Drawn) -> Result<(), OutputError> {
    let mut svg = String::new();
    draw(&mut svg).map_err(|problem| OutputError::Chart { path: path.to_path_buf(), problem: problem.to_string() })?;
    let drawn = format!("width=\"{}\" height=\"{}\"", size.0, size.1);
    let shown = format!("width=\"{}\" height=\"{}\"", size.0 / 2, size.1 / 2);
    let svg = svg.replacen(&drawn, &shown, 1);
    write_atomically(path, |out| out.write_all(svg.as_bytes()))
}

pub(super) type Drawn = Result<(), Box<dyn std::error::Error>>;
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

fn draw(svg: &mut String, title: &str, x_label: &str, y_label: &str, series: &[Series]) -> Drawn {
    let root = SVGBackend::with_string(svg, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    root.draw(&Text::new(
        title.to_owned(),
        (MARGIN, MARGIN / 2 + TITLE_HEIGHT / 2),
        text_style(1.25 * TEXT).pos(Pos::new(HPos::Left, VPos::Center)),
    ))?;
    let legend_top = MARGIN / 2 + TITLE_HEIGHT;
    let legend_bottom = draw_legend(&root, legend_top, series)?;
    let (_, plot) = root.split_vertically(legend_bottom);
    draw_plot(&plot, x_label, y_label, series)?;
    root.present()?;
    Ok(())
}

fn draw_plot(area: &Area, x_label: &str, y_label: &str, series: &[Series]) -> Drawn {
    let lines: Vec<(&Series, Vec<&[[f64; 2]]>)> =
        series.iter().map(|series| (series, finite_stretches(&series.points))).collect();
    let all = || lines.iter().flat_map(|(_, parts)| parts.iter().copied().flatten());
    let x = extent(all().map(|point| point[0]), 0.0);
    let y = extent(all().map(|point| point[1]), 0.05);
    let (x_ticks, y_ticks) = (Ticks::over(&x), Ticks::over(&y));
    let longest = [y.start, 0.5 * (y.start + y.end), y.end].map(|value| y_ticks.label(value).len());
    let letters = longest.into_iter().max().unwrap_or(0);
    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .margin_top(MARGIN / 2)
        .x_label_area_size(100)
        .y_label_area_size(90 + (LETTER * letters as f64) as i32)
        .build_cartesian_2d(x.clone(), y.clone())?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(225, 225, 225).stroke_width(2))
        .axis_style(RGBColor(120, 120, 120).stroke_width(2))
        .label_style(text_style(TEXT))
        .axis_desc_style(text_style(1.1 * TEXT))
        .x_labels(Ticks::WANTED)
        .y_labels(Ticks::WANTED)
        .x_label_formatter(&|value| x_ticks.label(*value))
        .y_label_formatter(&|value| y_ticks.label(*value))
        .x_desc(x_label)
        .y_desc(y_label)
        .draw()?;
    if all().next().is_none() {
        let centre = (0.5 * (x.start + x.end), 0.5 * (y.start + y.end));
        let style = text_style(1.25 * TEXT).pos(Pos::new(HPos::Center, VPos::Center));
        chart.draw_series([Text::new("no data", centre, style)])?;
    }
    for (series, parts) in &lines {
        for part in parts {
            let points = part.iter().map(|&[x, y]| (x, y));
            let style = line_style(series);
            if part.len() == 1 {
                chart.draw_series(points.map(|point| Circle::new(point, 7, style.filled())))?;
            } else if series.dashed {
                chart.draw_series(DashedLineSeries::new(points, DASH, GAP, style))?;
            } else {
                chart.draw_series(LineSeries::new(points, style))?;
            }
        }
    }
    Ok(())
}

const DASH: i32 = 18;
const GAP: i32 = 12;

fn line_style(series: &Series) -> ShapeStyle {
    let [r, g, b] = stroke_colour(series.colour, series.dashed);
    RGBColor(r, g, b).stroke_width(if series.dashed { 4 } else { 5 })
}

fn stroke_colour(colour: [u8; 3], dashed: bool) -> [u8; 3] {
    if dashed { colour.map(|channel| channel / 2) } else { colour }
}

pub(super) fn text_style(size: f64) -> TextStyle<'static> {
    TextStyle::from(("sans-serif", size)).color(&INK)
}

/// Draws a sample and the name of each series in rows from `top` on; returns where the rows end.
fn draw_legend(root: &Area, top: i32, series: &[Series]) -> Result<i32, Box<dyn std::error::Error>> {
    const SAMPLE: i32 = 2 * DASH + 2 * GAP + DASH;
    let right = SIZE.0 as i32 - MARGIN;
    let (mut x, mut y) = (MARGIN, top + LEGEND_LINE / 2);
    for series in series {
        let text_width = (LETTER * series.name.chars().count() as f64) as i32;
        let width = SAMPLE + GAP + text_width + 3 * GAP;
        if x > MARGIN && x + width > right {
            (x, y) = (MARGIN, y + LEGEND_LINE);
        }
        let line = [(x, y), (x + SAMPLE, y)];
        if series.dashed {
            root.draw(&plotters::element::DashedPathElement::new(line, DASH, GAP, line_style(series)))?;
        } else {
            root.draw(&PathElement::new(line, line_style(series)))?;
        }
        root.draw(&Text::new(
            series.name.clone(),
            (x + SAMPLE + GAP, y),
            text_style(TEXT).pos(Pos::new(HPos::Left, VPos::Center)),
        ))?;
        x += width;
    }
    Ok(if series.is_empty() { top } else { y + LEGEND_LINE / 2 })
}

/// The runs of points whose two coordinates are finite.
fn finite_stretches(points: &[[f64; 2]]) -> Vec<&[[f64; 2]]> {
    points.split(|point| !point.iter().all(|value| value.is_finite())).filter(|part| !part.is_empty()).collect()
}

/// The range of the values, widened by `slack` of itself on both sides; never of zero width.
fn extent(values: impl Iterator<Item = f64>, slack: f64) -> std::ops::Range<f64> {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    if low > high {
        return 0.0..1.0;
    }
    // Halves first: the difference of two finite values may not be finite.
    let width = 2.0 * (0.5 * high - 0.5 * low).min(0.25 * f64::MAX);
    let pad = if width > 1e-9 * low.abs().max(high.abs()) {
        slack * width
    } else {
        (0.05 * low.abs()).max(f64::MIN_POSITIVE.sqrt())
    };
    (low - pad).max(-0.5 * f64::MAX)..(high + pad).min(0.5 * f64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(name: &str, points: Vec<[f64; 2]>, dashed: bool, colour: usize) -> Series {
        Series { name: name.to_owned(), points, dashed, colour: PALETTE[colour] }
    }

    fn chart(series: &[Series]) -> String {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("pressure.svg");
        line_chart(&path, "Tank <test> & \"more\"", "time (ms)", "pressure (kPa)", series).unwrap();
        std::fs::read_to_string(path).unwrap()
    }

    /// The coordinates of every polyline of one colour.
    fn polylines(svg: &str, colour: [u8; 3]) -> Vec<Vec<(i32, i32)>> {
        let [r, g, b] = colour;
        let stroke = format!("stroke=\"#{r:02X}{g:02X}{b:02X}\"");
        svg.lines()
            .filter(|line| line.starts_with("<polyline") && line.contains(&stroke))
            .map(|line| {
                let points = line.split("points=\"").nth(1).unwrap().split('"').next().unwrap();
                points
                    .split_whitespace()
                    .map(|pair| {
                        let (x, y) = pair.split_once(',').unwrap();
                        (x.parse().unwrap(), y.parse().unwrap())
                    })
                    .collect()
            })
            .collect()
    }

    fn ramp(slope: f64) -> Vec<[f64; 2]> {
        (0..=100).map(|i| [f64::from(i), 101.0 + slope * f64::from(i)]).collect()
    }

    #[test]
    fn a_line_rises_with_its_data_and_falls_when_the_data_fall() {
        let data_line = |slope| polylines(&chart(&[series("p", ramp(slope), false, 0)]), PALETTE[0]).remove(1);
        let (rising, falling) = (data_line(3.0), data_line(-0.5));
        assert_eq!(rising.len(), 101);
        assert!(rising.windows(2).all(|w| w[1].0 > w[0].0 && w[1].1 < w[0].1));
        assert!(falling.windows(2).all(|w| w[1].1 >= w[0].1) && falling[0].1 < falling[100].1);
    }

    #[test]
    fn names_title_and_labels_are_there_and_escaped() {
        let svg =
            chart(&[series("inner <particles>", ramp(1.0), false, 0), series("control volume", ramp(1.1), true, 1)]);
        for text in [
            "Tank &lt;test&gt; &amp; &quot;more&quot;",
            "inner &lt;particles&gt;",
            "control volume",
            "time (ms)",
            "pressure (kPa)",
        ] {
            assert!(svg.contains(text), "{text}");
        }
        assert!(!svg.contains("<particles>") && !svg.contains("no data"));
        assert!(polylines(&svg, stroke_colour(PALETTE[1], true)).len() > 20, "a reference line is dashed");
        assert!(svg.starts_with("<svg width=\"920\" height=\"540\" viewBox=\"0 0 1840 1080\""));
    }

    #[test]
    fn empty_single_and_broken_data_make_a_chart() {
        assert!(chart(&[]).contains("no data"));
        assert!(chart(&[series("p", vec![[f64::NAN, 1.0], [1.0, f64::INFINITY]], false, 0)]).contains("no data"));
        let single = chart(&[series("p", vec![[1.0, 2.0]], false, 0)]);
        assert!(single.contains("<circle") && !single.contains("no data"));
        let mut broken = ramp(1.0);
        broken[50][1] = f64::NAN;
        let lines = polylines(&chart(&[series("p", broken, false, 0)]), PALETTE[0]);
        assert_eq!(lines[1..].iter().map(Vec::len).collect::<Vec<_>>(), [50, 50]);
        for value in [0.0, 1e300, -1e300, 1e-300, f64::MAX, f64::MIN] {
            let flat = chart(&[series("p", vec![[0.0, value], [1.0, value]], true, 0)]);
            assert!(!flat.contains("NaN") && !flat.contains("inf"), "{value}");
        }
        chart(&[series("p", vec![[0.0, f64::MIN], [1.0, f64::MAX]], false, 0)]);
    }

    #[test]
    fn a_long_legend_takes_more_rows() {
        let many: Vec<Series> =
            (0..7).map(|i| series(&format!("chamber number {i}: particles"), ramp(1.0), false, i)).collect();
        let svg = chart(&many);
        let sample = |i: usize| polylines(&svg, PALETTE[i])[0][0];
        assert!(sample(6).1 > sample(0).1 && sample(0).1 == sample(1).1);
    }

    #[test]
    fn a_file_that_cannot_be_written_is_an_error() {
        let path = Path::new("/nonexistent/folder/pressure.svg");
        assert!(line_chart(path, "t", "x", "y", &[]).is_err());
    }
}
