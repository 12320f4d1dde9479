//! Sod's shock tube (`study/verify/tube.rs`) against the exact solution.

use crate::scene::Method;
use crate::study::StudyError;
use crate::study::verify::tube::SOD;

use super::{Extent, Range, Trials, model_with};

pub fn trials(extent: Extent) -> Result<Trials, StudyError> {
    let ranges: &[Range] = match extent {
        Extent::Quick => &[
            Range {
                method: Method::ClosestApproach,
                particles: &[1000, 4000],
                occupancies: &[0.12],
                steps: &[0.3],
                rounds: &[1, 8],
            },
            Range { method: Method::Cell, particles: &[1000, 4000], occupancies: &[0.12], steps: &[], rounds: &[] },
            Range { method: Method::HardSphere, particles: &[4000], occupancies: &[0.1], steps: &[0.3], rounds: &[2] },
            Range { method: Method::None, particles: &[4000], occupancies: &[], steps: &[], rounds: &[] },
        ],
        // The most particles only where the others say that it matters: they take most of the time.
        Extent::Normal => &[
            Range {
                method: Method::ClosestApproach,
                particles: &[2500, 10_000],
                occupancies: &[0.05, 0.12, 0.3],
                steps: &[0.1, 0.3, 0.6],
                rounds: &[1, 2, 8],
            },
            Range {
                method: Method::ClosestApproach,
                particles: &[40_000],
                occupancies: &[0.05, 0.12, 0.3],
                steps: &[0.3],
                rounds: &[2, 8],
            },
            Range {
                method: Method::Cell,
                particles: &[2500, 10_000],
                occupancies: &[0.05, 0.12, 0.3],
                steps: &[0.3, 1.0, 2.0],
                rounds: &[],
            },
            Range {
                method: Method::Cell,
                particles: &[40_000],
                occupancies: &[0.05, 0.12, 0.3],
                steps: &[0.3, 2.0],
                rounds: &[],
            },
            Range {
                method: Method::HardSphere,
                particles: &[2500, 10_000],
                occupancies: &[0.01, 0.03, 0.1],
                steps: &[0.1, 0.3],
                rounds: &[2, 8],
            },
            Range {
                method: Method::HardSphere,
                particles: &[40_000],
                occupancies: &[0.01, 0.03],
                steps: &[0.3],
                rounds: &[8],
            },
            Range {
                method: Method::None,
                particles: &[2500, 10_000, 40_000],
                occupancies: &[],
                steps: &[],
                rounds: &[],
            },
        ],
        Extent::Full => &[
            Range {
                method: Method::ClosestApproach,
                particles: &[10_000, 40_000, 160_000, 640_000],
                occupancies: &[0.05, 0.12, 0.3],
                steps: &[0.1, 0.3, 0.6],
                rounds: &[1, 2, 4, 8],
            },
            Range {
                method: Method::Cell,
                particles: &[10_000, 40_000, 160_000, 640_000, 2_560_000],
                occupancies: &[0.05, 0.12, 0.3],
                steps: &[0.3, 1.0, 2.0],
                rounds: &[],
            },
            Range {
                method: Method::HardSphere,
                particles: &[10_000, 40_000, 160_000],
                occupancies: &[0.01, 0.03, 0.1],
                steps: &[0.1, 0.3],
                rounds: &[2, 8],
            },
            Range {
                method: Method::None,
                particles: &[10_000, 40_000, 160_000, 640_000],
                occupancies: &[],
                steps: &[],
                rounds: &[],
            },
        ],
    };
    let settings: Vec<_> = ranges.iter().flat_map(Range::settings).collect();
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
        judge: Box::new(|model, run| SOD.errors(model, SOD.end, &run.outcome.particles).map(|[density, _]| density)),
    })
}
