//! Elastic fabric on walls, with masses on it, and with a reference that changes. The gas around is thin.

use corpuscle::geometry::MeshShape;
use corpuscle::output::FabricSnapshot;
use corpuscle::scene::Method;

use crate::scenes::{ALIKE, Scene};
use crate::sheets::sheet;

const THICKNESS: f64 = 6e-4;

fn thin() -> String {
    ALIKE.replace("1e5", "1.0")
}

fn material(young: f64) -> String {
    format!("[fabric.material]\nthickness = {THICKNESS:e}\ndensity = 800.0\nyoung = {young:e}\npoisson = 0.3\n")
}

/// How far the middle of a sheet has slid along y on the wall at x = 0 in 2 ms, m, pressed by 1000 m/s2 and pulled by 600.
fn slid(friction: f64) -> f64 {
    let mesh = sheet(0.5 * THICKNESS + 1e-6, [0.02, 0.08], 2);
    let scene = Scene {
        particles: 200,
        end: 2e-3,
        step: Some(8e-6),
        chambers: thin(),
        elastic: format!("wall_friction = {friction:?}\n{}", material(1e7)),
        gravity: [-1000.0, 600.0, 0.0],
        ..Scene::new(Method::None, mesh.clone(), None)
    };
    let fabric = scene.run().1.outcome.fabric;
    fabric.nodes.iter().zip(&mesh.nodes).map(|(end, start)| end[1] - start[1]).sum::<f64>() / mesh.nodes.len() as f64
}

/// Coulomb's law: a = g_along - mu g_normal, or rest.
#[test]
fn a_sheet_slides_on_a_wall_by_its_friction() {
    for (friction, acceleration) in [(0.0, 600.0), (0.2, 400.0), (0.7, 0.0)] {
        let (found, expected) = (slid(friction), 0.5 * acceleration * 2e-3 * 2e-3);
        eprintln!("friction {friction}: {found:e} m, by the law {expected:e}");
        assert!((found - expected).abs() < 0.02 * 0.8e-3, "{friction}: {found:e} m, not {expected:e}");
    }
}

/// A sheet that falls on a body of these keys: where its nodes are in the end, and what is told of the scene.
fn fallen(body: &str) -> (FabricSnapshot, Vec<String>) {
    let scene = Scene {
        particles: 200,
        end: 3e-3,
        step: Some(8e-6),
        chambers: format!("[[wall]]\nname = \"body\"\n{body}{}", thin()),
        elastic: material(1e7),
        gravity: [-2000.0, 0.0, 0.0],
        ..Scene::new(Method::None, sheet(0.0415, [0.02, 0.08], 8), None)
    };
    let (model, run) = scene.run();
    (run.outcome.fabric, model.notes())
}

#[test]
fn convex_walls_of_few_faces_stop_a_sheet_that_falls() {
    let block = "shape = \"box\"\nmin = [0.02, 0.035, 0.035]\nmax = [0.04, 0.065, 0.065]\ngas = \"outside\"\n";
    let plate = "shape = \"plane\"\ncenter = [0.0395, 0.05, 0.05]\nnormal = [1, 0, 0]\nu = [0, 1, 0]\nsize = [0.03, 0.03]\nthickness = 1e-3\n";
    let ball = "shape = \"sphere\"\ncenter = [0.025, 0.05, 0.05]\nradius = 0.015\ngas = \"outside\"\n";
    let over = |node: &&[f64; 3]| (1..3).all(|axis| (node[axis] - 0.05).abs() < 0.015 - 1e-4);
    let post = "shape = \"cylinder\"\nbase = [0.02, 0.05, 0.05]\naxis = [1, 0, 0]\nradius = 0.022\nheight = 0.02\nsegments = 16\ngas = \"outside\"\n";
    for body in [block, plate, post] {
        let (fabric, notes) = fallen(body);
        let on_it: Vec<f64> = fabric.nodes.iter().filter(over).map(|node| node[0]).collect();
        let lowest = fabric.nodes.iter().map(|node| node[0]).fold(f64::INFINITY, f64::min);
        eprintln!("{} nodes on it, the lowest at {lowest} m", on_it.len());
        assert!(on_it.len() >= 9 && on_it.iter().all(|x| *x > 0.04 + 0.5 * THICKNESS - 2e-6), "{on_it:?}");
        assert!(on_it.iter().filter(|&&x| x < 0.04 + 0.5 * THICKNESS + 1e-4).count() >= 5, "{on_it:?}");
        // What is beside it falls on.
        assert!(lowest < 0.037, "{lowest}");
        assert!(!notes.iter().any(|note| note.contains("passes through")), "{notes:?}");
    }
    // A ball of 80 faces holds what falls on its top.
    let (fabric, notes) = fallen(&format!("{ball}subdivisions = 1\n"));
    let highest = fabric.nodes.iter().filter(over).map(|node| node[0]).fold(f64::NEG_INFINITY, f64::max);
    assert!((highest - 0.04 - 0.5 * THICKNESS).abs() < 1e-3, "{highest}");
    assert!(!notes.iter().any(|note| note.contains("passes through")), "{notes:?}");
    let (fabric, notes) = fallen(ball);
    assert!(fabric.nodes.iter().filter(over).all(|node| node[0] < 0.037), "it passes through");
    assert!(notes.iter().any(|note| note.contains("passes through wall `body`")), "{notes:?}");
}

