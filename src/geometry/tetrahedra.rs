//! What a closed surface encloses, cut into tetrahedra: a uniform point of it is drawn without trying, however flat or folded it is.
//!
//! Seen along the axis across which the surface shows most area, each triangle looks down on the next one below it. Which that is changes over the
//! triangle: it is cut, as when hidden surfaces are removed (Sutherland, Sproull and Schumacker 1974), into convex pieces that look down on one
//! triangle each. Between a piece and what lies below it there is no other surface, so that either all of that prism is inside or nothing. Those
//! that are inside fill the surface exactly, and a prism between two planes is at most three tetrahedra over each triangle of its base.
//!
//! Invariants: the tetrahedra do not overlap, and their volumes sum up to that of the surface, but for rounding. They depend on the surface
//! alone, not on the number of threads.

use super::meshes::ClosedSurface;
use super::sampling::map;
use glam::{DVec2, DVec3};

/// Over a triangle's area seen along the axis: pieces below are rounding.
const SLIVER: f64 = 1e-12;
/// Triangles in a bucket of the index, about.
const PER_BUCKET: f64 = 4.0;
const MOST_BUCKETS: f64 = 2048.0;

#[derive(Debug, Clone)]
pub struct Tetrahedra {
    corners: Vec<[DVec3; 4]>,
    /// The volumes of each and of all before it, m3.
    sums: Vec<f64>,
}

impl Tetrahedra {
    /// Cuts what the surface of `triangles` encloses, with their nodes at these places, m.
    pub fn new(surface: &ClosedSurface, nodes: &[[f64; 3]], triangles: &[[u32; 3]]) -> Tetrahedra {
        let places = || triangles.iter().map(|triangle| triangle.map(|node| DVec3::from(nodes[node as usize])));
        let axis = widest(places());
        // From its middle, so that a surface far from the origin loses no digits.
        let corners = || places().flatten();
        let (low, high) =
            corners().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), corner| (a.min(corner), b.max(corner)));
        let frame = Frame { axis, origin: 0.5 * (low + high) };
        let faces: Vec<Face> =
            places().filter_map(|corners| Face::new(corners.map(|corner| frame.seen(corner)))).collect();
        let index = Index::new(&faces);
        let pieces = map(faces.len(), |face, _| looked_down_on(&faces, face, &index));
        let mut all = Tetrahedra { corners: Vec::new(), sums: Vec::new() };
        for (face, pieces) in faces.iter().zip(pieces) {
            for (polygon, below) in pieces {
                all.add_prism(&polygon, [&faces[below], face], (surface, &frame));
            }
        }
        all
    }

    /// m3.
    pub fn volume(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
    }

    /// A uniform point for four numbers between 0 and 1; none if nothing is enclosed.
    pub fn point(&self, [which, a, b, c]: [f64; 4]) -> Option<[f64; 3]> {
        let wanted = which * self.volume();
        let index = self.sums.partition_point(|&sum| sum <= wanted).min(self.corners.len().checked_sub(1)?);
        // The gaps between three uniform numbers in order are uniform shares of four corners.
        let mut cuts = [a, b, c];
        cuts.sort_by(f64::total_cmp);
        let shares = [cuts[0], cuts[1] - cuts[0], cuts[2] - cuts[1], 1.0 - cuts[2]];
        let place: DVec3 = self.corners[index].iter().zip(shares).map(|(corner, share)| *corner * share).sum();
        Some(place.to_array())
    }

    /// What lies between a polygon of a face and the plane of one below, if that is inside.
    fn add_prism(&mut self, polygon: &[DVec2], [below, above]: [&Face; 2], (surface, frame): (&ClosedSurface, &Frame)) {
        let at = |place: DVec2, face: &Face| frame.place(place.extend(face.height(place)));
        let middle = polygon.iter().sum::<DVec2>() / polygon.len() as f64;
        if !surface.contains((0.5 * (at(middle, below) + at(middle, above))).to_array()) {
            return;
        }
        for k in 2..polygon.len() {
            let base = [polygon[0], polygon[k - 1], polygon[k]];
            let [a, b, c] = base.map(|place| at(place, below));
            let [d, e, f] = base.map(|place| at(place, above));
            for corners in [[a, b, c, f], [a, b, e, f], [a, d, e, f]] {
                let [p, q, r, s] = corners;
                let volume = (q - p).cross(r - p).dot(s - p).abs() / 6.0;
                if volume > 0.0 {
                    self.corners.push(corners);
                    self.sums.push(self.volume() + volume);
                }
            }
        }
    }
}

