//! Triangulation of a plane polygon with holes, by bridges and ear clipping.
//!
//! Every vertex is used and none is added, so that faces meet their neighbours along whole edges. Ears are cut
//! only where they have area. A set of positively oriented triangles whose directed edges cancel except along
//! the outline covers the polygon exactly once, so no further check of the result is needed.

use glam::DVec2;

/// Height of a triangle over the extent of the polygon, below which it counts as flat.
const FLAT: f64 = 1e-11;

/// Counter-clockwise triangles of the polygon `outer` less `holes`, as indices into all points in the order
/// given (outer first). All outlines run counter-clockwise; holes lie strictly inside and apart.
/// `None` when the outlines are not so.
pub(super) fn triangulate(outer: &[DVec2], holes: &[Vec<DVec2>]) -> Option<Vec<[u32; 3]>> {
    let mut points = outer.to_vec();
    let mut rings = Vec::new();
    for hole in holes {
        let first = points.len();
        points.extend_from_slice(hole);
        // Holes run clockwise, so that the material is to the left everywhere.
        rings.push((first..points.len()).rev().collect::<Vec<usize>>());
    }
    let extent = outer.iter().map(|p| (*p - outer[0]).abs().max_element()).fold(0.0, f64::max);
    let plane = Plane { points: &points, tolerance: FLAT * extent };
    let mut ring: Vec<usize> = (0..outer.len()).collect();
    while !rings.is_empty() {
        let bridge = plane.shortest_bridge(&ring, &rings)?;
        let hole = rings.swap_remove(bridge.hole);
        let loop_back = hole[bridge.to..].iter().chain(&hole[..=bridge.to]).copied();
        let tail = ring.split_off(bridge.from + 1);
        let back = ring[bridge.from];
        ring.extend(loop_back);
        ring.push(back);
        ring.extend(tail);
    }
    plane.clip(ring)
}

/// The same of one counter-clockwise outline, `ring`, as indices into `points`; it may pass a point several times, as where
/// a hole is joined to the outline by an edge to and fro.
pub(super) fn clip(points: &[DVec2], ring: Vec<usize>) -> Option<Vec<[u32; 3]>> {
    let extent = points.iter().map(|p| (*p - points[0]).abs().max_element()).fold(0.0, f64::max);
    Plane { points, tolerance: FLAT * extent }.clip(ring)
}

/// An edge from `ring[from]` to `holes[hole][to]`.
struct Bridge {
    from: usize,
    hole: usize,
    to: usize,
}

struct Plane<'a> {
    points: &'a [DVec2],
    /// Distances up to this count as zero.
    tolerance: f64,
}

