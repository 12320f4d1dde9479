//! Laws: from any start the degrees of freedom come to one temperature, T_int = T_tr, T1 = T2 for masses
//! 1:7 (specification, section 8: within 1 % for R = 3, x <= .2); and T_tr - T_int decays as
//! exp(-(1 + zeta/3) s / Z), s the collisions per particle (section 3: measured Z within 5 %).
//!
//! Pressure and energy checks never see a breach of these: with R = 1 the energies stay 1.5 % apart at
//! x = .2 (section 2).

use corpuscle::simulation::Options;
use corpuscle::subdomain::GpuParticle;

use crate::equilibrium_box::EquilibriumBox;
use crate::statistics::mean_of_series;
use crate::whole_run::{Run, model, run};

/// Kinetic energy times 2/3 and spin energy times 2/zeta (zeta = 2) per particle of a gas, over the reference
/// mass; `mass` is that of the gas over the heaviest.
pub fn temperatures(particles: &[GpuParticle], gas: u8, mass: f64) -> [f64; 2] {
    let mut sums = [0.0; 2];
    let mut count = 0.0;
    for particle in particles.iter().filter(|particle| particle.gas() == gas) {
        sums[0] += mass / 3.0 * particle.velocity.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>();
        sums[1] += f64::from(particle.spin);
        count += 1.0;
    }
    sums.map(|sum| sum / count)
}

/// Masses 1:7, half each, from a start with the light gas 9 times as hot as the heavy one and no spin.
fn mixture(rounds: u32, step_over_tau: f64, steps: u32) -> Run {
    mixture_by("closest-approach", rounds, step_over_tau, steps)
}

pub fn mixture_by(method: &str, rounds: u32, step_over_tau: f64, steps: u32) -> Run {
    let gas = EquilibriumBox {
        method,
        particles: 4000,
        rounds,
        step_over_tau,
        steps,
        molar_mass: 0.016,
        gases: "[[gas]]\nname = \"light\"\nmolar_mass = 0.004\ngamma = 1.4\n\
                [[gas]]\nname = \"heavy\"\nmolar_mass = 0.028\ngamma = 1.4\n",
        mixture: "{ light = 0.5, heavy = 0.5 }",
        snapshots: steps / 16,
        ..EquilibriumBox::default()
    };
    let mut model = model(&gas.toml());
    model.plan.steps_per_interval = 16;
    model.plan.collision_limit = model.plan.collision_limit.max(1.0);
    let unequal = |particles: &mut [GpuParticle]| {
        for particle in particles {
            let factor = if particle.gas() == 0 { 1.5 } else { 0.5 };
            particle.velocity = particle.velocity.map(|v| factor * v);
            particle.spin = 0.0;
        }
    };
    run(&model, Options { shuffle: Some(&unequal), ..Options::default() })
}

/// Mean and standard error of T_int/T_tr of all, and of T1/T2, after the first quarter of a run.
pub fn ratios(run: &Run) -> [(f64, f64); 2] {
    let late = &run.snapshots[run.snapshots.len() / 4..];
    let states: Vec<[[f64; 2]; 2]> = late
        .iter()
        .map(|(_, particles)| [temperatures(particles, 0, 1.0 / 7.0), temperatures(particles, 1, 1.0)])
        .collect();
    let spin: Vec<f64> = states.iter().map(|[light, heavy]| (light[1] + heavy[1]) / (light[0] + heavy[0])).collect();
    let gases: Vec<f64> = states.iter().map(|[light, heavy]| light[0] / heavy[0]).collect();
    [mean_of_series(&spin, 12), mean_of_series(&gases, 12)]
}

#[test]
fn spin_and_both_gases_come_to_one_temperature() {
    let run = mixture(3, 0.1, 2600);
    let start = [0, 1].map(|gas| temperatures(&run.snapshots[0].1, gas, [1.0 / 7.0, 1.0][usize::from(gas)]));
    assert!(start[0][0] > 8.0 * start[1][0] && start[0][1] == 0.0, "the start is unequal");
    let [spin, gases] = ratios(&run);
    println!(
        "T_int/T_tr {:.4} +- {:.4}, T1/T2 {:.4} +- {:.4}, lost {:?}",
        spin.0, spin.1, gases.0, gases.1, run.outcome.audit.lost_collision_fraction
    );
    for (name, (ratio, error)) in [("T_int/T_tr", spin), ("T1/T2", gases)] {
        assert!(error <= 0.01 / 2.0, "{name}: the run is too short, {error:.4}");
        assert!((ratio - 1.0).abs() < 0.01, "{name} = {ratio:.4} +- {error:.4}");
    }
}

