//! Holes through walls: where they may lie, and that they do not meet.
//!
//! A circular hole is a regular polygon of the circle's area: n corners at distance
//! r sqrt(2 pi / (n sin(2 pi / n))) from its centre, and it is that distance that must fit the face.

use std::f64::consts::PI;

use super::errors::Problem;
use super::numbers::{positive, sides, small_count};
use super::raw::{RawFace, RawHole};
use super::raw_values::At;
use super::types::{Face, Hole, Outline, UnitSystem};
use super::units::Quantity;

const CIRCLE_SEGMENTS: u32 = 32;
/// Every pair of holes of a wall is compared.
const MOST_HOLES: usize = 1000;

/// A rectangle in the two axes of a face, m.
type Extent = [[f64; 2]; 2];

/// The holes of a box with cavity `cavity` (min, max) or of a plate of `plate` sides about its centre.
pub(super) fn holes(
    raw: &[At<RawHole>],
    cavity: Option<([f64; 3], [f64; 3])>,
    plate: Option<[f64; 2]>,
    units: UnitSystem,
) -> Result<Vec<Hole>, Problem> {
    if let Some(surplus) = raw.get(MOST_HOLES) {
        let found = format!("hole number {}", MOST_HOLES + 1);
        return Err(Problem::value(&surplus.span, found, format!("at most {MOST_HOLES} holes in a wall")));
    }
    let mut holes: Vec<Hole> = Vec::with_capacity(raw.len());
    for (index, entry) in raw.iter().enumerate() {
        let (face, extent) = face_of(entry, cavity, plate)?;
        let hole = hole(entry, face, extent, units)?;
        if let Some(other) = holes.iter().position(|earlier| earlier.face == hole.face && overlap(earlier, &hole)) {
            debug_assert!(other < index);
            let found = format!("a hole that meets the hole {:?}", holes[other].name);
            return Err(Problem::value(&entry.value.center.span, found, "holes apart from each other on a face")
                .clash(&raw[other].value.center.span));
        }
        holes.push(hole);
    }
    Ok(holes)
}

pub(super) fn face(raw: RawFace) -> Face {
    let (axis, positive) = match raw {
        RawFace::XLow => (0, false),
        RawFace::XHigh => (0, true),
        RawFace::YLow => (1, false),
        RawFace::YHigh => (1, true),
        RawFace::ZLow => (2, false),
        RawFace::ZHigh => (2, true),
    };
    Face::Box { axis, positive }
}

fn face_of(
    raw: &At<RawHole>,
    cavity: Option<([f64; 3], [f64; 3])>,
    plate: Option<[f64; 2]>,
) -> Result<(Face, Extent), Problem> {
    match (cavity, plate.unwrap_or_default(), &raw.value.face) {
        (Some(_), _, None) => Err(Problem::missing(
            &raw.span,
            "face",
            "the face of the box that the hole pierces: \"-x\", \"+x\", \"-y\", \"+y\", \"-z\" or \"+z\"",
        )),
        (Some((min, max)), _, Some(given)) => {
            let face = face(given.value);
            let across = match face {
                Face::Box { axis: 0, .. } => [1, 2],
                Face::Box { axis: 1, .. } => [0, 2],
                _ => [0, 1],
            };
            Ok((face, across.map(|axis| [min[axis], max[axis]])))
        }
        (None, _, Some(given)) => {
            Err(Problem::value(&given.span, "`face` of a hole in a plane", "no `face` here: a plane has only one"))
        }
        (None, size, None) => Ok((Face::Plane, size.map(|side| [-0.5 * side, 0.5 * side]))),
    }
}

