//! Laws of a heat capacity cp = a + b T + c T^2 (method.md, "Heat capacities"): in equilibrium the spin energy has
//! the mean u(T) - 3/2 R T and the variance T^2 (cv - 3/2 R) of the curve at every temperature, from whatever start; a
//! closed tank that is filled has U = U0 + integral h dm within 1e-4, with h the integral of cp, and comes to the
//! temperature that the integral of cv asks for.
//!
//! Here the curves are integrated in closed form, without the solver's partition function.

use corpuscle::output::AuditLimits;
use corpuscle::simulation::Options;
use corpuscle::study::verify::curve::{Balance, CP, END, INFLOW, MOLAR_MASS, balance, cp, enthalpy_gain, tank};
use corpuscle::subdomain::{GpuParticle, Scales};

use crate::equilibrium_box::{EquilibriumBox, GAS_CONSTANT as R, TEMPERATURE};
use crate::statistics::mean_of_series;
use crate::whole_run::{Run, model, run};

/// Mean spin energy and its mean square over R and R^2, K and K2, from particles of one gas.
fn spin_moments(particles: &[GpuParticle], kelvin: f64) -> [f64; 2] {
    let sum = |power: i32| particles.iter().map(|p| (f64::from(p.spin) * kelvin).powi(power)).sum::<f64>();
    [sum(1), sum(2)].map(|sum| sum / particles.len() as f64)
}

/// A box at a temperature, from a start with a third of the spin energy moved to translation. Of each snapshot the mean
/// and mean square of the spin energy over R, and what translation says the temperature is.
fn box_at(method: &str, temperature: f64) -> (Run, Vec<[f64; 3]>, f64) {
    let gas = format!("[[gas]]\nname = \"curved\"\nmolar_mass = 0.044\ncp = {CP:?}\n");
    let steps = 1200;
    let step = if method == "half-turn" { 0.6 } else { 0.15 };
    let gas_box = EquilibriumBox {
        method,
        particles: 4000,
        rounds: 8,
        step_over_tau: step * (TEMPERATURE / temperature).sqrt(),
        steps,
        molar_mass: 0.044,
        gases: &gas,
        mixture: "\"curved\"",
        snapshots: 60,
        ..EquilibriumBox::default()
    };
    let text = gas_box.toml().replace("temperature = 300\n", &format!("temperature = {temperature}\n"));
    assert!(text.contains(&format!("temperature = {temperature}\n")));
    let mut model = model(&text);
    model.plan.steps_per_interval = 20;
    model.plan.collision_limit = 1.0;
    let kelvin = Scales::new(&model.plan).reference_mass / (model.plan.moles_per_particle * R);
    let unequal = |particles: &mut [GpuParticle]| {
        let kinetic = |p: &GpuParticle| 0.5 * p.velocity.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>();
        let translation: f64 = particles.iter().map(kinetic).sum();
        let spin: f64 = particles.iter().map(|p| f64::from(p.spin)).sum();
        let faster = (1.0 + spin / 3.0 / translation).sqrt() as f32;
        for particle in particles {
            particle.velocity = particle.velocity.map(|v| faster * v);
            particle.spin *= 2.0 / 3.0;
        }
    };
    let run = run(&model, Options { shuffle: Some(&unequal), ..Options::default() });
    let states = run.snapshots.iter().map(|(_, particles)| {
        let [mean, square] = spin_moments(particles, kelvin);
        let kinetic = particles.iter().map(|p| 0.5 * p.velocity.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>());
        [mean, square, 2.0 / 3.0 * kinetic.sum::<f64>() * kelvin / particles.len() as f64]
    });
    let states = states.collect();
    // What a curve leaves open, the energy at one temperature, is the model's own.
    let own = &model.plan.gases[0].species;
    (run, states, own.energy(1.0, temperature) / R - 1.5 * temperature)
}

#[test]
fn spin_comes_to_the_energy_of_the_curve_at_every_temperature() {
    let ways = [("closest-approach", 300.0), ("closest-approach", 900.0), ("half-turn", 300.0), ("half-turn", 900.0)];
    for (method, temperature) in ways {
        let (run, states, internal) = box_at(method, temperature);
        let internal_cv = cp(temperature) / R - 2.5;
        assert!(states[0][0] < 0.7 * internal && states[0][2] > 1.15 * temperature, "an unequal start");
        let late = &states[states.len() / 3..];
        let column = |k: usize| late.iter().map(|state| state[k]).collect::<Vec<f64>>();
        let [mean, square, translation] = [0, 1, 2].map(|k| mean_of_series(&column(k), 10));
        println!(
            "{method}, {temperature} K: spin {:.2} +- {:.2} K of {:.2}, square {:.4e} +- {:.1e} of {:.4e}, T {:.2} +- {:.2}",
            mean.0,
            mean.1,
            internal,
            square.0,
            square.1,
            internal.powi(2) + internal_cv * temperature.powi(2),
            translation.0,
            translation.1
        );
        let near = |(found, error): (f64, f64), expected: f64| {
            error < 0.005 * expected && (found - expected).abs() < 4.5 * error
        };
        assert!(near(mean, internal), "{mean:?}");
        assert!(near(translation, temperature), "{translation:?}");
        let second = internal.powi(2) + internal_cv * temperature.powi(2);
        assert!((square.0 - second).abs() < 4.5 * square.1, "{square:?} {second}");
        // The checks can fail: a constant heat capacity of the same cv has another energy, and other degrees of freedom
        // another square.
        assert!(!near(mean, internal_cv * temperature));
        let constant = internal.powi(2) + internal * temperature;
        assert!((square.0 - constant).abs() > 4.5 * square.1);
        assert!(run.outcome.audit.verdict(&AuditLimits::default()).is_empty());
    }
}

