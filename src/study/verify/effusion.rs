//! Flow of gas that does not collide through a hole, and through a tube of rough walls; and of gas that does, through the same hole.

use std::f64::consts::PI;

use crate::geometry::region_contains;
use crate::gpu::Device;
use crate::scene::{Method, Outline, Shape};
use crate::simulation::Options;
use crate::study::StudyError;

use super::gas_box::GAS_CONSTANT;
use super::witness::model_from;
use super::{Check, Effort, Findings, run, scene_of};

/// s.
const DURATION: f64 = 0.00125;
/// m, of the hole of `scenes/effusion.toml`.
pub const DIAMETER: f64 = 0.03;

/// `scenes/effusion.toml` with a hole of another diameter; the particles that left the inner box over those
/// that should have through a hole of [`DIAMETER`], and the standard error.
///
/// Particles of speed v leave at v A / (4 V), the fast first, so after a time t
/// N0 (1 - integral f(v) exp(-v A t / (4 V)) dv) have left; the run is short enough (10 %) that what comes
/// back from the 26 times larger outer space is .2 % of that. M particles that left are known to 1 / sqrt(M).
///
/// # Errors
/// If the run fails.
pub fn flow_ratio(device: &Device, particles: u64, diameter: f64) -> Result<(f64, f64), StudyError> {
    flow_ratio_by(device, Method::None, particles, diameter)
}

/// By a method whose particles meet.
///
/// # Errors
/// If the run fails.
pub fn flow_ratio_by(device: &Device, method: Method, particles: u64, diameter: f64) -> Result<(f64, f64), StudyError> {
    let mut scene = scene_of("effusion", include_str!("../../../scenes/effusion.toml"))?;
    scene.model.method = Some(method);
    scene.model.particles = Some(particles);
    scene.end_time = DURATION;
    scene.output.rows = 40;
    scene.output.snapshots = 0;
    for wall in &mut scene.walls {
        if let Shape::Box { holes, .. } = &mut wall.shape {
            for hole in holes {
                hole.outline = Outline::Circle { diameter, segments: 32 };
            }
        }
    }
    scene.model.time_step = Some(5e-6);
    let inner = scene.chambers[0].region.clone();
    let model = model_from("effusion", scene)?;
    let inside = |point| inner.as_ref().is_none_or(|region| region_contains(region, point));
    let run = run(device, &model, Options::default())?;
    let places = run.outcome.particles.iter().map(|particle| model.plan.grid.to_metres(particle.position));
    let started = model.plan.chambers[0].particles[0] as f64;
    let left = started - places.filter(|place| inside(*place)).count() as f64;
    let thermal = (GAS_CONSTANT * 300.0 / model.scene.gases[0].molar_mass).sqrt();
    let rate = thermal * PI / 4.0 * DIAMETER.powi(2) / (4.0 * model.plan.chambers[0].volume);
    Ok((left / (started * (1.0 - staying(rate * run.outcome.time))), 1.0 / left.sqrt()))
}

/// Radius, and length, m, of the tube of [`transmission`].
const TUBE: [f64; 2] = [0.0125, 0.025];
/// Of molecules that enter a tube twice as long as its radius, those that come out at the other end if its walls scatter by
/// the cosine law (Clausing 1932).
pub const CLAUSING: f64 = 0.5142;

/// The same box with a tube for a hole and walls of this friction: the flow through it over n cbar A / 4, and the standard
/// error. Counted from when the tube has filled, half a millisecond.
///
/// # Errors
/// If the run fails.
pub fn transmission(device: &Device, particles: u64, friction: f64) -> Result<(f64, f64), StudyError> {
    let [radius, length] = TUBE;
    let mut scene = scene_of("effusion", include_str!("../../../scenes/effusion.toml"))?;
    scene.model.particles = Some(particles);
    scene.model.time_step = Some(5e-6);
    scene.end_time = 3e-3;
    scene.output.rows = 30;
    scene.output.snapshots = 0;
    for wall in &mut scene.walls {
        if let Shape::Box { holes, thickness: Some(thickness), .. } = &mut wall.shape {
            *thickness = length;
            wall.surface.friction = friction;
            for hole in holes {
                hole.outline = Outline::Circle { diameter: 2.0 * radius, segments: 32 };
            }
        }
    }
    let model = model_from("tube", scene)?;
    let run = run(device, &model, Options::default())?;
    let thermal = (GAS_CONSTANT * 300.0 / model.scene.gases[0].molar_mass).sqrt();
    let rate = thermal * PI * radius * radius / (4.0 * model.plan.chambers[0].volume);
    let started = model.plan.chambers[0].particles[0] as f64;
    let seen: Vec<[f64; 2]> = run
        .rows
        .iter()
        .map(|row| [0.5 * (row.window[0] + row.window[1]), row.chambers[0].particles[0]])
        .filter(|[time, _]| *time > 5e-4)
        .collect();
    let (Some([first, before]), Some([last, after])) = (seen.first(), seen.last()) else {
        return Ok((f64::NAN, f64::NAN));
    };
    let left = before - after;
    // What the fast, which leave first, make of a share of the rate: found by halving.
    let lost = |share: f64| started * (staying(share * rate * first) - staying(share * rate * last));
    let (mut low, mut high) = (0.0, 2.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if lost(middle) < left { low = middle } else { high = middle }
    }
    Ok((low, low / left.sqrt()))
}

pub(super) fn rough_tube(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let particles = if effort == Effort::Quick { 200_000 } else { 1_000_000 };
    let found = transmission(device, particles, 1.0)?;
    Ok(vec![Check::of("flow through a rough tube, L = 2 R", CLAUSING, found, 0.03 * CLAUSING)].into())
}

/// The integral of exp(-u a) over the Maxwell distribution of speeds u (in units of sqrt(kT/m)), by the
/// trapezoidal rule, which converges faster than any power here.
pub fn staying(a: f64) -> f64 {
    let du = 0.01;
    let density = |u: f64| (2.0 / PI).sqrt() * u * u * (-0.5 * u * u - a * u).exp();
    (1..1200).map(|k| du * density(f64::from(k) * du)).sum()
}

pub(super) fn effusion(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let particles = if effort == Effort::Quick { 200_000 } else { 1_000_000 };
    Ok(vec![Check::of("flow, method none", 1.0, flow_ratio(device, particles, DIAMETER)?, 0.03)].into())
}
