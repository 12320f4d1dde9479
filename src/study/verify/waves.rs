//! Sound and heat of the method `half-turn`: standing waves in a box of gas at rest, n half waves along it.
//!
//! Sound: v = U sin kx, k = n pi/L, swings at k sqrt(gamma) c0 and dies down as exp(-b t), b = Gamma k^2. With U = .1 c0 it dies down
//! sooner than it steepens. Heat: T = T0 (1 + e cos kx) at one pressure decays as exp(-chi k^2 t); its amplitude is that of
//! p/(gamma p0) - n/n0, which sound leaves alone: of each particle E/(gamma cv T0) - 1. N particles show the one to sqrt(2/N) c0 and the
//! other to sqrt(.29/(2 N)); these are thermal fluctuations, which live as long as the wave, so the errors are those of seeds.

use std::f64::consts::PI;

use crate::geometry::Grid;
use crate::gpu::Device;
use crate::simulation::Options;
use crate::study::StudyError;
use crate::subdomain::GpuParticle;

use super::gas_box::{EDGE, EquilibriumBox};
use super::shear::decay;
use super::sound::fit;
use super::statistics::mean_and_error;
use super::witness::{model_from, scene_of};
use super::{Check, Effort, Findings, run};

const GAMMA: f64 = 1.4;
/// U over the thermal speed, and e.
const SOUND: f64 = 0.1;
const HEAT: f64 = 0.2;
/// What the prototype found for the method, over d c0: Gamma .33 to .35, chi .50.
pub const DAMPING: f64 = 0.34;
pub const DIFFUSIVITY: f64 = 0.5;

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
        gas.step_over_tau = if self.method == "half-turn" { 0.6 } else { 0.2 };
        let (k, speed) = (self.number(), gas.thermal_speed());
        gas.steps = (duration / (k * speed) / gas.time_step()).ceil() as u32;
        let mut found = Vec::new();
        for seed in 1..=self.seeds {
            let mut scene = scene_of("waves", &gas.toml())?;
            scene.seed = seed;
            let mut model = model_from("waves", scene)?;
            model.plan.collision_limit = model.plan.collision_limit.max(1.0);
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
        let (mut frequencies, mut dampings) = (Vec::new(), Vec::new());
        for of_seed in &series {
            let [frequency, damping] = fit(of_seed, GAMMA.sqrt());
            // Damping slows a wave: omega^2 = omega_0^2 - b^2.
            frequencies.push(frequency.hypot(damping) / GAMMA.sqrt());
            dampings.push(damping / self.spacing());
        }
        Ok([mean_and_error(&frequencies), mean_and_error(&dampings)])
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

/// Half-turn's waves of kd = .24.
fn of(effort: Effort) -> Waves {
    let (particles, half_waves, seeds) = if effort == Effort::Quick { (17_000, 2, 12) } else { (60_000, 3, 24) };
    Waves { method: "half-turn", particles, half_waves, seeds }
}

/// What the case `sound` has of half-turn.
pub(super) fn sounds(device: &Device, effort: Effort) -> Result<Vec<Check>, StudyError> {
    let waves = of(effort);
    let [frequency, damping] = waves.sound(device)?;
    let (of_frequency, of_damping) = if effort == Effort::Quick { (0.03, 0.08) } else { (0.01, 0.04) };
    let what = format!("kd = {:.2}, N = {}", waves.spacing(), waves.particles);
    Ok(vec![
        Check::of(format!("half-turn: frequency, {what}"), 1.0, frequency, of_frequency),
        Check::of(format!("half-turn: damping / (d c0 k^2), {what}"), DAMPING, damping, of_damping),
    ])
}

/// Thermal diffusivity; a tenth is what the figure is known to.
pub(super) fn heats(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let waves = of(effort);
    let quantity = format!("half-turn: chi / (d c0), kd = {:.2}, N = {}", waves.spacing(), waves.particles);
    Ok(vec![Check::of(quantity, DIFFUSIVITY, waves.heat(device)?, 0.05)].into())
}
