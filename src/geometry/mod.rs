//! Triangle meshes of the walls, where the gas is, its volumes and the triangle grid. All f64 and
//! deterministic: the same walls give the same bits, whatever the number of threads.
//!
//! `Vessel::build` turns the walls of a scene into one checked mesh (`build` of
//! `primitives`, `round`, `plate`, `polygon`, `mesh_file` of `stl`, `obj` and `facet`, `mend`, `closed`, `crossings`) and answers where the gas is (`lines`) and how much of it
//! (`vessel`, `region`, `blocks`, with `sampling`; `bag` and `tetrahedra` of closed fabric). `TriangleGrid` lays its triangles on the cells of a `Grid`, and `clearance` has planes
//! that part the gas near them from them. `meshes` makes meshes of fabric, reads, writes and measures them, and
//! `node_frames` has the motion of their nodes.

mod bag;
mod blocks;
mod build;
mod cell_gas;
mod clearance;
mod closed;
mod crossings;
mod error;
mod facet;
mod gaps;
mod grid;
mod lines;
mod mend;
mod mesh_file;
mod meshes;
mod node_frames;
mod notes;
mod obj;
mod plate;
mod polygon;
mod primitives;
mod region;
mod round;
mod sampling;
mod soup;
mod spaces;
mod stl;
mod tetrahedra;
mod triangle_grid;
mod vessel;
mod wall_mesh;

pub use bag::Bag;
pub use blocks::block_volumes;
pub use cell_gas::{CELL_GENERATOR, CELL_POINTS, CellGas, CellPart, cell_gas, still_points};
pub use clearance::{CLEARANCE_UNIT, Clearance, NO_PLANE, clearances};
pub use closed::check_closed;
pub use error::{GeometryError, Places};
pub use gaps::{Narrowest, Passage};
pub use grid::{Grid, GridError};
pub use mesh_file::read_surface;
pub use meshes::{ClosedSurface, MeshError, MeshShape, PartMeasure, TriangleMesh, inside};
pub use node_frames::{FrameFault, FrameNote, Motion, NodeFrames, NodeFramesError, Precision};
pub use notes::Hollow;
pub use region::{region_bounds, region_contains, region_volume};
pub use round::{Facets, facets};
pub use spaces::Spaces;
pub use triangle_grid::{Body, CellClass, FixedTriangle, Lists, MovingWalls, TriangleGrid};
pub use vessel::{Overlaps, Triangle, Vessel, WallInfo};
pub use wall_mesh::{FoundHole, Mended};

#[cfg(test)]
mod tests;
