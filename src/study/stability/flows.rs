//! Flows: a hole, tubes with jumps, a jet.

use std::f64::consts::PI;

use crate::gas::CONTINUUM_COEFFICIENT;
use crate::gpu::Device;
use crate::scene::{DiameterCap, Jet, JetSpeed, Method};
use crate::simulation::{Model, Options};
use crate::study::StudyError;
use crate::study::verify::filling::{energy_error, enthalpy};
use crate::study::verify::holes::{RADIUS, VOLUME, discharge_of, emptying_scene};
use crate::study::verify::piston::{Piston, on_piston, shock_pressure};
use crate::study::verify::tube::{SOD, Tube};
use crate::study::verify::{Check, Run, model_from, run, scene_of};

use super::Effort;
use super::at_rest::of_any;

/// What guards allow a resolved hole (specification, section 6).
const FLOW: f64 = 0.07;
/// At 160,000 particles, and how it falls with their number (specification, section 8: .024; section 2: N^-.26).
const PROFILE: f64 = 0.024;
/// Of the pressure behind a shock that is a few mean free paths wide, and of its excess.
const ON_PISTON: [f64; 2] = [0.05, 0.2];
/// Occupancies of holes' runs, the second of rigid spheres.
const USUAL: f64 = 0.12;
const THIN: f64 = 0.03;
/// rad.
const CONE: f64 = 0.2;

pub(super) fn knudsen(device: &Device, method: Method, knudsen: f64, effort: Effort) -> Result<Vec<Check>, StudyError> {
    // Enough for noise, and so many that the gas is no denser than plans make it: lambda over the spacing n^(-1/3) is
    // 1/(sqrt2 pi (6 f/pi)^(2/3)).
    let [least, most] = match effort {
        Effort::Quick => [4000, 4000],
        Effort::Usual => [8000, 64_000],
        Effort::Full => [64_000, 512_000],
    };
    let occupancy = if method == Method::HardSphere { THIN } else { USUAL };
    let path_over_spacing = 1.0 / (2f64.sqrt() * PI * (6.0 * occupancy / PI).powf(2.0 / 3.0));
    let resolving = VOLUME * (path_over_spacing / (knudsen * RADIUS)).powi(3);
    let particles = if method == Method::None { least } else { (resolving as u64).clamp(least, most) };
    let mut scene = emptying_scene()?;
    scene.model.method = Some(method);
    scene.model.particles = Some(particles);
    let density = particles as f64 / VOLUME;
    if method != Method::None {
        scene.model.diameter = Some((1.0 / (2f64.sqrt() * PI * density * knudsen * RADIUS)).sqrt());
        // The Knudsen number is that of the gas that stays, which is denser than the mean.
        scene.model.diameter_cap = Some(DiameterCap::Off);
    }
    let model = model_from("orifice", scene)?;
    let run = run(device, &model, Options::default())?;
    let (found, error) = discharge_of(&run.rows);
    let mut checks = of_any(&model, &run);
    let relative = (found / CONTINUUM_COEFFICIENT, error / CONTINUUM_COEFFICIENT);
    checks.push(Check::of("flow, Cd over that of a continuum", 1.0, relative, FLOW));
    Ok(checks)
}

pub(super) fn wall_speed(
    device: &Device,
    method: Method,
    speed: f64,
    effort: Effort,
) -> Result<Vec<Check>, StudyError> {
    let particles = match effort {
        Effort::Quick => 4000,
        Effort::Usual => 16_000,
        Effort::Full => 64_000,
    };
    let piston = Piston::shock(particles, speed).by(method);
    let model = piston.model()?;
    let run = run(device, &model, Options::default())?;
    let (found, error) = on_piston(&piston, &run);
    let expected = shock_pressure(speed);
    let allowed = (ON_PISTON[0] * expected).min(ON_PISTON[1] * (expected - 1.0));
    let mut checks = of_any(&model, &run);
    checks.push(Check::of("pressure on the piston over p1", expected, (found, error), allowed));
    Ok(checks)
}

/// Of the densities of the exact solution: what a profile is off grows with its jumps.
fn range(tube: &Tube) -> f64 {
    let exact = tube.exact();
    let densities = (-300..=300).filter_map(|k| exact.as_ref().map(|exact| exact.at(f64::from(k) / 50.0).density));
    let (low, high) = densities.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), d| (low.min(d), high.max(d)));
    high - low
}

fn tube(device: &Device, method: Method, right: [f64; 2], effort: Effort) -> Result<Vec<Check>, StudyError> {
    let particles = match effort {
        Effort::Quick => 4000,
        Effort::Usual => 6_000,
        Effort::Full => 160_000,
    };
    let tube = Tube { particles, right, end: 0.15, ..SOD };
    let mut scene = tube.scene()?;
    scene.model.method = Some(method);
    let model: Model = model_from("tube", scene)?;
    let run: Run = run(device, &model, Options::default())?;
    let density = tube.errors(&model, tube.end, &run.outcome.particles).map_or(f64::NAN, |[density, _]| density);
    let mut checks = of_any(&model, &run);
    let allowed = PROFILE * (particles as f64 / 160_000.0).powf(-0.26) * range(&tube) / range(&SOD);
    checks.push(Check::of("density profile", 0.0, (density, tube.noise(&model)), allowed));
    Ok(checks)
}

pub(super) fn density_ratio(
    device: &Device,
    method: Method,
    ratio: f64,
    effort: Effort,
) -> Result<Vec<Check>, StudyError> {
    tube(device, method, [1.0 / ratio, 1.0], effort)
}

pub(super) fn temperature_ratio(
    device: &Device,
    method: Method,
    ratio: f64,
    effort: Effort,
) -> Result<Vec<Check>, StudyError> {
    tube(device, method, [1.0 / ratio, 1.0 / ratio], effort)
}

/// Energy here is U0 and the enthalpy that came in (specification, section 8: 1e-4).
pub(super) fn mach(device: &Device, method: Method, mach: f64, effort: Effort) -> Result<Vec<Check>, StudyError> {
    let mut scene = scene_of("jet", include_str!("../../../scenes/tank.toml"))?;
    scene.model.method = Some(method);
    scene.model.particles = Some(match effort {
        Effort::Quick => 1000,
        Effort::Usual => 2000,
        Effort::Full => 30_000,
    });
    // Moles per particle follow from the gas that is in at the end of the run.
    scene.end_time = 0.004;
    scene.output.rows = 10;
    scene.output.snapshots = 0;
    for orifice in &mut scene.orifices {
        orifice.jet = Some(Jet { speed: JetSpeed::Mach(mach), cone_angle: CONE });
    }
    let model = model_from("jet", scene)?;
    let run = run(device, &model, Options::default())?;
    let brought = enthalpy(&model) * run.outcome.audit.mass_injected;
    let mut checks = of_any(&model, &run);
    checks.retain(|check| check.quantity != "energy");
    checks.insert(0, Check::of("energy", 0.0, (energy_error(&run, brought), 0.0), 1e-4));
    Ok(checks)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sod's densities run from .125 to 1; against cold gas of the same density a shock piles up several times it.
    #[test]
    fn the_range_is_that_of_the_exact_solution() {
        assert!((range(&SOD) - 0.875).abs() < 1e-3);
        let strong = range(&Tube { right: [0.01, 0.01], ..SOD });
        assert!((3.0..6.0).contains(&strong), "{strong}");
    }
}
