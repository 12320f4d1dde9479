//! Triangle meshes of the walls, their volumes and the triangle grid.

mod grid;

pub use grid::{Grid, GridError};
