//! The speed of sound, from a standing wave in a closed tube.

use std::f64::consts::PI;

use crate::gpu::Device;
use crate::scene::Method;
use crate::simulation::Options;
use crate::study::StudyError;
use crate::study::pareto::{Setting, model_with};
use crate::subdomain::GpuParticle;

use super::damped_wave::fit;
use super::tube::{LENGTH, SOD, Tube};
use super::waves::{NOTE, sounds};
use super::{Check, Effort, Findings, run};

/// The frequency of the first mode over pi c / L, and its standard error, from the mean of cos(pi x / L) over the
/// particles, which follows a damped cosine: of a run with this setting, whose sound is about `faster` times that of the ideal gas.
///
/// # Errors
/// If the run fails.
pub fn wave(device: &Device, setting: &Setting, faster: f64) -> Result<(f64, f64), StudyError> {
    let particles = setting.particles.unwrap_or(SOD.particles);
    // .74 of the pressure, isentropic: some 20 % of the density.
    let (gamma, pressure): (f64, f64) = (1.4, 0.74);
    let temperature = pressure.powf((gamma - 1.0) / gamma);
    // Two periods at the speed of sound of the mean state.
    let sound = faster * (gamma * (0.5 * (1.0 + temperature))).sqrt();
    let tube = Tube { particles, right: [pressure, temperature], end: 4.0 / sound, snapshots: 80, ..SOD };
    let model = model_with("tube", tube.scene()?, &Setting { particles: Some(particles), ..*setting }, None)?;
    let run = run(device, &model, Options::default())?;
    let mode = |particles: &[GpuParticle]| {
        let of = |p: &GpuParticle| (PI * model.plan.grid.to_metres(p.position)[0] / LENGTH).cos();
        particles.iter().map(of).sum::<f64>() / particles.len() as f64
    };
    let series: Vec<(f64, f64)> =
        run.snapshots.iter().map(|(time, particles)| (time * tube.speed() / LENGTH, mode(particles))).collect();
    // Of the gas mixed: its energy is that of the start.
    let mean = (1.0 + pressure) / (1.0 + pressure / temperature);
    let [frequency, damping] = fit(&series, PI * sound);
    // Damping slows a mode: omega^2 = omega_0^2 - damping^2.
    let free = frequency.hypot(damping);
    // Counting noise sqrt(1/(2 N)) of the mode, not correlated between quarter periods: of a cosine of amplitude a over a
    // span T known at M moments the frequency's error is sqrt(24/M) / T x noise / a.
    let amplitude = series.iter().map(|(_, value)| value.abs()).fold(0.0, f64::max);
    let noise = (0.5 / particles as f64).sqrt();
    let error = (24.0f64 / 8.0).sqrt() / tube.end * noise / amplitude;
    Ok((free / (PI * (gamma * mean).sqrt()), error / frequency))
}

pub(super) fn sound(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    // One per cent is allowed; a third of it takes 200,000 particles, and fewer know less.
    let (particles, tolerance) = if effort == Effort::Quick { (24_000, 0.03) } else { (240_000, 0.01) };
    let method = Some(Method::ClosestApproach);
    let setting = Setting { method, particles: Some(particles), ..Setting::default() };
    let mut checks = vec![frequency(device, &setting, tolerance)?];
    checks.extend(sounds(device, effort)?);
    Ok(Findings { notes: vec![NOTE.into()], ..checks.into() })
}

/// Of a run with this setting.
///
/// # Errors
/// If the run fails.
pub fn frequency(device: &Device, setting: &Setting, tolerance: f64) -> Result<Check, StudyError> {
    let quantity = format!("frequency, N = {}", setting.particles.unwrap_or(SOD.particles));
    Ok(Check::of(quantity, 1.0, wave(device, setting, 1.0)?, tolerance))
}
