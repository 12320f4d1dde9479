//! Walls for the tests of this layer, and those tests that span several of its modules.

mod mesh_files;
mod regions;
mod triangle_grid;
mod vessels;

use crate::geometry::{GeometryError, Vessel};
use crate::scene::{Face, GasSide, Hole, Outline, Shape, SurfaceModel, Wall};
use parry3d_f64::math::Vector;
use parry3d_f64::shape::TriMesh;

pub(super) fn wall(name: &str, shape: Shape, gas: GasSide) -> Wall {
    Wall { name: name.into(), shape, gas, surface: SurfaceModel::default(), parts: Vec::new() }
}

/// A box of gas from the origin.
pub(super) fn tank(size: [f64; 3]) -> Wall {
    let shape = Shape::Box { min: [0.0; 3], max: size, thickness: None, holes: vec![] };
    wall("tank", shape, GasSide::Inside)
}

/// A closed shell around the cavity `min`..`max`.
pub(super) fn hollow_box(min: [f64; 3], max: [f64; 3], thickness: f64) -> Wall {
    pierced_box(min, max, thickness, vec![])
}

pub(super) fn pierced_box(min: [f64; 3], max: [f64; 3], thickness: f64, holes: Vec<Hole>) -> Wall {
    wall("shell", Shape::Box { min, max, thickness: Some(thickness), holes }, GasSide::Both)
}

pub(super) fn hole(name: &str, face: Face, center: [f64; 2], outline: Outline) -> Hole {
    Hole { name: name.into(), face, center, outline, flow_only: false }
}

pub(super) fn sphere(name: &str, center: [f64; 3], radius: f64, subdivisions: u32, gas: GasSide) -> Wall {
    wall(name, Shape::Sphere { center, radius, subdivisions }, gas)
}

pub(super) fn build_error(walls: &[Wall]) -> GeometryError {
    Vessel::build(walls).expect_err("an error")
}

/// The triangles of one wall for the oracle, normals out of what the surface encloses.
pub(super) fn oracle(vessel: &Vessel, wall: u32) -> TriMesh {
    let vertices = vessel.vertices.iter().map(|v| Vector::from_array(*v)).collect();
    let cavity = vessel.walls[wall as usize].cavity;
    let triangles = vessel
        .triangles
        .iter()
        .filter(|t| t.wall == wall)
        .map(|t| if cavity { [t.vertices[0], t.vertices[2], t.vertices[1]] } else { t.vertices })
        .collect();
    TriMesh::new(vertices, triangles).expect("a mesh")
}
