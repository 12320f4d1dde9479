//! Law: between two walls of T1 and T2 that all hits leave with the wall's temperature, a gas without collisions carries
//! q = J (2 + zeta/2) R (T1 - T2), where J = n / (sqrt(pi M / (2 R T1)) + sqrt(pi M / (2 R T2))), mol/(m2 s), goes either way
//! (Kogan, Rarefied Gas Dynamics, 1969). Mirrors between the walls do not matter, so a box, a prism and a mesh of the same
//! length carry the same.
//!
//! Statistics: of N hits on a wall each changes the energy by k sqrt(3 (T1^2 + T2^2)) at random about 3 k (T1 - T2), with
//! zeta = 2, and N scatters by its square root at most.

use std::path::Path;

use corpuscle::output::AuditLimits;
use corpuscle::simulation::Options;
use corpuscle::study::verify::gas_box::GAS_CONSTANT;
use corpuscle::study::verify::run;

use crate::whole_run::{device, model, model_in};

const HOT: f64 = 600.0;
const COLD: f64 = 300.0;
/// m, between the walls.
const LENGTH: f64 = 0.1;
const MOLAR_MASS: f64 = 0.028;
/// mol/m3.
const DENSITY: f64 = 1e5 / (GAS_CONSTANT * 400.0);
const PARTICLES: f64 = 2000.0;

fn scene(wall: &str, method: &str) -> String {
    format!(
        "end_time = 0.012\nseed = 5\n[[gas]]\nname = \"nitrogen\"\nmolar_mass = {MOLAR_MASS}\ngamma = 1.4\n\
         [[wall]]\nname = \"v\"\n{wall}\n\
         [[chamber]]\nname = \"all\"\npressure = 100000.0\ntemperature = 400.0\ngas = \"nitrogen\"\n\
         [model]\nmethod = \"{method}\"\nparticles = {PARTICLES}\n[output]\nrows = 60\nsnapshots = 0\n"
    )
}

fn part(face: &str, keys: &str) -> String {
    format!("[[wall.part]]\nface = \"{face}\"\n{keys}\n")
}

fn ends(hot: &str, cold: &str) -> String {
    part(hot, &format!("temperature = {HOT}")) + &part(cold, &format!("temperature = {COLD}"))
}

const BOX: &str = "shape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n";

/// mol/(m2 s) to a wall of either temperature.
fn flux(hot: f64, cold: f64) -> f64 {
    let slowness = |t: f64| (std::f64::consts::PI * MOLAR_MASS / (2.0 * GAS_CONSTANT * t)).sqrt();
    DENSITY / (slowness(hot) + slowness(cold))
}

fn expected(hot: f64, cold: f64) -> f64 {
    flux(hot, cold) * 3.0 * GAS_CONSTANT * (hot - cold)
}

/// An STL file of a cube: its faces at the ends of x are solids, and the other four are one.
fn cube_of_solids() -> String {
    let mut text = String::new();
    let corner = |axis: usize, end: f64, u: f64, v: f64| {
        let mut point = [0.0; 3];
        (point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3]) = (LENGTH * end, LENGTH * u, LENGTH * v);
        format!("vertex {} {} {}\n", point[0], point[1], point[2])
    };
    for (name, faces) in [
        ("hot end", vec![(0, 0.0)]),
        ("sides", vec![(1, 0.0), (1, 1.0), (2, 0.0), (2, 1.0)]),
        ("cold end", vec![(0, 1.0)]),
    ] {
        text += &format!("solid {name}\n");
        for (axis, end) in faces {
            for square in [[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], [[0.0, 0.0], [1.0, 1.0], [0.0, 1.0]]] {
                let mut corners = square.map(|[u, v]| corner(axis, end, u, v));
                if end == 0.0 {
                    corners.swap(1, 2);
                }
                text += &format!("facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n", corners.concat());
            }
        }
        text += &format!("endsolid {name}\n");
    }
    text
}

