//! The speed of sound, from a standing wave in a closed tube.

use std::f64::consts::PI;

use crate::gpu::Device;
use crate::simulation::Options;
use crate::study::StudyError;
use crate::study::pareto::{Setting, model_with};
use crate::subdomain::GpuParticle;

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

/// Frequency and damping of e^(-b t) (A cos w t + B sin w t) + C nearest to a series, A, B and C being the best for
/// each: by a search on ever finer grids.
pub(super) fn fit(series: &[(f64, f64)], guess: f64) -> [f64; 2] {
    let misfit = |w: f64, b: f64| {
        let columns = |t: f64| [(-b * t).exp() * (w * t).cos(), (-b * t).exp() * (w * t).sin(), 1.0];
        let mut matrix = [[0.0; 4]; 3];
        for &(t, value) in series {
            let c = columns(t);
            for row in 0..3 {
                for column in 0..3 {
                    matrix[row][column] += c[row] * c[column];
                }
                matrix[row][3] += c[row] * value;
            }
        }
        let best = solved(matrix);
        series.iter().map(|&(t, v)| (v - columns(t).iter().zip(best).map(|(c, a)| c * a).sum::<f64>()).powi(2)).sum()
    };
    let (mut center, mut reach) = ([guess, 0.05 * guess], [0.2 * guess, 0.05 * guess]);
    for _ in 0..12 {
        let mut best = (f64::INFINITY, center);
        for i in -6..=6 {
            for k in -6..=6 {
                let at = [center[0] + reach[0] * f64::from(i) / 6.0, center[1] + reach[1] * f64::from(k) / 6.0];
                let found: f64 = misfit(at[0], at[1]);
                if found < best.0 {
                    best = (found, at);
                }
            }
        }
        center = best.1;
        reach = reach.map(|r| 0.5 * r);
    }
    center
}

/// Gauss elimination of three equations with pivots on the diagonal.
fn solved(mut m: [[f64; 4]; 3]) -> [f64; 3] {
    for pivot in 0..3 {
        for row in pivot + 1..3 {
            let factor = m[row][pivot] / m[pivot][pivot];
            let above = m[pivot];
            m[row].iter_mut().zip(above).for_each(|(entry, above)| *entry -= factor * above);
        }
    }
    let mut x = [0.0; 3];
    for row in (0..3).rev() {
        let known: f64 = (row + 1..3).map(|k| m[row][k] * x[k]).sum();
        x[row] = (m[row][3] - known) / m[row][row];
    }
    x
}

pub(super) fn sound(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    // One per cent is allowed; a third of it takes 200,000 particles, and fewer know less.
    let (particles, tolerance) = if effort == Effort::Quick { (24_000, 0.03) } else { (240_000, 0.01) };
    let mut checks = vec![frequency(device, &Setting { particles: Some(particles), ..Setting::default() }, tolerance)?];
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A damped cosine's frequency and damping are found, also with an offset and some noise.
    #[test]
    fn the_fit_finds_frequency_and_damping() {
        let value = |t: f64, k: usize| {
            0.1 * (-0.4 * t).exp() * (3.7 * t).cos() + 0.01 + 1e-4 * f64::from((k * 7919 % 13) as u32) / 13.0
        };
        let series: Vec<(f64, f64)> = (0..80).map(|k| (0.05 * k as f64, value(0.05 * k as f64, k))).collect();
        let [frequency, damping] = fit(&series, 3.9);
        assert!((frequency - 3.7).abs() < 5e-3 && (damping - 0.4).abs() < 1e-2, "{frequency} {damping}");
    }
}
