//! Law: what leaves through a modelled vent takes the enthalpy of the gas inside with it, so that a vessel empties
//! isentropically: d lnT / d lnN = 2/(3 + zeta) = gamma - 1 (docs/explanation/method.md, "Vents and leaks",
//! and section 8: within .01 at beta <= .02 in units of the thermal speed). And the flow is that of Wang and Nefske: choked, T/T0 =
//! x^(gamma-1) of the part x of the mass that is left, dx/dt = -K x^((gamma+1)/2), x = (1 + (gamma-1)/2 K t)^(-2/(gamma-1)),
//! K = C23 A/V .6847 sqrt(R T0 / M).
//!
//! The runs, and what they tell, are those of `corpuscle verify leak`.

use corpuscle::output::AuditLimits;
use corpuscle::simulation::Options;
use corpuscle::study::verify::curve::CP;
use corpuscle::study::verify::gas_box::GAS_CONSTANT as R;
use corpuscle::study::verify::losses::{emptied, left as left_after, pores, rate, slope};

use crate::whole_run::{device, model, run};

#[test]
fn a_vessel_empties_isentropically() {
    let particles = 4000;
    let end_time = 0.7 / rate(pores());
    let run = emptied(&device(), particles, end_time, pores()).expect("a run");
    let audit = &run.outcome.audit;
    assert_eq!(audit.verdict(&AuditLimits::default()), Vec::<String>::new());
    assert_eq!(audit.particles_vented, audit.particles_initial - audit.particles_inside);
    let (found, error) = slope(&run);
    println!("d lnT / d lnN {found:.4} +- {error:.4}");
    assert!((found - 0.4).abs() < 4.5 * error, "{found} +- {error}");
    // The check can fail: a probability that does not depend on the speed has .2.
    assert!((0.2 - 0.4f64).abs() > 4.5 * error);
    let last = run.rows.last().expect("a row");
    let x = |time: f64| left_after(pores(), time);
    // Before 1/12 of the run has passed, little has left; then the mass follows within a few particles.
    let mass = run.outcome.audit.mass_start;
    let left = last.vents[0].mass / mass;
    println!("left {left:.4}, {:.4} expected", 1.0 - x(end_time));
    // A temperature that errs by 1 % shifts the flow by half of it; the flow in hand pays what it owes in 8 intervals.
    assert!((left - (1.0 - x(end_time))).abs() < 0.01, "{left} {}", 1.0 - x(end_time));
    let wanted: f64 = run.rows.iter().map(|row| row.vents[0].wanted_mass_flow * (row.window[1] - row.window[0])).sum();
    assert!((last.vents[0].mass / wanted - 1.0).abs() < 0.01, "{} {wanted}", last.vents[0].mass);
    let energy = last.vents[0].enthalpy / run.outcome.audit.enthalpy_vented;
    assert!((energy - 1.0).abs() < 1e-12);
    assert!(run.rows.iter().all(|row| (row.vents[0].wanted_discharge - pores()).abs() < 1e-9));
}

/// The reference case of docs/reference/accuracy.md, to its tolerance.
#[test]
#[ignore = "minutes on a software device: scripts/test.sh --long"]
fn a_vessel_empties_isentropically_within_a_hundredth() {
    let run = emptied(&device(), 100_000, 0.7 / rate(pores()), pores()).expect("a run");
    let (found, error) = slope(&run);
    println!("d lnT / d lnN {found:.4} +- {error:.4}");
    assert!(error < 0.01 / 2.5 && (found - 0.4).abs() < 0.01, "{found} +- {error}");
}

/// A vent on a disc, opened by the pressure of the gas that flows in, a leak on the rest, cold walls: the mass and the
/// pressure follow the control volume, and nothing is lost.
#[test]
fn filling_and_venting_follows_the_control_volume() {
    let model = crate::whole_run::published("vent.toml", 4000, 0.02);
    let run = run(&model, Options::default());
    assert_eq!(run.outcome.audit.verdict(&AuditLimits::default()), Vec::<String>::new());
    let last = run.rows.last().expect("a row");
    let reference = corpuscle::simulation::reference(&model, &[last.time]);
    let pressure = last.chambers[0].pressure / reference[0][0].pressure;
    let entered = model.plan.initial_particles + run.outcome.audit.particles_injected;
    let moles: f64 = reference[0][0].moles.iter().sum();
    let number = last.chambers[0].particles.iter().sum::<f64>() * model.plan.moles_per_particle / moles;
    println!("pressure {pressure:.4}, number {number:.4} of the control volume's; {:?}", last.vents);
    // Of some 5000 particles: the energy of what entered, left and was cooled errs by a per cent or two.
    assert!((pressure - 1.0).abs() < 0.04 && (number - 1.0).abs() < 0.02);
    assert!(run.rows[0].vents[0].mass_flow == 0.0 && last.vents[0].mass_flow > 0.0, "it opens on the way");
    assert!(last.vents[1].mass > 0.0 && last.walls[0].heat > 0.0);
    assert_eq!(run.outcome.particles.len() as u64, entered - run.outcome.audit.particles_vented);
    // The check can fail: without the vents there would be so much more.
    assert!(run.outcome.audit.particles_vented as f64 > 0.1 * entered as f64);
}

/// The same with a gas of cp(T): what is left has lost n cv dT = -dn R T, so ln(N/N0) is the integral of cv/(R T).
#[test]
fn a_gas_with_a_curve_empties_isentropically_too() {
    let (start, [a, b, c]) = (600.0, CP);
    let text = format!(
        "end_time = 4e-3\nseed = 4\n[[gas]]\nname = \"curved\"\nmolar_mass = 0.044\ncp = {CP:?}\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
         [[chamber]]\nname = \"all\"\npressure = 2e5\ntemperature = {start}\ngas = \"curved\"\n\
         [[vent]]\nname = \"pores\"\nwall = \"box\"\ndischarge = {:e}\nexternal_pressure = 0.0\n\
         [model]\nparticles = 4000\noccupancy = 0.1\n[output]\nrows = 4\nsnapshots = 0\n",
        pores()
    );
    let model = model(&text);
    let run = run(&model, Options::default());
    let audit = &run.outcome.audit;
    assert_eq!(audit.verdict(&AuditLimits::default()), Vec::<String>::new());
    let (before, after) = (audit.particles_initial as f64, audit.particles_inside as f64);
    let integral = |t: f64| (a - R) * t.ln() + b * t + 0.5 * c * t * t;
    let (mut low, mut high) = (0.3 * start, start);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if integral(start) - integral(middle) > R * (before / after).ln() { low = middle } else { high = middle }
    }
    // u = the integral of cv from 0 K, of which the model has its own below the curve's range.
    let gain = a * (low - start) + 0.5 * b * (low.powi(2) - start.powi(2)) + c / 3.0 * (low.powi(3) - start.powi(3));
    let per_mole = |energy: f64, count: f64| energy / (count * model.plan.moles_per_particle);
    let found = per_mole(audit.energy_end, after) - per_mole(audit.energy_start, before);
    let expected = gain - R * (low - start);
    // As of the constant gas, with a variance of some 5 (kT)^2 for each of those that left.
    let error = (5.0 * (before - after)).sqrt() * R * 0.5 * (start + low) / after;
    println!("{before} to {after}, {low:.1} K: {found:.1} +- {error:.1} J/mol of {expected:.1}");
    assert!((found - expected).abs() < 4.5 * error, "{found} {expected} +- {error}");
    // The check can fail: if each took only its share of the energy, nothing would change.
    assert!(expected.abs() > 9.0 * error);
}
