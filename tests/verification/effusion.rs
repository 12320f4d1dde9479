//! Law: without collisions n cbar A / 4 particles a second leave through a hole of area A (specification,
//! sections 4 and 8: within 3 %). The walls are specular, so the hole's side wall sends nothing back: a
//! particle keeps its velocity along the hole's axis and so comes through.
//!
//! Particles of speed v leave at v A / (4 V), the fast first, so after a time t
//! N0 (1 - integral f(v) exp(-v A t / (4 V)) dv) have left; the run is short enough (10 %) that what comes
//! back from the 26 times larger outer space is .2 % of that. Statistics: M particles that left are known
//! to 1 / sqrt(M).

use std::f64::consts::PI;

use corpuscle::scene::{Method, Outline, Shape};
use corpuscle::simulation::{Model, Options};

use crate::whole_run::{published, run};

const PARTICLES: u64 = 100_000;
/// s.
const DURATION: f64 = 0.00125;
const DIAMETER: f64 = 0.03;

/// `scenes/effusion.toml` with a hole of another diameter; the particles that left the inner box over those
/// that should have through a hole of [`DIAMETER`], and the standard error.
fn flow_ratio(diameter: f64) -> (f64, f64) {
    let mut scene = published("effusion.toml", PARTICLES, DURATION).scene;
    assert_eq!(scene.model.method, Some(Method::None));
    for wall in &mut scene.walls {
        if let Shape::Box { holes, .. } = &mut wall.shape {
            for hole in holes {
                hole.outline = Outline::Circle { diameter, segments: 32 };
            }
        }
    }
    scene.model.time_step = Some(5e-6);
    let model = Model::new(scene).expect("a model");
    let inner = model.scene.chambers[0].region.clone().expect("the inner box");
    let inside = |point| corpuscle::geometry::region_contains(&inner, point);
    let run = run(&model, Options::default());
    let places = run.outcome.particles.iter().map(|particle| model.plan.grid.to_metres(particle.position));
    let started = model.plan.chambers[0].particles[0] as f64;
    let left = started - places.filter(|place| inside(*place)).count() as f64;
    assert!((run.outcome.time / DURATION - 1.0).abs() < 1e-12);
    let thermal = (8.314462618 * 300.0 / model.scene.gases[0].molar_mass).sqrt();
    let rate = thermal * PI / 4.0 * DIAMETER.powi(2) / (4.0 * model.plan.chambers[0].volume);
    (left / (started * (1.0 - staying(rate * DURATION))), 1.0 / left.sqrt())
}

/// The integral of exp(-u a) over the Maxwell distribution of speeds u (in units of sqrt(kT/m)), by the
/// trapezoidal rule, which converges faster than any power here.
fn staying(a: f64) -> f64 {
    let du = 0.01;
    let density = |u: f64| (2.0 / PI).sqrt() * u * u * (-0.5 * u * u - a * u).exp();
    (1..1200).map(|k| du * density(f64::from(k) * du)).sum()
}

#[test]
fn a_thin_gas_leaves_through_a_hole_at_n_cbar_a_over_4() {
    let (ratio, error) = flow_ratio(DIAMETER);
    println!("effusion {ratio:.4} +- {error:.4}");
    assert!(error <= 0.03 / 2.5);
    assert!((ratio - 1.0).abs() < 0.03, "{ratio:.4} +- {error:.4}");
    // The check can fail: a hole 5 % narrower, by 9.75 % of its area, does not pass.
    let (narrow, error) = flow_ratio(0.95 * DIAMETER);
    println!("narrow {narrow:.4} +- {error:.4}");
    assert!((narrow - 1.0).abs() > 0.03, "{narrow:.4} +- {error:.4}");
}

/// To first order in time the share is cbar A t / (4 V).
#[test]
fn the_share_that_stays() {
    assert!((staying(0.0) - 1.0).abs() < 1e-9);
    assert!(((1.0 - staying(1e-4)) / 1e-4 - (8.0 / PI).sqrt()).abs() < 1e-3);
}
