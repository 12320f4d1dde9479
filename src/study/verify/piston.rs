//! Pistons: slow compression to half the volume against the adiabatic law (docs/reference/accuracy.md), and pistons that
//! drive a shock against Rankine and Hugoniot.
//!
//! Speeds are in c0 = sqrt(kT/m) of the gas at rest. A slow piston (.02 c0) leaves T V^(gamma-1) alone. A fast one,
//! started at once, drives a shock of Mach number M, u/a = 2/(gamma+1) (M - 1/M); until it comes back from the far end
//! the piston feels p/p1 = 1 + 2 gamma/(gamma+1) (M^2 - 1), and so does on the gas the work p A u t.

use crate::gpu::Device;
use crate::scene::{Method, Scene};
use crate::simulation::{Model, Options};
use crate::study::StudyError;

use super::gas_box::GAS_CONSTANT;
use super::statistics::error_of_hits;
use super::{Check, Effort, Findings, Run, model_from, run, scene_of};

pub const GAMMA: f64 = 1.4;
const MOLAR_MASS: f64 = 0.028;
const TEMPERATURE: f64 = 300.0;
const PRESSURE: f64 = 1e5;
/// m; the cross-section is a square of half of it.
const LENGTH: f64 = 0.1;
/// Speed of the slow piston, and how much of the length it is pushed in.
const SLOW: f64 = 0.02;
const PUSHED: f64 = 0.5;

/// A closed box and a piston that is pushed into it.
#[derive(Debug, Clone, Copy)]
pub struct Piston {
    pub particles: u64,
    pub seed: u64,
    /// In c0.
    pub speed: f64,
    /// Way of the piston at the end, in lengths of the box.
    pub pushed: f64,
    pub method: Method,
}

impl Piston {
    pub fn slow(particles: u64, seed: u64) -> Piston {
        Piston { particles, seed, speed: SLOW, pushed: PUSHED, method: Method::ClosestApproach }
    }

    /// Until the shock is nearly at the far end.
    pub fn shock(particles: u64, speed: f64) -> Piston {
        let front = mach(speed) * GAMMA.sqrt();
        Piston { particles, seed: 3, speed, pushed: 0.9 * speed / front, method: Method::ClosestApproach }
    }

    pub fn by(self, method: Method) -> Piston {
        Piston { method, ..self }
    }

    /// # Errors
    /// If no plan can be made for it.
    pub fn scene(&self) -> Result<Scene, StudyError> {
        let Piston { particles, seed, speed, pushed, method } = *self;
        let width = 0.5 * LENGTH;
        let speed = speed * (GAS_CONSTANT * TEMPERATURE / MOLAR_MASS).sqrt();
        let text = format!(
            "end_time = {end:e}\nseed = {seed}\n[[gas]]\nname = \"gas\"\nmolar_mass = {MOLAR_MASS}\ngamma = {GAMMA}\n\
             [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [{LENGTH}, {width}, {width}]\n\
             gas = \"inside\"\n\
             [[wall]]\nname = \"piston\"\nshape = \"box\"\nmin = [{back:e}, -0.003, -0.003]\n\
             max = [0.0, {wide:e}, {wide:e}]\ngas = \"outside\"\n\
             [[motion]]\nwall = \"piston\"\ndirection = [1.0, 0.0, 0.0]\nvelocity = {speed:e}\n\
             [[chamber]]\nname = \"all\"\npressure = {PRESSURE}\ntemperature = {TEMPERATURE}\ngas = \"gas\"\n\
             [[surface]]\nname = \"walls\"\nwall = \"box\"\n\
             [model]\nparticles = {particles}\n[output]\nrows = 20\nsnapshots = 0\n",
            end = pushed * LENGTH / speed,
            back = -(pushed + 0.1) * LENGTH,
            wide = width + 0.003,
        );
        let mut scene = scene_of("piston", &text)?;
        scene.model.method = Some(method);
        Ok(scene)
    }

    /// # Errors
    /// As [`Piston::scene`].
    pub fn model(&self) -> Result<Model, StudyError> {
        model_from("piston", self.scene()?)
    }

    /// # Errors
    /// If the run fails.
    pub fn run(&self, device: &Device) -> Result<Run, StudyError> {
        run(device, &self.model()?, Options::default())
    }
}

