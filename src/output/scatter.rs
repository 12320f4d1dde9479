//! Scatter charts on two logarithmic axes as SVG: marks by group, error bars, a front.

use std::path::Path;

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::OutputError;
use super::chart::{Area, Drawn, INK, LETTER, MARGIN, SIZE, TEXT, save, text_style};

/// The shape of a group's marks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    Circle,
    Square,
    Triangle,
    Diamond,
    Cross,
}

/// Marks of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    pub name: String,
    pub colour: [u8; 3],
    pub shape: Shape,
    pub marks: Vec<Mark>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// (x, y), both above zero; others are not drawn.
    pub place: [f64; 2],
    /// Half the length of the error bar along y.
    pub bar: Option<f64>,
    /// 0 to 1: how large.
    pub size: f64,
    pub hollow: bool,
}

#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scatter {
    pub title: String,
    pub x_label: String,
    pub y_label: String,
    pub groups: Vec<Group>,
    /// Joined by steps, by rising x.
    pub front: Vec<[f64; 2]>,
    /// Places with a ring around them, and what it means.
    pub ringed: Vec<[f64; 2]>,
    pub ring_name: String,
    /// Lines of small text below the legend.
    pub notes: Vec<String>,
}

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

const LINE: i32 = 46;
const SAMPLE: i32 = 44;
const RING: i32 = 24;
const GRID: RGBColor = RGBColor(225, 225, 225);

/// Draws the chart into `path`. Errors: the file cannot be written.
pub fn scatter_chart(path: &Path, scatter: &Scatter) -> Result<(), OutputError> {
    save(path, SIZE, |svg| draw(svg, scatter))
}