fn hole(raw: &At<RawHole>, face: Face, extent: Extent, units: UnitSystem) -> Result<Hole, Problem> {
    let hole = &raw.value;
    let outline = match (&hole.size, &hole.diameter) {
        (Some(size), None) => {
            if let Some(segments) = &hole.segments {
                return Err(Problem::value(
                    &segments.span,
                    "`segments` of a rectangle",
                    "`segments` beside `diameter`",
                ));
            }
            Outline::Rectangle { size: sides(size, units)? }
        }
        (None, Some(diameter)) => Outline::Circle {
            diameter: positive(diameter, Quantity::Length, units)?,
            segments: hole.segments.as_ref().map_or(Ok(CIRCLE_SEGMENTS), |n| small_count(n, 3..=1024))?,
        },
        (Some(_), Some(diameter)) => {
            return Err(Problem::value(&diameter.span, "both `size` and `diameter`", "exactly one of them"));
        }
        (None, None) => {
            return Err(Problem::value(
                &raw.span,
                "neither `size` nor `diameter`",
                "`size` of a rectangle or `diameter` of a circle",
            ));
        }
    };
    let center = super::numbers::point(&hole.center, units)?;
    let half = half_extent(&outline);
    for axis in 0..2 {
        let [low, high] = extent[axis];
        let (from, to) = (center[axis] - half[axis], center[axis] + half[axis]);
        if from <= low || to >= high {
            let unit = units.factor(Quantity::Length);
            let symbol = units.symbol(Quantity::Length);
            let found = format!("a hole from {:.6} to {:.6} {symbol}", from / unit, to / unit);
            let allowed =
                format!("a hole inside its face, which goes from {:.6} to {:.6} {symbol}", low / unit, high / unit);
            return Err(Problem::value(&hole.center.value.0[axis].span, found, allowed));
        }
    }
    let flow_only = match &hole.flow_only {
        Some(asked) if asked.value && face == Face::Plane => {
            let allowed = "no `flow_only` here: what is behind a plate is no space of its own";
            return Err(Problem::value(&asked.span, "`flow_only` of a hole in a plane", allowed));
        }
        asked => asked.as_ref().is_some_and(|asked| asked.value),
    };
    Ok(Hole { name: hole.name.value.clone(), face, center, outline, flow_only })
}

/// Half the sides of the rectangle that holds the outline.
fn half_extent(outline: &Outline) -> [f64; 2] {
    match *outline {
        Outline::Rectangle { size } => size.map(|side| 0.5 * side),
        Outline::Circle { diameter, segments } => [corner_radius(diameter, segments); 2],
    }
}

/// From the centre to the corners of the polygon.
fn corner_radius(diameter: f64, segments: u32) -> f64 {
    let angle = 2.0 * PI / f64::from(segments);
    0.5 * diameter * (angle / angle.sin()).sqrt()
}

/// Whether two holes of a face touch (circles by the circle through their corners).
fn overlap(a: &Hole, b: &Hole) -> bool {
    // A circle is a point with a reach, a rectangle a box without one.
    let parts = |hole: &Hole| match hole.outline {
        Outline::Rectangle { size } => (size.map(|side| 0.5 * side), 0.0),
        Outline::Circle { diameter, segments } => ([0.0; 2], corner_radius(diameter, segments)),
    };
    let ((half_a, reach_a), (half_b, reach_b)) = (parts(a), parts(b));
    let gap: [f64; 2] =
        std::array::from_fn(|axis| ((a.center[axis] - b.center[axis]).abs() - half_a[axis] - half_b[axis]).max(0.0));
    gap[0].hypot(gap[1]) <= reach_a + reach_b
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hole(center: [f64; 2], outline: Outline) -> Hole {
        Hole { name: String::new(), face: Face::Plane, center, outline, flow_only: false }
    }

    /// The polygon has the area of the circle.
    #[test]
    fn the_corner_radius_gives_the_area_of_the_circle() {
        for segments in [3, 4, 32, 1024] {
            let (r, n) = (corner_radius(2.0, segments), f64::from(segments));
            let area = 0.5 * n * r * r * (2.0 * PI / n).sin();
            assert!((area / PI - 1.0).abs() < 1e-13, "{segments}: {area}");
            assert!(r > 1.0);
        }
    }

    #[test]
    fn holes_overlap_exactly_where_their_outlines_meet() {
        let square = |x, y| hole([x, y], Outline::Rectangle { size: [2.0, 2.0] });
        let circle = |x, y| hole([x, y], Outline::Circle { diameter: 2.0, segments: 1024 });
        assert!(overlap(&square(0.0, 0.0), &square(2.0, 1.0)));
        assert!(!overlap(&square(0.0, 0.0), &square(2.1, 0.0)));
        assert!(overlap(&circle(0.0, 0.0), &circle(1.4, 1.4)));
        assert!(!overlap(&circle(0.0, 0.0), &circle(1.5, 1.5)));
        assert!(overlap(&square(0.0, 0.0), &circle(1.6, 1.6)));
        assert!(!overlap(&square(0.0, 0.0), &circle(1.8, 1.8)));
        assert!(overlap(&square(0.0, 0.0), &circle(0.1, 0.1)), "one inside the other");
    }
}
