//! Rigid spheres: their pressure on walls and the speed of their sound.

use super::figure::figure;
use crate::gas::kinetics;
use crate::gpu::Device;
use crate::scene::Method;
use crate::study::StudyError;
use crate::study::pareto::Setting;
use crate::study::verify::collisions::rigid_pressure_ratio;
use crate::study::verify::sound::wave;
use crate::study::verify::{Check, Effort, Findings};

/// Occupancy, steps, and the pressure over n k T (docs/explanation/method.md, "Collisions"; x = .1, R = 2, N = 8000).
const PRESSURES: [(f64, u32, f64); 3] = [(0.03, 960, 1.124), (0.2, 1280, 2.248), (0.3, 1280, 3.458)];
/// What is taken for the table's own error, as in the case `wall-pressure`.
const KNOWN: f64 = 0.02;
/// Of the sound.
const OCCUPANCY: f64 = 0.1;

/// Speed of sound of rigid spheres with two degrees of freedom of spin over that of the ideal gas.
///
/// With Z(f) = p/(n k T) and cv = 5/2 k, which density does not change: (m/kT) dp/drho at constant entropy is
/// d(f Z)/df + Z^2/(cv/k), against gamma of the ideal gas.
fn faster(occupancy: f64) -> f64 {
    let z = kinetics::rigid_compressibility;
    let h = 1e-5;
    let slope = ((occupancy + h) * z(occupancy + h) - (occupancy - h) * z(occupancy - h)) / (2.0 * h);
    ((slope + z(occupancy).powi(2) / 2.5) / 1.4).sqrt()
}

pub fn spheres(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let mut findings = Findings::default();
    let count = if effort == Effort::Quick { 1 } else { PRESSURES.len() };
    for (occupancy, steps, expected) in &PRESSURES[..count] {
        let (found, _) = rigid_pressure_ratio(device, *occupancy, *steps)?;
        let quantity = format!("hard-sphere: p/nkT, f = {occupancy}");
        findings.checks.push(figure(quantity, *expected, found, KNOWN * expected));
    }
    let particles = 24_000;
    let setting = Setting {
        method: Some(Method::HardSphere),
        particles: Some(particles),
        occupancy: Some(OCCUPANCY),
        // Of rigid spheres, which collide more often than tau says.
        step: Some(0.1),
        rounds: Some(4),
    };
    let expected = faster(OCCUPANCY);
    let (found, error) = wave(device, &setting, expected)?;
    let quantity = format!("hard-sphere: sound over sqrt(gamma kT/m), f = {OCCUPANCY} (prototype 1.15)");
    // As the case `sound` at this size: 3 % of the frequency.
    findings.checks.push(Check::of(quantity, expected, (found, error), 0.03 * expected));
    findings.notes.push(format!(
        "The prototype has the sound of `hard-sphere` 15 % too fast at f = .1. By its own pressures there rigid spheres have \
         (m/kT) dp/drho = d(f Z)/df + Z^2/(cv/k): sound is {:.0} % faster, and the run agrees",
        100.0 * (expected - 1.0)
    ));
    Ok(findings)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An ideal gas has its own speed; 15 % are those of f = .035.
    #[test]
    fn rigid_spheres_sound_faster() {
        assert!((faster(1e-4) - 1.0).abs() < 1e-3);
        assert!((faster(0.1) - 1.49).abs() < 0.01, "{}", faster(0.1));
        assert!((faster(0.035) - 1.15).abs() < 0.01, "{}", faster(0.035));
    }
}