/// Mach number of the shock before a piston of this speed, in c0.
pub fn mach(speed: f64) -> f64 {
    let half = 0.25 * (GAMMA + 1.0) * speed / GAMMA.sqrt();
    half + (1.0 + half * half).sqrt()
}

/// Of the pressure behind the shock to that before it.
pub fn shock_pressure(speed: f64) -> f64 {
    1.0 + 2.0 * GAMMA / (GAMMA + 1.0) * (mach(speed).powi(2) - 1.0)
}

/// Mean temperature at the end over that at the start.
pub fn warming(run: &Run) -> f64 {
    run.outcome.audit.energy_end / run.outcome.audit.energy_start
}

/// Mean pressure on the piston over that at the start, and its standard error, that of hits ([`error_of_hits`]), which are at least those on a wall at rest.
pub fn on_piston(piston: &Piston, run: &Run) -> (f64, f64) {
    let swept = piston.pushed * LENGTH * 0.25 * LENGTH * LENGTH;
    let work = run.outcome.audit.work_by_walls.unwrap_or(f64::NAN);
    // H = n cbar A t / 4, cbar = sqrt(8/pi) c0.
    let hits = piston.particles as f64 * (8.0 / std::f64::consts::PI).sqrt() / 4.0 * piston.pushed / piston.speed;
    let pressure = work / (PRESSURE * swept);
    (pressure, pressure * error_of_hits(hits))
}

/// T V^(gamma-1) at 2:1, from a few seeds.
///
/// # Errors
/// If a run fails.
pub fn compressions(device: &Device, method: Method, particles: u64, seeds: u64) -> Result<(f64, f64), StudyError> {
    let expected = (1.0 - PUSHED).powf(1.0 - GAMMA);
    let mut found = Vec::new();
    for seed in 1..=seeds {
        found.push(warming(&Piston::slow(particles, seed).by(method).run(device)?) / expected);
    }
    let count = found.len() as f64;
    let mean = found.iter().sum::<f64>() / count;
    let square = found.iter().map(|ratio| (ratio - mean).powi(2)).sum::<f64>() / (count - 1.0);
    Ok((mean, (square / count).sqrt()))
}

/// [`compressions`] as a row.
///
/// # Errors
/// If a run fails.
pub fn compressed(device: &Device, method: Method, particles: u64, seeds: u64) -> Result<Check, StudyError> {
    let what = format!("{}: T V^(gamma-1) at 2:1, {SLOW} c0, N = {particles}", method.name());
    Ok(Check::of(what, 1.0, compressions(device, method, particles, seeds)?, 0.005))
}

/// [`on_piston`] as a row, against the pressure behind the shock of a piston of this speed, c0.
///
/// # Errors
/// If the run fails.
pub fn pressed(device: &Device, piston: &Piston, speed: f64, tolerance: f64) -> Result<Check, StudyError> {
    let pressure = on_piston(piston, &piston.run(device)?);
    let what = format!("{}: p on a piston of {speed} c0 over p1, N = {}", piston.method.name(), piston.particles);
    Ok(Check::of(what, shock_pressure(speed), pressure, tolerance))
}

pub(super) fn pistons(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    // As many particles of each fast piston as make the noise of the hits a third of the tolerance.
    let (slow, fast, seeds) = match effort {
        Effort::Quick => (800, [(0.1, 36_000, 0.04), (0.5, 100_000, 0.04), (2.0, 120_000, 0.2)], 3),
        Effort::Full => (8000, [(0.1, 250_000, 0.015), (0.5, 700_000, 0.015), (2.0, 700_000, 0.085)], 4),
    };
    let mut checks = Vec::new();
    for method in [Method::ClosestApproach, Method::Cell, Method::HalfTurn] {
        checks.push(compressed(device, method, slow, seeds)?);
        // Two speeds are enough where the method is old, one to see the shock of `cell`.
        let speeds = match method {
            Method::Cell => &fast[1..2],
            Method::ClosestApproach => &fast[..2],
            _ => &fast[..],
        };
        for &(speed, particles, tolerance) in speeds {
            checks.push(pressed(device, &Piston::shock(particles, speed).by(method), speed, tolerance)?);
        }
    }
    Ok(checks.into())
}
