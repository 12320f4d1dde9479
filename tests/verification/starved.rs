//! Law: cells of the method `cell` with few particles. Of K others that a particle meets in its cell, a Poisson number of mean m, beside
//! the partner of its last collision, each is as likely to be the next; before it leaves the cell it collides with any of them
//! a = .28 (h/lambda)/m times (a way of .45 h from anywhere in a cube, while neither of the two has left). So a share r = a / (1 + (1 + m) a) of the collisions is with
//! the same partner again, which changes nothing: the gas is 1/(1 - r) times as viscous. Cells of one mean free path: r = .03 at 8 particles, .10 at 2, .30 at a half.
//!
//! And the guards of a run tell what they are for, and nothing of a good scene.

use std::path::Path;

use corpuscle::plan::Quantity;
use corpuscle::scene::{self, Method};
use corpuscle::simulation::{Model, Options};
use corpuscle::study::verify::shear::viscosity_in;

use crate::equilibrium_box::{EDGE, EquilibriumBox};
use crate::whole_run::{device, run};

/// Kinematic viscosity over lambda c0 in cells of one mean free path, a twentieth of the box, and its standard error.
fn viscosity(particles: u64, seeds: u64) -> (f64, f64) {
    let path = EDGE / 20.0;
    let density = particles as f64 / EDGE.powi(3);
    let square = 1.0 / (2f64.sqrt() * std::f64::consts::PI * density * path);
    let occupancy = std::f64::consts::PI / 6.0 * density * square.powf(1.5);
    let gas = EquilibriumBox { method: "cell", particles, occupancy, step_over_tau: 0.2, ..EquilibriumBox::default() };
    let found = viscosity_in(&device(), gas, seeds, Some(path), true).expect("a run");
    let scale = EDGE / (particles as f64).cbrt() / path;
    (found.0 * scale, found.1 * scale)
}

#[test]
#[ignore = "some minutes: scripts/test.sh --long"]
fn starved_cells_are_too_viscous() {
    let again = |m: f64| 0.28 / m / (1.0 + (1.0 + m) * 0.28 / m);
    let full = viscosity(64_000, 4);
    for (particles, seeds, m) in [(16_000, 8, 2.0), (4000, 16, 0.5)] {
        let found = viscosity(particles, seeds);
        let (ratio, error) = (found.0 / full.0, (found.1 / found.0).hypot(full.1 / full.0) * found.0 / full.0);
        let expected = (1.0 - again(8.0)) / (1.0 - again(m));
        println!("{m} in a cell: {ratio:.3} +- {error:.3} of full cells, {expected:.3} expected");
        assert!(error < 0.06, "{error:.3}");
        assert!((ratio - expected).abs() < 3.0 * error, "{ratio:.3} +- {error:.3}, {expected:.3} expected");
        // The limit parts what is within the tenth to which viscosities are known from what is not.
        assert_eq!(ratio > 1.1, m < 2.0, "{ratio:.3}");
    }
}

/// Gas of two pressures, a wall between.
fn divided(pressures: [f64; 2], method: &str, occupancy: f64) -> Model {
    let text = format!(
        r#"
        end_time = 4e-4
        gas = [{{ name = "nitrogen", molar_mass = 0.028, gamma = 1.4 }}]
        model = {{ method = "{method}", particles = 12000, occupancy = {occupancy} }}
        output = {{ rows = 1, snapshots = 0 }}
        [[wall]]
        name = "box"
        shape = "box"
        min = [0.0, 0.0, 0.0]
        max = [0.29, 0.1, 0.1]
        gas = "inside"
        [[wall]]
        name = "plate"
        shape = "plane"
        center = [0.1, 0.05, 0.05]
        normal = [1.0, 0.0, 0.0]
        u = [0.0, 1.0, 0.0]
        size = [0.11, 0.11]
        thickness = 0.001
        [[chamber]]
        name = "thin"
        region = {{ box = {{ min = [0.0, 0.0, 0.0], max = [0.1, 0.1, 0.1] }} }}
        pressure = {:e}
        temperature = 300.0
        gas = "nitrogen"
        [[chamber]]
        name = "dense"
        pressure = {:e}
        temperature = 300.0
        gas = "nitrogen"
        "#,
        pressures[0], pressures[1]
    );
    Model::new(scene::parse(&text, "divided.toml", Path::new("")).expect("a scene")).expect("a model")
}

fn told(model: &Model, options: Options<'_>) -> Vec<Quantity> {
    run(model, options).outcome.warnings.iter().map(|told| told.warning.quantity).collect()
}

#[test]
fn starved_cells_are_told_before_a_run_and_in_it() {
    let planned = |model: &Model| model.plan.warnings.iter().any(|text| text.contains("particles in a collision cell"));
    let starved = divided([1.4e4, 1e5], "cell", 0.3);
    assert!(planned(&starved), "{:?}", starved.plan.warnings);
    assert!(told(&starved, Options::default()).contains(&Quantity::CellParticles));
    for good in [divided([6e4, 1e5], "cell", 0.3), divided([1.4e4, 1e5], "closest-approach", 0.3)] {
        assert!(!planned(&good), "{:?}", good.plan.warnings);
        assert!(!told(&good, Options::default()).contains(&Quantity::CellParticles));
    }
}

/// The ladder takes shorter steps where it may; a run that holds them, or is two intervals behind, tells.
#[test]
fn flights_past_cells_are_told() {
    for method in ["cell", "none"] {
        let mut scene = divided([6e4, 1e5], "cell", 0.21).scene;
        if method == "none" {
            (scene.model.occupancy, scene.model.method) = (None, Some(Method::None));
        }
        let model = Model::new(scene.clone()).expect("a model");
        let fast = |model: &Model, hold_step| {
            let told = told(model, Options { hold_step, ..Options::default() });
            told.into_iter().filter(|quantity| *quantity == Quantity::FastParticles).count()
        };
        assert_eq!([fast(&model, false), fast(&model, true)], [0, 0], "{method}: its own step");
        scene.model.time_step = Some(2.0 * model.plan.time_step);
        let model = Model::new(scene).expect("a model");
        assert_eq!([fast(&model, false), fast(&model, true)], [0, 1], "{method}: twice that");
    }
}
