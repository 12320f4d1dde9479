//! The specification's table of Sod's shock tube, section 2. Its f and x are those of the gas on the left: with those of the mean
//! state rigid spheres on the left would be 1.8 times as dense, and the table's errors of them half as large again.

use super::figure;
use crate::gpu::Device;
use crate::scene::Method;
use crate::study::StudyError;
use crate::study::pareto::Setting;
use crate::study::verify::sod::profile;
use crate::study::verify::tube::{LENGTH, SOD, Tube, counting_noise, mean_differences};
use crate::study::verify::{Effort, Findings};

/// Method, particles, f, x, R, and the mean |difference| of density and velocity.
type Row = (Method, u64, Option<f64>, Option<f64>, Option<u32>, [f64; 2]);

/// Those of at most 160,000 particles.
const TABLE: [Row; 8] = [
    (Method::HardSphere, 40_000, Some(0.1), Some(0.3), Some(2), [0.0533, 0.191]),
    (Method::ClosestApproach, 10_000, Some(0.1), Some(0.3), Some(1), [0.0420, 0.087]),
    // The velocity is disputed.
    (Method::ClosestApproach, 40_000, Some(0.1), Some(0.3), Some(1), [0.0301, 0.055]),
    (Method::Cell, 160_000, Some(0.1), Some(2.0), None, [0.0232, 0.046]),
    (Method::Cell, 40_000, Some(0.1), Some(0.3), None, [0.0307, 0.068]),
    (Method::None, 160_000, None, None, None, [0.0589, 0.155]),
    (Method::ClosestApproach, 160_000, Some(0.1), Some(0.3), Some(1), [0.0218, 0.045]),
    (Method::ClosestApproach, 160_000, Some(0.3), Some(0.3), Some(1), [0.0166, 0.030]),
];

/// The row whose velocity is disputed: less than a quarter and four times the particles have between them.
const DISPUTED: usize = 2;

/// Single runs, to 5 %, whose counting noise is as much again as ours.
pub fn table(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let count = if effort == Effort::Quick { 4 } else { TABLE.len() };
    let mut findings = Findings::default();
    // All particles in as much room as makes them as dense as those of the left half, 8/9 of them.
    let left = 9.0 / 8.0 * 0.5 * LENGTH * SOD.width.powi(2);
    for (row, &(method, particles, occupancy, step, rounds, expected)) in TABLE[..count].iter().enumerate() {
        let setting = Setting { method: Some(method), particles: Some(particles), occupancy, step, rounds };
        let (_, profile) = profile(device, &Tube { particles, ..SOD }, &setting, Some(left))?;
        let (found, noise) = (mean_differences(&profile), counting_noise(&profile));
        for (k, name) in ["rho", "u"].into_iter().enumerate() {
            let quantity = format!("{setting}: mean |{name} - exact|");
            let known = (0.05 * expected[k]).hypot(3.0 * noise[k].1);
            let check = figure(quantity, expected[k], (found[k], noise[k].1), known);
            findings.checks.push(if (row, name) == (DISPUTED, "u") { check.disputed() } else { check });
        }
    }
    findings.notes.push(
        "The specification's table of Sod's tube is that of f and x of the gas on the left, which it does not say: with those of the mean \
         state hard-sphere has .078 in the density, not .053, and the other methods less than the table. The velocity's .055 of \
         closest-approach with 40,000 particles does not fit its neighbours, .087 of 10,000 and .045 of 160,000: the root of \
         their product is .063"
            .into(),
    );
    Ok(findings)
}
