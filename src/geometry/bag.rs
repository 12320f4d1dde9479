//! What a closed surface encloses at the start of a run.

use std::sync::OnceLock;

use super::GeometryError;
use super::meshes::ClosedSurface;
use super::tetrahedra::Tetrahedra;
use glam::DVec3;

#[derive(Debug, Clone)]
pub struct Bag {
    surface: ClosedSurface,
    nodes: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    /// Cut once gas is to be put into it.
    tetrahedra: OnceLock<Tetrahedra>,
    /// m3.
    pub volume: f64,
    /// Its corners, m.
    pub bounds: ([f64; 3], [f64; 3]),
}

impl Bag {
    /// # Errors
    /// If the surface is not closed.
    pub fn new(nodes: &[[f64; 3]], triangles: &[[u32; 3]], subject: &str) -> Result<Bag, GeometryError> {
        // (Other surfaces may have the other nodes.)
        let own = || triangles.iter().flatten().map(|&node| DVec3::from(nodes[node as usize]));
        let bounds = (own().fold(DVec3::INFINITY, DVec3::min), own().fold(DVec3::NEG_INFINITY, DVec3::max));
        let vertices: Vec<DVec3> = nodes.iter().map(|&node| DVec3::from(node)).collect();
        Ok(Bag {
            surface: ClosedSurface::new(nodes, triangles, subject)?,
            nodes: nodes.to_vec(),
            triangles: triangles.to_vec(),
            tetrahedra: OnceLock::new(),
            volume: super::closed::signed_volume_about(bounds.0, &vertices, triangles),
            bounds: (bounds.0.to_array(), bounds.1.to_array()),
        })
    }

    pub fn contains(&self, point: [f64; 3]) -> bool {
        self.surface.contains(point)
    }

    /// Whether a node of it is within another.
    pub fn has_node_in(&self, other: &Bag) -> bool {
        self.triangles.iter().flatten().any(|&node| other.contains(self.nodes[node as usize]))
    }

    /// What of the line along x through (y, z) it encloses, from and to, m.
    pub(super) fn within(&self, y: f64, z: f64) -> Vec<(f64, f64)> {
        self.surface.within(y, z)
    }

    /// A uniform point of its inside for four numbers between 0 and 1; rounding may put one next to the surface behind it.
    pub fn point(&self, uniform: [f64; 4]) -> [f64; 3] {
        let cut = || Tetrahedra::new(&self.surface, &self.nodes, &self.triangles);
        // (One that encloses nothing has no point in it anyway.)
        self.tetrahedra.get_or_init(cut).point(uniform).unwrap_or(self.bounds.0)
    }
}
