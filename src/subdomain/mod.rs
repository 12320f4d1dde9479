//! One device's gas: the particle buffers and the kernels of each phase of the step.
//!
//! Invariants: between steps `particles` holds every particle once, in the order of their cells where
//! there are collisions (of a device alone that is stalled, for want of room, `sorted` does until the host goes on); positions are fixed-point on the plan's grid; nothing is read back but the
//! tallies of an interval, one interval late, and whole states on request.

mod buffers;
mod cell_table;
mod constants;
mod counters;
mod device_gas;
mod dispatch;
mod domain;
mod domain_buffers;
mod domain_input;
mod encode;
mod exchange;
mod fabric;
mod fit;
mod guess;
mod kernels;
mod layout;
mod memory;
mod nearness;
mod parameters;
mod readback;
mod recall;
pub mod registry;
mod room;
mod rounds;
mod scales;
mod shaders;
mod sizes;
mod state;
mod step_slot;
mod subdomain_box;
mod tallies;
mod walls;

pub use buffers::{few_stretches, most_particles};
pub use cell_table::{CellTable, TooManyParts};
pub use constants::{Features, Patches, block_counts, box_bits, constants, runtime_constants};
pub use counters::{Counters, places_in_shards};
pub use device_gas::Subdomain;
pub use domain::Domain;
pub use domain_input::{DomainInput, KernelChoice};
pub use exchange::{Messages, Outgoing};
pub use fabric::Fabric;
pub use layout::{
    GpuFlight, GpuGas, GpuMotion, GpuNewborn, GpuPart, GpuParticle, GpuPeer, GpuSending, GpuSheet, GpuStep,
    GpuStillGas, GpuSurfaceModel, GpuSwept, GpuTriangle, GpuUpdate, GpuVent, GpuWeights, GpuZone,
};
pub use memory::Memory;
pub use recall::Remembered;
pub use scales::Scales;
pub use shaders::{KERNELS, shader};
pub use sizes::{CHUNK, CROWD, MEMBERS, MOST_MEMBERS, MOTION_ENTRIES, STRETCH, TILE_BITS, WORKGROUP};
pub use state::{StateError, share_table, zone_inside, zone_of, zone_plane};
pub use step_slot::{FULL_SHARE, Newborns, StepSlot, Steps, Tables};
pub use subdomain_box::{Cells, Ghosts, GridCells, SubdomainBox};
pub use tallies::{BlockSum, SurfaceModelSum, SurfaceSum, Tallies, VentSum, ZoneSum};
pub use walls::Walls;
