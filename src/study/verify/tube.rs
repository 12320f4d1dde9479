//! A closed tube with gas left and right of its middle, and the exact solution for it (`sod.rs`, `sound.rs`).
//!
//! The tube is 1 m long and square, with specular walls, so that on average all is a function of x and t. In units of
//! the tube's length, the density and sqrt(p/rho) on the left the cases are those of the literature.

use std::f64::consts::PI;

use crate::gas::{Fluid, Riemann};
use crate::scene::Scene;
use crate::simulation::Model;
use crate::study::StudyError;
use crate::subdomain::GpuParticle;

use super::gas_box::GAS_CONSTANT;
use super::scene_of;
use super::witness::model_from;

/// m.
pub const LENGTH: f64 = 1.0;
const MOLAR_MASS: f64 = 0.028;
const TEMPERATURE: f64 = 300.0;
const PRESSURE: f64 = 101_325.0;
/// Slices in which the gas is compared.
pub const BINS: usize = 50;

/// Gas left and right of the middle of a tube.
#[derive(Debug, Clone, Copy)]
pub struct Tube {
    pub particles: u64,
    pub gamma: f64,
    /// Pressure and temperature of the right over those of the left; pressure 0 is a vacuum.
    pub right: [f64; 2],
    /// Of the sides of the cross-section, m.
    pub width: f64,
    /// In LENGTH / sqrt(p/rho) of the left.
    pub end: f64,
    pub snapshots: u32,
    pub seed: u64,
}

impl Tube {
    /// sqrt(p/rho) of the left, m/s.
    pub fn speed(&self) -> f64 {
        (GAS_CONSTANT * TEMPERATURE / MOLAR_MASS).sqrt()
    }

    /// # Errors
    /// If no plan can be made for it.
    pub fn model(&self) -> Result<Model, StudyError> {
        model_from("tube", self.scene()?)
    }

    /// # Errors
    /// If its figures make no scene.
    pub fn scene(&self) -> Result<Scene, StudyError> {
        let Tube { particles, gamma, width, snapshots, seed, .. } = *self;
        let [pressure, temperature] = self.right;
        let right = if pressure > 0.0 {
            format!(
                "[[chamber]]\nname = \"right\"\npressure = {:e}\ntemperature = {:e}\ngas = \"gas\"\n",
                PRESSURE * pressure,
                TEMPERATURE * temperature
            )
        } else {
            String::new()
        };
        let text = format!(
            "end_time = {end:e}\nseed = {seed}\n[[gas]]\nname = \"gas\"\nmolar_mass = {MOLAR_MASS}\ngamma = {gamma}\n\
             [[wall]]\nname = \"tube\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [{LENGTH}, {width}, {width}]\n\
             gas = \"inside\"\n\
             [[chamber]]\nname = \"left\"\npressure = {PRESSURE}\ntemperature = {TEMPERATURE}\ngas = \"gas\"\n\
             region = {{ box = {{ min = [0.0, 0.0, 0.0], max = [{half}, {width}, {width}] }} }}\n{right}\
             [model]\nmethod = \"closest-approach\"\nparticles = {particles}\n[output]\nrows = 4\nsnapshots = {snapshots}\n",
            end = self.end * LENGTH / self.speed(),
            half = 0.5 * LENGTH,
        );
        scene_of("tube", &text)
    }

    /// The exact solution until waves reach the ends of the tube, in the units of the left.
    pub fn exact(&self) -> Option<Riemann> {
        let [pressure, temperature] = self.right;
        let left = Fluid { density: 1.0, velocity: 0.0, pressure: 1.0 };
        let density = if pressure > 0.0 { pressure / temperature } else { 0.0 };
        Riemann::new(left, Fluid { density, velocity: 0.0, pressure }, self.gamma)
    }

