//! Meshes as pictures need them: normals at the corners, and the edges that are drawn.
//!
//! Triangles that meet at less than [`CREASE`] share a normal there, weighted by their angles: a facetted cylinder looks
//! round, a box keeps its edges. Neighbours may be turned opposite ways.

use std::collections::BTreeMap;

use glam::DVec3;

use super::camera::Camera;

/// Degrees between the normals of neighbours, above which their edge is one.
const CREASE: f64 = 35.0;
/// The same of what hides all behind it.
const SHARP: f64 = 60.0;

/// A triangle mesh, m.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Surface {
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
}

/// Where a triangle has a side, and which way it goes along it.
type Sides = Vec<(usize, bool)>;

impl Surface {
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|vertex| self.vertices[vertex as usize])
    }

    /// The unit normals of the triangles, zero of one without area.
    pub fn normals(&self) -> Vec<DVec3> {
        let normal = |triangle: usize| {
            let [a, b, c] = self.corners(triangle);
            (b - a).cross(c - a).normalize_or_zero()
        };
        (0..self.triangles.len()).map(normal).collect()
    }

    /// The normals at the three corners of each triangle, on the side of the triangle's own.
    pub fn corner_normals(&self) -> Vec<[DVec3; 3]> {
        let normals = self.normals();
        let mut around: Vec<Vec<(usize, f64)>> = vec![Vec::new(); self.vertices.len()];
        for (triangle, vertices) in self.triangles.iter().enumerate() {
            let corners = self.corners(triangle);
            for k in 0..3 {
                let [before, after] = [1, 2].map(|step| corners[(k + step) % 3] - corners[k]);
                let angle = before.angle_between(after);
                around[vertices[k] as usize].push((triangle, if angle.is_finite() { angle } else { 0.0 }));
            }
        }
        let least = CREASE.to_radians().cos();
        let at_corner = |triangle: usize, vertex: u32| {
            let own = normals[triangle];
            let shared = around[vertex as usize].iter().filter_map(|&(other, angle)| {
                let cosine = own.dot(normals[other]);
                (cosine.abs() >= least).then_some(cosine.signum() * angle * normals[other])
            });
            let sum: DVec3 = shared.sum();
            sum.try_normalize().unwrap_or(if own == DVec3::ZERO { DVec3::Z } else { own })
        };
        let all = self.triangles.iter().enumerate();
        all.map(|(triangle, vertices)| vertices.map(|vertex| at_corner(triangle, vertex))).collect()
    }

    /// Whether neighbours are turned the same way, so that the mesh has two sides.
    pub fn has_two_sides(&self) -> bool {
        self.edges().values().all(|sides| sides.len() != 2 || sides[0].1 != sides[1].1)
    }

    /// The ends of the edges of what is seen through: of one triangle alone or of several, sharp ones, and those behind
    /// which the surface turns away from the viewer.
    pub fn drawn_edges(&self, camera: &Camera) -> Vec<[DVec3; 2]> {
        let least = CREASE.to_radians().cos();
        self.edges_between(|normals| {
            let towards = normals.map(|normal| normal.dot(camera.axes[2]) > 0.0);
            normals[0].dot(normals[1]) < least || towards[0] != towards[1]
        })
    }

    /// The ends of the edges of what hides all behind it: of one triangle alone or of several, and those that are sharper than
    /// a round fold of few triangles has. Where it turns away from the viewer its depth has a step.
    pub fn sharp_edges(&self) -> Vec<[DVec3; 2]> {
        let least = SHARP.to_radians().cos();
        self.edges_between(|[one, other]| one.dot(other) < least)
    }

    /// The ends of the edges with other than two triangles, and of those whose normals, as if both were turned the same way,
    /// are such.
    fn edges_between(&self, are_such: impl Fn([DVec3; 2]) -> bool) -> Vec<[DVec3; 2]> {
        let normals = self.normals();
        let is_drawn = |sides: &Sides| match sides[..] {
            [(one, ahead), (other, also_ahead)] => {
                let sign = if ahead == also_ahead { -1.0 } else { 1.0 };
                are_such([normals[one], sign * normals[other]])
            }
            _ => true,
        };
        let edges = self.edges();
        let drawn = edges.iter().filter(|(_, sides)| is_drawn(sides));
        drawn.map(|((from, to), _)| [*from, *to].map(|vertex| self.vertices[vertex as usize])).collect()
    }

    /// The triangles at each edge.
    fn edges(&self) -> BTreeMap<(u32, u32), Sides> {
        let mut edges: BTreeMap<(u32, u32), Sides> = BTreeMap::new();
        for (triangle, vertices) in self.triangles.iter().enumerate() {
            for k in 0..3 {
                let (from, to) = (vertices[k], vertices[(k + 1) % 3]);
                edges.entry((from.min(to), from.max(to))).or_default().push((triangle, from < to));
            }
        }
        edges
    }

    /// The triangles from the farthest to the nearest, by their middles.
    pub fn from_behind(&self, camera: &Camera) -> Vec<usize> {
        let middle = |triangle: usize| camera.nearness(self.corners(triangle).iter().sum::<DVec3>() / 3.0);
        let near: Vec<f64> = (0..self.triangles.len()).map(middle).collect();
        let mut order: Vec<usize> = (0..near.len()).collect();
        order.sort_by(|&a, &b| near[a].total_cmp(&near[b]));
        order
    }
}

