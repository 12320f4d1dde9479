//! Law: a time step that is far too long makes a run wrong, never one that loses something. Held at up to four collision
//! times, every method that collides keeps particles, mass and energy, has finite states, and was warned of at planning. One
//! that no run can follow is cut to one that a run can.

use corpuscle::output::AuditLimits;
use corpuscle::scene::Method;
use corpuscle::simulation::{Model, Options};

use crate::equilibrium_box::EquilibriumBox;
use crate::whole_run::{published, run};

#[test]
fn steps_that_are_too_long_lose_nothing() {
    for method in ["closest-approach", "hard-sphere", "cell"] {
        for step_over_tau in [0.1, 1.0, 4.0] {
            let gas = EquilibriumBox { method, step_over_tau, steps: 96, ..EquilibriumBox::default() };
            let model = gas.model().expect("a box");
            let run = run(&model, Options { hold_step: true, ..Options::default() });
            let audit = &run.outcome.audit;
            let case = format!("{method} at x = {step_over_tau}");
            println!("{case}: energy {:+.1e}, {} collisions", audit.energy_error(), run.outcome.collisions);
            assert_eq!(run.outcome.steps, 96, "{case}: the step was not held");
            assert!(run.outcome.collisions > 0, "{case}");
            assert_eq!((audit.particles_inside, audit.particles_outside), (1000, 0), "{case}");
            assert_eq!(audit.verdict(&AuditLimits::default()), Vec::<String>::new(), "{case}");
            let states = run.outcome.particles.iter();
            assert!(states.flat_map(|p| p.velocity).chain([audit.energy_end as f32]).all(f32::is_finite), "{case}");
            let warned = model.plan.warnings.iter().any(|warning| warning.contains("the time step"));
            assert_eq!(warned, step_over_tau > 2.0 || method != "cell" && step_over_tau > 0.5, "{case}");
        }
    }
}

/// A second, in scenes of milliseconds: inflow, a hole, a vent, a piston, by every method of particles.
#[test]
fn a_step_of_a_second_ends_well() {
    let scenes = [("tank.toml", 0.001), ("piston.toml", 5e-4), ("vent.toml", 0.002)];
    for (name, end) in scenes {
        for method in [Method::ClosestApproach, Method::HardSphere, Method::Cell, Method::None] {
            let mut scene = published(name, 600, end).scene;
            scene.model.method = Some(method);
            scene.model.time_step = Some(1.0);
            let model = Model::new(scene.clone()).expect("a plan");
            let warned =
                |model: &Model| model.plan.warnings.iter().any(|warning| warning.contains("us asked for, at most"));
            let case = format!("{name} by {}", method.name());
            println!("{case}: steps of {:.3e} s", model.plan.time_step);
            assert!(warned(&model), "{case}: {:?}", model.plan.warnings);
            let run = run(&model, Options::default());
            assert_eq!(run.outcome.audit.verdict(&AuditLimits::default()), Vec::<String>::new(), "{case}");
            let states = run.outcome.particles.iter().flat_map(|p| p.velocity);
            assert!(states.chain([run.outcome.audit.energy_end as f32]).all(f32::is_finite), "{case}");
            // The plan's own step is neither cut nor warned of.
            scene.model.time_step = None;
            let own = Model::new(scene.clone()).expect("a plan").plan.time_step;
            scene.model.time_step = Some(own);
            let model = Model::new(scene).expect("a plan");
            assert!(!warned(&model) && model.plan.time_step == own, "{case}");
        }
    }
}