/// The check can fail: one round leaves the light gas hotter by 2 % at x = .2 and by 5 % at x = 1
/// (specification, section 2).
#[test]
fn one_round_at_long_steps_breaks_equipartition() {
    let [_, gases] = ratios(&mixture(1, 0.5, 480));
    println!("R 1: T1/T2 {:.4} +- {:.4}", gases.0, gases.1);
    assert!(gases.0 - 1.0 > 0.01 + 2.0 * gases.1, "{gases:?}");
}

/// Z from a run that starts without spin and stops after about s = .5 Z, and its standard error.
///
/// The start has D = T_tr - T_int without noise. At a = (1 + zeta/3) s / Z thermal noise gives D an error of
/// sqrt(5/(3N)) sqrt(1 - exp(-2a)) T, T = 3/5 of that at the start: relative to D and to a = .83, 1.5
/// sqrt(5/(3N)).
fn measured_collision_number(asked: f64, occupancy: f64, step_over_tau: f64) -> (f64, f64) {
    collision_number_by("closest-approach", asked, occupancy, step_over_tau)
}

pub fn collision_number_by(method: &str, asked: f64, occupancy: f64, step_over_tau: f64) -> (f64, f64) {
    let particles = 50_000u64;
    let steps = (0.5 * asked / step_over_tau).round() as u32;
    let gas = EquilibriumBox {
        method,
        particles,
        occupancy,
        step_over_tau,
        steps,
        collision_number: asked,
        ..EquilibriumBox::default()
    };
    let mut model = model(&gas.toml());
    model.plan.collision_limit = model.plan.collision_limit.max(1.0);
    let without_spin = |particles: &mut [GpuParticle]| particles.iter_mut().for_each(|particle| particle.spin = 0.0);
    let run = run(&model, Options { shuffle: Some(&without_spin), ..Options::default() });
    let [translation, spin] = temperatures(&run.outcome.particles, 0, 1.0);
    // All energy was in translation: 3/2 T0 = 3/2 T_tr + T_int.
    let start = translation + 2.0 / 3.0 * spin;
    let per_particle = 2.0 * run.outcome.collisions as f64 / particles as f64;
    let decay = (start / (translation - spin)).ln();
    (5.0 / 3.0 * per_particle / decay, 1.5 * (5.0 / 3.0 / particles as f64).sqrt() * asked)
}

/// The law is that of molecular chaos, hence of a thin gas.
#[test]
fn spin_relaxes_in_the_collision_number_asked_for() {
    for asked in [2.0, 5.0] {
        let (found, error) = measured_collision_number(asked, 0.003, 0.05);
        println!("Z {asked}: {found:.3} +- {error:.3}");
        assert!(error <= 0.01 * asked);
        assert!((found - asked).abs() < 0.05 * asked, "Z = {found:.3} +- {error:.3}, asked {asked}");
        // The check can fail: a Z of a tenth more is told apart.
        assert!((found - 1.1 * asked).abs() > 0.05 * 1.1 * asked - 2.0 * error);
    }
}

/// Dense gas relaxes a little slower per collision: a pair that collided stays within a diameter for a while,
/// and of those of which a third particle turns one meanwhile (a share of order sigma/lambda) many collide
/// again, with energies that know of each other. Measured at 400,000 particles for Z = 2: 1.99, 2.04 and 2.09
/// at f = .001, .01 and .1 (all +- .01), while the rate of collisions is the theory's at each.
#[test]
fn spin_relaxes_slower_by_a_few_per_cent_in_dense_gas() {
    let (found, error) = measured_collision_number(5.0, 0.1, 0.1);
    println!("Z 5, f .1: {found:.3} +- {error:.3}");
    assert!(found > 5.0 + 2.0 * error && found < 5.0 * 1.08 + 2.0 * error, "Z = {found:.3} +- {error:.3}");
}