/// The axis along which triangles show most area.
fn widest(triangles: impl Iterator<Item = [DVec3; 3]>) -> usize {
    let seen: DVec3 = triangles.map(|[a, b, c]| (b - a).cross(c - a).abs()).sum();
    (0..3).max_by(|&a, &b| seen[a].total_cmp(&seen[b])).unwrap_or(2)
}

/// Places as they are seen along an axis: two coordinates across it, and the height.
struct Frame {
    axis: usize,
    origin: DVec3,
}

impl Frame {
    fn seen(&self, place: DVec3) -> DVec3 {
        let from = (place - self.origin).to_array();
        DVec3::new(from[(self.axis + 1) % 3], from[(self.axis + 2) % 3], from[self.axis])
    }

    fn place(&self, seen: DVec3) -> DVec3 {
        let mut place = [0.0; 3];
        (place[(self.axis + 1) % 3], place[(self.axis + 2) % 3], place[self.axis]) = (seen.x, seen.y, seen.z);
        DVec3::from(place) + self.origin
    }
}

/// A triangle that is not seen edge-on.
struct Face {
    /// Counter-clockwise.
    corners: [DVec2; 3],
    area: f64,
    low: DVec2,
    high: DVec2,
    /// Its height is `level` + `slope` . (p - first corner).
    level: f64,
    slope: DVec2,
}

impl Face {
    fn new([a, b, c]: [DVec3; 3]) -> Option<Face> {
        let (ab, ac) = (b - a, c - a);
        let doubled = ab.truncate().perp_dot(ac.truncate());
        let longest = ab.truncate().length_squared().max(ac.truncate().length_squared());
        if doubled.is_nan() || doubled.abs() <= SLIVER * longest {
            return None;
        }
        let slope = DVec2::new(ab.z * ac.y - ac.z * ab.y, ac.z * ab.x - ab.z * ac.x) / doubled;
        let [p, q, r] = [a, b, c].map(DVec3::truncate);
        Some(Face {
            corners: if doubled > 0.0 { [p, q, r] } else { [p, r, q] },
            area: 0.5 * doubled.abs(),
            low: p.min(q).min(r),
            high: p.max(q).max(r),
            level: a.z,
            slope,
        })
    }

    fn height(&self, place: DVec2) -> f64 {
        self.level + self.slope.dot(place - self.corners[0])
    }
}

/// Faces by the squares that their boxes touch.
struct Index {
    low: DVec2,
    width: f64,
    columns: usize,
    rows: usize,
    buckets: Vec<Vec<u32>>,
}

impl Index {
    fn new(faces: &[Face]) -> Index {
        let far = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (low, high) = faces.iter().fold(far, |(low, high), face| (low.min(face.low), high.max(face.high)));
        let extent = if faces.is_empty() { DVec2::ONE } else { high - low };
        let wanted = (extent.x * extent.y / (faces.len().max(1) as f64 / PER_BUCKET)).sqrt();
        let width = wanted.max(extent.max_element() / MOST_BUCKETS).max(f64::MIN_POSITIVE);
        let number = |length: f64| (length / width) as usize + 1;
        let (columns, rows) = (number(extent.x), number(extent.y));
        let mut index = Index { low, width, columns, rows, buckets: vec![Vec::new(); columns * rows] };
        for (k, face) in faces.iter().enumerate() {
            index.touched(face).for_each(|bucket| index.buckets[bucket].push(k as u32));
        }
        index
    }

    fn touched(&self, face: &Face) -> impl Iterator<Item = usize> + use<> {
        let (columns, last) = (self.columns, [self.columns - 1, self.rows - 1]);
        let [from, to] = [face.low, face.high].map(|corner| {
            let places = ((corner - self.low) / self.width).to_array();
            [0, 1].map(|axis| (places[axis] as usize).min(last[axis]))
        });
        (from[1]..=to[1]).flat_map(move |row| (from[0]..=to[0]).map(move |column| row * columns + column))
    }

    /// Those whose boxes meet that of a face, in order.
    fn near(&self, faces: &[Face], face: usize) -> Vec<usize> {
        let own = &faces[face];
        let mut near: Vec<usize> =
            self.touched(own).flat_map(|bucket| self.buckets[bucket].iter().map(|&k| k as usize)).collect();
        near.sort_unstable();
        near.dedup();
        near.retain(|&k| k != face && faces[k].low.cmple(own.high).all() && own.low.cmple(faces[k].high).all());
        near
    }
}

