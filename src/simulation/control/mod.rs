//! What decides of the next steps: the clock, the ladder of steps, the local gas and the states of surfaces.

pub(super) mod clock;
pub(super) mod ladder;
pub(super) mod local_gas;
pub(super) mod surface_states;
