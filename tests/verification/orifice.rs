//! Law: gas with collisions leaves a chamber for near-vacuum at Cd times the choked isentropic flow, Cd that of
//! specification, section 4, at the Knudsen number of the hole: .78 at .1, less where the gas is thinner.
//!
//! The specification does not say what length its Knudsen number has. It is the hole's radius: with the
//! diameter the same table would ask for .78 at lambda = .2 radii. (Kinetic theory has 1.33 times the effusion,
//! Cd = .583 x 1.33 = .775, at lambda = .1 radii, and 1.2 times, .70, at .2.)
//!
//! Over a window d ln N / dt = -Cd A / V .685 sqrt(R T / M). Statistics: the n particles that leave are known to
//! sqrt(n), and gas that expands in a run of 1.2 ms is uniform to a few per cent.

use corpuscle::simulation::Options;

use crate::whole_run::{model, run};

const CHAMBER: u64 = 12_000;
/// m3: the inner box.
const VOLUME: f64 = 0.16 * 0.12 * 0.12;
/// m, half the side of the hole, which is the radius 2 area / perimeter of a square one.
const RADIUS: f64 = 0.02;

/// Cd over the run and its standard error, with a mean free path of `knudsen` hole radii at the start.
fn discharge(knudsen: f64) -> (f64, f64) {
    let mean_free_path = knudsen * RADIUS;
    let density = CHAMBER as f64 / VOLUME;
    let diameter = (1.0 / (2f64.sqrt() * std::f64::consts::PI * density * mean_free_path)).sqrt();
    let text = format!(
        r#"
        end_time = 1.2e-3
        gas = [{{ name = "nitrogen", molar_mass = 0.028, gamma = 1.4 }}]
        model = {{ particles = {CHAMBER}, diameter = {diameter:e} }}
        output = {{ rows = 12, snapshots = 0 }}
        [[wall]]
        name = "tank"
        shape = "box"
        min = [-0.02, -0.08, -0.08]
        max = [0.36, 0.08, 0.08]
        gas = "inside"
        [[wall]]
        name = "inner"
        shape = "box"
        min = [0.0, -0.06, -0.06]
        max = [0.16, 0.06, 0.06]
        thickness = 0.002
        hole = [{{ name = "vent", face = "+x", center = [0.0, 0.0], size = [0.04, 0.04] }}]
        [[chamber]]
        name = "inner"
        region = {{ box = {{ min = [0.0, -0.06, -0.06], max = [0.16, 0.06, 0.06] }} }}
        pressure = 1.0e6
        temperature = 700.0
        gas = "nitrogen"
        [[chamber]]
        name = "tank"
        pressure = 200.0
        temperature = 700.0
        gas = "nitrogen"
        "#
    );
    let model = model(&text);
    assert!((model.plan.openings[0].length - RADIUS).abs() < 1e-9);
    let rows = run(&model, Options::default()).rows;
    // The first two rows see the flow start.
    let window = &rows[2..];
    let number = |k: usize| window[k].chambers[0].particles[0];
    let choked = (1.4f64).sqrt() * (2.0 / 2.4f64).powi(3) * (4.0 * RADIUS * RADIUS) / VOLUME;
    let passed: f64 = window
        .windows(2)
        .map(|pair| {
            let temperature = 0.5 * (pair[0].chambers[0].temperature + pair[1].chambers[0].temperature);
            (pair[1].time - pair[0].time) * choked * (8.314462618 / 0.028 * temperature).sqrt()
        })
        .sum();
    let (first, last) = (number(0), number(window.len() - 1));
    ((first / last).ln() / passed, (first / last).ln() / passed / (first - last).sqrt())
}

#[test]
fn gas_leaves_a_hole_at_the_discharge_coefficient_of_its_knudsen_number() {
    let (resolved, error) = discharge(0.1);
    println!("Cd at Kn .1: {resolved:.3} +- {error:.3}");
    assert!((resolved - 0.78).abs() < 2.5 * error + 0.02, "{resolved:.3} +- {error:.3}");
    // Thin gas flows less, between the kinetic limit and the .71 of Kn .3, and so the check can fail.
    let (thin, error) = discharge(0.4);
    println!("Cd at Kn .4: {thin:.3} +- {error:.3}");
    assert!(thin > 0.583 - 2.5 * error && thin < 0.71 + 2.5 * error, "{thin:.3} +- {error:.3}");
    assert!((thin - 0.78).abs() > 2.5 * error + 0.02, "{thin:.3} +- {error:.3}");
}