/// What both ends take in the later three quarters of a run over what the law says, and the standard error. The hot end is
/// the first of the wall's parts.
fn carried(text: &str, folder: &Path, area: f64) -> ([f64; 2], f64) {
    let model = model_in(text, folder);
    let run = run(&device(), &model, Options::default()).expect("a run");
    assert_eq!(run.outcome.audit.verdict(&AuditLimits::default()), Vec::<String>::new());
    let (first, last) = (&run.rows[run.rows.len() / 4], &run.rows[run.rows.len() - 1]);
    // The columns are those of the parts, and are all heat.
    let total: f64 = last.walls.iter().map(|wall| wall.heat).sum();
    let told = run.outcome.audit.heat_to_walls.unwrap_or(f64::NAN);
    assert!(last.walls.len() == 2 && (total - told).abs() < 1e-9 * last.walls[1].heat, "{:?} {told}", last.walls);
    let time = last.window[1] - first.window[1];
    let law = expected(HOT, COLD) * area * time;
    let hits = flux(HOT, COLD) * area * time * PARTICLES / (DENSITY * area * LENGTH);
    let each = (3.0 * (HOT * HOT + COLD * COLD)).sqrt() / (3.0 * (HOT - COLD));
    let taken = [-1.0, 1.0]
        .into_iter()
        .zip([0, 1])
        .map(|(sign, wall): (f64, usize)| sign * (last.walls[wall].heat - first.walls[wall].heat) / law);
    let taken: Vec<f64> = taken.collect();
    ([taken[0], taken[1]], ((1.0 + each * each) / hits).sqrt())
}

#[test]
fn parts_of_a_box_a_cylinder_and_a_mesh_carry_the_heat_of_free_flight() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("cube.stl"), cube_of_solids()).expect("a file");
    let cylinder = "shape = \"cylinder\"\nbase = [0.0, 0.0, 0.0]\naxis = [0.0, 0.0, 1.0]\nradius = 0.05\nheight = 0.1\n\
                    gas = \"inside\"\n";
    let mesh = "shape = \"mesh\"\nfile = \"cube.stl\"\ngas = \"inside\"\n";
    let round = std::f64::consts::PI * 0.05 * 0.05;
    for (name, wall, parts, area) in [
        ("box", BOX, ends("-x", "+x"), LENGTH * LENGTH),
        ("cylinder", cylinder, ends("top", "base"), round),
        ("mesh", mesh, ends("hot end", "cold end"), LENGTH * LENGTH),
    ] {
        let text = scene(&format!("{wall}{parts}"), "none");
        let ([given, taken], error) = carried(&text, folder.path(), area);
        println!("{name}: {given:.4} given, {taken:.4} taken, of the law's, +- {error:.4}");
        assert!(
            (given - 1.0).abs() < 4.0 * error && (taken - 1.0).abs() < 4.0 * error,
            "{name} {given} {taken} {error}"
        );
        // The check can fail: ends 30 K hotter and colder would be seen, and so would sides that have a temperature.
        assert!((expected(HOT + 30.0, COLD - 30.0) / expected(HOT, COLD) - 1.0).abs() > 8.0 * error);
    }
    let warm = scene(&format!("{BOX}temperature = {COLD}\n{}", ends("-x", "+x")), "none");
    let model = model(&warm);
    let run = run(&device(), &model, Options::default()).expect("a run");
    let walls = &run.rows[run.rows.len() - 1].walls;
    assert!(walls.len() == 3 && walls[0].heat > 2.0 * walls[2].heat, "{walls:?}");
}

/// Six parts that have the keys of a wall are that wall, to the last bit.
#[test]
fn parts_that_are_all_of_a_wall_are_the_wall() {
    let outcome = |wall: &str| {
        let text = scene(&format!("{BOX}{wall}"), "closest-approach").replace("0.012", "0.0005");
        run(&device(), &model(&text), Options::default()).expect("a run")
    };
    let keys = "temperature = 600.0\naccommodation = 0.7\nfriction = 0.3\n";
    let faces = |keys: &str| ["-x", "+x", "-y", "+y", "-z", "+z"].map(|face| part(face, keys)).concat();
    let [whole, parts, other] = [keys, &faces(keys), &faces(&keys.replace("0.7", "0.71"))].map(outcome);
    assert_eq!(whole.outcome.particles, parts.outcome.particles);
    assert_eq!(whole.outcome.audit.heat_to_walls, parts.outcome.audit.heat_to_walls);
    assert!(whole.outcome.audit.heat_to_walls.is_some_and(|heat| heat < 0.0));
    // The check can fail: another share is seen.
    assert_ne!(whole.outcome.particles, other.outcome.particles);
    // Keys that the parts do not give are the wall's, whose own columns are of nothing.
    let inherited = outcome(&format!("temperature = 600.0\naccommodation = 0.7\n{}", faces("friction = 0.3")));
    assert_eq!(whole.outcome.particles, inherited.outcome.particles);
    let walls = inherited.rows.last().map(|row| row.walls.clone()).unwrap_or_default();
    assert!(walls.len() == 7 && walls[0].heat == 0.0 && walls[0].heat_flux == 0.0 && walls[1].heat < 0.0, "{walls:?}");
}
