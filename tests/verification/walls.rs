//! Law: a wall that takes heat by a coefficient h cools the gas as dT/dt = -(T - T_w)/tau, tau = n cv / (h A); a gas
//! within walls of its own temperature keeps it, its pressure n R T / V and its equipartition (specification, section 4
//! "Rigid wall").
//!
//! Statistics: a share alpha of the hits is exchanged, N alpha cbar A t / (4 V) of them until t; each changes the energy
//! by kT sqrt(2 (2 + zeta/2)) at random. At equilibrium the energy of N particles fluctuates by
//! kT sqrt(N (3 + zeta)/2) about the mean, independently every 4V/(A cbar) or so.

use corpuscle::output::AuditLimits;
use corpuscle::simulation::Options;

use crate::statistics::mean_of_series;
use crate::whole_run::{Run, model, run};

const GAS_CONSTANT: f64 = 8.314462618;
const EDGE: f64 = 0.1;

fn boxed(particles: u64, end_time: f64, temperature: f64, wall: &str) -> Run {
    let text = format!(
        "end_time = {end_time:e}\nseed = 3\n[[gas]]\nname = \"nitrogen\"\nmolar_mass = 0.028\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [{EDGE}, {EDGE}, {EDGE}]\n\
         gas = \"inside\"\ntemperature = 300.0\n{wall}\n\
         [[chamber]]\nname = \"all\"\npressure = 100000.0\ntemperature = {temperature}\ngas = \"nitrogen\"\n\
         [[surface]]\nname = \"walls\"\nwall = \"box\"\n\
         [model]\nparticles = {particles}\noccupancy = 0.1\ntime_step = 3e-6\n[output]\nrows = 60\nsnapshots = 0\n"
    );
    let run = run(&model(&text), Options::default());
    assert_eq!(run.outcome.audit.verdict(&AuditLimits::default()), Vec::<String>::new());
    run
}

/// Nitrogen at 1 bar from 600 K towards 300 K within one time constant.
#[test]
fn heat_transfer_cools_a_gas_exponentially() {
    let (start, wall) = (600.0, 300.0);
    let moles = 1e5 * EDGE.powi(3) / (GAS_CONSTANT * start);
    let area = 6.0 * EDGE * EDGE;
    let tau = 2.5e-3;
    let coefficient = moles * 2.5 * GAS_CONSTANT / (area * tau);
    let particles = 4000;
    let run = boxed(particles, tau, start, &format!("heat_transfer = {coefficient:e}"));
    let expected = |time: f64| wall + (start - wall) * (-time / tau).exp();
    let last = run.rows.last().expect("a row");
    // All energy that is gone, as a temperature: finer than the translational temperature of a row.
    let end = start - last.walls[0].heat / (moles * 2.5 * GAS_CONSTANT);
    let mean = 450.0;
    let speed = (8.0 * GAS_CONSTANT * mean / (std::f64::consts::PI * 0.028f64)).sqrt();
    // h = alpha c cbar R 3/4.
    let alpha = coefficient / (moles / EDGE.powi(3) * speed * GAS_CONSTANT * 0.75);
    let exchanged = particles as f64 * alpha * speed * area / (4.0 * EDGE.powi(3)) * tau;
    let error = mean * (exchanged * 6.0).sqrt() / (particles as f64 * 2.5);
    println!(
        "alpha {alpha:.4}, {exchanged:.0} exchanges: {end:.2} K, {:.2} K expected, +- {error:.2} K",
        expected(tau)
    );
    assert!((end - expected(tau)).abs() < 3.0 * error, "{end} {}", expected(tau));
    // The check can fail: a coefficient a fifth larger would be seen.
    let more = wall + (start - wall) * (-1.2f64).exp();
    assert!((more - expected(tau)).abs() > 3.0 * error);
    // The heat is that of the audit.
    assert_eq!(run.outcome.audit.heat_to_walls, Some(last.walls[0].heat));
}

#[test]
fn a_gas_within_walls_of_its_temperature_stays_as_it_is() {
    let particles = 3000;
    let run = boxed(particles, 3e-3, 300.0, "accommodation = 1.0");
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
