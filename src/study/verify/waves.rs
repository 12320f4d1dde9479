//! Sound and heat of the method `half-turn`: standing waves in a box of gas at rest, n half waves along it.
//!
//! Sound: v = U sin kx, k = n pi/L, swings at k sqrt(gamma) c0 and dies down as exp(-b t), b = Gamma k^2. With U = .15 c0 it dies down
//! sooner than it steepens. Heat: T = T0 (1 + e cos kx) at one pressure decays as exp(-chi k^2 t); its amplitude is that of
//! p/(gamma p0) - n/n0, which sound leaves alone: of each particle E/(gamma cv T0) - 1. N particles show the one to sqrt(2/N) c0 and the
//! other to sqrt(.29/(2 N)); these are thermal fluctuations, which live as long as the wave, so the errors are those of seeds: of sound by
//! leaving out one after the other (jackknife), since a fit to a single noisy run is biased.

use std::f64::consts::PI;

use crate::gas::kinetics::HALF_TURN_VISCOSITY;
use crate::geometry::Grid;
use crate::gpu::Device;
use crate::plan::SPACINGS_FLOWN;
use crate::simulation::Options;
use crate::study::StudyError;
use crate::subdomain::GpuParticle;

use super::damped_wave::fit;
use super::gas_box::{EDGE, EquilibriumBox};
use super::shear::decay;
use super::statistics::mean_and_error;
use super::witness::{model_from, scene_of};
use super::{Check, Effort, Findings, run};

const GAMMA: f64 = 1.4;
/// U over the thermal speed, and e.
const SOUND: f64 = 0.15;
const HEAT: f64 = 0.2;
/// What the prototype found for the method, over d c0.
pub const DIFFUSIVITY: f64 = 0.5;
/// Gamma = (4/3 nu + (gamma - 1) chi)/2 (Landau and Lifshitz, Fluid Mechanics, section 79) of the prototype's nu and chi, without a bulk viscosity.
pub const DAMPING: f64 = 0.5 * (4.0 / 3.0 * HALF_TURN_VISCOSITY + (GAMMA - 1.0) * DIFFUSIVITY);
/// What nu and chi are known to makes .02 of it, and spin that needs a step of .6 d/c0 to follow, (gamma - 1)^2 of that, at most .05.
const DAMPING_KNOWN_TO: f64 = 0.05;

/// So many particles, half waves and seeds.
#[derive(Debug, Clone, Copy)]
pub struct Waves {
    pub method: &'static str,
    pub particles: u64,
    pub half_waves: u32,
    pub seeds: u64,
}

/// What is done to a particle in units of c0, whose k x is given, and what is seen of it.
#[derive(Clone, Copy)]
struct Wave {
    stir: fn(f64, &mut GpuParticle),
    /// By how much k x grows, over its sine.
    pushed: f64,
    seen: fn(f64, f64, &GpuParticle) -> f64,
}

impl Waves {
    /// k, 1/m.
    fn number(&self) -> f64 {
        f64::from(self.half_waves) * PI / EDGE
    }

    /// k d.
    fn spacing(&self) -> f64 {
        self.number() * EDGE / (self.particles as f64).cbrt()
    }

    /// Times k c0 and amplitudes, for each seed.
    fn series(&self, device: &Device, duration: f64, wave: Wave) -> Result<Vec<Vec<(f64, f64)>>, StudyError> {
        let mut gas = EquilibriumBox {
            method: self.method,
            particles: self.particles,
            snapshots: 40,
            ..EquilibriumBox::default()
        };
        gas.step_over_tau = if self.method == "half-turn" { SPACINGS_FLOWN } else { 0.2 };
        let (k, speed) = (self.number(), gas.thermal_speed());
        gas.steps = (duration / (k * speed) / gas.time_step()).ceil() as u32;
        let mut found = Vec::new();
        for seed in 1..=self.seeds {
            let mut scene = scene_of("waves", &gas.toml())?;
            scene.seed = seed;
            let mut model = model_from("waves", scene)?;
            model.plan.collision_limit = model.plan.collision_limit.max(1.0);
            // Snapshots are at the ends of intervals.
            model.plan.steps_per_interval = 2;
            let grid = model.plan.grid;
            let phase = move |grid: &Grid, particle: &GpuParticle| k * grid.to_metres(particle.position)[0];
            let stirred = move |particles: &mut [GpuParticle]| {
                for particle in particles {
                    let mut place = grid.to_metres(particle.position);
                    place[0] += wave.pushed / k * phase(&grid, particle).sin();
                    particle.position = grid.to_fixed(place).unwrap_or(particle.position);
                    let at = phase(&grid, particle);
                    particle.velocity = particle.velocity.map(|v| v / speed as f32);
                    particle.spin /= (speed * speed) as f32;
                    (wave.stir)(at, particle);
                    particle.velocity = particle.velocity.map(|v| v * speed as f32);
                    particle.spin *= (speed * speed) as f32;
                }
            };
            let run = run(device, &model, Options { shuffle: Some(&stirred), ..Options::default() })?;
            let amplitude = |particles: &[GpuParticle]| {
                let sum: f64 =
                    particles.iter().map(|particle| (wave.seen)(phase(&grid, particle), speed, particle)).sum();
                sum / particles.len() as f64
            };
            found.push(run.snapshots.iter().map(|(time, all)| (time * k * speed, amplitude(all))).collect());
        }
        Ok(found)
    }