#[cfg(test)]
mod tests {
    use super::super::camera::Frame;
    use super::*;

    fn camera(view: &str) -> Camera {
        let frame = Frame { size: [100, 100], margins: [0.0; 4] };
        Camera::around(view.parse().unwrap(), frame, [DVec3::ZERO, DVec3::ONE].into_iter())
    }

    /// Two triangles of a unit square, the half beyond the diagonal lifted by an angle.
    fn folded(degrees: f64, turned: bool) -> Surface {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let vertices = vec![
            DVec3::ZERO,
            DVec3::X,
            DVec3::Y,
            DVec3::new(0.5, 0.5, 0.0) + DVec3::new(0.5 * cos, 0.5 * cos, 0.7 * sin),
        ];
        let second = if turned { [1, 2, 3] } else { [1, 3, 2] };
        Surface { vertices, triangles: vec![[0, 1, 2], second] }
    }

    #[test]
    fn sharp_edges_are_drawn_and_soft_ones_are_smooth() {
        let top = camera("top");
        for (degrees, edges) in [(10.0, 4), (60.0, 5)] {
            for turned in [false, true] {
                let surface = folded(degrees, turned);
                assert_eq!(surface.drawn_edges(&top).len(), edges, "{degrees} {turned}");
                assert_eq!(surface.has_two_sides(), !turned);
                let normals = surface.corner_normals();
                let own = surface.normals();
                let smooth = normals[0][1].angle_between(own[0]).to_degrees();
                assert!(if edges == 4 { (smooth - 5.0).abs() < 1.5 } else { smooth < 1e-6 }, "{smooth}");
                assert!(normals[0][0] == own[0] && normals[1].iter().all(|normal| normal.dot(own[1]) > 0.9));
            }
        }
    }

    /// Seen from where one half faces the viewer and the other does not, the soft edge is the outline.
    #[test]
    fn outlines_are_drawn() {
        let grazing = camera("-45,5");
        assert_eq!(folded(-20.0, false).drawn_edges(&grazing).len(), 5);
        assert_eq!(folded(-20.0, true).drawn_edges(&grazing).len(), 5);
        assert_eq!([50.0, 70.0].map(|degrees| folded(degrees, true).sharp_edges().len()), [4, 5]);
    }

    #[test]
    fn the_farthest_is_first() {
        let raised = |z: f64| folded(0.0, false).vertices.iter().map(|v| *v + z * DVec3::Z).collect::<Vec<_>>();
        let vertices = [raised(1.0), raised(-1.0)].concat();
        let surface = Surface { vertices, triangles: vec![[0, 1, 2], [4, 5, 6], [1, 2, 3]] };
        assert_eq!(surface.from_behind(&camera("top")), [1, 0, 2]);
    }

    #[test]
    fn a_triangle_without_area_has_finite_normals() {
        let surface = Surface { vertices: vec![DVec3::ZERO; 3], triangles: vec![[0, 1, 2]] };
        assert!(surface.corner_normals()[0].iter().all(|normal| normal.is_finite()));
    }
}
