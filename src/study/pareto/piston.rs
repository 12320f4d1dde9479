//! A piston that drives a shock (`study/verify/piston.rs`) against Rankine and Hugoniot.

use crate::scene::Method;
use crate::study::StudyError;
use crate::study::verify::piston::{Piston, on_piston, shock_pressure};

use super::{Extent, Norm, Range, Trials, model_with};

/// Of the piston, in c0.
const SPEED: f64 = 0.5;

const QUICK: &[Range<'static>] = &[
    Range::new(Method::ClosestApproach, &[2000], &[0.12], &[0.3], &[1, 8]),
    Range::new(Method::HardSphere, &[2000], &[0.03], &[0.3], &[2]),
    Range::new(Method::Cell, &[2000], &[0.12], &[], &[]),
    Range::new(Method::HalfTurn, &[2000], &[], &[], &[]),
    Range::new(Method::None, &[2000], &[], &[], &[]),
];
const NORMAL: &[Range<'static>] = &[
    Range::new(Method::ClosestApproach, &[2500, 10_000, 40_000], &[0.05, 0.12, 0.3], &[0.3, 0.6], &[1, 8]),
    Range::new(Method::HardSphere, &[2500, 10_000, 40_000], &[0.01, 0.03, 0.1], &[0.3], &[8]),
    Range::new(Method::Cell, &[2500, 10_000, 40_000], &[0.05, 0.12, 0.3], &[0.3, 1.0], &[]),
    Range::new(Method::HalfTurn, &[2500, 10_000, 40_000], &[], &[], &[]),
    Range::new(Method::None, &[2500, 10_000, 40_000], &[], &[], &[]),
];
const FULL: &[Range<'static>] = &[
    Range::new(
        Method::ClosestApproach,
        &[10_000, 40_000, 160_000, 640_000],
        &[0.05, 0.12, 0.3],
        &[0.1, 0.3, 0.6],
        &[1, 2, 8],
    ),
    Range::new(Method::HardSphere, &[10_000, 40_000, 160_000], &[0.01, 0.03, 0.1], &[0.3], &[8]),
    Range::new(Method::Cell, &[10_000, 40_000, 160_000, 640_000], &[0.05, 0.12, 0.3], &[0.3, 1.0, 2.0], &[]),
    Range::new(Method::HalfTurn, &[10_000, 40_000, 160_000, 640_000], &[], &[], &[]),
    Range::new(Method::None, &[10_000, 40_000, 160_000, 640_000], &[], &[], &[]),
];

pub fn trials(extent: Extent) -> Result<Trials, StudyError> {
    let settings = extent.settings([QUICK, NORMAL, FULL]);
    let of = |particles: u64| Piston::shock(particles, SPEED);
    let scene = of(2000).scene()?;
    Ok(Trials {
        about: format!(
            "A piston starts at once with {SPEED} c0 (c0 = sqrt(kT/m)) into gas at rest, gamma 7/5, and stops before the shock \
             comes back. The error is |p/p2 - 1|, p the mean pressure on it (its work over the volume that it swept) and p2 that \
             behind the shock by Rankine and Hugoniot. Noise of the hits is in it."
        ),
        error: "|p/p2 - 1|".into(),
        most_particles: settings.iter().filter_map(|setting| setting.particles).max().unwrap_or(0),
        settings,
        volume: None,
        model: Box::new(move |setting, seed| {
            let mut scene = scene.clone();
            scene.seed += seed;
            model_with("piston", scene, setting, None)
        }),
        judge: Box::new(move |model, run| {
            let (pressure, _) = on_piston(&of(model.plan.particles), run);
            Some(vec![pressure / shock_pressure(SPEED) - 1.0])
        }),
        norm: Norm::Mean,
    })
}
