//! Discharge through a resolved hole (`study/verify/holes.rs`): how well it is resolved.

use crate::gas::CONTINUUM_COEFFICIENT;
use crate::scene::Method;
use crate::study::StudyError;
use crate::study::verify::holes::{RADIUS, VOLUME, discharge_of, emptying_scene};

use super::{Extent, Norm, Range, Trials, model_with};

/// Rows that a discharge needs: two of the start, and a window.
const LEAST_ROWS: usize = 4;

const QUICK: &[Range<'static>] = &[
    Range::new(Method::ClosestApproach, &[2000], &[0.12], &[0.3], &[8]),
    Range::new(Method::Cell, &[2000], &[0.12], &[], &[]),
    Range::new(Method::HalfTurn, &[2000], &[], &[], &[]),
    Range::new(Method::HardSphere, &[2000], &[0.03], &[0.3], &[2]),
    Range::new(Method::None, &[2000], &[], &[], &[]),
];
const NORMAL: &[Range<'static>] = &[
    Range::new(Method::ClosestApproach, &[4000, 16_000, 64_000], &[0.05, 0.12, 0.3], &[0.1, 0.3, 0.6], &[1, 8]),
    Range::new(Method::Cell, &[4000, 16_000, 64_000], &[0.05, 0.12, 0.3], &[0.3, 1.0, 2.0], &[]),
    Range::new(Method::HalfTurn, &[4000, 16_000, 64_000], &[], &[], &[]),
    Range::new(Method::HardSphere, &[4000, 16_000, 64_000], &[0.01, 0.03, 0.1], &[0.3], &[8]),
    Range::new(Method::None, &[4000, 16_000, 64_000], &[], &[], &[]),
];
const FULL: &[Range<'static>] = &[
    Range::new(
        Method::ClosestApproach,
        &[16_000, 64_000, 256_000, 1_024_000],
        &[0.05, 0.12, 0.3],
        &[0.1, 0.3, 0.6],
        &[1, 2, 4, 8],
    ),
    Range::new(Method::Cell, &[16_000, 64_000, 256_000, 1_024_000], &[0.05, 0.12, 0.3], &[0.3, 1.0, 2.0], &[]),
    Range::new(Method::HalfTurn, &[16_000, 64_000, 256_000, 1_024_000], &[], &[], &[]),
    Range::new(Method::HardSphere, &[16_000, 64_000, 256_000], &[0.01, 0.03, 0.1], &[0.1, 0.3], &[2, 8]),
    Range::new(Method::None, &[16_000, 64_000, 256_000, 1_024_000], &[], &[], &[]),
];

pub fn trials(extent: Extent) -> Result<Trials, StudyError> {
    let settings = extent.settings([QUICK, NORMAL, FULL]);
    let scene = emptying_scene()?;
    Ok(Trials {
        about: format!(
            "Gas leaves a chamber of {:.3} L through a square hole of {:.0} mm into near-vacuum for {:.1} ms. The error is \
             |Cd / {CONTINUUM_COEFFICIENT} - 1|, Cd the mean flow over the choked isentropic one. The reference is that of a \
             thin orifice in a continuum, a figure of the literature (docs/explanation/method.md, Openings) that is itself \
             good to some 2 %, as is the gas of so small a chamber: smaller errors say nothing. What is seen is how far a \
             mean free path that is not small against the hole keeps the flow from that of a continuum. Occupancy and x are \
             those of the chamber at the start.",
            1e3 * VOLUME,
            2e3 * RADIUS,
            1e3 * scene.end_time
        ),
        error: format!("|Cd / {CONTINUUM_COEFFICIENT} - 1|"),
        most_particles: settings.iter().filter_map(|setting| setting.particles).max().unwrap_or(0),
        settings,
        volume: Some(VOLUME),
        model: Box::new(move |setting, seed| {
            let mut scene = scene.clone();
            scene.seed += seed;
            model_with("orifice", scene, setting, Some(VOLUME))
        }),
        judge: Box::new(|_, run| {
            // An interval of long steps may be longer than a row should be.
            let enough = run.rows.len() >= LEAST_ROWS;
            enough.then(|| vec![discharge_of(&run.rows).0 / CONTINUUM_COEFFICIENT - 1.0])
        }),
        norm: Norm::Mean,
    })
}