#[test]
fn a_tank_filled_with_such_a_gas_has_its_enthalpy_and_its_temperature() {
    let model = tank(2500).expect("a plan");
    let run = run(&model, Options::default());
    let audit = &run.outcome.audit;
    assert!(audit.verdict(&AuditLimits::default()).is_empty());
    let at_start = model.plan.gases[0].species.energy(1.0, 300.0) * audit.mass_start / MOLAR_MASS;
    assert!((audit.energy_start / at_start - 1.0).abs() < 1e-6, "{} {at_start}", audit.energy_start);
    let Balance { energy_error, temperature, found: (found, noise) } = balance(&model, &run);
    assert!(energy_error.abs() < 1e-4, "{energy_error:.2e}");
    let volume = corpuscle::simulation::reference(&model, &[END])[0][0].temperature;
    assert!((volume / temperature - 1.0).abs() < 1e-3, "control volume {volume} K, curve {temperature} K");
    println!("T {found:.2} +- {noise:.2} K, curve {temperature:.2} K, control volume {volume:.2} K");
    assert!(noise < 0.005 * temperature && (found - temperature).abs() < 4.5 * noise, "{found} {temperature}");
    // The check can fail: with the heat capacity of 800 K the gas would be colder by 30 K.
    let [n0, n1] = [audit.mass_start, audit.mass_injected].map(|mass| mass / MOLAR_MASS);
    let constant = (n0 * 300.0 + n1 * INFLOW * cp(INFLOW) / (cp(INFLOW) - R)) / (n0 + n1);
    assert!((found - constant).abs() > 4.5 * noise, "{constant}");
}

/// What leaves a wall that exchanges all hits has the internal energy of the curve at its temperature: mean u and variance
/// T^2 (cv - 3/2 R). In free flight within such walls all gas has it soon, from whatever start.
#[test]
fn walls_emit_the_energy_of_the_curve_at_their_temperature() {
    let (wall, particles) = (800.0, 20_000);
    let text = format!(
        "end_time = 4e-3\n[[gas]]\nname = \"curved\"\nmolar_mass = {MOLAR_MASS}\ncp = {CP:?}\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
         temperature = {wall}\naccommodation = 1.0\n\
         [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\ngas = \"curved\"\n\
         [model]\nmethod = \"none\"\nparticles = {particles}\n[output]\nrows = 4\nsnapshots = 0\n"
    );
    let model = model(&text);
    let run = run(&model, Options::default());
    let kelvin = Scales::new(&model.plan).reference_mass / (model.plan.moles_per_particle * R);
    let [mean, square] = spin_moments(&run.outcome.particles, kelvin);
    let own = &model.plan.gases[0].species;
    let internal = |t: f64| own.energy(1.0, t) / R - 1.5 * t;
    let variance = wall * wall * (cp(wall) / R - 2.5);
    let error = (variance / particles as f64).sqrt();
    println!(
        "spin {mean:.1} +- {error:.1} K of {:.1}, variance {:.4e} of {variance:.4e}",
        internal(wall),
        square - mean * mean
    );
    // 4 ms are some twenty crossings of the box.
    assert!((mean - internal(wall)).abs() < 4.5 * error, "{mean} {}", internal(wall));
    // Of a gamma variate of shape s the variance errs by sqrt((2 + 6/s)/N); of a mixture somewhat more.
    assert!(((square - mean * mean) / variance - 1.0).abs() < 4.5 * (4.0 / particles as f64).sqrt());
    // The checks can fail: a constant heat capacity of the same cv would have another mean and variance.
    let constant = (cp(wall) / R - 2.5) * wall;
    assert!((constant - internal(wall)).abs() > 9.0 * error);
    let audit = &run.outcome.audit;
    assert_eq!(audit.verdict(&AuditLimits::default()), Vec::<String>::new());
    // The heat that came in is that of the curve between the two temperatures.
    let heat = audit.mass_start / MOLAR_MASS * (enthalpy_gain(300.0, wall) - R * (wall - 300.0));
    let noise = (variance + 1.5 * wall * wall).sqrt() * R * audit.mass_start / MOLAR_MASS / (particles as f64).sqrt();
    let taken = -audit.heat_to_walls.expect("heat");
    assert!((taken - heat).abs() < 4.5 * noise + 1e-4 * heat, "{taken} {heat} +- {noise}");
}
