//! Laws: where the diameter is capped, block by block from noisy densities, the gas still presses with n k T
//! (method.md, "Collisions": sigma may depend on position; within .5 %), and collides by the cross-section
//! that is left: (cap/sigma)^2 n^(-2/3).
//!
//! Statistics: the pressure as in `wall_pressure`. A block's density counts less one standard error, an eighth for the
//! plan's 64 particles, so the cross-section is up to (1 - 1/8)^(-2/3) = 1.09 times as large; and blocks scatter.

use corpuscle::simulation::{Model, Options, Outcome};
use corpuscle::study::verify::collisions::{PressureRatio, pressure_in};
use corpuscle::study::verify::run;

use crate::equilibrium_box::EquilibriumBox;
use crate::whole_run::device;

/// In mean spacings; at f = .3 the diameter is .83 of one.
const CAP: f64 = 0.5;

fn dense(cap: Option<f64>) -> (PressureRatio, Outcome) {
    let gas =
        EquilibriumBox { occupancy: 0.3, step_over_tau: 0.3, steps: 1500, rounds: 4, ..EquilibriumBox::default() };
    let scene = gas.model().expect("a plan").scene;
    let mut model = Model::new(scene).expect("a plan");
    // A plan refuses one below the diameter at the mean density, where every block's noise moves it.
    assert_eq!(model.plan.diameter_cap.replace(cap.unwrap_or(f64::INFINITY)), None, "the gas stays uniform");
    model.plan.tally_every = 1;
    let run = run(&device(), &model, Options::default()).expect("a run");
    (pressure_in(&model, &gas, &run.rows[0]), run.outcome)
}

#[test]
fn capped_diameters_keep_the_pressure_and_collide_less() {
    let ((pressure, capped), (_, whole)) = (dense(Some(CAP)), dense(None));
    println!("p/nkT {:.5} +- {:.5}", pressure.ratio, pressure.error);
    assert!(pressure.error <= 0.005 / 4.0);
    assert!((pressure.ratio - 1.0).abs() < 0.005, "{:.5} +- {:.5}", pressure.ratio, pressure.error);
    let spacings = (6.0 * 0.3 / std::f64::consts::PI).cbrt();
    let share = (CAP / spacings).powi(2);
    let found = capped.collisions as f64 / whole.collisions as f64;
    println!("{:.4} of the collisions, {share:.4} of the cross-section", found);
    let holds = |found: f64| found > 0.98 * share && found < 1.12 * share;
    assert!(holds(found), "{found:.4} for {share:.4}");
    // The check can fail: the whole diameter does not pass.
    assert!(!holds(1.0));
}
