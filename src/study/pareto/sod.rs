//! Sod's shock tube (`study/verify/tube.rs`) against the exact solution.

use crate::scene::Method;
use crate::study::StudyError;
use crate::study::verify::tube::{SOD, Slice};

use super::{Extent, Norm, Range, Trials, model_with};

const QUICK: &[Range<'static>] = &[
    Range::new(Method::ClosestApproach, &[1000, 4000], &[0.12], &[0.3], &[1, 8]),
    Range::new(Method::Cell, &[1000, 4000], &[0.12], &[], &[]),
    Range::new(Method::HalfTurn, &[1000, 4000], &[], &[], &[]),
    Range::new(Method::HardSphere, &[4000], &[0.1], &[0.3], &[2]),
    Range::new(Method::None, &[4000], &[], &[], &[]),
];
/// The most particles only where the others say that it matters: they take most of the time.
const NORMAL: &[Range<'static>] = &[
    Range::new(Method::ClosestApproach, &[2500, 10_000], &[0.05, 0.12, 0.3], &[0.1, 0.3, 0.6], &[1, 2, 8]),
    Range::new(Method::ClosestApproach, &[40_000], &[0.05, 0.12, 0.3], &[0.3], &[2, 8]),
    Range::new(Method::Cell, &[2500, 10_000], &[0.05, 0.12, 0.3], &[0.3, 1.0, 2.0], &[]),
    Range::new(Method::HalfTurn, &[2500, 10_000], &[], &[], &[]),
    Range::new(Method::Cell, &[40_000], &[0.05, 0.12, 0.3], &[0.3, 2.0], &[]),
    Range::new(Method::Cell, &[160_000], &[0.12, 0.3], &[1.0, 2.0], &[]),
    Range::new(Method::Cell, &[640_000], &[0.12], &[1.0], &[]),
    Range::new(Method::HalfTurn, &[20_000, 40_000, 160_000], &[], &[], &[]),
    Range::new(Method::HardSphere, &[2500, 10_000], &[0.01, 0.03, 0.1], &[0.1, 0.3], &[2, 8]),
    Range::new(Method::HardSphere, &[40_000], &[0.01, 0.03], &[0.3], &[8]),
    Range::new(Method::None, &[2500, 10_000, 40_000], &[], &[], &[]),
];
const FULL: &[Range<'static>] = &[
    Range::new(
        Method::ClosestApproach,
        &[10_000, 40_000, 160_000, 640_000],
        &[0.05, 0.12, 0.3],
        &[0.1, 0.3, 0.6],
        &[1, 2, 4, 8],
    ),
    Range::new(Method::Cell, &[10_000, 40_000, 160_000, 640_000, 2_560_000], &[0.05, 0.12, 0.3], &[0.3, 1.0, 2.0], &[]),
    Range::new(Method::HalfTurn, &[10_000, 40_000, 160_000, 640_000, 2_560_000], &[], &[], &[]),
    Range::new(Method::HardSphere, &[10_000, 40_000, 160_000], &[0.01, 0.03, 0.1], &[0.1, 0.3], &[2, 8]),
    Range::new(Method::None, &[10_000, 40_000, 160_000, 640_000], &[], &[], &[]),
];

pub fn trials(extent: Extent) -> Result<Trials, StudyError> {
    let settings = extent.settings([QUICK, NORMAL, FULL]);
    Ok(Trials {
        about: "Sod's shock tube, gamma 1.4, at t = 0.2 (in units of the tube's length and sqrt(p/rho) of the left). The error \
                is the mean over 50 slices of |density - exact|, the exact Riemann solution averaged over the slice, over \
                the density of the left; counting noise is in it."
            .into(),
        error: "mean |density - exact|".into(),
        most_particles: settings.iter().filter_map(|setting| setting.particles).max().unwrap_or(0),
        settings,
        volume: None,
        model: Box::new(|setting, seed| {
            let mut scene = SOD.scene()?;
            scene.seed += seed;
            model_with("tube", scene, setting, None)
        }),
        judge: Box::new(|model, run| {
            let slices = SOD.profile(model, SOD.end, &run.outcome.particles)?;
            Some(slices.iter().map(|Slice { density: [found, exact], .. }| found - exact).collect())
        }),
        norm: Norm::Mean,
    })
}
