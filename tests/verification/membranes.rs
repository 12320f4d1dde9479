//! The cases of membranes as `corpuscle verify --quick` runs them, and that each can fail: coarse meshes do, and so does the rule that sets
//! principal stresses of compression to 0, which has no potential.

use corpuscle::fabric::{Hold, Law, Model, principal};
use corpuscle::study::verify::membrane::moving::{self, CRUMPLING_TIME, crumpling};
use corpuscle::study::verify::membrane::shapes;
use corpuscle::study::verify::membrane::sheet::{FABRIC, Sheet};
use corpuscle::study::verify::membrane::stretched::{self, ORTHOTROPIC, WOVEN, loop_on_host};
use corpuscle::study::verify::{CASES, Check, Effort, Verdict};
use glam::DVec3;

use crate::whole_run::device;

fn passes(name: &str) {
    let case = CASES.iter().find(|case| case.name == name).expect("a case of this name");
    let found = case.run(&device(), Effort::Quick).expect("a run");
    assert!(!found.checks.is_empty());
    for check in &found.checks {
        println!("{check:?}");
        assert_eq!(check.verdict(), Verdict::Pass, "{name}: {check:?}");
    }
}

fn fails(check: &Check) {
    println!("{check:?}");
    assert_eq!(check.verdict(), Verdict::Fail, "{check:?}");
}

#[test]
fn a_uniform_strain_is_uniform_within_an_irregular_mesh() {
    passes("membrane-patch");
    // Not yet at rest.
    fails(&stretched::irregular(&device(), 64).expect("a run"));
}

#[test]
fn a_wrinkled_strip_pulls_with_its_young_modulus() {
    passes("membrane-strip");
    // One whose ends stay as wide is taut across near them, and pulls with more.
    fails(&stretched::pull(&device(), 0.0).expect("a run"));
}

#[test]
fn waves_have_their_speed_and_a_taut_sheet_its_energy() {
    passes("membrane-wave");
    // Masses in lumps: (pi/3)^2/24 too slow.
    fails(&moving::wave(&device(), 3).expect("a run"));
    passes("membrane-taut");
    // Its waves are fewer steps long: the energy of central differences comes and goes.
    fails(&moving::swing(&device(), 5).expect("a run"));
}

/// Principal stresses of an elastic sheet, those of compression set to 0.
fn clipped(law: &Law, strain: [f64; 3]) -> [f64; 3] {
    let stress = law.as_a_sheet(strain);
    let [most, least] = principal(stress);
    if least >= 0.0 {
        return stress;
    }
    if most <= 0.0 {
        return [0.0; 3];
    }
    let (mean, radius) = (0.5 * (most + least), 0.5 * (most - least));
    // The dyad of the larger one's direction.
    let [x, y] = [0.5 * (stress[0] - stress[1]) / radius, stress[2] / radius];
    [0.5 * (1.0 + x), 0.5 * (1.0 - x), 0.5 * y].map(|part| (mean + radius) * part)
}

#[test]
fn a_closed_loop_leaves_no_work_but_by_the_rule_of_principal_stresses() {
    passes("membrane-loop");
    for elasticity in [FABRIC.elasticity, ORTHOTROPIC, WOVEN] {
        let law = Law::new(&elasticity);
        let relaxed = loop_on_host(&law, |strain| law.stress(strain).stress, 20_000);
        let by_rule = loop_on_host(&law, |strain| clipped(&law, strain), 20_000);
        println!("{elasticity:?}: {relaxed:e} relaxed, {by_rule:.4} by the rule");
        assert!(relaxed.abs() < 1e-5 && by_rule.abs() > 3e-4, "{relaxed} {by_rule}");
    }
}

/// The relative change of the energy of motion of a sheet on the host, with any rule for its stress.
fn crumpled(sheet: &Sheet, rule: impl Fn(&Law, [f64; 3]) -> [f64; 3]) -> f64 {
    let model = sheet.input(Model::new).expect("a model");
    let dt = sheet.longest_step();
    let mut places: Vec<DVec3> = sheet.mesh.nodes.iter().copied().map(DVec3::from).collect();
    let mut velocities = sheet.velocities.clone();
    let kinetic = |velocities: &[DVec3]| -> f64 {
        velocities.iter().zip(&model.masses).map(|(v, m)| 0.5 * m * v.length_squared()).sum()
    };
    assert!(model.holds.iter().all(|hold| *hold == Hold::Free));
    let (start, mut most) = (kinetic(&velocities), 0.0_f64);
    for _ in 0..(CRUMPLING_TIME / dt) as u32 {
        let mut forces = vec![DVec3::ZERO; places.len()];
        for triangle in &model.triangles {
            let [a, b, c] = triangle.nodes.map(|node| node as usize);
            let edges = [places[b] - places[a], places[c] - places[a]];
            let stress = rule(&model.laws[triangle.material], model.strain(triangle, edges));
            let [second, third] = triangle.pull(edges, stress);
            forces[a] -= second + third;
            forces[b] += second;
            forces[c] += third;
        }
        for ((velocity, place), (force, mass)) in
            velocities.iter_mut().zip(&mut places).zip(forces.iter().zip(&model.masses))
        {
            *velocity += dt / mass * *force;
            *place += dt * *velocity;
        }
        most = most.max(kinetic(&velocities));
    }
    most / start - 1.0
}

#[test]
fn a_sheet_that_crumples_keeps_its_energy_but_by_the_rule_of_principal_stresses() {
    passes("membrane-sheet");
    let sheet = crumpling(10);
    let relaxed = crumpled(&sheet, |law, strain| law.stress(strain).stress);
    // With the share of the elastic sheet's stress that the law has, too.
    let with_share = |law: &Law, strain| {
        let (tension, sheet, k) = (clipped(law, strain), law.as_a_sheet(strain), law.compression);
        std::array::from_fn(|i| (1.0 - k) * tension[i] + k * sheet[i])
    };
    let by_rule = crumpled(&sheet, with_share);
    println!("the most that the energy of motion grew: {relaxed:.4} relaxed, {by_rule:.4} by the rule");
    assert!(relaxed < 5e-3 && by_rule > 0.5, "{relaxed} {by_rule}");
}

#[test]
fn a_sheet_slides_until_friction_stops_it() {
    passes("membrane-slide");
    // Of a friction of .1 three times as much is far off.
    let found = moving::slid(&device(), 0.3).expect("a run");
    fails(&Check::of("way", 0.03125, (found, 0.0), 3e-4));
}

#[test]
fn bags_have_the_shapes_of_the_literature() {
    for name in ["membrane-bag", "membrane-height", "membrane-discs"] {
        passes(name);
    }
    fails(&shapes::square(&device(), 6).expect("a run"));
    fails(&shapes::half_height(&device(), 8, 50_000.0).expect("a run"));
    fails(&shapes::disc(&device(), 4).expect("a run")[0]);
}

#[test]
fn round_membranes_bear_the_tension_of_their_radius() {
    passes("membrane-round");
    fails(&shapes::cylinder(&device(), 16).expect("a run"));
    fails(&shapes::sphere(&device(), 2).expect("a run"));
}
