//! Triangle meshes of fabric and of closed surfaces in general: nodes by number, triangles, named parts. They are made
//! (`shape` of `bags`, `round_shapes`), read and written (`files`), measured (`mesh`), and asked what they enclose (`inside`).

mod bags;
mod error;
mod files;
mod inside;
mod mesh;
mod round_shapes;
mod shape;

pub use error::MeshError;
pub use inside::{ClosedSurface, inside};
pub use mesh::{PartMeasure, TriangleMesh};
pub use shape::MeshShape;
