//! Meshes that cross themselves.
//!
//! Two triangles of a wall that meet beside a common edge meet along a segment, or where they lie in one plane in an
//! area. Whether that is wrong is asked of the places around its middle: in how many solids of the wall they are. A
//! surface that crosses itself parts its surroundings into places of depth k, k + 1, k + 2 and k + 1. So of a cavity (depth
//! 0 and 1) every crossing is wrong; of solids one that leaves a place of depth -1, while places of depth 2 are an
//! overlap, and the union is the solid. Two triangles in one plane that face away from each other with gas on both sides are a
//! sheet without thickness. Surfaces that only touch are neither.
//!
//! The triangles are swept along the axis on which they are shortest; a triangle is compared with those whose boxes meet its
//! own. What meets in less than [`SHORT`] of the wall's extent is rounding.

use super::error::{GeometryError, Places};
use super::sampling::map;
use super::vessel::{Overlaps, Vessel};
use glam::DVec3;

/// Over the extent of the wall.
const SHORT: f64 = 1e-8;
/// How far beside a crossing its surroundings are, over its length.
const BESIDE: f64 = 1e-3;
/// What barycentric coordinates and shares of edges may miss by rounding.
const SLACK: f64 = 1e-9;
/// Over the extent: how far from a plane corners lie in it.
const FLAT: f64 = 1e-12;

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Crossing,
    Overlap,
    Sheet,
}

/// A triangle of the wall that is looked at.
struct Facet {
    ids: [u32; 3],
    corners: [DVec3; 3],
    normal: DVec3,
    low: DVec3,
    high: DVec3,
}

/// Where two triangles meet.
struct Meeting {
    middle: DVec3,
    /// Its length, or the least width of an area.
    size: f64,
    in_one_plane: bool,
}

impl Vessel {
    /// The overlaps of a wall's solids; `subject` names it in errors.
    pub(super) fn find_crossings(&self, wall: usize, subject: &str) -> Result<Option<Overlaps>, GeometryError> {
        let own = self.triangles.iter().filter(|triangle| triangle.wall as usize == wall);
        let mut facets: Vec<Facet> = own.map(|triangle| self.facet(triangle.vertices)).collect();
        let Some(first) = facets.first() else { return Ok(None) };
        let (low, high) = facets.iter().fold((first.low, first.high), |(a, b), f| (a.min(f.low), b.max(f.high)));
        let extent = (high - low).max_element();
        let axis = sweep_axis(&facets, high - low);
        facets.sort_by(|a, b| a.low[axis].total_cmp(&b.low[axis]).then(a.ids.cmp(&b.ids)));
        let found = map(facets.len(), |index, _| {
            let own = &facets[index];
            let later = facets[index + 1..].iter().take_while(|other| other.low[axis] <= own.high[axis]);
            let near = later.filter(|other| own.low.cmple(other.high).all() && other.low.cmple(own.high).all());
            let judged = near.filter_map(|other| self.judged(wall, own, other, extent));
            judged.collect::<Vec<(Kind, DVec3)>>()
        });
        let found: Vec<(Kind, DVec3)> = found.into_iter().flatten().collect();
        let of = |kind: Kind| {
            let places = || found.iter().filter(move |(own, _)| *own == kind).map(|(_, place)| vec![*place]);
            (places().count(), Places::of(places(), ""))
        };
        let wall = || subject.to_string();
        match [of(Kind::Crossing), of(Kind::Sheet), of(Kind::Overlap)] {
            [(0, _), (0, _), (0, _)] => Ok(None),
            [(0, _), (0, _), (count, first)] => Ok(Some(Overlaps { count, first })),
            [(0, _), (count, first), _] => Err(GeometryError::Sheet { wall: wall(), count, first }),
            [(count, first), ..] => Err(GeometryError::Crossing { wall: wall(), count, first }),
        }
    }

    fn facet(&self, ids: [u32; 3]) -> Facet {
        let corners @ [a, b, c] = ids.map(|v| DVec3::from(self.vertices[v as usize]));
        let normal = (b - a).cross(c - a).normalize_or_zero();
        Facet { ids, corners, normal, low: a.min(b).min(c), high: a.max(b).max(c) }
    }

    /// What the meeting of two triangles is, and where; `None` where they do not meet, or only touch.
    fn judged(&self, wall: usize, a: &Facet, b: &Facet, extent: f64) -> Option<(Kind, DVec3)> {
        let meeting = meeting(a, b, extent)?;
        if meeting.size < SHORT * extent {
            return None;
        }
        let step = BESIDE * meeting.size;
        let sides = around(a, b, meeting.in_one_plane);
        let places = sides.iter().map(|side| (meeting.middle + *side * step).to_array());
        let depths: Vec<i32> = places.clone().map(|place| self.depth_of(wall, place)).collect();
        let cavity = self.walls[wall].cavity;
        let (least, most) = (depths.iter().min()?, depths.iter().max()?);
        let kind = if *least < 0 || *most > 1 && cavity {
            Kind::Crossing
        } else if *most > 1 {
            Kind::Overlap
        } else if meeting.in_one_plane && a.normal.dot(b.normal) < 0.0 && places.clone().all(|place| self.is_gas(place))
        {
            Kind::Sheet
        } else {
            return None;
        };
        Some((kind, meeting.middle))
    }

