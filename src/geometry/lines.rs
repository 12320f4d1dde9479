//! Where lines along x cross the walls.
//!
//! The y and z of all vertices are rounded to 2^-48 of the vessel's extent, and so is a line: whether it passes
//! a triangle is decided in integers, without rounding. A line exactly through an edge or a vertex counts as
//! moved by an infinitesimal (e, e^2), so it passes one of the triangles that meet there, whatever their order.
//! Therefore the signed crossings of a line with a closed surface always sum to zero.

use glam::DVec3;

const BITS: u32 = 48;

/// Triangles by (y, z), in square buckets.
#[derive(Debug, Clone)]
pub(super) struct LineIndex {
    origin: [f64; 2],
    /// Quanta per metre, a power of two.
    scale: f64,
    shift: u32,
    buckets: [i64; 2],
    /// First entry of `list` for each bucket, and the end.
    start: Vec<u32>,
    list: Vec<u32>,
    triangles: Vec<Projected>,
}

#[derive(Debug, Clone)]
struct Projected {
    x: [f64; 3],
    /// (y, z) in quanta.
    corners: [[i64; 2]; 3],
    /// Twice its area seen along x, positive where the normal is along +x; not zero.
    area: i128,
    wall: u32,
}

/// A line leaves a solid (+1, the normal is along +x) or enters one (-1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Crossing {
    pub x: f64,
    pub sign: i32,
    pub wall: u32,
}

impl LineIndex {
    /// `triangles`: vertex indices and wall of each; `min`, `max` bound all vertices.
    pub fn new(
        vertices: &[DVec3],
        triangles: impl Iterator<Item = ([u32; 3], u32)>,
        min: DVec3,
        max: DVec3,
    ) -> LineIndex {
        let extent = (max.y - min.y).max(max.z - min.z).max(f64::MIN_POSITIVE);
        // Finite also for a vessel of no size.
        let scale = libm::exp2((f64::from(BITS) - libm::ceil(libm::log2(extent))).min(1000.0));
        let origin = [min.y, min.z];
        let fixed = |p: DVec3| [quanta(p.y, origin[0], scale), quanta(p.z, origin[1], scale)];
        let triangles: Vec<Projected> = triangles
            .map(|(t, wall)| {
                let places = t.map(|v| vertices[v as usize]);
                let corners = places.map(fixed);
                let area = cross_product(corners[0], corners[1], corners[2]);
                Projected { x: places.map(|p| p.x), corners, area, wall }
            })
            // A triangle seen edge-on is never crossed.
            .filter(|t| t.area != 0)
            .collect();
        let wanted = (2.0 * triangles.len() as f64).sqrt() as u32;
        let shift = BITS - wanted.clamp(1, 1024).next_power_of_two().trailing_zeros();
        let top = fixed(max);
        let buckets = [(top[0] >> shift) + 1, (top[1] >> shift) + 1];
        let mut index = LineIndex { origin, scale, shift, buckets, start: Vec::new(), list: Vec::new(), triangles };
        index.fill();
        index
    }

    fn fill(&mut self) {
        let mut count = vec![0u32; (self.buckets[0] * self.buckets[1]) as usize + 1];
        for t in &self.triangles {
            self.covered(t).for_each(|b| count[b + 1] += 1);
        }
        for b in 1..count.len() {
            count[b] += count[b - 1];
        }
        let mut next = count.clone();
        let mut list = vec![0; count.last().map_or(0, |&n| n as usize)];
        for (k, t) in self.triangles.iter().enumerate() {
            self.covered(t).for_each(|b| {
                list[next[b] as usize] = k as u32;
                next[b] += 1;
            });
        }
        self.start = count;
        self.list = list;
    }

    /// The buckets of the triangle's bounding rectangle.
    fn covered(&self, t: &Projected) -> impl Iterator<Item = usize> + use<> {
        let range = |axis: usize| {
            let corners = t.corners.map(|c| c[axis]);
            let low = corners[0].min(corners[1]).min(corners[2]);
            let high = corners[0].max(corners[1]).max(corners[2]);
            (low >> self.shift)..=(high >> self.shift)
        };
        let (rows, columns, width) = (range(1), range(0), self.buckets[0]);
        rows.flat_map(move |r| columns.clone().map(move |c| (r * width + c) as usize))
    }

    /// Calls `found` for every crossing of the line through (y, z), m, in no particular order in x.
    pub fn cross(&self, y: f64, z: f64, mut found: impl FnMut(Crossing)) {
        let q = [quanta(y, self.origin[0], self.scale), quanta(z, self.origin[1], self.scale)];
        let bucket = q.map(|c| c >> self.shift);
        if (0..2).any(|axis| bucket[axis] < 0 || bucket[axis] >= self.buckets[axis]) {
            return;
        }
        let bucket = (bucket[1] * self.buckets[0] + bucket[0]) as usize;
        for &k in &self.list[self.start[bucket] as usize..self.start[bucket + 1] as usize] {
            if let Some(crossing) = self.triangles[k as usize].cross(q) {
                found(crossing);
            }
        }
    }
}