    /// Frequency over k sqrt(gamma) c0, and damping over k^2 d c0, of sound, with their standard errors.
    ///
    /// # Errors
    /// If a run fails.
    pub fn sound(&self, device: &Device) -> Result<[(f64, f64); 2], StudyError> {
        let wave = Wave {
            stir: |at, particle| particle.velocity[0] += (SOUND * at.sin()) as f32,
            pushed: 0.0,
            seen: |at, speed, particle| 2.0 * f64::from(particle.velocity[0]) / speed * at.sin(),
        };
        // Two periods.
        let series = self.series(device, 4.0 * PI / GAMMA.sqrt(), wave)?;
        let fitted = |left_out: usize| {
            let [frequency, damping] = fit(&mean_series(&series, left_out), GAMMA.sqrt());
            // Damping slows a wave: omega^2 = omega_0^2 - b^2.
            [frequency.hypot(damping) / GAMMA.sqrt(), damping / self.spacing()]
        };
        let all = fitted(usize::MAX);
        let others: Vec<[f64; 2]> = (0..series.len()).map(fitted).collect();
        Ok([0, 1].map(|k| (all[k], jackknife(&others.iter().map(|found| found[k]).collect::<Vec<_>>()))))
    }

    /// Diffusivity of heat over d c0, and its standard error.
    ///
    /// # Errors
    /// If a run fails.
    pub fn heat(&self, device: &Device) -> Result<(f64, f64), StudyError> {
        let wave = Wave {
            stir: |at, particle| {
                let hotter = 1.0 + HEAT * at.cos();
                particle.velocity = particle.velocity.map(|v| v * hotter.sqrt() as f32);
                particle.spin *= hotter as f32;
            },
            // n = n0 (1 - e cos kx).
            pushed: HEAT,
            seen: |at, speed, particle| {
                let square: f64 = particle.velocity.iter().map(|v| f64::from(*v).powi(2)).sum();
                let energy = (0.5 * square + f64::from(particle.spin)) / speed.powi(2);
                (energy / (GAMMA / (GAMMA - 1.0)) - 1.0) * at.cos()
            },
        };
        // To some e^-1.
        let series = self.series(device, 1.0 / (DIFFUSIVITY * self.spacing()), wave)?;
        let found: Vec<f64> = series.iter().map(|of_seed| decay(of_seed) / self.spacing()).collect();
        Ok(mean_and_error(&found))
    }
}

/// Moment by moment, without one of them.
fn mean_series(series: &[Vec<(f64, f64)>], left_out: usize) -> Vec<(f64, f64)> {
    let used = || series.iter().enumerate().filter(|(index, _)| *index != left_out).map(|(_, of_seed)| of_seed);
    let count = used().count() as f64;
    let moment = |k: usize, time: f64| (time, used().map(|of_seed| of_seed[k].1).sum::<f64>() / count);
    series.first().into_iter().flatten().enumerate().map(|(k, (time, _))| moment(k, *time)).collect()
}

/// The standard error of what is found of all, from what is found without one after the other.
fn jackknife(found: &[f64]) -> f64 {
    (found.len() as f64 - 1.0) * mean_and_error(found).1
}

/// Half-turn's waves of kd = .24: of heat, and of sound, which takes more particles.
fn of(effort: Effort, sound: bool) -> Waves {
    let (particles, half_waves, seeds) = match (effort, sound) {
        (Effort::Quick, false) => (17_000, 2, 12),
        (Effort::Full, false) => (60_000, 3, 24),
        (Effort::Quick, true) => (60_000, 3, 12),
        (Effort::Full, true) => (142_000, 4, 24),
    };
    Waves { method: "half-turn", particles, half_waves, seeds }
}

/// A note of the case `sound`.
pub(super) const NOTE: &str = "The prototype has .33 to .35 d c0 for the damping of sound with half-turn. Its own viscosity and diffusivity \
     of heat, which runs find too, make .24, and a bulk viscosity that would make up the rest, some .2 d c0, is more than spin that \
     follows within a step has: the reference is .24";

/// What the case `sound` has of half-turn.
pub(super) fn sounds(device: &Device, effort: Effort) -> Result<Vec<Check>, StudyError> {
    sounds_of(device, &of(effort, true), if effort == Effort::Quick { 0.03 } else { 0.01 })
}

/// Frequency, which may be off by so much, and damping of these waves against those of half-turn.
///
/// # Errors
/// If a run fails.
pub fn sounds_of(device: &Device, waves: &Waves, of_frequency: f64) -> Result<Vec<Check>, StudyError> {
    let [frequency, damping] = waves.sound(device)?;
    let what = format!("kd = {:.2}, N = {}", waves.spacing(), waves.particles);
    let method = waves.method;
    Ok(vec![
        Check::of(format!("{method}: frequency, {what}"), 1.0, frequency, of_frequency),
        Check::of(
            format!("{method}: damping / (d c0 k^2), {what} (prototype .34)"),
            DAMPING,
            damping,
            DAMPING_KNOWN_TO,
        ),
    ])
}

/// Thermal diffusivity; a tenth is what the figure is known to.
pub(super) fn heats(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let waves = of(effort, false);
    let quantity = format!("half-turn: chi / (d c0), kd = {:.2}, N = {}", waves.spacing(), waves.particles);
    Ok(vec![Check::of(quantity, DIFFUSIVITY, waves.heat(device)?, 0.05)].into())
}
