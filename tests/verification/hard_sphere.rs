//! Law of the method `hard-sphere` (specification, section 2, table for x = .1, R = 2, N = 8000): its pressure on walls
//! over n k T is 1.039 at f = .01 and 1.486 at f = .1, near that of rigid spheres (Carnahan-Starling: 1.041, 1.521)
//! and not the ideal gas's.
//!
//! Statistics: H independent hits give the pressure to 1.13 / sqrt(H) (section 6). The table's own error is taken for half
//! a per cent.

use corpuscle::simulation::Options;

use crate::equilibrium_box::{EDGE, EquilibriumBox, GAS_CONSTANT};
use crate::whole_run::{model, run};

/// Wall pressure over n k T after the first quarter of a run, in which overlaps of the start end; and its standard error.
fn pressure_ratio(occupancy: f64, steps: u32) -> (f64, f64) {
    let gas = EquilibriumBox {
        method: "hard-sphere",
        particles: 8000,
        occupancy,
        step_over_tau: 0.1,
        rounds: 2,
        steps,
        rows: 4,
        ..EquilibriumBox::default()
    };
    let mut model = model(&gas.toml());
    // Steps stay as long as asked, though dense rigid spheres collide more often than tau says.
    model.plan.collision_limit = 1.0;
    assert!(model.plan.warnings.iter().any(|warning| warning.contains("Carnahan-Starling")));
    let run = run(&model, Options::default());
    assert_eq!(run.outcome.steps, u64::from(steps));
    let moles = model.plan.particles as f64 * model.plan.moles_per_particle;
    let (mut ratio, mut hits, mut duration) = (0.0, 0, 0.0);
    for row in &run.rows[1..] {
        let length = row.window[1] - row.window[0];
        let ideal = moles * GAS_CONSTANT * row.chambers[0].temperature / EDGE.powi(3);
        ratio += length * row.surfaces[0].pressure / ideal;
        duration += length;
        hits += row.surfaces[0].hits;
    }
    (ratio / duration, 1.13 / (hits as f64).sqrt())
}

#[test]
fn rigid_spheres_press_as_the_table_says() {
    for (occupancy, steps, expected) in [(0.01, 480, 1.039), (0.1, 1280, 1.486)] {
        let (ratio, error) = pressure_ratio(occupancy, steps);
        println!("f {occupancy}: {ratio:.4} +- {error:.4} ({expected})");
        let tolerance = expected * (0.005 + 3.0 * error);
        assert!((ratio - expected).abs() < tolerance, "f {occupancy}: {ratio:.4} +- {error:.4}");
        // The check can fail: the ideal gas is told apart.
        assert!((ratio - 1.0).abs() > 0.5 * (expected - 1.0), "{ratio}");
    }
}
