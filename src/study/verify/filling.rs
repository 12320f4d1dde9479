//! A closed tank that is filled (method.md, "Inflow"): its energy is U0 + integral h dm of the mass injected,
//! within 1e-4; the mass injected is within half a particle per gas of the curve's integral.

use crate::gpu::Device;
use crate::scene::Method;
use crate::simulation::{Model, Options};
use crate::study::StudyError;

use super::gas_box::GAS_CONSTANT;
use super::witness::model_from;
use super::{Check, Effort, Findings, Run, run, scene_of};

/// s; the whole rise and most of the peak.
pub const DURATION: f64 = 0.012;

/// kg through a piecewise linear curve of (s, kg/s) until `end`.
pub fn integral(curve: &[[f64; 2]], end: f64) -> f64 {
    let at = |[t0, f0]: [f64; 2], [t1, f1]: [f64; 2], t: f64| f0 + (f1 - f0) * (t - t0) / (t1 - t0);
    let pieces = curve.windows(2).filter(|piece| piece[0][0] < end);
    pieces
        .map(|piece| {
            let t1 = piece[1][0].min(end);
            0.5 * (t1 - piece[0][0]) * (piece[0][1] + at(piece[0], piece[1], t1))
        })
        .sum()
}

/// How far the energy is off, relative, if `enthalpy` (J) entered.
pub fn energy_error(run: &Run, enthalpy: f64) -> f64 {
    let audit = &run.outcome.audit;
    audit.energy_end / (audit.energy_start + enthalpy) - 1.0
}

/// The first part of `scenes/tank.toml`.
///
/// # Errors
/// If the run fails.
pub fn filled(device: &Device, method: Method, particles: u64) -> Result<(Model, Run), StudyError> {
    let mut scene = scene_of("filling", include_str!("../../../scenes/tank.toml"))?;
    scene.model.method = Some(method);
    scene.model.particles = Some(particles);
    // Moles per particle follow from the gas that is in at the end of the run.
    scene.end_time = DURATION;
    scene.output.rows = 40;
    scene.output.snapshots = 0;
    let model = model_from("filling", scene)?;
    let run = run(device, &model, Options::default())?;
    Ok((model, run))
}

/// J/kg of the gas that enters through the first orifice: cp T0, T0 that of its start, with cp = 7/2 R.
pub fn enthalpy(model: &Model) -> f64 {
    let orifice = &model.scene.orifices[0];
    3.5 * GAS_CONSTANT * orifice.temperature.points[0][1] / model.scene.gases[orifice.mixture.0[0].0].molar_mass
}

pub(super) fn balances(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let particles = if effort == Effort::Quick { 1500 } else { 6000 };
    let mut checks = Vec::new();
    for method in [Method::ClosestApproach, Method::HalfTurn] {
        let (model, run) = filled(device, method, particles)?;
        let orifice = &model.scene.orifices[0];
        let gas = &model.scene.gases[orifice.mixture.0[0].0];
        let mass = integral(&orifice.mass_flow.points, DURATION);
        let particle = gas.molar_mass * model.plan.moles_per_particle;
        let injected = run.outcome.audit.mass_injected;
        let error = energy_error(&run, enthalpy(&model) * injected);
        let (name, off) = (method.name(), (injected - mass) / particle);
        checks.push(Check::of(format!("{name}: mass injected, particles off"), 0.0, (off, 0.0), 0.5 * (1.0 + 1e-9)));
        checks.push(Check::of(format!("{name}: energy over U0 + integral h dm, less 1"), 0.0, (error, 0.0), 1e-4));
    }
    Ok(checks.into())
}