    /// Means over the slices at a time (in units of `end`): of density and velocity, found and exact, in the units of the
    /// left.
    pub fn profile(&self, model: &Model, time: f64, particles: &[GpuParticle]) -> Option<Vec<Slice>> {
        let exact = self.exact()?;
        let mut numbers = [0.0; BINS];
        let mut velocities = [0.0; BINS];
        for particle in particles {
            let x = model.plan.grid.to_metres(particle.position)[0] / LENGTH;
            let bin = ((x * BINS as f64) as usize).min(BINS - 1);
            numbers[bin] += 1.0;
            velocities[bin] += f64::from(particle.velocity[0]) / self.speed();
        }
        let left: f64 = model.plan.chambers[0].particles.iter().map(|&n| n as f64).sum();
        let unit = 2.0 * left / BINS as f64;
        let slice = |bin: usize| {
            // The mean of the solution over the slice, of the velocity by mass.
            let fine = 200;
            let (mut density, mut momentum, mut pressure) = (0.0, 0.0, 0.0);
            for k in 0..fine {
                let x = (bin as f64 + (f64::from(k) + 0.5) / f64::from(fine)) / BINS as f64 - 0.5;
                let state = exact.at(x / time);
                density += state.density / f64::from(fine);
                momentum += state.density * state.velocity / f64::from(fine);
                pressure += state.pressure / f64::from(fine);
            }
            let per_particle = |variance: f64| if density > 0.0 { (variance / unit).sqrt() } else { 0.0 };
            Slice {
                x: (bin as f64 + 0.5) / BINS as f64,
                density: [numbers[bin] / unit, density],
                velocity: [
                    if numbers[bin] > 0.0 { velocities[bin] / numbers[bin] } else { 0.0 },
                    if density > 0.0 { momentum / density } else { 0.0 },
                ],
                scatter: [per_particle(density), per_particle(pressure / density.powi(2))],
            }
        };
        Some((0..BINS).map(slice).collect())
    }

    /// Mean |difference| to the exact solution at a time (in units of `end`) over the slices, of density and velocity.
    pub fn errors(&self, model: &Model, time: f64, particles: &[GpuParticle]) -> Option<[f64; 2]> {
        Some(mean_differences(&self.profile(model, time, particles)?))
    }

    /// Standard error that the counting noise of as many independent particles gives the density's mean |difference|.
    pub fn noise(&self, model: &Model) -> f64 {
        let left: f64 = model.plan.chambers[0].particles.iter().map(|&n| n as f64).sum();
        // Of the |difference| in a slice with the left's density, whose counts scatter by a root of 2 left / BINS.
        let of_slice = (BINS as f64 / (2.0 * left)).sqrt();
        (1.0 - 2.0 / PI).sqrt() * of_slice / (BINS as f64).sqrt()
    }
}

/// A slice of a tube: found and exact.
#[derive(Debug, Clone, Copy)]
pub struct Slice {
    /// Its middle over the tube's length.
    pub x: f64,
    pub density: [f64; 2],
    pub velocity: [f64; 2],
    /// Standard deviations that counting independent particles gives the two: rho n particles in a slice, n of the
    /// density of the left, have the density to sqrt(rho/n) and the velocity to sqrt(T/(rho n)).
    pub scatter: [f64; 2],
}

/// What counting noise makes of the mean |difference| of a profile: mean and standard deviation, of density and velocity.
/// |z| of a normal variate has the mean sqrt(2/pi) and the variance 1 - 2/pi.
pub fn counting_noise(profile: &[Slice]) -> [(f64, f64); 2] {
    let count = profile.len() as f64;
    [0, 1].map(|k| {
        let mean = profile.iter().map(|slice| slice.scatter[k]).sum::<f64>() / count;
        let square: f64 = profile.iter().map(|slice| slice.scatter[k].powi(2)).sum();
        ((2.0 / PI).sqrt() * mean, ((1.0 - 2.0 / PI) * square).sqrt() / count)
    })
}

/// Mean |difference| of density and velocity.
pub fn mean_differences(profile: &[Slice]) -> [f64; 2] {
    let mean = |of: fn(&Slice) -> [f64; 2]| {
        profile.iter().map(of).map(|[found, exact]| (found - exact).abs()).sum::<f64>() / profile.len() as f64
    };
    [mean(|slice| slice.density), mean(|slice| slice.velocity)]
}

pub const SOD: Tube =
    Tube { particles: 160_000, gamma: 1.4, right: [0.1, 0.8], width: 0.1, end: 0.2, snapshots: 0, seed: 5 };

#[cfg(test)]
mod tests {
    use super::*;

    /// The exact profile itself has no error, and a shifted one has.
    #[test]
    fn the_exact_profile_has_no_error() {
        let exact = SOD.exact().unwrap();
        let state = exact.at(0.0);
        assert!((state.density - 0.42632).abs() < 1e-4, "between the fan and the contact");
        assert!(Tube { right: [0.0, 1.0], ..SOD }.exact().unwrap().at(5.9).density < 1e-9);
    }

    /// Fifty slices of a hundred particles at rest: 8 % and 6 % / sqrt(50) of the density.
    #[test]
    fn counting_noise_is_that_of_normal_variates() {
        let slice = Slice { x: 0.5, density: [1.0; 2], velocity: [0.0; 2], scatter: [0.1, 0.1] };
        let [(mean, error), _] = counting_noise(&[slice; 50]);
        assert!((mean - 0.079_79).abs() < 1e-5 && (error - 0.060_28 / 50f64.sqrt()).abs() < 1e-5, "{mean} {error}");
    }
}
