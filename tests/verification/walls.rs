//! Law: a wall that takes heat by a coefficient h cools the gas as dT/dt = -(T - T_w)/tau, tau = n cv / (h A); a gas
//! within walls of its own temperature keeps it, its pressure n R T / V and its equipartition (method.md, "Walls"
//! "Rigid wall").
//!
//! Statistics: a share alpha of the hits is exchanged, N alpha cbar A t / (4 V) of them until t; each changes the energy
//! by kT sqrt(2 (2 + zeta/2)) at random. At equilibrium the energy of N particles fluctuates by
//! kT sqrt(N (3 + zeta)/2) about the mean, independently every 4V/(A cbar) or so.

use corpuscle::output::AuditLimits;
use corpuscle::simulation::Options;
use corpuscle::study::verify::gas_box::GAS_CONSTANT;
use corpuscle::study::verify::losses::{COLD, TAU, WARM, cooled, heat_loss, model_within_walls, within_walls};
use corpuscle::study::verify::run;

use crate::statistics::mean_of_series;
use crate::whole_run::device;

/// Nitrogen at 1 bar from 600 K towards 300 K within one time constant.
#[test]
fn heat_transfer_cools_a_gas_exponentially() {
    let ((end, error), run) = heat_loss(&device(), 4000).expect("a run");
    assert_eq!(run.outcome.audit.verdict(&AuditLimits::default()), Vec::<String>::new());
    println!("{end:.2} K, {:.2} K expected, +- {error:.2} K", cooled(TAU));
    assert!((end - cooled(TAU)).abs() < 3.0 * error, "{end} {}", cooled(TAU));
    // The check can fail: a coefficient a fifth larger would be seen.
    let more = COLD + (WARM - COLD) * (-1.2f64).exp();
    assert!((more - cooled(TAU)).abs() > 3.0 * error);
}

/// The last step is tallied, whatever its number, so that the history ends with the run.
#[test]
fn the_last_row_ends_with_the_run() {
    let model = model_within_walls(1000, 3.09e-4, 600.0, "accommodation = 1.0").expect("a model");
    let run = run(&device(), &model, Options::default()).expect("a run");
    assert!(!run.outcome.steps.is_multiple_of(model.plan.tally_every.into()), "{} steps", run.outcome.steps);
    let end = run.rows.last().map_or(0.0, |row| row.window[1]);
    assert!((end / model.plan.end_time - 1.0).abs() < 1e-9, "{end}");
    let told = run.rows.last().map(|row| row.walls[0].heat);
    assert!(told.is_some_and(|heat| heat > 0.0));
    assert_eq!(run.outcome.audit.heat_to_walls, told);
}

#[test]
fn a_gas_within_walls_of_its_temperature_stays_as_it_is() {
    let particles = 3000;
    let run = within_walls(&device(), particles, 3e-3, 300.0, "accommodation = 1.0").expect("a run");
    assert_eq!(run.outcome.audit.verdict(&AuditLimits::default()), Vec::<String>::new());
    let number = particles as f64;
    let temperatures: Vec<f64> = run.rows.iter().map(|row| row.chambers[0].temperature / 300.0).collect();
    let pressures: Vec<f64> = run.rows.iter().map(|row| row.surfaces[0].pressure / 1e5).collect();
    for (what, values) in [("temperature", &temperatures), ("pressure", &pressures)] {
        let (mean, error) = mean_of_series(&values[6..], 9);
        println!("{what} {mean:.4} +- {error:.4}");
        assert!((mean - 1.0).abs() < 4.5 * error && error < 0.01, "{what} {mean} +- {error}");
    }
    // Independent states: one in 4V/(A cbar) = .14 ms. A row has a third of that.
    let (mean, _) = mean_of_series(&temperatures, 5);
    assert!((mean - 1.05).abs() > 0.03, "the check can fail: 5 % would be seen");
    let outcome = &run.outcome;
    let energy = outcome.audit.energy_end / outcome.audit.energy_start;
    assert!((energy - 1.0).abs() < 4.5 * (2.5 * number).sqrt() / (2.5 * number), "{energy}");
    assert!(energy != 1.0, "the walls exchange nothing");
    // Equipartition of spin, at the end: zeta/2 kT each, with the variance of an exponential.
    let thermal = GAS_CONSTANT * 300.0 / 0.028;
    let spin = outcome.particles.iter().map(|p| f64::from(p.spin)).sum::<f64>() / number / thermal;
    assert!((spin - 1.0).abs() < 4.5 / number.sqrt(), "{spin}");
}
