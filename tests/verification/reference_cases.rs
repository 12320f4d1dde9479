//! The cases of `corpuscle verify` that no other test here runs, as `--quick` runs them: every row passes. And that such
//! rows can fail: gas without collisions is no continuum, and does not pass as one.

use corpuscle::scene::{GAS_CONSTANT, HeatCapacity, Method, Scene};
use corpuscle::study::pareto::Setting;
use corpuscle::study::verify::tube::Tube;
use corpuscle::study::verify::waves::{DIFFUSIVITY, Waves};
use corpuscle::study::verify::{CASES, Check, Effort, Verdict, collisions, holes, noh, shear, sod, sound, thin_wall};

use crate::equilibrium_box::EquilibriumBox;
use crate::whole_run::device;

/// Runs a case and expects every row to pass.
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
fn a_collision_at_closest_approach_has_no_virial() {
    passes("virial");
    // Rigid spheres are pushed apart along what parts them.
    let gas = EquilibriumBox { method: "hard-sphere", particles: 4000, steps: 20, ..EquilibriumBox::default() };
    let (found, pairs) = collisions::virial(&device(), &gas).expect("a run");
    println!("rigid spheres: {found} of {pairs} pairs");
    assert!(pairs > 100 && found.abs() > 0.1, "{found} of {pairs} pairs");
}

#[test]
fn shock_tubes_are_those_of_the_exact_solution() {
    passes("sod");
    // Free flight has a mean |difference| of .06 in the density and .16 in the velocity (method.md, "Collisions").
    let (checks, _) = sod::against(&device(), 40_000, 1.4, Method::None, 0).expect("a run");
    checks.iter().for_each(fails);
}

#[test]
#[ignore = "half a minute: scripts/test.sh --long; `corpuscle verify sod-monatomic` runs the case too"]
fn monatomic_shock_tubes_are_those_of_the_exact_solution() {
    passes("sod-monatomic");
    // Of free flight, as with gamma 7/5.
    let (checks, _) = sod::against(&device(), 40_000, 5.0 / 3.0, Method::None, 0).expect("a run");
    checks.iter().for_each(fails);
}

#[test]
#[ignore = "a minute or two: scripts/test.sh --long; `corpuscle verify expansion` runs the case too"]
fn expansion_into_a_vacuum_is_that_of_the_exact_solution() {
    passes("expansion");
    fails(&sod::expanded(&device(), 40_000, Method::None).expect("a run"));
}

#[test]
#[ignore = "a minute or two: scripts/test.sh --long; `corpuscle verify sound` runs the case too"]
fn a_standing_wave_has_the_speed_of_sound() {
    passes("sound");
    // Rigid spheres of f = .1 have sound that is 15 % faster (docs/explanation/method.md, "Collisions").
    let rigid = Setting {
        method: Some(Method::HardSphere),
        particles: Some(24_000),
        occupancy: Some(0.1),
        ..Setting::default()
    };
    fails(&sound::frequency(&device(), &rigid, 0.03).expect("a run"));
}

#[test]
fn vortices_decay_with_the_viscosity_of_the_method() {
    passes("viscosity");
    // At f = .2 it is .54 (docs/explanation/method.md, "Collisions"), where .65 is allowed a tenth of it.
    fails(&shear::at_occupancy(&device(), 0.2, 8000, 3).expect("a run"));
}

#[test]
fn a_chamber_empties_between_isentropically_and_by_effusion() {
    passes("blow-down");
    // Free flight leaves more slowly, Cd .58. (Its .2 so few particles do not know well enough.)
    let free = |scene: &mut Scene| {
        (scene.model.diameter, scene.model.diameter_cap, scene.model.method) = (None, None, Some(Method::None));
    };
    fails(&holes::emptied(&device(), 6000, free).expect("a run").checks[1]);
}

/// A gas of gamma 5/3 has 1/3 in free flight and 2/3 as a continuum.
#[test]
#[ignore = "a minute: scripts/test.sh --long"]
fn a_chamber_of_another_gas_does_not_empty_like_this_one() {
    let monatomic = |scene: &mut Scene| scene.gases[0].heat = HeatCapacity::Constant(1.5 * GAS_CONSTANT);
    fails(&holes::emptied(&device(), 6000, monatomic).expect("a run").checks[0]);
}

#[test]
fn a_strong_shock_tube_is_that_of_the_exact_solution() {
    passes("strong-tube");
    // Free flight is not, nor is it within the limits of a smeared profile.
    let tube = Tube { particles: 40_000, ..sod::STRONG };
    sod::by_method_in(&device(), &tube, Method::None).expect("a run").0.iter().for_each(fails);
}

#[test]
fn gas_of_infinite_mach_number_is_stopped_by_a_shock() {
    passes("noh");
    // Free flight lets the stream and what comes back pass through each other: twice as dense, no spin.
    let behind = noh::behind_the_shock(&device(), Method::None, 20_000, 1.4).expect("a run");
    println!("{behind:?}");
    assert!((behind.density.0 * noh::compression(1.4) - 2.0).abs() < 0.1, "{behind:?}");
    assert_eq!(behind.spin.map(|(found, _)| found), Some(0.0));
}

#[test]
fn a_thin_wall_keeps_what_is_on_its_sides() {
    passes("thin-wall");
    let [cold, hot] = thin_wall::changes(&device(), "half-turn", 4000, 600, false).expect("a run");
    println!("without it {cold:.3} {hot:.3}");
    assert!(cold > 0.01 && hot < -0.01, "{cold} {hot}");
}

#[test]
fn heat_diffuses_as_the_method_lets_it() {
    passes("half-turn-heat");
    // Closest approach has half as much again, and would fail the check.
    let others = Waves { method: "closest-approach", particles: 8000, half_waves: 2, seeds: 4 };
    let (found, error) = others.heat(&device()).expect("runs");
    println!("closest approach {found:.3} +- {error:.3}");
    assert!(found - 3.0 * error > DIFFUSIVITY + 0.05, "{found} +- {error}");
}
