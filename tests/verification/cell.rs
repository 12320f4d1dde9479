//! Laws of the method `cell` (method.md, "Collisions"): the gas presses with p = n k T at long and short steps;
//! collisions come at the rate n pi sigma^2 gbar within 1.5 %, also in cells that walls cut and part; spin and gases of
//! masses 1:7 come to one temperature within 1 %; spin relaxes in the collision number asked for, within 5 %.

use std::f64::consts::PI;

use corpuscle::simulation::Options;
use corpuscle::study::verify::collisions::virial_error_of_cells;
use corpuscle::study::verify::equilibrium::{Relaxation, collision_number, mixture, ratios};

use crate::equilibrium_box::{EDGE, EquilibriumBox, TEMPERATURE};
use crate::wall_pressure::pressure_ratio;
use crate::whole_run::{device, model, run};

#[test]
fn the_pressure_is_that_of_the_ideal_gas() {
    for (occupancy, step_over_tau, steps) in [(0.1, 0.2, 1500), (0.3, 2.0, 600)] {
        let (ratio, error, _) = pressure_ratio("cell", occupancy, step_over_tau, steps);
        let gas = EquilibriumBox { occupancy, step_over_tau, steps, ..EquilibriumBox::default() };
        let random = virial_error_of_cells(&gas);
        let error = error.hypot(random);
        println!("f {occupancy}, x {step_over_tau}: {ratio:.5} +- {error:.5}");
        assert!(error < 0.005 / 2.0, "the run is too short: {error:.5}");
        assert!((ratio - 1.0).abs() < 0.005 + 2.0 * error, "{ratio:.5} +- {error:.5}");
        // The check can fail: rigid spheres of f = .1 press harder by a half.
        assert!((ratio - 1.486).abs() > 0.1);
    }
}

/// Collisions over theirs in theory, and the standard error. `sides`: of a plate across the box at this height (m) and
/// of this thickness.
fn rate(occupancy: f64, step_over_tau: f64, steps: u32, plate: Option<[f64; 2]>) -> (f64, f64) {
    let wall = plate.map(|[height, thickness]| {
        format!(
            "[[wall]]\nname = \"plate\"\nshape = \"plane\"\ncenter = [0.05, 0.05, {height}]\nnormal = [0.0, 0.0, 1.0]\n\
             u = [1.0, 0.0, 0.0]\nsize = [0.1, 0.1]\nthickness = {thickness}\n"
        )
    });
    let walls = wall.as_deref().unwrap_or("");
    let gas = EquilibriumBox {
        method: "cell",
        walls,
        particles: 8000,
        occupancy,
        step_over_tau,
        steps,
        ..EquilibriumBox::default()
    };
    let mut model = model(&gas.toml());
    model.plan.tally_every = 1;
    // Chance makes some blocks of the ladder denser than x = 2 allows.
    model.plan.collision_limit = 4.0;
    let run = run(&model, Options::default());
    assert_eq!(run.outcome.steps, u64::from(steps), "every step is as long as asked");
    assert_eq!(run.outcome.audit.lost_collision_fraction, Some(0.0));
    let temperature = run.rows[0].chambers[0].temperature / TEMPERATURE;
    let gbar = (16.0 / PI * temperature).sqrt() * gas.thermal_speed();
    // Pairs over volume, of each side of the plate.
    let area = EDGE * EDGE;
    let sides = match plate {
        None => vec![(gas.particles as f64, area * EDGE)],
        Some([height, thickness]) => {
            let places = run.outcome.particles.iter().map(|p| model.plan.grid.to_metres(p.position)[2]);
            let below = places.filter(|&z| z < height).count() as f64;
            let volumes = [height - 0.5 * thickness, EDGE - height - 0.5 * thickness].map(|length| area * length);
            vec![(below, volumes[0]), (gas.particles as f64 - below, volumes[1])]
        }
    };
    let pairs: f64 = sides.iter().map(|(count, volume)| 0.5 * count * (count - 1.0) / volume).sum();
    let expected = pairs * PI * model.plan.diameter.powi(2) * gbar * model.plan.time_step * f64::from(steps);
    let collisions = run.outcome.collisions as f64;
    (collisions / expected, 1.0 / collisions.sqrt())
}

#[test]
fn the_collision_rate_is_that_of_kinetic_theory() {
    for (occupancy, step_over_tau, steps) in [(0.1, 0.2, 150), (0.3, 2.0, 20)] {
        let (ratio, error) = rate(occupancy, step_over_tau, steps, None);
        println!("f {occupancy}, x {step_over_tau}: {ratio:.4} +- {error:.4}");
        assert!(error <= 0.015 / 3.0, "too few collisions: {error}");
        assert!((ratio - 1.0).abs() < 0.015, "{ratio:.4} +- {error:.4}");
        // The check can fail: pairs with themselves, N^2/2 in a cell of six, would be seen.
        assert!((ratio * 7.0 / 6.0 - 1.0).abs() > 0.015);
    }
}

/// A thin plate parts every cell it crosses, a twelfth of all: were its two sides one gas of twice the volume whose pairs
/// are told apart later, the rate would be too low by a half there, and by some 4 % in all.
#[test]
fn the_rate_beside_a_thin_plate_is_that_of_kinetic_theory() {
    for height in [0.0503, 0.0467] {
        let (ratio, error) = rate(0.1, 0.2, 150, Some([height, 0.001]));
        println!("plate at {height}: {ratio:.4} +- {error:.4}");
        assert!(error <= 0.015 / 3.0, "too few collisions: {error}");
        assert!((ratio - 1.0).abs() < 0.015, "{ratio:.4} +- {error:.4}");
    }
}

#[test]
fn spin_and_both_gases_come_to_one_temperature() {
    let run = mixture(&device(), "cell", 0, 0.5, 1200).expect("a run");
    let [spin, gases] = ratios(&run);
    println!("T_int/T_tr {:.4} +- {:.4}, T1/T2 {:.4} +- {:.4}", spin.0, spin.1, gases.0, gases.1);
    for (name, (ratio, error)) in [("T_int/T_tr", spin), ("T1/T2", gases)] {
        assert!(error <= 0.01 / 2.0, "{name}: the run is too short, {error:.4}");
        assert!((ratio - 1.0).abs() < 0.01, "{name} = {ratio:.4} +- {error:.4}");
    }
}

#[test]
fn spin_relaxes_in_the_collision_number_asked_for() {
    let asked = 5.0;
    let gas = Relaxation { method: "cell", zeta: 2.0, asked, occupancy: 0.1, step_over_tau: 0.25 };
    let (found, error) = collision_number(&device(), gas).expect("a run");
    println!("Z {asked}: {found:.3} +- {error:.3}");
    assert!(error <= 0.01 * asked);
    assert!((found - asked).abs() < 0.05 * asked, "Z = {found:.3} +- {error:.3}");
    // The check can fail: a Z of a tenth more is told apart.
    assert!((found - 1.1 * asked).abs() > 0.05 * 1.1 * asked - 2.0 * error);
}