    /// In how many solids of a wall a place is; what lies outside of a cavity is one.
    pub fn depth_of(&self, wall: usize, place: [f64; 3]) -> i32 {
        let mut depth = i32::from(self.walls[wall].cavity);
        self.lines_through(place, |crossing| {
            if crossing.wall as usize == wall && crossing.x > place[0] {
                depth += crossing.sign;
            }
        });
        depth
    }
}

/// The axis on which the triangles are shortest, over their range.
fn sweep_axis(facets: &[Facet], range: DVec3) -> usize {
    let lengths: DVec3 = facets.iter().map(|facet| facet.high - facet.low).sum();
    let share = |axis: usize| if range[axis] > 0.0 { lengths[axis] / range[axis] } else { f64::INFINITY };
    (0..3).min_by(|&a, &b| share(a).total_cmp(&share(b))).unwrap_or(0)
}

/// Directions into each of the places that two triangles part around a common point.
fn around(a: &Facet, b: &Facet, in_one_plane: bool) -> Vec<DVec3> {
    if in_one_plane {
        return vec![a.normal, -a.normal];
    }
    let line = a.normal.cross(b.normal).normalize();
    let [along_a, along_b] = [a, b].map(|facet| facet.normal.cross(line));
    [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]
        .map(|(p, q)| (p * along_a + q * along_b).normalize_or_zero())
        .to_vec()
}

fn meeting(a: &Facet, b: &Facet, extent: f64) -> Option<Meeting> {
    let shared = a.ids.iter().filter(|id| b.ids.contains(id)).count();
    let above = |of: &Facet, plane: &Facet| of.corners.map(|corner| (corner - plane.corners[0]).dot(plane.normal));
    let (a_above, b_above) = (above(a, b), above(b, a));
    let flat = |heights: [f64; 3]| heights.iter().all(|height| height.abs() <= FLAT * extent);
    if flat(a_above) && flat(b_above) {
        return common_area(a, b);
    }
    let apart = |heights: [f64; 3]| heights.iter().all(|h| *h > 0.0) || heights.iter().all(|h| *h < 0.0);
    if shared >= 2 || apart(a_above) || apart(b_above) {
        return None;
    }
    let points: Vec<DVec3> = hits(a, b, a_above).chain(hits(b, a, b_above)).collect();
    let line = a.normal.cross(b.normal).try_normalize()?;
    let along = |point: &&DVec3| point.dot(line);
    let from = points.iter().min_by(|p, q| along(p).total_cmp(&along(q)))?;
    let to = points.iter().max_by(|p, q| along(p).total_cmp(&along(q)))?;
    Some(Meeting { middle: (*from + *to) / 2.0, size: from.distance(*to), in_one_plane: false })
}

/// Where the edges of a triangle, whose corners are so far above the plane of another, meet that one.
fn hits<'a>(of: &'a Facet, other: &'a Facet, above: [f64; 3]) -> impl Iterator<Item = DVec3> + 'a {
    (0..3).filter_map(move |k| {
        let next = (k + 1) % 3;
        let (from, to) = (above[k], above[next]);
        if from == to || from.signum() == to.signum() && from != 0.0 && to != 0.0 {
            return None;
        }
        let point = of.corners[k].lerp(of.corners[next], from / (from - to));
        let inside = (0..3).all(|e| {
            let (p, q, r) = (other.corners[e], other.corners[(e + 1) % 3], other.corners[(e + 2) % 3]);
            let inwards = other.normal.cross(q - p);
            (point - p).dot(inwards) >= -SLACK * (r - p).dot(inwards)
        });
        inside.then_some(point)
    })
}

/// What two triangles in one plane have in common (Sutherland and Hodgman 1974).
fn common_area(a: &Facet, b: &Facet) -> Option<Meeting> {
    let mut polygon = a.corners.to_vec();
    for k in 0..3 {
        let (p, q) = (b.corners[k], b.corners[(k + 1) % 3]);
        let inwards = b.normal.cross(q - p).normalize_or_zero();
        let inside = |point: DVec3| (point - p).dot(inwards);
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (k, &to) in polygon.iter().enumerate() {
            let from = polygon[(k + polygon.len() - 1) % polygon.len()];
            let (before, after) = (inside(from), inside(to));
            if (before > 0.0) != (after > 0.0) {
                kept.push(from + (to - from) * (before / (before - after)));
            }
            if after > 0.0 {
                kept.push(to);
            }
        }
        polygon = kept;
    }
    let first = *polygon.first()?;
    let middle = polygon.iter().sum::<DVec3>() / polygon.len() as f64;
    let doubled: DVec3 = polygon.windows(2).map(|pair| (pair[0] - first).cross(pair[1] - first)).sum();
    let longest = polygon.iter().map(|point| point.distance(middle)).fold(0.0, f64::max);
    (longest > 0.0).then(|| Meeting { middle, size: doubled.length() / longest, in_one_plane: true })
}
