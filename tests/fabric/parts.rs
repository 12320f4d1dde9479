//! Parts of fabric with surfaces of their own.
//!
//! Law: in free flight a surface of the temperature T gives gas of the temperature T0 the heat c cbar/4 (2 + zeta/2) R (T - T0) on each
//! side, zeta = 2, until what it has heated comes back.
//!
//! Statistics: of N hits each changes the energy by k sqrt(3 (T^2 + T0^2)) at random about 3 k (T - T0), and N scatters by its square root.

use corpuscle::geometry::{MeshShape, TriangleMesh};
use corpuscle::scene::{GAS_CONSTANT, Method};

use crate::scenes::{ALIKE, Scene, inside_and_outside};
use crate::sheets::sheet;
use crate::whole_run::Run;

const GAS: f64 = 300.0;
const PARTICLES: u32 = 100_000;
const END: f64 = 4e-5;
/// m, of the sheet.
const SIDE: f64 = 0.09;

fn part(face: &str, keys: &str) -> String {
    format!("[[fabric.part]]\nface = \"{face}\"\n{keys}\n")
}

/// A flat sheet in the middle of the box whose two halves are parts.
fn halves() -> TriangleMesh {
    let mut mesh = sheet(0.05, [0.005, 0.005 + SIDE], 6);
    mesh.names = vec!["left".into(), "right".into()];
    let is_right = |corners: &[u32; 3]| corners.iter().map(|&node| mesh.nodes[node as usize][1]).sum::<f64>() > 0.15;
    mesh.parts = mesh.triangles.iter().map(|corners| Some(u32::from(is_right(corners)))).collect();
    mesh
}

/// A run of free flight with these keys of the sheet; each column of heat over the time and both sides of half the sheet, W/m2.
fn fluxes(keys: &str) -> (Vec<String>, Vec<f64>, f64) {
    let scene = Scene {
        particles: PARTICLES,
        end: END,
        step: Some(1e-6),
        rows: 1,
        chambers: format!("{keys}{ALIKE}"),
        ..Scene::new(Method::None, halves(), None)
    };
    let (model, run) = scene.run();
    let per = SIDE * SIDE * END;
    let audit = &run.outcome.audit;
    assert!(audit.energy_error().abs() < 1e-5, "{}", audit.energy_error());
    let names = model.scene.heated_surfaces().map(|(id, _)| model.scene.surface_name(id)).collect();
    let fluxes = run.rows[0].walls.iter().map(|wall| wall.heat / per).collect();
    (names, fluxes, audit.heat_to_walls.expect("heat") / per)
}

/// What the law says for a half, W/m2, and its standard error as a share.
fn law(temperature: f64) -> (f64, f64) {
    let flux = 0.25 * 1e5 / (GAS_CONSTANT * GAS) * (8.0 * GAS_CONSTANT * GAS / (std::f64::consts::PI * 0.029)).sqrt();
    let hits = f64::from(PARTICLES) * flux * SIDE * SIDE * END / (1e5 / (GAS_CONSTANT * GAS) * 1e-3);
    let each = (3.0 * (temperature * temperature + GAS * GAS)).sqrt() / (3.0 * (temperature - GAS));
    (-flux * 3.0 * GAS_CONSTANT * (temperature - GAS), ((1.0 + each * each) / hits).sqrt())
}

#[test]
fn a_part_gives_the_heat_of_its_own_temperature() {
    let (expected, error) = law(600.0);
    let is_law = |flux: f64| (flux / expected - 1.0).abs() < 4.0 * error;
    // The check can fail: both halves together, or a part that is 100 K colder, would be seen.
    assert!(!is_law(2.0 * expected) && !is_law(law(500.0).0), "{error}");

    let hot = part("right", "temperature = 600.0\naccommodation = 1.0");
    let (names, alone, all) = fluxes(&hot);
    eprintln!("{names:?}: {alone:.1?} W/m2, law {expected:.4e} +- {error:.3}");
    assert_eq!(names, ["bag/right"]);
    assert!(is_law(alone[0]) && (all / alone[0] - 1.0).abs() < 1e-9, "{alone:?} {all}");

    // The rest keeps a temperature that no hit takes.
    let (names, beside, all) = fluxes(&format!("temperature = 600.0\naccommodation = 0.0\n{hot}"));
    assert_eq!(names, ["bag", "bag/right"]);
    assert!(beside[0] == 0.0 && is_law(beside[1]) && (all / beside[1] - 1.0).abs() < 1e-9, "{beside:?} {all}");

    // Each half its own.
    let (colder, colder_error) = law(400.0);
    let (names, both, _) = fluxes(&(part("left", "temperature = 400.0") + &hot));
    eprintln!("{names:?}: {both:.1?} W/m2, laws {colder:.4e} +- {colder_error:.3}, {expected:.4e}");
    assert_eq!(names, ["bag/left", "bag/right"]);
    assert!((both[0] / colder - 1.0).abs() < 4.0 * colder_error && is_law(both[1]), "{both:?}");
}

/// Parts that are all of a fabric and have its keys are that fabric, to the last bit.
#[test]
fn parts_that_are_all_of_a_fabric_are_the_fabric() {
    let can = MeshShape::Cylinder { radius: 0.03, height: 0.05, around: 12, along: None, closed: true };
    let run = |keys: &str| -> Run {
        let scene = Scene {
            end: 2e-4,
            chambers: keys.to_string() + &inside_and_outside(2e5, 1e5),
            ..Scene::new(Method::HalfTurn, can.mesh([0.05; 3]).expect("a cylinder"), None)
        };
        scene.run().1
    };
    let keys = "temperature = 600.0\naccommodation = 0.7\nfriction = 0.3\n";
    let parts = |keys: &str| ["base", "side", "top"].map(|face| part(face, keys)).concat();
    let [whole, divided, other] =
        [keys.to_string(), parts(keys), parts(&keys.replace("0.7", "0.71"))].map(|keys| run(&keys));
    assert_eq!(whole.outcome.particles, divided.outcome.particles);
    assert_eq!(whole.outcome.audit.heat_to_walls, divided.outcome.audit.heat_to_walls);
    assert!(whole.outcome.audit.heat_to_walls.is_some_and(|heat| heat < 0.0));
    // The check can fail: another share is seen.
    assert_ne!(whole.outcome.particles, other.outcome.particles);
    assert_eq!([&whole, &divided].map(|run| run.rows[0].walls.len()), [1, 3]);
}
