//! Kinetic theory and thermodynamics on the host, f64 throughout.
//!
//! Deterministic: every transcendental function of a draw is that of crate `libm`.

mod control_volume;
mod curve;
mod discharge;
mod inflow;
mod initial;
pub mod kinetics;
mod least_squares;
mod modes;
mod philox;
mod random;
mod riemann;
mod species;
mod swept;
pub mod thermo;
pub mod vent;
pub mod wall_heat;

pub use control_volume::{
    Beginning, Collisions, ControlVolume, HeatedWall, Lost, OpenVent, Reservoir, Source, State, Vented, moles_at,
};
pub use curve::{
    FlowIntegral, bends, displacement, flow_times_of_temperature, flow_times_temperature, integral_held, turns,
    value_held, value_inside, velocity, way,
};
pub use discharge::{
    BETWEEN, COEFFICIENT_LIMITS, CONTINUUM_COEFFICIENT, Side, coefficient_into_vacuum, continuum_by_excess,
    continuum_coefficient, exchange, isentropic, published, specified,
};
pub use inflow::{Inflow, InflowParticles, InflowState, InflowStateError, Newborn, Unrepresented, jet_mach, jet_state};
pub use initial::{Correction, FillError, Filling, InitialGas, Space};
pub use modes::{MOST_MODES, fit};
pub use philox::philox4x32_10;
pub use random::{Draws, Purpose, key};
pub use riemann::{Fluid, Riemann};
pub use species::{Mode, Modes, Species};
pub use swept::Swept;

/// One particle on the host, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Particle {
    /// Unique and dense: 0.. over the whole run, initial gas first, then inflow in order of entry.
    pub id: u32,
    /// Gas index.
    pub gas: u8,
    pub position: [f64; 3],
    pub velocity: [f64; 3],
    /// J, of the whole particle (a particle is `moles_per_particle` moles).
    pub spin_energy: f64,
}
