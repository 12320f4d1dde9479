//! The method `half-turn` against the law, and against what a program of its own found for it (docs/explanation/method.md).

use crate::gas::kinetics::HALF_TURN_VISCOSITY;
use crate::gpu::Device;
use crate::plan::{COLLISION_CELL, SPACINGS_FLOWN};
use crate::scene::Method;
use crate::simulation::Model;
use crate::study::StudyError;

use super::gas_box::EquilibriumBox;
use super::holes::{discharge_of_seeds, emptying_scene};
use super::shear::viscosity_in;
use super::witness::model_from;
use super::{Check, Effort, Findings};

/// To which the viscosity is known.
const KNOWN_TO: f64 = 0.03;
/// Cd into vacuum against the diameter of a hole over the spacing of the particles before it: .843 - .374 d/D.
const DISCHARGE: [f64; 2] = [0.843, 0.374];

/// Gas whose viscosity is measured.
#[derive(Debug, Clone, Copy)]
pub struct Sheared {
    pub particles: u64,
    /// Mean spacings that thermal speed flies in a step.
    pub spacings_flown: f64,
    /// By how many times the gas that the grid is made for is as dense.
    pub denser: f64,
    /// Whether steps are as long as that; else the run may shorten them, as any run does.
    pub held: bool,
}

/// Its kinematic viscosity over d c0, and the standard error.
///
/// # Errors
/// If a run fails.
pub fn viscosity(device: &Device, sheared: Sheared, seeds: u64) -> Result<(f64, f64), StudyError> {
    let Sheared { particles, spacings_flown, denser, held } = sheared;
    let gas =
        EquilibriumBox { method: "half-turn", particles, step_over_tau: spacings_flown, ..EquilibriumBox::default() };
    let edge = 0.5 * COLLISION_CELL / (denser * gas.number_density()).cbrt();
    viscosity_in(device, gas, seeds, Some(edge), held)
}

/// Gas of the density that the grid is made for, and eight times thinner and denser: collision cells follow.
pub(super) fn viscosities(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let (particles, seeds) = if effort == Effort::Quick { (16_000, 3) } else { (64_000, 8) };
    let check = |denser: f64| {
        let found =
            viscosity(device, Sheared { particles, spacings_flown: SPACINGS_FLOWN, denser, held: false }, seeds)?;
        let what = format!("nu / (d c0), N = {particles}, gas {} times as dense as planned", 1.0 / denser);
        Ok(Check::of(what, HALF_TURN_VISCOSITY, found, KNOWN_TO))
    };
    [1.0, 8.0, 0.125].into_iter().map(check).collect()
}

/// A chamber that empties through a square hole.
///
/// # Errors
/// If no plan can be made for it.
pub fn emptying(particles: u64) -> Result<Model, StudyError> {
    let mut scene = emptying_scene()?;
    scene.model.method = Some(Method::HalfTurn);
    scene.model.particles = Some(particles);
    model_from("orifice", scene)
}

/// By the density in the middle of the time over which the flow is taken.
pub(super) fn discharges(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    // As many runs of each as make the error of their mean a third of the tolerance.
    let numbers: &[(u64, u64)] = if effort == Effort::Quick {
        &[(100_000, 2)]
    } else {
        &[(20_000, 10), (50_000, 8), (100_000, 4), (200_000, 2), (400_000, 2)]
    };
    let check = |&(particles, seeds): &(u64, u64)| {
        let mut model = emptying(particles)?;
        let mut before = 0.0;
        let found = discharge_of_seeds(device, &mut model, seeds, |model, run| {
            let middle = &run.rows[run.rows.len() / 2];
            before = middle.chambers[0].particles[0] / model.plan.chambers[0].volume;
        })?;
        let opening = &model.plan.openings[0];
        let diameter = 2.0 * (opening.area / std::f64::consts::PI).sqrt();
        let spacings = diameter * before.cbrt();
        let [limit, slope] = DISCHARGE;
        let what = format!("Cd into vacuum, a hole of {spacings:.1} spacings");
        // The figures scatter by .01. They are of round holes in thin walls, and the square one here passes less.
        Ok(Check::of(what, limit - slope / spacings, found, 0.02).disputed())
    };
    numbers.iter().map(check).collect()
}
