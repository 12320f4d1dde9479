//! Events that mutual choice in few rounds loses (specification, section 2).

use super::figure;
use crate::gpu::Device;
use crate::study::StudyError;
use crate::study::verify::collisions::collision_rate;
use crate::study::verify::equilibrium::{mixture_of, ratios};
use crate::study::verify::gas_box::EquilibriumBox;
use crate::study::verify::{Effort, Findings};

/// x, and the rate over theory with one to four rounds; good to .01.
const TABLE: [(f64, [f64; 4]); 5] = [
    (0.05, [0.945, 0.998, 0.994, 0.999]),
    (0.1, [0.884, 0.982, 1.004, 1.003]),
    (0.2, [0.814, 0.947, 0.982, 0.994]),
    (0.5, [0.648, 0.855, 0.935, 0.970]),
    (1.0, [0.462, 0.712, 0.846, 0.914]),
];
const KNOWN: f64 = 0.01;
/// x, T_int/T_tr and T(m=1)/T(m=7) with one round.
const TEMPERATURES: [(f64, [f64; 2]); 2] = [(0.2, [0.985, 1.02]), (1.0, [0.946, 1.05])];

/// Counted in the core of a box of walls, where the specification has no walls. C collisions know a rate to 1/sqrt(C): the
/// core has half of the 8000 particles.
pub fn collisions(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let rows = if effort == Effort::Quick { 2..3 } else { 0..TABLE.len() };
    let mut findings = Findings::default();
    for (step_over_tau, expected) in &TABLE[rows] {
        for (rounds, expected) in (1..).zip(*expected) {
            let steps = (50.0 / (step_over_tau * expected)) as u32;
            let step_over_tau = *step_over_tau;
            let gas = EquilibriumBox { particles: 8000, rounds, step_over_tau, steps, ..EquilibriumBox::default() };
            let rate = collision_rate(device, &gas)?;
            let quantity = format!("closest-approach: R = {rounds}, x = {step_over_tau}");
            findings.checks.push(figure(quantity, expected, (rate.core, rate.error), KNOWN));
        }
    }
    for (step_over_tau, expected) in TEMPERATURES {
        // Walls, behind which pairs do not meet in the step, part temperatures too: so many particles that few meet one.
        let steps = if effort == Effort::Quick { 200.0 } else { 400.0 } / step_over_tau;
        let run = mixture_of(device, "closest-approach", 16_000, 1, step_over_tau, steps as u32)?;
        let names = ["T_int/T_tr", "T1/T2, masses 1:7"];
        for ((name, expected), found) in names.into_iter().zip(expected).zip(ratios(&run)) {
            let quantity = format!("closest-approach: {name}, R = 1, x = {step_over_tau}");
            findings.checks.push(figure(quantity, expected, found, KNOWN));
        }
    }
    Ok(findings)
}
