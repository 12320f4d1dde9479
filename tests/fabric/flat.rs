//! Gas that starts in a bag which is nearly flat.

use corpuscle::geometry::MeshShape;
use corpuscle::scene::Method;
use corpuscle::simulation::{Options, initial_particles};
use glam::{DQuat, DVec3, EulerRot};

use crate::scenes::{Scene, inside_and_outside, on_the_wrong_side};
use crate::whole_run::run;

/// Two sheets of 2000 times the distance between them, askew: of a box around them they fill less than a thousandth.
fn flat() -> Scene {
    let mut mesh = MeshShape::Cushion { radius: 0.04, rings: 10, gap: 4e-5 }.mesh([0.0; 3]).expect("a cushion");
    let turn = DQuat::from_euler(EulerRot::XYZ, 0.5, 0.6, 0.1);
    for node in &mut mesh.nodes {
        *node = (turn * DVec3::from(*node) + DVec3::splat(0.05)).to_array();
    }
    Scene {
        particles: 300_000,
        end: 2e-6,
        step: Some(2e-7),
        rows: 1,
        chambers: inside_and_outside(5e8, 1e4),
        ..Scene::new(Method::None, mesh, None)
    }
}

/// All of the bag's gas is between its sheets, evenly from one to the other and from the middle outwards, and stays there.
#[test]
fn gas_starts_between_the_sheets_of_a_flat_bag() {
    let scene = flat();
    let model = scene.model();
    let begun = initial_particles(&model).expect("initial particles");
    let own = model.plan.chambers[0].particles.iter().sum::<u64>();
    let inside: Vec<DVec3> = begun
        .iter()
        .filter(|particle| particle.is_inside())
        .map(|particle| DVec3::from(model.plan.grid.to_metres(particle.position)) - DVec3::splat(0.05))
        .collect();
    assert!(own > 100_000 && inside.len() as u64 == own, "{} of {own} are inside", inside.len());
    // Where the sheets are planes, within nine tenths of the radius, layers of equal height and rings of equal area have equally many.
    let normal = DQuat::from_euler(EulerRot::XYZ, 0.5, 0.6, 0.1) * DVec3::Z;
    let mut counts = [[0_u32; 5]; 5];
    for place in &inside {
        let height = place.dot(normal);
        let ring = (place.length_squared() - height * height) / (0.036 * 0.036 * 0.95);
        // (On the lattice a place is as exact as a quantum.)
        let layer = (height / 4e-5 + 0.5).clamp(0.0, 1.0 - 1e-9);
        if ring < 1.0 {
            counts[(5.0 * layer) as usize][(5.0 * ring) as usize] += 1;
        }
    }
    let all: u32 = counts.iter().flatten().sum();
    let mean = f64::from(all) / 25.0;
    let chi: f64 = counts.iter().flatten().map(|&n| (f64::from(n) - mean).powi(2) / mean).sum();
    eprintln!("{} inside, of which {all} in 25 bins: chi-square {chi:.1} of 24", inside.len());
    // Within 4 standard errors; a ring with 3 % too many alone is more.
    assert!((chi - 24.0).abs() < 4.0 * 48.0f64.sqrt(), "{chi}: {counts:?}");
    let run = run(&model, Options::default());
    let wrong = on_the_wrong_side(&model, &run, scene.end);
    assert!(
        wrong.is_empty() && run.outcome.audit.passed.is_some_and(|passed| passed.particles == 0),
        "{} on the wrong side",
        wrong.len()
    );
}
