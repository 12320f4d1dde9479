//! Events that mutual choice in few rounds loses (docs/explanation/method.md, "Collisions").

use super::figure::figure;
use crate::gpu::Device;
use crate::study::StudyError;
use crate::study::verify::collisions::collision_rate_held;
use crate::study::verify::gas_box::EquilibriumBox;
use crate::study::verify::{Effort, Findings};

/// x, and the rate over theory with one to four rounds, as the prototype has it; good to .01.
const TABLE: [(f64, [f64; 4]); 5] = [
    (0.2, [0.814, 0.947, 0.982, 0.994]),
    (0.05, [0.945, 0.998, 0.994, 0.999]),
    (0.1, [0.884, 0.982, 1.004, 1.003]),
    (0.5, [0.648, 0.855, 0.935, 0.970]),
    (1.0, [0.462, 0.712, 0.846, 0.914]),
];
const KNOWN: f64 = 0.01;

/// Counted in the core of a box of walls, where the prototype has no walls. C collisions know a rate to 1/sqrt(C): the
/// core has half of the 8000 particles.
pub fn collisions(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let mut findings = Findings::default();
    let rows = if effort == Effort::Quick { 1 } else { TABLE.len() };
    for (step_over_tau, expected) in TABLE[..rows].iter().copied() {
        for (rounds, expected) in (1..).zip(expected) {
            let steps = (50.0 / (step_over_tau * expected)) as u32;
            let gas = EquilibriumBox { particles: 8000, rounds, step_over_tau, steps, ..EquilibriumBox::default() };
            let rate = collision_rate_held(device, &gas)?;
            let quantity = format!("closest-approach: R = {rounds}, x = {step_over_tau}");
            findings.checks.push(figure(quantity, expected, (rate.core, rate.error), KNOWN));
        }
    }
    Ok(findings)
}