impl Plane<'_> {
    /// Signed height of `c` over the line a b: positive to the left.
    fn height(&self, a: usize, b: usize, c: usize) -> f64 {
        let (a, b, c) = (self.points[a], self.points[b], self.points[c]);
        (b - a).perp_dot(c - a) / (b - a).length().max(f64::MIN_POSITIVE)
    }

    fn left(&self, a: usize, b: usize, c: usize) -> bool {
        self.height(a, b, c) > self.tolerance
    }

    fn left_or_on(&self, a: usize, b: usize, c: usize) -> bool {
        self.height(a, b, c) >= -self.tolerance
    }

    /// Does the direction from `at` to `target` point into the material at this corner? (O'Rourke, Computational
    /// Geometry in C, section 1.5.)
    fn in_cone(&self, before: usize, at: usize, after: usize, target: usize) -> bool {
        if self.left_or_on(before, at, after) {
            self.left(at, target, before) && self.left(target, at, after)
        } else {
            !(self.left_or_on(at, target, after) && self.left_or_on(target, at, before))
        }
    }

    /// The triangles of a ring, cut off as ears.
    fn clip(&self, mut ring: Vec<usize>) -> Option<Vec<[u32; 3]>> {
        let mut triangles = Vec::with_capacity(ring.len());
        while ring.len() > 2 {
            let ear = self.best_ear(&ring)?;
            let n = ring.len();
            triangles.push([ring[(ear + n - 1) % n], ring[ear], ring[(ear + 1) % n]].map(|v| v as u32));
            if n == 3 {
                break;
            }
            ring.remove(ear);
        }
        Some(triangles)
    }

    fn shortest_bridge(&self, ring: &[usize], holes: &[Vec<usize>]) -> Option<Bridge> {
        let mut pairs = Vec::new();
        for (from, &a) in ring.iter().enumerate() {
            for (hole, vertices) in holes.iter().enumerate() {
                for (to, &b) in vertices.iter().enumerate() {
                    pairs.push((self.points[a].distance_squared(self.points[b]), from, hole, to));
                }
            }
        }
        pairs.sort_by(|p, q| p.0.total_cmp(&q.0).then((p.1, p.2, p.3).cmp(&(q.1, q.2, q.3))));
        let n = ring.len();
        let found = pairs.into_iter().find(|&(_, from, hole, to)| {
            let (a, b) = (ring[from], holes[hole][to]);
            self.in_cone(ring[(from + n - 1) % n], a, ring[(from + 1) % n], b)
                && std::iter::once(ring).chain(holes.iter().map(Vec::as_slice)).all(|outline| self.sees(a, b, outline))
        });
        found.map(|(_, from, hole, to)| Bridge { from, hole, to })
    }

    /// Does the segment a b pass the outline without touching it, its own ends apart?
    fn sees(&self, a: usize, b: usize, outline: &[usize]) -> bool {
        (0..outline.len()).all(|i| {
            let (c, d) = (outline[i], outline[(i + 1) % outline.len()]);
            let ends = [a, b];
            if !ends.contains(&c) && self.on_segment(a, b, c) {
                return false;
            }
            if ends.contains(&c) || ends.contains(&d) {
                return true;
            }
            let apart = self.left(a, b, c) == self.left(a, b, d) && self.left(b, a, c) == self.left(b, a, d);
            let clear = self.left(c, d, a) == self.left(c, d, b) && self.left(d, c, a) == self.left(d, c, b);
            apart || clear
        })
    }

    fn on_segment(&self, a: usize, b: usize, c: usize) -> bool {
        let along = (self.points[c] - self.points[a]).dot(self.points[b] - self.points[a]);
        self.height(a, b, c).abs() <= self.tolerance
            && along >= 0.0
            && along <= self.points[a].distance_squared(self.points[b])
    }

    /// The roundest ear of the ring: a corner that can be cut off along a diagonal inside the material.
    fn best_ear(&self, ring: &[usize]) -> Option<usize> {
        let n = ring.len();
        let mut corners: Vec<(f64, usize)> = (0..n)
            .filter_map(|i| {
                let (a, b, c) = (ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]);
                let points = [a, b, c].map(|v| self.points[v]);
                let longest = (0..3).map(|k| points[k].distance_squared(points[(k + 1) % 3])).fold(0.0, f64::max);
                let doubled = (points[1] - points[0]).perp_dot(points[2] - points[0]);
                (doubled > self.tolerance * longest.sqrt()).then_some((doubled / longest, i))
            })
            .collect();
        corners.sort_by(|p, q| q.0.total_cmp(&p.0).then(p.1.cmp(&q.1)));
        corners.into_iter().map(|(_, i)| i).find(|&i| n == 3 || self.is_ear(ring, i))
    }

    fn is_ear(&self, ring: &[usize], i: usize) -> bool {
        let n = ring.len();
        let at = |offset: usize| ring[(i + offset) % n];
        let (a, b, c) = (at(n - 1), at(0), at(1));
        let empty = ring.iter().all(|&p| {
            p == a
                || p == b
                || p == c
                || !(self.left_or_on(a, b, p) && self.left_or_on(b, c, p) && self.left_or_on(c, a, p))
        });
        empty && self.in_cone(at(n - 2), a, b, c) && self.in_cone(b, c, at(2), a)
    }
}

