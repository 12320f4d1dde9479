//! What the kernels of a membrane and the host number alike: buffers, and the energies of a node.
//!
//! `build.rs` compiles this file, too: every kernel of `shaders/membrane/` begins with the numbers below as constants of WGSL,
//! and a buffer's place is its binding number.

/// Constants, and all of them as a table of names and values.
macro_rules! registry {
    ($(#[doc = $all:literal])* $table:ident { $($(#[doc = $about:literal])* $name:ident = $value:expr,)* }) => {
        $($(#[doc = $about])* pub const $name: u32 = $value;)*
        $(#[doc = $all])*
        pub const $table: &[(&str, u32)] = &[$((stringify!($name), $name)),*];
    };
}

registry! {
    /// The works of a node, J.
    WORK_TABLE {
        /// Of damping: what it takes is minus this.
        WORK_DAMPING = 0,
        WORK_PRESSURE = 1,
        WORK_GRAVITY = 2,
        /// Of what holds nodes.
        WORK_HOLDS = 3,
        /// What nodes took of what the gas gave, and what they did not.
        WORK_GAS = 4,
        WORK_LEDGER = 5,
        /// Of obstacles: what pushes nodes off, and what rubs them.
        WORK_OBSTACLES = 6,
        WORK_FRICTION = 7,
        /// Of a reference that changes its size, on strain.
        WORK_REFERENCE = 8,
    }
}

registry! {
    /// Room for faces of obstacles.
    OBSTACLE_TABLE {
        MOST_OBSTACLES = 256,
    }
}

/// All numbers that kernels see.
pub const NUMBERS: [&[(&str, u32)]; 2] = [WORK_TABLE, OBSTACLE_TABLE];

/// The uniform of which each dispatch sees the part of its step.
pub const STEPPED: &str = "substep";

/// The buffers of kernels: the place of a name is its binding number.
pub const BUFFERS: &[&str] = &[
    "substep",
    "membrane_step",
    "elastic",
    "elements",
    "element_forces",
    "corners",
    "node_constants",
    "prescribed",
    "obstacles",
    "membrane_nodes",
    "impulses",
    "given",
    "node_velocities",
    "neighbours",
    "neighbour_starts",
    "smooth_from",
    "smooth_to",
    "nodes",
    "faults",
];

/// The phase in which they are dispatched.
pub const PHASE: &str = "membrane";