fn draw(svg: &mut String, scatter: &Scatter) -> Drawn {
    let root = SVGBackend::with_string(svg, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let left = Pos::new(HPos::Left, VPos::Center);
    root.draw(&Text::new(scatter.title.clone(), (MARGIN, MARGIN + 10), text_style(1.25 * TEXT).pos(left)))?;
    let mut bottom = draw_legend(&root, MARGIN + 10 + LINE, scatter)?;
    for note in &scatter.notes {
        root.draw(&Text::new(note.clone(), (MARGIN, bottom), text_style(0.85 * TEXT).pos(left)))?;
        bottom += LINE;
    }
    let (_, plot) = root.split_vertically(bottom);
    draw_plot(&plot, scatter)?;
    root.present()?;
    Ok(())
}

fn draw_plot(area: &Area, scatter: &Scatter) -> Drawn {
    let marks = || scatter.groups.iter().flat_map(|group| &group.marks).filter(|mark| drawable(mark.place));
    let places = || marks().map(|mark| mark.place);
    let ends = marks().flat_map(|mark| {
        let [_, y] = mark.place;
        let bar = mark.bar.unwrap_or(0.0);
        // A bar down to zero has no end on a logarithmic axis.
        [y + bar, if y - bar > 0.3 * y { y - bar } else { 0.3 * y }].map(|end| if bar > 0.0 { end } else { y })
    });
    let x = decades(places().map(|place| place[0]));
    let y = decades(ends);
    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .margin_top(MARGIN / 2)
        .x_label_area_size(110)
        .y_label_area_size(170)
        .build_cartesian_2d(x.clone(), y.clone())?;
    chart.configure_mesh().disable_mesh().x_labels(0).y_labels(0).axis_style(INK.stroke_width(2)).draw()?;
    draw_axes(area, &mut chart, scatter, [&x, &y])?;
    if places().next().is_none() {
        let centre = (0.5 * (x.start + x.end), 0.5 * (y.start + y.end));
        let style = text_style(1.25 * TEXT).pos(Pos::new(HPos::Center, VPos::Center));
        chart.draw_series([Text::new("no data", centre, style)])?;
    }
    let front: Vec<[f64; 2]> = scatter.front.iter().copied().filter(|place| drawable(*place)).collect();
    chart.draw_series([PathElement::new(stairs(&front), INK.stroke_width(3))])?;
    for group in &scatter.groups {
        for mark in group.marks.iter().filter(|mark| drawable(mark.place)) {
            draw_mark(&mut chart, group, mark)?;
        }
    }
    let rings = scatter.ringed.iter().filter(|place| drawable(**place)).map(|place| logarithms(*place));
    chart.draw_series(rings.map(|place| Circle::new(place, RING, INK.stroke_width(5))))?;
    Ok(())
}

fn draw_axes(area: &Area, chart: &mut Chart<'_, '_>, scatter: &Scatter, [x, y]: [&std::ops::Range<f64>; 2]) -> Drawn {
    // Ticks of both axes with their grid lines; labels hang on places of the drawing.
    for tick in ticks(x) {
        chart
            .draw_series([PathElement::new([(tick.log10(), y.start), (tick.log10(), y.end)], GRID.stroke_width(2))])?;
        let (left, bottom) = local(area, chart.backend_coord(&(tick.log10(), y.start)));
        let style = text_style(TEXT).pos(Pos::new(HPos::Center, VPos::Top));
        area.draw(&Text::new(label(tick), (left, bottom + 14), style))?;
    }
    for tick in ticks(y) {
        chart
            .draw_series([PathElement::new([(x.start, tick.log10()), (x.end, tick.log10())], GRID.stroke_width(2))])?;
        let (left, middle) = local(area, chart.backend_coord(&(x.start, tick.log10())));
        let style = text_style(TEXT).pos(Pos::new(HPos::Right, VPos::Center));
        area.draw(&Text::new(label(tick), (left - 14, middle), style))?;
    }
    let (left, bottom) = local(area, chart.backend_coord(&(x.start, y.start)));
    let (right, top) = local(area, chart.backend_coord(&(x.end, y.end)));
    let style = text_style(1.1 * TEXT).pos(Pos::new(HPos::Center, VPos::Bottom));
    let (_, height) = area.dim_in_pixel();
    area.draw(&Text::new(scatter.x_label.clone(), ((left + right) / 2, height as i32 - 24), style))?;
    let style = text_style(1.1 * TEXT).transform(FontTransform::Rotate270).pos(Pos::new(HPos::Center, VPos::Top));
    area.draw(&Text::new(scatter.y_label.clone(), (MARGIN / 2, (top + bottom) / 2), style))?;
    Ok(())
}

/// A place of the drawing within a part of it.
fn local(area: &Area, place: (i32, i32)) -> (i32, i32) {
    let (left, top) = area.get_base_pixel();
    (place.0 - left, place.1 - top)
}

fn draw_mark(chart: &mut Chart<'_, '_>, group: &Group, mark: &Mark) -> Drawn {
    let [r, g, b] = group.colour;
    let colour = RGBColor(r, g, b);
    let (x, y) = logarithms(mark.place);
    if let Some(bar) = mark.bar.filter(|bar| *bar > 0.0) {
        let low = (mark.place[1] - bar).max(0.3 * mark.place[1]);
        let ends = [(x, low.log10()), (x, (mark.place[1] + bar).log10())];
        chart.draw_series([PathElement::new(ends, colour.stroke_width(3))])?;
    }
    let (inside, outline) = parts(group.shape, radius(mark.size), colour, mark.hollow);
    chart.draw_series([EmptyElement::at((x, y)) + inside + outline])?;
    Ok(())
}

fn radius(size: f64) -> i32 {
    (7.0 + 9.0 * size.clamp(0.0, 1.0)) as i32
}

type Parts = (Polygon<(i32, i32)>, PathElement<(i32, i32)>);

/// The inside and the outline of a mark around the origin, in units of the drawing.
fn parts(shape: Shape, radius: i32, colour: RGBColor, hollow: bool) -> Parts {
    let corners = |count: u32, turn: f64, reach: f64| -> Vec<(i32, i32)> {
        let reach = reach * f64::from(radius);
        let corner = |k: u32| {
            let angle = std::f64::consts::TAU * (f64::from(k) + turn) / f64::from(count);
            ((reach * angle.sin()).round() as i32, (-reach * angle.cos()).round() as i32)
        };
        (0..count).map(corner).collect()
    };
    let outline = match shape {
        Shape::Circle => corners(24, 0.0, 1.0),
        Shape::Square => corners(4, 0.5, 1.25),
        Shape::Triangle => corners(3, 0.0, 1.3),
        Shape::Diamond => corners(4, 0.0, 1.35),
        // A star of four.
        Shape::Cross => {
            let (tips, dents) = (corners(4, 0.5, 1.5), corners(4, 0.0, 0.45));
            dents.into_iter().zip(tips).flat_map(|(dent, tip)| [dent, tip]).collect()
        }
    };
    let closed: Vec<(i32, i32)> = outline.iter().chain(outline.first()).copied().collect();
    let fill = if hollow { WHITE } else { colour };
    (Polygon::new(outline, fill.filled()), PathElement::new(closed, colour.stroke_width(3)))
}

fn draw_legend(root: &Area, top: i32, scatter: &Scatter) -> Result<i32, Box<dyn std::error::Error>> {
    let left = Pos::new(HPos::Left, VPos::Center);
    let right = SIZE.0 as i32 - MARGIN;
    let (mut x, mut y) = (MARGIN, top);
    let mut entries: Vec<(String, Option<&Group>, bool)> =
        scatter.groups.iter().map(|group| (group.name.clone(), Some(group), false)).collect();
    if !scatter.front.is_empty() {
        entries.push(("front".to_owned(), None, false));
    }
    if !scatter.ringed.is_empty() {
        entries.push((scatter.ring_name.clone(), None, true));
    }
    for (name, group, ring) in entries {
        let width = SAMPLE + (LETTER * name.chars().count() as f64) as i32 + 50;
        if x > MARGIN && x + width > right {
            (x, y) = (MARGIN, y + LINE);
        }
        let centre = (x + SAMPLE / 2, y);
        match group {
            Some(group) => {
                let [r, g, b] = group.colour;
                let (inside, outline) = parts(group.shape, radius(0.6), RGBColor(r, g, b), false);
                root.draw(&(EmptyElement::at(centre) + inside + outline))?;
            }
            None if ring => root.draw(&Circle::new(centre, RING - 6, INK.stroke_width(5)))?,
            None => root.draw(&PathElement::new([(x, y), (x + SAMPLE, y)], INK.stroke_width(3)))?,
        }
        root.draw(&Text::new(name, (x + SAMPLE + 10, y), text_style(TEXT).pos(left)))?;
        x += width;
    }
    Ok(y + LINE)
}

fn drawable(place: [f64; 2]) -> bool {
    place.iter().all(|value| value.is_finite() && *value > 0.0)
}

fn logarithms([x, y]: [f64; 2]) -> (f64, f64) {
    (x.log10(), y.log10())
}

/// The corners of the steps that join a front: what costs more and is no better is not between two of its points.
fn stairs(front: &[[f64; 2]]) -> Vec<(f64, f64)> {
    let mut corners = Vec::new();
    for &place in front {
        let (x, y) = logarithms(place);
        if let Some(&(_, above)) = corners.last() {
            corners.push((x, above));
        }
        corners.push((x, y));
    }
    corners
}

/// The range of the logarithms, with room at both ends; never of no width.
fn decades(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let positive = values.filter(|value| value.is_finite() && *value > 0.0).map(f64::log10);
    let (low, high) = positive.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if low > high {
        return -1.0..1.0;
    }
    let room = (0.06 * (high - low)).max(0.06);
    low - room..high + room
}

/// 1, 2 and 5 times the powers of ten in a range of logarithms; only the powers where there are many.
fn ticks(range: &std::ops::Range<f64>) -> Vec<f64> {
    let factors: &[f64] = match range.end - range.start {
        width if width > 4.0 => &[1.0],
        width if width > 0.7 => &[1.0, 2.0, 5.0],
        _ => &[1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0],
    };
    let exponents = range.start.floor() as i32..=range.end.ceil() as i32;
    let all = exponents.flat_map(|exponent| factors.iter().map(move |factor| factor * 10f64.powi(exponent)));
    all.filter(|tick| range.contains(&tick.log10())).collect()
}

fn label(tick: f64) -> String {
    let decimals = (1.0 - tick.log10().floor()).clamp(0.0, 9.0) as usize;
    let text = if (1e-4..1e6).contains(&tick) { format!("{tick:.decimals$}") } else { format!("{tick:e}") };
    if text.contains('.') && !text.contains('e') {
        return text.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::PALETTE;

    fn mark(x: f64, y: f64) -> Mark {
        Mark { place: [x, y], bar: None, size: 0.5, hollow: false }
    }

    fn group(name: &str, marks: Vec<Mark>) -> Group {
        Group { name: name.into(), colour: PALETTE[0], shape: Shape::Circle, marks }
    }

    fn chart(scatter: &Scatter) -> String {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("chart.svg");
        scatter_chart(&path, scatter).unwrap();
        std::fs::read_to_string(path).unwrap()
    }

    fn of(groups: Vec<Group>) -> Scatter {
        Scatter { title: "Sod <&>".into(), x_label: "device time, s".into(), groups, ..Scatter::default() }
    }

    #[test]
    fn marks_bars_front_and_rings_are_drawn() {
        let plain = of(vec![group("cell", vec![mark(1.0, 0.1), mark(10.0, 0.01)])]);
        let count = |scatter: &Scatter, what: &str| chart(scatter).matches(what).count();
        let one_less = of(vec![group("cell", vec![mark(1.0, 0.1)])]);
        assert_eq!(count(&plain, "<polygon") - count(&one_less, "<polygon"), 1);
        let front = Scatter { front: vec![[1.0, 0.1], [10.0, 0.01]], ..plain.clone() };
        assert!(count(&front, "<polyline") > count(&plain, "<polyline"));
        let ringed = Scatter { ringed: vec![[1.0, 0.1]], ring_name: "default".into(), ..plain.clone() };
        assert_eq!(count(&ringed, "<circle") - count(&plain, "<circle"), 2);
        let mut barred = plain.clone();
        barred.groups[0].marks[0].bar = Some(0.02);
        assert_eq!(count(&barred, "<polyline") - count(&plain, "<polyline"), 1);
        let svg = chart(&plain);
        assert!(svg.contains("Sod &lt;&amp;&gt;") && svg.contains("device time, s"), "{svg}");
    }

    /// Also what has no place on a logarithmic axis, or no width, makes a chart.
    #[test]
    fn nothing_to_draw_makes_a_chart_that_says_so() {
        for marks in [vec![], vec![mark(0.0, 1.0), mark(1.0, -1.0), mark(f64::NAN, 1.0), mark(1.0, f64::INFINITY)]] {
            assert!(chart(&of(vec![group("none", marks)])).contains("no data"));
        }
        let mut wide = mark(3.0, 0.2);
        wide.bar = Some(7.0);
        let svg = chart(&of(vec![group("none", vec![wide])]));
        assert!(!svg.contains("no data") && !svg.contains("NaN") && !svg.contains("inf"));
    }

    #[test]
    fn ticks_are_round_and_enough() {
        assert_eq!(ticks(&(-1.1..1.1)), [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0]);
        assert!(ticks(&(-1.6..-1.3)).len() >= 2);
        assert_eq!(ticks(&(-3.5..1.5)).len(), 5);
        assert_eq!([0.02, 0.25, 1.0, 50.0, 1e-3].map(label), ["0.02", "0.25", "1", "50", "0.001"]);
        assert_eq!(label(1e-5), "1e-5");
    }

    #[test]
    fn a_front_goes_in_steps() {
        let corners = stairs(&[[1.0, 100.0], [10.0, 1.0]]);
        assert_eq!(corners, [(0.0, 2.0), (1.0, 2.0), (1.0, 0.0)]);
    }
}
