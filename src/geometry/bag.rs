//! What a closed surface encloses at the start of a run.

use super::GeometryError;
use super::meshes::ClosedSurface;
use glam::DVec3;

#[derive(Debug, Clone)]
pub struct Bag {
    surface: ClosedSurface,
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
            volume: super::closed::signed_volume_about(bounds.0, &vertices, triangles),
            bounds: (bounds.0.to_array(), bounds.1.to_array()),
        })
    }

    pub fn contains(&self, point: [f64; 3]) -> bool {
        self.surface.contains(point)
    }
}
