//! The method `half-turn`: where its viscosity, of which all else follows, is no longer what plans take it for, and a
//! hole what they say.

use crate::gas::CONTINUUM_COEFFICIENT;
use crate::gas::kinetics::HALF_TURN_VISCOSITY;
use crate::gpu::Device;
use crate::plan::{COLLISION_CELL, SPACINGS_FLOWN, TILE_EDGE};
use crate::scene::Method;
use crate::study::StudyError;
use crate::study::verify::Check;
use crate::study::verify::gas_box::EquilibriumBox;
use crate::study::verify::half_turn::{Sheared, viscosity};
use crate::study::verify::holes::{RADIUS, VOLUME, discharge_of_seeds};

use super::Effort;
use super::at_rest::{at_rest, lasting, of_any};
use super::flows::{FLOW, hole};

/// Of its viscosity: half as much again. (Gas of `closest-approach` is three times as viscous.)
const VISCOSITY: f64 = 0.5 * HALF_TURN_VISCOSITY;

/// Particles and seeds of a viscosity.
fn size(effort: Effort) -> (u64, u64) {
    match effort {
        Effort::Quick => (4000, 3),
        Effort::Usual => (16_000, 4),
        Effort::Full => (64_000, 6),
    }
}

fn of_viscosity(found: (f64, f64)) -> Check {
    Check::of("viscosity, nu/(d c0)", HALF_TURN_VISCOSITY, found, VISCOSITY)
}

/// Steps in which thermal speed flies so many mean spacings: what gas at rest keeps, and its viscosity.
pub(super) fn spacings_flown(
    device: &Device,
    method: Method,
    flown: f64,
    effort: Effort,
) -> Result<Vec<Check>, StudyError> {
    let gas =
        EquilibriumBox { method: method.name(), particles: 2000, step_over_tau: flown, ..EquilibriumBox::default() };
    let mut checks = at_rest(device, &lasting(gas, 120.0), 1.0)?;
    let (particles, seeds) = size(effort);
    let sheared = Sheared { particles, spacings_flown: flown, denser: 1.0, held: true };
    checks.push(of_viscosity(viscosity(device, sheared, seeds)?));
    Ok(checks)
}

/// Gas so thin beside what the grid is made for that a tile, the largest collision cell, holds so many particles.
pub(super) fn members(device: &Device, _: Method, members: f64, effort: Effort) -> Result<Vec<Check>, StudyError> {
    let (particles, seeds) = size(effort);
    let planned = (TILE_EDGE * 0.5 * COLLISION_CELL).powi(3);
    let sheared = Sheared { particles, spacings_flown: SPACINGS_FLOWN, denser: planned / members, held: true };
    Ok(vec![of_viscosity(viscosity(device, sheared, seeds)?)])
}

/// A hole that is so many mean spacings wide before its chamber empties.
pub(super) fn across(device: &Device, method: Method, spacings: f64, effort: Effort) -> Result<Vec<Check>, StudyError> {
    let resolving = VOLUME * (spacings / (2.0 * RADIUS)).powi(3);
    // As many runs as make the error of their mean a third of what is allowed.
    let seeds = if effort == Effort::Quick { 1 } else { (32_000.0 / resolving).ceil().clamp(1.0, 8.0) as u64 };
    let mut model = hole(method, resolving as u64, None)?;
    let mut checks = Vec::new();
    let (found, error) = discharge_of_seeds(device, &mut model, seeds, |model, run| checks = of_any(model, run))?;
    let found = (found / CONTINUUM_COEFFICIENT, error / CONTINUUM_COEFFICIENT);
    checks.push(Check::of("flow, Cd over that of a continuum", 1.0, found, FLOW));
    Ok(checks)
}
