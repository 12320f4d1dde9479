//! The mesh of one wall, as its shape or its file gives it.

use crate::scene::Face;
use glam::DVec3;

/// The surface of one wall.
#[derive(Debug, Clone, Default)]
pub(super) struct WallMesh {
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// One per triangle.
    pub faces: Vec<Option<Face>>,
    pub holes: Vec<FoundHole>,
    pub mended: Option<Mended>,
}

impl WallMesh {
    pub fn vertex(&mut self, position: DVec3) -> u32 {
        self.vertices.push(position);
        (self.vertices.len() - 1) as u32
    }

    pub fn triangle(&mut self, corners: [u32; 3], face: Option<Face>) {
        self.triangles.push(corners);
        self.faces.push(face);
    }

    /// Corners counter-clockwise seen from where the normal points.
    pub fn quad(&mut self, [a, b, c, d]: [u32; 4], face: Option<Face>) {
        self.triangle([a, b, c], face);
        self.triangle([a, c, d], face);
    }

    pub fn flip(&mut self) {
        self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
}

/// A hole as cut. Lengths in m.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundHole {
    pub name: String,
    /// Index of the wall.
    pub wall: u32,
    /// Middle of the hole, half-way through the wall.
    pub center: [f64; 3],
    /// Along the hole: out of a box, along the normal of a plane.
    pub normal: [f64; 3],
    pub thickness: f64,
    /// m2, of the polygon that is cut.
    pub area: f64,
    pub perimeter: f64,
    /// The corners of that polygon, half-way through the wall.
    pub outline: Vec<[f64; 3]>,
}

/// What was done to a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Mended {
    /// Corners that became another one.
    pub welded: usize,
    /// Triangles without area that were left out.
    pub flat: usize,
    /// Edges that were split at corners of their neighbours.
    pub split: usize,
    /// m.
    pub tolerance: f64,
}
