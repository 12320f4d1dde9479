//! What decides of the next steps: the clock, the ladder of steps, the local gas and the states of surfaces.

pub(super) mod clock;
mod fabric_seen;
pub(super) mod interval;
pub(super) mod ladder;
pub(super) mod local_gas;
pub(super) mod state_error;
pub(super) mod surface_states;
mod vent_seen;
pub(super) mod window;