type Polygon = Vec<DVec2>;

/// The pieces of a face that look down on one other face each, which is told.
fn looked_down_on(faces: &[Face], face: usize, index: &Index) -> Vec<(Polygon, usize)> {
    let own = &faces[face];
    let mut near = index.near(faces, face);
    // The nearest first, which hide the others.
    let depth = |other: &usize| {
        let middle = faces[*other].corners.iter().sum::<DVec2>() / 3.0;
        own.height(middle) - faces[*other].height(middle)
    };
    near.sort_by(|a, b| depth(a).total_cmp(&depth(b)).then(a.cmp(b)));
    let mut pieces: Vec<(Polygon, Option<usize>)> = vec![(own.corners.to_vec(), None)];
    for other in near {
        let mut next = Vec::with_capacity(pieces.len() + 4);
        for (polygon, seen) in pieces {
            let view = View { own, below: &faces[other], floor: seen.map(|seen| &faces[seen]) };
            match view.parts(&polygon) {
                None => next.push((polygon, seen)),
                Some((hiding, rest)) => {
                    next.push((hiding, Some(other)));
                    next.extend(rest.into_iter().map(|part| (part, seen)));
                }
            }
        }
        pieces = next;
    }
    pieces.into_iter().filter_map(|(polygon, seen)| Some((polygon, seen?))).collect()
}

/// A face, another, and what is seen so far of what lies below the first.
struct View<'a> {
    own: &'a Face,
    below: &'a Face,
    floor: Option<&'a Face>,
}

impl View<'_> {
    /// The part of a convex polygon of the face below which the other one is nearer than what is seen so far, and the rest in convex parts;
    /// none if there is no such part.
    fn parts(&self, polygon: &[DVec2]) -> Option<(Polygon, Vec<Polygon>)> {
        let View { own, below, floor } = self;
        let under = |place: DVec2| own.height(place) - below.height(place);
        let over = |place: DVec2| floor.map_or(1.0, |floor| below.height(place) - floor.height(place));
        // (Of most the planes tell.)
        if !polygon.iter().any(|&place| under(place) > 0.0) || !polygon.iter().any(|&place| over(place) > 0.0) {
            return None;
        }
        let mut rest = Vec::new();
        let mut inner = polygon.to_vec();
        let mut cut = |function: &dyn Fn(DVec2) -> f64| {
            let (positive, negative) = split(&inner, function);
            rest.push(negative);
            inner = positive;
        };
        for k in 0..3 {
            let (from, to) = (below.corners[k], below.corners[(k + 1) % 3]);
            cut(&|place| (to - from).perp_dot(place - from));
        }
        cut(&under);
        cut(&over);
        let is_some = |polygon: &Polygon| area(polygon) > SLIVER * own.area;
        rest.retain(is_some);
        is_some(&inner).then_some((inner, rest))
    }
}

/// The parts of a convex polygon where a linear function is positive, and where it is not.
fn split(polygon: &[DVec2], function: impl Fn(DVec2) -> f64) -> (Polygon, Polygon) {
    let values: Vec<f64> = polygon.iter().map(|&place| function(place)).collect();
    if values.iter().all(|&value| value >= 0.0) {
        return (polygon.to_vec(), Vec::new());
    }
    if values.iter().all(|&value| value <= 0.0) {
        return (Vec::new(), polygon.to_vec());
    }
    let (mut positive, mut negative) = (Vec::with_capacity(polygon.len() + 1), Vec::with_capacity(polygon.len() + 1));
    for k in 0..polygon.len() {
        let next = (k + 1) % polygon.len();
        if values[k] >= 0.0 {
            positive.push(polygon[k]);
        }
        if values[k] <= 0.0 {
            negative.push(polygon[k]);
        }
        if values[k] * values[next] < 0.0 {
            let cut = polygon[k].lerp(polygon[next], values[k] / (values[k] - values[next]));
            positive.push(cut);
            negative.push(cut);
        }
    }
    (positive, negative)
}

fn area(polygon: &[DVec2]) -> f64 {
    let Some(&first) = polygon.first() else { return 0.0 };
    0.5 * polygon.windows(2).map(|pair| (pair[0] - first).perp_dot(pair[1] - first)).sum::<f64>()
}

#[cfg(test)]
mod tests;
