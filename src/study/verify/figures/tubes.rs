//! The prototype's table of Sod's shock tube. Its f and x are those of the gas on the left: with those of the mean
//! state rigid spheres on the left would be 1.8 times as dense, and the table's errors of them half as large again.

use super::figure::figure;
use crate::gpu::Device;
use crate::scene::Method;
use crate::study::StudyError;
use crate::study::pareto::Setting;
use crate::study::verify::sod::profile;
use crate::study::verify::statistics::mean_and_error;
use crate::study::verify::tube::{LENGTH, SOD, Tube, counting_noise, mean_differences};
use crate::study::verify::{Effort, Findings};

/// Method, particles, f, x, R, and the mean |difference| of density and velocity.
type Row = (Method, u64, Option<f64>, Option<f64>, Option<u32>, [f64; 2]);

/// Those of at most 160,000 particles. Of closest approach with 10,000 and 40,000 they are means of 16 and of 2 single runs, all others single
/// runs. (A first one of 40,000 had .055, out of line with those of 10,000 and 160,000.)
const TABLE: [Row; 8] = [
    (Method::HardSphere, 40_000, Some(0.1), Some(0.3), Some(2), [0.0533, 0.191]),
    (Method::ClosestApproach, 10_000, Some(0.1), Some(0.3), Some(1), [0.0443, 0.104]),
    (Method::ClosestApproach, 40_000, Some(0.1), Some(0.3), Some(1), [0.0291, 0.068]),
    (Method::Cell, 160_000, Some(0.1), Some(2.0), None, [0.0232, 0.046]),
    (Method::Cell, 40_000, Some(0.1), Some(0.3), None, [0.0307, 0.068]),
    (Method::None, 160_000, None, None, None, [0.0589, 0.155]),
    (Method::ClosestApproach, 160_000, Some(0.1), Some(0.3), Some(1), [0.0218, 0.045]),
    (Method::ClosestApproach, 160_000, Some(0.3), Some(0.3), Some(1), [0.0166, 0.030]),
];

/// Runs whose scatter is known to a quarter; of fewer the error is that of counting noise.
const SCATTERED: u64 = 8;

/// What the table's figures are known to, besides counting noise.
const KNOWN: f64 = 0.05;

/// The prototype's are held as single runs, to 5 % and their counting noise. Ours are means of as many seeds as have `together` particles.
pub fn table(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let (count, together) = if effort == Effort::Quick { (4, 0) } else { (TABLE.len(), 320_000) };
    let mut findings = Findings::default();
    // All particles in as much room as makes them as dense as those of the left half, 8/9 of them.
    let left = 9.0 / 8.0 * 0.5 * LENGTH * SOD.width.powi(2);
    for &(method, particles, occupancy, step, rounds, expected) in &TABLE[..count] {
        let setting = Setting { method: Some(method), particles: Some(particles), occupancy, step, rounds };
        let seeds = (together / particles).max(1);
        let (mut runs, mut noise) = ([Vec::new(), Vec::new()], [0.0; 2]);
        for seed in SOD.seed..SOD.seed + seeds {
            let (_, profile) = profile(device, &Tube { particles, seed, ..SOD }, &setting, Some(left))?;
            let found = mean_differences(&profile);
            tracing::debug!("{setting}, seed {seed}: {found:?}");
            runs.iter_mut().zip(found).for_each(|(runs, found)| runs.push(found));
            noise = counting_noise(&profile).map(|(_, deviation)| deviation);
        }
        // Counting noise alone makes less of it than runs scatter where the difference is beyond the noise.
        let found = [0, 1].map(|k| {
            let (mean, scatter) = mean_and_error(&runs[k]);
            let counted = noise[k] / (seeds as f64).sqrt();
            (mean, if seeds >= SCATTERED { scatter.max(counted) } else { counted })
        });
        for (k, name) in ["rho", "u"].into_iter().enumerate() {
            let quantity = format!("{setting}: mean |{name} - exact|");
            let known = (KNOWN * expected[k]).hypot(3.0 * noise[k]);
            findings.checks.push(figure(quantity, expected[k], found[k], known));
        }
    }
    findings.notes.push(
        "In the prototype's table of Sod's tube f and x are those of the gas on the left. With those of the mean state \
         hard-sphere has .078 in the density, not .053, and the other methods less than the table"
            .into(),
    );
    Ok(findings)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of one gas the velocity's errors fall as a power of the particles, within what single runs are known to: a figure out of line is a
    /// wrong one.
    #[test]
    fn the_rows_of_one_gas_are_in_line() {
        let [few, some, many] = [1, 2, 6].map(|row| TABLE[row]);
        assert_eq!((4 * few.1, some.1), (some.1, many.1 / 4));
        for other in [few, many] {
            assert_eq!((other.0, other.2, other.3, other.4), (some.0, some.2, some.3, some.4));
        }
        let in_line = |figure: f64| (figure / (few.5[1] * many.5[1]).sqrt() - 1.0).abs() < 2.0 * KNOWN;
        assert!(in_line(some.5[1]) && !in_line(0.055));
    }
}