/// Kinetic energy of a slack sphere under 10 kPa from outside after 50 us, J, and what p t A gives.
fn pressed(added: f64) -> [f64; 2] {
    let end = 5e-5;
    let mesh = MeshShape::Sphere { radius: 0.03, subdivisions: 2 }.mesh([0.05; 3]).expect("a sphere");
    let inside = "[[chamber]]\nname = \"in\"\ninside = \"bag\"\npressure = 1.0\ntemperature = 300.0\ngas = \"air\"\n";
    let scene = Scene {
        particles: 200,
        end,
        step: Some(5e-7),
        chambers: inside.into(),
        elastic: format!("external_pressure = 1e4\nadded_mass = {added:?}\n{}", material(1e6)),
        ..Scene::new(Method::None, mesh, None)
    };
    let (_, run) = scene.run();
    let last = run.rows.last().expect("rows").fabrics[0];
    let (time, mass) = (run.outcome.time, 800.0 * THICKNESS + added);
    [last.energies.expect("energies").kinetic, 0.5 * (1e4 * time).powi(2) * last.area / mass]
}

/// Twice the mass has half the energy.
#[test]
fn added_mass_is_moved_along() {
    for added in [0.0, 800.0 * THICKNESS] {
        let [found, expected] = pressed(added);
        eprintln!("added {added} kg/m2: {found:e} J, by p t A {expected:e}");
        assert!((found / expected - 1.0).abs() < 0.04, "{added}: {found:e} J, not {expected:e}");
    }
}

/// A reference that starts as large as the sheet is stretched and shrinks to its true size: the sheet has no stress at first, and then the
/// energy of its law at each size; that comes from the change of the reference, and the account closes.
#[test]
fn a_reference_that_shrinks_tightens_a_sheet() {
    let mesh = sheet(0.05, [1e-3, 0.099], 4);
    let mut reference = mesh.clone();
    reference.nodes.iter_mut().for_each(|place| *place = place.map(|x| 0.05 + 0.99 * (x - 0.05)));
    let (young, whole) = (1e9, 1.6e-4);
    let keys = format!("fixed = \"edge\"\nreference_scale = {:?}\nreference_time = {whole:e}\n", 1.0 / 0.99);
    let scene = Scene {
        particles: 200,
        end: 2.56e-4,
        step: Some(1e-6),
        rows: 8,
        chambers: thin(),
        elastic: keys + &material(young),
        reference: Some(reference),
        ..Scene::new(Method::None, mesh, None)
    };
    let (_, run) = scene.run();
    let energy = |time: f64| {
        let size = 1.0 + (1.0 / 0.99 - 1.0) * (1.0 - time / whole).max(0.0);
        let strain = 0.5 * ((0.99 * size).powi(-2) - 1.0);
        (0.99 * 0.098 * size).powi(2) * THICKNESS * young / 0.7 * strain * strain
    };
    for row in &run.rows {
        let found = row.fabrics[0].energies.expect("energies").strain;
        // (Energies of strain are those of half a step before.)
        let expected = energy(row.window[1] - 0.5e-6);
        eprintln!("{:.1} us: {found:.6} J, by the law {expected:.6}", 1e6 * row.window[1]);
        assert!((found - expected).abs() < 1e-3 * energy(1.0), "{} s: {found} J, not {expected}", row.window[1]);
    }
    let account = run.outcome.audit.fabric.expect("elastic fabric");
    assert!((account.from_supports / energy(1.0) - 1.0).abs() < 1e-3, "{account:?}");
    assert!(account.error().abs() < 1e-3, "{account:?}");
}
