//! Triangle meshes of the walls, their volumes and the triangle grid.

mod grid;

pub use grid::{Grid, GridError};
pub struct FixedTriangle { pub corners: [[i32;3];3], pub ids: [u32;3], pub normal: [f32;3], pub source: u32 }
pub struct TriangleGrid { pub triangles: Vec<FixedTriangle>, pub start: Vec<u32>, pub list: Vec<u32>, pub class: Vec<CellClass> }
pub enum CellClass { Clear, Gas, Cut, Solid }
