//! Laws: from any start the degrees of freedom come to one temperature, T_int = T_tr, T1 = T2 for masses
//! 1:7 (docs/reference/accuracy.md: within 1 % for R = 3, x <= .2); and T_tr - T_int decays as
//! exp(-(1 + zeta/3) s / Z), s the collisions per particle (section 3: measured Z within 5 %).
//!
//! Pressure and energy checks never see a breach of these: with R = 1 the energies stay 1.5 % apart at
//! x = .2 (section 2).

use corpuscle::study::verify::equilibrium::{self, Relaxation, ratios, temperatures};

use crate::whole_run::{Run, device};

fn mixture(rounds: u32, step_over_tau: f64, steps: u32) -> Run {
    equilibrium::mixture(&device(), "closest-approach", rounds, step_over_tau, steps).expect("a run")
}

fn measured_collision_number(asked: f64, occupancy: f64, step_over_tau: f64) -> (f64, f64) {
    let gas = Relaxation { method: "closest-approach", zeta: 2.0, asked, occupancy, step_over_tau };
    equilibrium::collision_number(&device(), gas).expect("a run")
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
/// (docs/explanation/method.md, "Collisions").
#[test]
fn one_round_at_long_steps_breaks_equipartition() {
    let [_, gases] = ratios(&mixture(1, 0.5, 480));
    println!("R 1: T1/T2 {:.4} +- {:.4}", gases.0, gases.1);
    assert!(gases.0 - 1.0 > 0.01 + 2.0 * gases.1, "{gases:?}");
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