/// Signed area, positive for a counter-clockwise outline.
pub(super) fn area(outline: &[DVec2]) -> f64 {
    (0..outline.len())
        .map(|i| (outline[i] - outline[0]).perp_dot(outline[(i + 1) % outline.len()] - outline[0]))
        .sum::<f64>()
        / 2.0
}

pub(super) fn perimeter(outline: &[DVec2]) -> f64 {
    (0..outline.len()).map(|i| outline[i].distance(outline[(i + 1) % outline.len()])).sum()
}

/// Do two convex counter-clockwise outlines overlap or touch? By separating edges.
pub(super) fn convex_overlap(a: &[DVec2], b: &[DVec2]) -> bool {
    let separates = |p: &[DVec2], q: &[DVec2]| {
        (0..p.len()).any(|i| {
            let (start, end) = (p[i], p[(i + 1) % p.len()]);
            q.iter().all(|point| (end - start).perp_dot(*point - start) < 0.0)
        })
    };
    !separates(a, b) && !separates(b, a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn rectangle(x: f64, y: f64, w: f64, h: f64) -> Vec<DVec2> {
        vec![DVec2::new(x, y), DVec2::new(x + w, y), DVec2::new(x + w, y + h), DVec2::new(x, y + h)]
    }

    fn check(outer: &[DVec2], holes: &[Vec<DVec2>]) {
        let triangles = triangulate(outer, holes).expect("a triangulation");
        let points: Vec<DVec2> = outer.iter().chain(holes.iter().flatten()).copied().collect();
        // Euler: v + 2 (holes - 1) triangles, whatever the diagonals.
        assert_eq!(triangles.len(), points.len() + 2 * holes.len() - 2);
        let parts: Vec<f64> = triangles.iter().map(|t| area(&t.map(|v| points[v as usize]))).collect();
        let whole = area(outer) - holes.iter().map(|h| area(h)).sum::<f64>();
        assert!(parts.iter().all(|&a| a > 1e-10 * whole), "sliver: {parts:?}");
        assert!((parts.iter().sum::<f64>() - whole).abs() < 1e-12 * area(outer));
    }

    #[test]
    fn triangles_add_up_to_the_polygon_also_where_corners_are_collinear() {
        check(&rectangle(0.0, 0.0, 2.0, 1.0), &[]);
        // Edges of the holes on common lines, diagonals through corners of others.
        let grid: Vec<Vec<DVec2>> =
            (0..16).map(|k| rectangle(0.1 + f64::from(k % 4) * 0.2, 0.1 + f64::from(k / 4) * 0.2, 0.1, 0.1)).collect();
        check(&rectangle(0.0, 0.0, 0.9, 0.9), &grid);
    }

    #[test]
    fn a_hole_outside_the_polygon_is_refused() {
        assert_eq!(triangulate(&rectangle(0.0, 0.0, 1.0, 1.0), &[rectangle(2.0, 0.2, 0.1, 0.1)]), None);
    }

    proptest! {
        #[test]
        fn any_set_of_separate_convex_holes(cells in proptest::collection::vec((0.0..1.0f64, 0.05..0.95f64, 3u32..24), 1..12)) {
            let holes: Vec<Vec<DVec2>> = cells.iter().enumerate().map(|(k, &(turn, size, corners))| {
                let center = DVec2::new((k % 4) as f64 + 0.5, (k / 4) as f64 + 0.5);
                (0..corners).map(|i| {
                    let angle = std::f64::consts::TAU * (turn + f64::from(i) / f64::from(corners));
                    center + 0.49 * size * DVec2::new(libm::cos(angle), libm::sin(angle))
                }).collect()
            }).collect();
            check(&rectangle(0.0, 0.0, 4.0, 3.0), &holes);
        }

        #[test]
        fn overlap_of_rectangles_is_that_of_their_intervals(x in -2.0..2.0f64, y in -2.0..2.0f64) {
            let overlap = x.abs() <= 1.0 && y.abs() <= 1.0;
            prop_assert_eq!(convex_overlap(&rectangle(0.0, 0.0, 1.0, 1.0), &rectangle(x, y, 1.0, 1.0)), overlap);
        }
    }
}