/// Not a number becomes a place outside.
fn quanta(value: f64, origin: f64, scale: f64) -> i64 {
    let quanta = ((value - origin) * scale).round();
    if quanta.abs() < 2.0 * (1u64 << BITS) as f64 { quanta as i64 } else { -1 }
}

fn cross_product(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i128 {
    i128::from(b[0] - a[0]) * i128::from(c[1] - a[1]) - i128::from(b[1] - a[1]) * i128::from(c[0] - a[0])
}

impl Projected {
    fn cross(&self, q: [i64; 2]) -> Option<Crossing> {
        let mut weights = [0i128; 3];
        for (k, own) in weights.iter_mut().enumerate() {
            let (a, b) = (self.corners[(k + 1) % 3], self.corners[(k + 2) % 3]);
            let weight = cross_product(a, b, q);
            // On the edge: the sign after moving q by (e, e^2).
            let moved = match weight {
                0 if b[1] != a[1] => i128::from(a[1] - b[1]),
                0 => i128::from(b[0] - a[0]),
                weight => weight,
            };
            if (moved < 0) != (self.area < 0) {
                return None;
            }
            *own = weight;
        }
        // From one corner, so that a triangle across x has its x exactly.
        let area = self.area as f64;
        let (u, v) = (weights[1] as f64 / area, weights[2] as f64 / area);
        let x = self.x[0] + (u * (self.x[1] - self.x[0]) + v * (self.x[2] - self.x[0]));
        Some(Crossing { x, sign: self.area.signum() as i32, wall: self.wall })
    }
}

/// Where along sorted crossings the number of solids satisfies `wanted`: x-intervals of positive length, in
/// order, touching ones merged. `outside` is the number at both far ends.
pub(super) fn intervals(crossings: &[Crossing], outside: i32, wanted: impl Fn(i32) -> bool, out: &mut Vec<(f64, f64)>) {
    out.clear();
    let mut depth = outside;
    for pair in crossings.windows(2) {
        depth -= pair[0].sign;
        let (from, to) = (pair[0].x, pair[1].x);
        if wanted(depth) && to > from {
            match out.last_mut() {
                Some(last) if last.1 == from => last.1 = to,
                _ => out.push((from, to)),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A closed fan: a pyramid whose apex is hit by a line, as are many edges.
    fn pyramid(rim: &[(i32, i32)], apex: (i32, i32)) -> LineIndex {
        let place = |x: f64, (y, z): (i32, i32)| DVec3::new(x, f64::from(y) / 8.0, f64::from(z) / 8.0);
        let mut vertices: Vec<DVec3> = rim.iter().map(|&c| place(0.0, c)).collect();
        vertices.extend([place(1.0, apex), place(-1.0, apex)]);
        let n = rim.len() as u32;
        let triangles = (0..n).flat_map(|i| {
            let next = (i + 1) % n;
            [([i, next, n], 0), ([next, i, n + 1], 0)]
        });
        LineIndex::new(&vertices, triangles, DVec3::new(-1.0, -1.0, -1.0), DVec3::ONE)
    }

    fn crossings(index: &LineIndex, y: f64, z: f64) -> Vec<Crossing> {
        let mut out = Vec::new();
        index.cross(y, z, |c| out.push(c));
        out
    }

    #[test]
    fn a_line_through_edges_and_the_apex_crosses_once_each_way() {
        let index = pyramid(&[(-8, -8), (0, -8), (8, -8), (8, 0), (8, 8), (0, 8), (-8, 8), (-8, 0)], (0, 0));
        for (y, z, x) in [(0.0, 0.0, 1.0), (0.5, 0.5, 0.5), (0.0, 0.25, 0.75), (-0.25, 0.0, 0.75)] {
            let mut found = crossings(&index, y, z);
            found.sort_by(|a, b| a.x.total_cmp(&b.x));
            assert_eq!(found.iter().map(|c| (c.x, c.sign)).collect::<Vec<_>>(), [(-x, -1), (x, 1)]);
        }
        assert_eq!(crossings(&index, f64::NAN, 0.0), []);
    }

    proptest! {
        /// On an integer lattice, so that lines through corners and edges are common.
        #[test]
        fn crossings_of_a_closed_surface_cancel(
            rim in proptest::collection::vec((-8i32..=8, -8i32..=8), 3..9),
            apex in (-8i32..=8, -8i32..=8),
            line in (-8i32..=8, -8i32..=8),
        ) {
            let index = pyramid(&rim, apex);
            let found = crossings(&index, f64::from(line.0) / 8.0, f64::from(line.1) / 8.0);
            prop_assert_eq!(found.iter().map(|c| c.sign).sum::<i32>(), 0);
        }
    }

    #[test]
    fn an_open_surface_does_not_cancel() {
        let vertices = [DVec3::ZERO, DVec3::Y, DVec3::Z];
        let index = LineIndex::new(&vertices, [([0, 1, 2], 0)].into_iter(), DVec3::ZERO, DVec3::ONE);
        assert_eq!(crossings(&index, 0.25, 0.25).len(), 1);
        // The half-open rule: of the right angle's corner, yes; of the far corners, no.
        assert_eq!(crossings(&index, 0.0, 0.0).len(), 1);
        assert_eq!(crossings(&index, 1.0, 0.0).len(), 0);
    }
}
