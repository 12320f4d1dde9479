//! Law, of the limit "wall hits per particle and step": what parts spin from translation in thin gas in a small box is
//! how often walls are hit in a step, not the occupancy or the step. Two boxes of the same occupancy and x = dt/tau, whose
//! particles are of other sizes, differ in nothing else; a pair does not meet after a wall in the same step.

use corpuscle::simulation::Options;
use corpuscle::study::verify::equilibrium::temperatures;
use corpuscle::study::verify::statistics::mean_of_series;

use crate::equilibrium_box::EquilibriumBox;
use crate::whole_run::run;

/// Hits per particle and step, and T_int/T_tr with its standard error, after the first quarter of the run.
fn found(particles: u64, steps: u32) -> (f64, (f64, f64)) {
    let gas = EquilibriumBox {
        particles,
        occupancy: 0.0025,
        step_over_tau: 0.2,
        rounds: 8,
        steps,
        snapshots: steps / 10,
        ..EquilibriumBox::default()
    };
    let run = run(&gas.model().expect("a box"), Options { hold_step: true, ..Options::default() });
    let late = &run.snapshots[run.snapshots.len() / 4..];
    let ratios: Vec<f64> = late
        .iter()
        .map(|(_, particles)| {
            let [translation, spin] = temperatures(particles, 0, 1.0);
            spin / translation
        })
        .collect();
    (run.outcome.bounces as f64 / run.outcome.particle_steps as f64, mean_of_series(&ratios, 12))
}

#[test]
#[ignore = "minutes: scripts/test.sh --long"]
fn hits_on_walls_part_spin_from_translation() {
    let (many, (broken, error)) = found(2000, 3000);
    let (few, (better, better_error)) = found(30_000, 900);
    println!(
        "{many:.3} hits a step: T_int/T_tr {broken:.4} +- {error:.4}; {few:.3}: {better:.4} +- {better_error:.4} \
         (in proportion {:.4})",
        1.0 - (1.0 - broken) * few / many
    );
    assert!((0.15..0.25).contains(&many) && (0.06..0.1).contains(&few), "{many} {few}");
    assert!(broken < 1.0 - 0.02 - 2.0 * error, "beyond the limit it breaks");
    assert!((better - 1.0).abs() < 0.02 + 2.0 * better_error, "within the limit it holds");
    let apart = better - broken;
    assert!(apart > 3.0 * error.hypot(better_error), "{apart}");
}
