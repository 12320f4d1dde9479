//! A triangle mesh: nodes, triangles, named parts.
//!
//! Meshes that are made here number their nodes in the order in which the triangles name them, part by part. So a file
//! without numbers (STL), whose corners are joined where they coincide, gives the same numbers as one with them (OBJ), and
//! both fit a file of the nodes' motion.

use crate::geometry::GeometryError;
use crate::geometry::closed::{area, check_closed, is_closed, signed_volume_about};
use crate::geometry::soup::PartOf;
use glam::DVec3;

#[derive(Debug, Clone, Default, PartialEq)]
pub struct TriangleMesh {
    /// m, or the unit of the file that it was read from.
    pub nodes: Vec<[f64; 3]>,
    /// Nodes, counter-clockwise seen from where the normal points.
    pub triangles: Vec<[u32; 3]>,
    /// The part of each triangle, by its place in `names`.
    pub parts: Vec<PartOf>,
    pub names: Vec<String>,
}

/// One part of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct PartMeasure {
    /// Empty for triangles of no part.
    pub name: String,
    pub triangles: usize,
    /// m2.
    pub area: f64,
    /// m3: of the cone from the middle of the mesh's box to the part, positive where normals point away from it. Those of
    /// all parts sum to the volume that a closed mesh encloses; that of a part which is closed alone is its volume.
    pub volume: f64,
}

impl TriangleMesh {
    pub(super) fn node(&mut self, place: DVec3) -> u32 {
        self.nodes.push(place.to_array());
        (self.nodes.len() - 1) as u32
    }

    /// Begins a part: its place among the names.
    pub(super) fn part(&mut self, name: &str) -> PartOf {
        self.names.push(name.to_owned());
        Some((self.names.len() - 1) as u32)
    }

    pub(super) fn triangle(&mut self, corners: [u32; 3], part: PartOf) {
        self.triangles.push(corners);
        self.parts.push(part);
    }

    pub(in crate::geometry) fn places(&self) -> Vec<DVec3> {
        self.nodes.iter().copied().map(DVec3::from).collect()
    }

    /// Whether each edge has a triangle on both sides, turned alike.
    pub fn is_closed(&self) -> bool {
        !self.triangles.is_empty() && is_closed(&self.triangles)
    }

    /// That it is closed, turned alike throughout, and without triangles of no area; `subject` names it in errors.
    pub fn check_closed(&self, subject: &str) -> Result<(), GeometryError> {
        check_closed(subject, &self.places(), &self.triangles)
    }

    /// The corners of its box, m; not finite without nodes.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) =
            self.nodes.iter().fold(start, |(low, high), &p| (low.min(DVec3::from(p)), high.max(DVec3::from(p))));
        [low.to_array(), high.to_array()]
    }

    /// The middle of its box, m.
    pub fn middle(&self) -> [f64; 3] {
        let [low, high] = self.bounds().map(DVec3::from);
        ((low + high) / 2.0).to_array()
    }

    /// Of each part, in the order of the names; triangles of no part come last, if there are any.
    pub fn measures(&self) -> Vec<PartMeasure> {
        let (places, middle) = (self.places(), DVec3::from(self.middle()));
        let parts = (0..self.names.len() as u32).map(Some).chain([None]);
        let measures = parts.map(|part| {
            let own = self.triangles.iter().zip(&self.parts).filter(|(_, of)| **of == part);
            let triangles: Vec<[u32; 3]> = own.map(|(triangle, _)| *triangle).collect();
            PartMeasure {
                name: part.map_or(String::new(), |part| self.names[part as usize].clone()),
                triangles: triangles.len(),
                area: area(&places, &triangles),
                volume: signed_volume_about(middle, &places, &triangles),
            }
        });
        measures.filter(|part| part.triangles > 0 || !part.name.is_empty()).collect()
    }

    /// m3: what a closed mesh encloses, positive where normals point outwards.
    pub fn volume(&self) -> f64 {
        signed_volume_about(DVec3::from(self.middle()), &self.places(), &self.triangles)
    }

    /// m2.
    pub fn area(&self) -> f64 {
        area(&self.places(), &self.triangles)
    }

    /// The least distance between two nodes, m; infinite for fewer than two.
    pub fn least_distance(&self) -> f64 {
        let mut places = self.places();
        places.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let mut least = f64::INFINITY;
        for (k, own) in places.iter().enumerate() {
            for other in &places[k + 1..] {
                if other.x - own.x >= least {
                    break;
                }
                least = least.min(own.distance(*other));
            }
        }
        least
    }

    /// With nodes numbered in the order in which the triangles name them; nodes of no triangle are left out.
    pub(super) fn numbered(self) -> TriangleMesh {
        const NONE: u32 = u32::MAX;
        let mut number = vec![NONE; self.nodes.len()];
        let mut nodes = Vec::with_capacity(self.nodes.len());
        let mut triangles = self.triangles;
        for corner in triangles.iter_mut().flatten() {
            let own = &mut number[*corner as usize];
            if *own == NONE {
                *own = nodes.len() as u32;
                nodes.push(self.nodes[*corner as usize]);
            }
            *corner = *own;
        }
        TriangleMesh { nodes, triangles, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron(at: f64) -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        let nodes = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| mesh.node(p + at));
        let (low, high) = (mesh.part("low"), mesh.part("high"));
        let faces = [([0, 2, 1], low), ([0, 1, 3], low), ([0, 3, 2], low), ([1, 2, 3], high)];
        for (corners, part) in faces {
            mesh.triangle(corners.map(|k: usize| nodes[k]), part);
        }
        mesh
    }

    #[test]
    fn parts_sum_to_the_whole() {
        for at in [0.0, 1000.0] {
            let mesh = tetrahedron(at);
            let parts = mesh.measures();
            assert_eq!(
                parts.iter().map(|part| (part.name.as_str(), part.triangles)).collect::<Vec<_>>(),
                [("low", 3), ("high", 1)]
            );
            assert!((parts[0].area - 1.5).abs() < 1e-12 && (parts[1].area - 0.75f64.sqrt()).abs() < 1e-12);
            let sum: f64 = parts.iter().map(|part| part.volume).sum();
            assert!((sum - 1.0 / 6.0).abs() < 1e-12 && (mesh.volume() - sum).abs() < 1e-15, "{sum}");
            // The cone from (.5, .5, .5) to the face x + y + z = 1 turns inwards.
            assert!((parts[1].volume + 1.0 / 12.0).abs() < 1e-12, "{parts:?}");
            assert_eq!(mesh.check_closed("t"), Ok(()));
            assert!((mesh.least_distance() - 1.0).abs() < 1e-12);
        }
        let mut open = tetrahedron(0.0);
        open.triangles.pop();
        assert!(!open.is_closed() && open.check_closed("t").is_err() && !TriangleMesh::default().is_closed());
    }

    #[test]
    fn nodes_are_numbered_as_triangles_name_them() {
        let mut mesh = tetrahedron(0.0);
        mesh.node(DVec3::splat(9.0));
        mesh.triangles.reverse();
        let numbered = mesh.clone().numbered();
        assert_eq!(numbered.triangles[..2], [[0, 1, 2], [3, 2, 1]]);
        assert_eq!(numbered.nodes, [mesh.nodes[1], mesh.nodes[2], mesh.nodes[3], mesh.nodes[0]]);
        assert_eq!(numbered.clone().numbered(), numbered);
    }
}
