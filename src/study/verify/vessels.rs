//! Vessels with holes, by several methods: what leaves through one, against its bounds and against the balance of the gas.

use crate::gas::{self, kinetics};
use crate::gpu::Device;
use crate::scene::Method;
use crate::simulation::Options;
use crate::study::StudyError;

use super::effusion::{self, DIAMETER, flow_ratio_by};
use super::holes::{self, RADIUS, VOLUME, emptying_scene};
use super::witness::model_from;
use super::{Check, Effort, Findings, run};

/// Free flight: n cbar A/4. With half-turn no less may leave than that, and no more than a continuum lets choke, .84/.58 of it.
pub(super) fn effusion(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let Findings { mut checks, .. } = effusion::effusion(device, effort)?;
    let numbers: &[u64] = if effort == Effort::Quick { &[50_000] } else { &[5_000, 50_000, 400_000] };
    for &particles in numbers {
        checks.push(bounded(device, Method::HalfTurn, particles, DIAMETER)?);
    }
    Ok(checks.into())
}

/// The flow between both bounds; a method that lets more or less through is no gas. (They are of a hole of [`DIAMETER`], whatever the one of the
/// run is.)
///
/// # Errors
/// If the run fails.
pub fn bounded(device: &Device, method: Method, particles: u64, diameter: f64) -> Result<Check, StudyError> {
    let [free, continuum] = gas::COEFFICIENT_LIMITS;
    let most = continuum / free;
    let found = flow_ratio_by(device, method, particles, diameter)?;
    let quantity = format!("{}: flow over n cbar A/4, from 1 to {most:.2}, N = {particles}", method.name());
    Ok(Check::of(quantity, 0.5 * (1.0 + most), found, 0.5 * (most - 1.0) + 3.0 * found.1))
}

pub(super) fn blow_down(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let mut findings = holes::blow_down(device, effort)?;
    let particles = if effort == Effort::Quick { 20_000 } else { 60_000 };
    findings.checks.extend(emptied_by_half_turn(device, particles)?);
    Ok(findings)
}

/// As [`holes::emptied`]. Gas that conducts little heat takes its enthalpy along however narrow the hole is, so d lnT / d lnN is at most .4; and at
/// least as far from free flight's as the discharge is, of the Knudsen number by which the hole acts when a quarter has left.
fn emptied_by_half_turn(device: &Device, particles: u64) -> Result<Vec<Check>, StudyError> {
    let mut scene = emptying_scene()?;
    scene.end_time = 6e-3;
    scene.model.particles = Some(particles);
    scene.model.method = Some(Method::HalfTurn);
    let model = model_from("blow-down", scene)?;
    let rows = run(device, &model, Options::default())?.rows;
    let spacing = kinetics::mean_spacing(0.75 * particles as f64 / VOLUME);
    let least = holes::expected_slope(gas::published(kinetics::HALF_TURN_PATHS[0] * spacing / RADIUS));
    let found = holes::slope(&rows);
    let (expected, tolerance) = (0.5 * (least + 0.4), 0.5 * (0.4 - least) + 3.0 * found.1);
    let quantity = format!("half-turn: d lnT / d lnN of the gas that stays, {least:.3} to 0.4, N = {particles}");
    let course = holes::course(&model, &rows, particles);
    Ok(vec![
        Check::of(quantity, expected, found, tolerance),
        Check { quantity: format!("half-turn: {}", course.quantity), ..course },
    ])
}
