//! Shear viscosity, from the decay of vortices.
//!
//! u = U (sin kx cos ky, -cos kx sin ky), k = pi/L, is a flow within a box with walls without friction (Taylor and Green,
//! 1937); it decays as exp(-2 nu k^2 t) and keeps its form. Its amplitude is the projection of the particles'
//! velocities on it; N particles show it to sqrt(2/N) thermal speeds at a moment.

use std::f64::consts::PI;

use crate::gas::kinetics::HALF_TURN_VISCOSITY;
use crate::geometry::{Grid, GridError};
use crate::gpu::Device;
use crate::plan::PlanError;
use crate::simulation::{Model, Options};
use crate::study::StudyError;
use crate::subdomain::GpuParticle;

use super::gas_box::{EDGE, EquilibriumBox};
use super::statistics::mean_and_error;
use super::witness::{model_from, scene_of, unsound};
use super::{Check, Effort, Findings, run};

/// Kinematic viscosity over d c0 of closest approach at f = .1 (method.md, "Collisions"), known to 10 %.
pub const FLOOR: f64 = 0.65;
/// U over the thermal speed.
const START: f64 = 0.4;
/// Of its first amplitude, down to which the decay is followed.
const LAST: f64 = 0.4;

/// sin kx cos ky, -cos kx sin ky.
fn form(grid: &Grid, particle: &GpuParticle) -> [f64; 2] {
    let [x, y, _] = grid.to_metres(particle.position).map(|at| PI * at / EDGE);
    [x.sin() * y.cos(), -x.cos() * y.sin()]
}

/// Kinematic viscosity over the mean distance of particles d and the thermal speed c0, and its standard error, from
/// `seeds` runs of such a box, as long as the vortices need.
///
/// # Errors
/// If a run fails.
pub fn viscosity(device: &Device, gas: EquilibriumBox<'_>, seeds: u64) -> Result<(f64, f64), StudyError> {
    viscosity_in(device, gas, seeds, None, true)
}

/// The same, with cells of this edge, m, in place of the plan's. `held`: steps are as long as asked for; else a run may shorten them.
///
/// # Errors
/// If a run fails.
pub fn viscosity_in(
    device: &Device,
    gas: EquilibriumBox<'_>,
    seeds: u64,
    cell: Option<f64>,
    held: bool,
) -> Result<(f64, f64), StudyError> {
    // Some .65 d c0 (docs/explanation/method.md, "Collisions"): the time in which the vortices fall to LAST.
    let distance = EDGE / (gas.particles as f64).cbrt();
    let mut gas_box = EquilibriumBox { snapshots: 40, ..gas };
    let speed = gas_box.thermal_speed();
    let expected = if gas.method == "half-turn" { HALF_TURN_VISCOSITY } else { FLOOR };
    let rate = 2.0 * expected * distance * speed * (PI / EDGE).powi(2);
    gas_box.steps = (-LAST.ln() / rate / gas_box.time_step()).ceil() as u32;
    let mut found = Vec::new();
    for seed in 1..=seeds {
        let mut scene = scene_of("shear", &gas_box.toml())?;
        scene.seed = seed;
        let mut model = model_from("shear", scene)?;
        if let Some(edge) = cell {
            let wrong = |error: GridError| unsound("shear", PlanError::from(error).into());
            model.plan.grid = Grid::around([0.0; 3], [EDGE; 3], edge).map_err(wrong)?;
        }
        let grid = model.plan.grid;
        let stirred = move |particles: &mut [GpuParticle]| {
            for particle in particles {
                let [x, y] = form(&grid, particle).map(|u| (START * speed * u) as f32);
                particle.velocity[0] += x;
                particle.velocity[1] += y;
            }
        };
        let run = run(device, &model, Options { shuffle: Some(&stirred), hold_step: held, ..Options::default() })?;
        let amplitudes: Vec<(f64, f64)> = run.snapshots.iter().map(|(time, p)| (*time, amplitude(&model, p))).collect();
        found.push(decay(&amplitudes) / (2.0 * (PI / EDGE).powi(2)) / (distance * speed));
    }
    Ok(mean_and_error(&found))
}

/// m/s.
fn amplitude(model: &Model, particles: &[GpuParticle]) -> f64 {
    let (mut product, mut square) = (0.0, 0.0);
    for particle in particles {
        let [x, y] = form(&model.plan.grid, particle);
        product += x * f64::from(particle.velocity[0]) + y * f64::from(particle.velocity[1]);
        square += x * x + y * y;
    }
    product / square
}

/// b of A exp(-b t), 1/s, through logarithms that count as the squares of the values: those err alike.
pub(super) fn decay(series: &[(f64, f64)]) -> f64 {
    let mut sums = [0.0; 5];
    for &(t, a) in series.iter().filter(|(_, a)| *a > 0.0) {
        let (weight, log) = (a * a, a.ln());
        let terms = [weight, weight * t, weight * t * t, weight * log, weight * t * log];
        sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
    }
    let [n, t, tt, l, tl] = sums;
    -(n * tl - t * l) / (n * tt - t * t)
}

pub(super) fn viscosities(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let (particles, seeds) = if effort == Effort::Quick { (8000, 8) } else { (32_000, 8) };
    Ok(vec![at_occupancy(device, 0.1, particles, seeds)?].into())
}

/// Gas of this occupancy against [`FLOOR`], which is that of .1.
///
/// # Errors
/// If a run fails.
pub fn at_occupancy(device: &Device, occupancy: f64, particles: u64, seeds: u64) -> Result<Check, StudyError> {
    let gas = EquilibriumBox { particles, occupancy, step_over_tau: 0.2, ..EquilibriumBox::default() };
    let found = viscosity(device, gas, seeds)?;
    Ok(Check::of(format!("nu / (d c0), f = {occupancy}, N = {particles}"), FLOOR, found, 0.1 * FLOOR))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_decay_of_an_exponential_is_found() {
        let series: Vec<(f64, f64)> =
            (0..20).map(|k| (0.1 * f64::from(k), 3.0 * (-0.07 * f64::from(k)).exp())).collect();
        assert!((decay(&series) - 0.7).abs() < 1e-12);
    }
}
