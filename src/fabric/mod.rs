//! Fabric on one device: membranes of triangles that bear tension only. Knows devices and the lattice of positions, neither gas nor scenes.
//!
//! [`Membrane`] holds a membrane on a device and moves it ([`input`] says what it is made from, [`law`] what its stress is). It is whole on
//! every rank, and the same to the last bit: one thread adds the forces of a node's triangles in the order of a list. [`model`] is the
//! same membrane on the host, in f64: what is uploaded is made from it, and energies of strain are read by it.

mod elastic;
mod energies;
mod error;
pub mod input;
pub mod law;
mod layout;
mod membrane;
pub mod model;
mod obstacles;
mod principal;
pub mod registry;
mod shaders;
mod smoothing;
mod state;

pub use elastic::{Elasticity, Material};
pub use energies::Energies;
pub use error::MembraneError;
pub use input::{Element, Hold, MembraneInput, Obstacle, Relaxation, longest_step};
pub use law::{Law, Stress, Taut, principal};
pub use layout::{
    GpuElastic, GpuElement, GpuElementForces, GpuMembraneNode, GpuMembraneStep, GpuNeighbour, GpuNodeConstants,
    GpuObstacle, GpuSubstep,
};
pub use membrane::Membrane;
pub use model::{Model, Triangle};
pub use principal::Principal;
pub use registry::MOST_OBSTACLES;
pub use shaders::KERNELS;
pub use smoothing::recoils;
pub use state::{MembraneState, place};
