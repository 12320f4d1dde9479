//! Noh's problem (1987), plane: cold gas streams at one speed V against a wall.
//!
//! A shock of infinite Mach number goes back from the wall at (gamma - 1)/2 V; behind it gas is at rest, (gamma + 1)/(gamma - 1) times as
//! dense, and has the whole energy as heat: T = (gamma - 1) V^2/(2 R). It starts without any spin, so spin has to come up to
//! the temperature of the translation. What is a quarter of the way from the wall and from the front is left out: particles in one
//! layer of cells at the wall stay too hot, a known error of all methods that capture shocks.

use crate::gpu::Device;
use crate::scene::Method;
use crate::simulation::Options;
use crate::study::StudyError;
use crate::subdomain::GpuParticle;

use super::tube::{LENGTH, SOD, Tube};
use super::{Check, Effort, Findings, model_from, run};

/// Part of the tube that the gas has flown at the end.
const FLOWN: f64 = 0.6;
/// Of the gas behind the shock, thermal speed over that of the scene.
const SLOWER: f64 = 0.5;

/// What is behind the shock, over what should be, and the standard errors.
#[derive(Debug, Clone, Copy)]
pub struct Behind {
    pub density: (f64, f64),
    pub translation: (f64, f64),
    /// `None` where gas has no spin.
    pub spin: Option<(f64, f64)>,
}

/// (gamma + 1)/(gamma - 1).
pub fn compression(gamma: f64) -> f64 {
    (gamma + 1.0) / (gamma - 1.0)
}

/// # Errors
/// If the run fails.
pub fn behind_the_shock(device: &Device, method: Method, particles: u64, gamma: f64) -> Result<Behind, StudyError> {
    // So fast that the gas at rest has SLOWER^2 of the temperature of the scene, by which tallies have their range.
    let over_thermal = SLOWER * (2.0 / (gamma - 1.0)).sqrt();
    let tube = Tube { particles, gamma, right: [1.0, 1.0], end: FLOWN / over_thermal, ..SOD };
    let speed = over_thermal * tube.speed();
    let mut scene = tube.scene()?;
    scene.model.method = Some(method);
    let model = model_from("noh", scene)?;
    let streaming = move |particles: &mut [GpuParticle]| {
        for particle in particles {
            (particle.velocity, particle.spin) = ([-speed as f32, 0.0, 0.0], 0.0);
        }
    };
    let particles = run(device, &model, Options { shuffle: Some(&streaming), ..Options::default() })?.outcome.particles;
    let front = 0.5 * (gamma - 1.0) * FLOWN * LENGTH;
    let within = |particle: &&GpuParticle| {
        let x = model.plan.grid.to_metres(particle.position)[0];
        x > 0.25 * front && x < 0.75 * front
    };
    let seen: Vec<&GpuParticle> = particles.iter().filter(within).collect();
    let count = seen.len() as f64;
    let expected = compression(gamma) * particles.len() as f64 * 0.5 * front / LENGTH;
    let thermal = (SLOWER * tube.speed()).powi(2);
    let mean = |of: fn(&GpuParticle) -> f64| seen.iter().map(|particle| of(particle)).sum::<f64>() / count / thermal;
    let square = mean(|particle| particle.velocity.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>() / 3.0);
    let spins = 0.5 * (2.0 / (gamma - 1.0) - 3.0);
    let spin =
        (spins > 0.01).then(|| (mean(|particle| f64::from(particle.spin)) / spins, (spins * count).sqrt().recip()));
    Ok(Behind {
        density: (count / expected, count.sqrt().recip()),
        translation: (square, (2.0 / (3.0 * count)).sqrt()),
        spin,
    })
}

/// The density to some 2 %, by which what stays too hot at the wall lets it be too small.
pub(super) fn noh(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let (particles, tolerance) = if effort == Effort::Quick { (60_000, 0.025) } else { (240_000, 0.02) };
    let mut checks = Vec::new();
    for gamma in [1.4, 5.0 / 3.0] {
        let behind = behind_the_shock(device, Method::HalfTurn, particles, gamma)?;
        let what = |what: &str| format!("half-turn: {what} behind the shock, gamma {gamma:.3}, N = {particles}");
        let times = compression(gamma);
        let density = (times * behind.density.0, times * behind.density.1);
        checks.push(Check::of(what("density"), times, density, tolerance * times));
        checks.push(Check::of(what("T_tr over theory"), 1.0, behind.translation, 0.03));
        checks.extend(behind.spin.map(|found| Check::of(what("T_int over theory"), 1.0, found, 0.03)));
    }
    Ok(checks.into())
}
