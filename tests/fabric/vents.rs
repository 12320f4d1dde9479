//! What fabric does to gas: vents and pores, heat, roughness.

use corpuscle::geometry::{MeshShape, Motion as NodeMotion, TriangleMesh};
use corpuscle::scene::{self, GAS_CONSTANT, Method};
use corpuscle::simulation::{Model, Options, Row};
use tempfile::TempDir;

use crate::scenes::{ALIKE, Scene, inside_and_outside, on_the_wrong_side};
use crate::whole_run::{model_in, run};

const METHODS: [Method; 3] = [Method::None, Method::HalfTurn, Method::ClosestApproach];

fn sphere() -> TriangleMesh {
    MeshShape::Sphere { radius: 0.03, subdivisions: 2 }.mesh([0.05; 3]).expect("a sphere")
}

const INSIDE: &str =
    "[[chamber]]\nname = \"in\"\ninside = \"bag\"\npressure = 2e5\ntemperature = 300.0\ngas = \"air\"\n";
/// Outside of the bag.
const ORIFICE: &str = "[[orifice]]\nname = \"inlet\"\nposition = [0.0, 0.05, 0.05]\ndirection = [1.0, 0.0, 0.0]\n\
    area = 1e-4\ngas = \"air\"\ntemperature = 300.0\nmass_flow = [[0.0, 0.01], [1.0, 0.01]]\n";
const VENT: &str = "discharge = 0.7\narea = 0.0002\nopening_pressure = 2e4\n";

/// A bag at rest without gas around it loses what a vessel of the same mesh does.
#[test]
fn a_bag_blows_down_as_a_vessel_does() {
    let bag = Scene {
        particles: 6000,
        end: 2e-3,
        chambers: format!("external_pressure = 1e5\n{INSIDE}[[vent]]\nname = \"vent\"\nfabric = \"bag\"\n{VENT}"),
        ..Scene::new(Method::HalfTurn, sphere(), None)
    };
    let (_, of_bag) = bag.run();
    let folder = TempDir::new().expect("a folder");
    sphere().write(&folder.path().join("bag.obj"), 1.0).expect("a mesh file");
    let vessel = format!(
        "end_time = 2e-3\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[wall]]\nname = \"bag\"\nshape = \"mesh\"\nfile = \"bag.obj\"\ngas = \"inside\"\n{}\
         [[vent]]\nname = \"vent\"\nwall = \"bag\"\nexternal_pressure = 1e5\n{VENT}\
         [model]\nmethod = \"half-turn\"\nparticles = 6000\n[output]\nrows = 5\nsnapshots = 0\n",
        INSIDE.replace("inside = \"bag\"\n", "")
    );
    let of_vessel = run(&model_in(&vessel, folder.path()), Options::default());
    let [bag, vessel] = [&of_bag, &of_vessel].map(|run| {
        let audit = &run.outcome.audit;
        assert_eq!(audit.particles_vented, audit.particles_initial - run.outcome.particles.len() as u64);
        assert!(audit.energy_error().abs() < 1e-5, "{}", audit.energy_error());
        let last = run.rows.last().expect("rows");
        [last.vents[0].mass / audit.mass_start, last.chambers[0].pressure, audit.enthalpy_vented / audit.energy_start]
    });
    assert_eq!(of_bag.outcome.audit.passed.map(|passed| passed.particles), Some(0));
    eprintln!("left, pressure, enthalpy: bag {bag:?}, vessel {vessel:?}");
    assert!(bag[0] > 0.2, "{bag:?}");
    for (of_bag, of_vessel) in bag.iter().zip(vessel) {
        assert!((of_bag / of_vessel - 1.0).abs() < 0.03, "bag {bag:?}, vessel {vessel:?}");
    }
}

/// Gas leaks through pores at the velocity of the law, rho v(p - p') A, and stays in the run: on the other side. The mean of some seeds is
/// as the law, within three standard errors by their scatter and 1 % for a vent that follows the gas of an earlier interval.
#[test]
fn pores_pass_what_their_law_says_to_the_other_side() {
    for method in METHODS {
        let over: Vec<f64> = (1..=6).map(|seed| mass_over_law(method, seed)).collect();
        let number = over.len() as f64;
        let mean = over.iter().sum::<f64>() / number;
        let square: f64 = over.iter().map(|over| (over - mean) * (over - mean)).sum();
        let error = (square / (number * (number - 1.0))).sqrt();
        eprintln!("{}: {mean:.4} +- {error:.4} of the law", method.name());
        assert!(error < 0.01, "{}: {over:?} says nothing", method.name());
        assert!((mean - 1.0).abs() < 3.0 * error + 0.01, "{}: {over:?}", method.name());
    }
}

/// What has passed pores, over their law.
fn mass_over_law(method: Method, seed: u32) -> f64 {
    {
        let scene = Scene {
            seed,
            particles: 20_000,
            end: 4e-4,
            step: Some(5e-7),
            rows: 8,
            chambers: inside_and_outside(3e5, 1e5)
                + "[[vent]]\nname = \"pores\"\nfabric = \"bag\"\nleak_velocity = [[0.0, 0.0], [2e5, 5.0]]\n",
            ..Scene::new(method, sphere(), None)
        };
        let (model, run) = scene.run();
        let (audit, name) = (&run.outcome.audit, method.name());
        assert_eq!(run.outcome.particles.len() as u64, audit.particles_initial, "{name}");
        assert!(
            on_the_wrong_side(&model, &run, scene.end).is_empty()
                && audit.passed.is_some_and(|passed| passed.particles == 0),
            "{name}"
        );
        assert!(audit.energy_error().abs() < 1e-5 && audit.mass_error() == 0.0, "{name}: {audit:?}");
        let (passed, mass) = audit.through_fabric.expect("pores");
        let inside = run.outcome.particles.iter().filter(|particle| particle.is_inside()).count() as u64;
        assert_eq!(model.plan.chambers[0].particles.iter().sum::<u64>() - inside, passed, "{name}");
        // By the gas of each row. (A vent follows the gas of the interval before last, and makes up for it.)
        let law = |row: &Row| {
            let [inside, outside] = [&row.chambers[0], &row.chambers[1]];
            let velocity = 5.0 * (inside.pressure - outside.pressure) / 2e5;
            inside.density * velocity * row.fabrics[0].area * (row.window[1] - row.window[0])
        };
        let expected: f64 = run.rows.iter().map(law).sum();
        let [first, last] = [&run.rows[0], run.rows.last().expect("rows")];
        eprintln!("{name}: {passed} passed, {mass:.4e} kg where {expected:.4e} is the law");
        assert!(passed > 500 && (last.vents[0].mass / mass - 1.0).abs() < 1e-9, "{name}: {mass}");
        // With its enthalpy, as gas of the control volume.
        let heat = last.vents[0].enthalpy / (mass * 3.5 * GAS_CONSTANT / 0.029 * 300.0);
        assert!((0.93..1.03).contains(&heat), "{name}: {heat} of the enthalpy at the start");
        // (In free flight nothing evens out what the fastest take away.)
        let reference = corpuscle::simulation::reference(&model, &[last.time]);
        for (state, of_volume) in last.chambers.iter().zip(&reference[0]).filter(|_| method != Method::None) {
            assert!((state.pressure / of_volume.pressure - 1.0).abs() < 0.03, "{name}: {state:?}, {of_volume:?}");
        }
        // Pressures come together.
        let apart = |row: &Row| row.chambers[0].pressure - row.chambers[1].pressure;
        assert!(apart(last) < 0.9 * apart(first), "{name}");
        mass / expected
    }
}

/// A shaken bag of warm, rough fabric that leaks: each side is known, and the account closes.
#[test]
fn nothing_is_lost_through_fabric_that_is_shaken() {
    for method in METHODS {
        let (step, steps) = (2e-6, 150);
        let end = step * f64::from(steps);
        let shake = NodeMotion::Shake { speed: 100.0, amplitude: Some(1e-3), seed: 5 };
        let frames = shake.frames(&sphere(), 44, end).expect("frames");
        let scene = Scene {
            end,
            step: Some(step),
            chambers: "temperature = 400.0\naccommodation = 0.4\nfriction = 0.5\n".to_string()
                + &inside_and_outside(3e5, 1e5)
                + "[[vent]]\nname = \"vent\"\nfabric = \"bag\"\nface = \"sphere\"\nposition = [0.05, 0.05, 0.08]\n\
                   diameter = 0.04\narea = 1e-4\ndischarge = 0.6\n\
                   [[vent]]\nname = \"pores\"\nfabric = \"bag\"\nleak_velocity = [[0.0, 5.0], [2e5, 20.0]]\n",
            ..Scene::new(method, sphere(), Some(frames))
        };
        let (model, run) = scene.run();
        let (audit, name) = (&run.outcome.audit, method.name());
        let wrong = on_the_wrong_side(&model, &run, end);
        let last = run.rows.last().expect("rows");
        eprintln!("{name}: {:?}, wrong {}, energy off {:.1e}", audit.through_fabric, wrong.len(), audit.energy_error());
        assert!(wrong.is_empty() && audit.passed.is_some_and(|passed| passed.particles == 0), "{name}: {wrong:?}");
        assert_eq!((audit.particles_outside, audit.truncated_flights), (0, 0), "{name}");
        assert_eq!(run.outcome.particles.len() as u64, audit.particles_initial, "{name}");
        assert!(audit.energy_error().abs() < 1e-5, "{name}: {audit:?}");
        assert!(last.vents.iter().all(|vent| vent.mass > 0.0) && last.walls[0].heat != 0.0, "{name}: {:?}", last.vents);
        assert!(audit.work_by_walls.is_some_and(|work| work.abs() > 1e-3 * audit.energy_start), "{name}");
    }
}

/// In free flight a fabric of 600 K gives gas of 300 K on both sides c cbar/4 (2 + 1) R 300 K, before what it has heated comes back.
#[test]
fn warm_fabric_heats_both_sides() {
    let scene = Scene {
        particles: 40_000,
        end: 2e-5,
        step: Some(1e-6),
        rows: 1,
        chambers: format!("temperature = 600.0\n{ALIKE}"),
        ..Scene::new(Method::None, sphere(), None)
    };
    let (model, run) = scene.run();
    let concentration = 1e5 / (GAS_CONSTANT * 300.0);
    let mean_speed = (8.0 * GAS_CONSTANT * 300.0 / (std::f64::consts::PI * 0.029)).sqrt();
    let expected = -0.25 * concentration * mean_speed * 3.0 * GAS_CONSTANT * 300.0;
    let found = run.rows[0].walls[0].heat_flux;
    let area = model.fabric.measures(0.0)[0][1];
    let taken = run.outcome.audit.heat_to_walls.expect("heat") / (2.0 * area * 2e-5);
    eprintln!("{found:.4e} W/m2 and {taken:.4e}, expected {expected:.4e} on each side");
    assert!((found / expected - 1.0).abs() < 0.06, "{found} W/m2, expected {expected}");
    assert!((taken / found - 1.0).abs() < 1e-6 && run.outcome.audit.energy_error().abs() < 1e-5);
}

#[test]
fn what_vents_on_fabric_cannot_be_is_told() {
    let said = |mesh: TriangleMesh, chambers: &str| {
        let scene = Scene { chambers: chambers.into(), ..Scene::new(Method::HalfTurn, mesh, None) };
        let folder = TempDir::new().expect("a folder");
        match scene::parse(&scene.text(&folder), "test.toml", folder.path()) {
            Err(error) => format!("{error:?}"),
            Ok(scene) => Model::new(scene).map_or_else(|error| error.to_string(), |_| "nothing".into()),
        }
    };
    let with = |chambers: &str, keys: &str| {
        format!("{chambers}[[vent]]\nname = \"vent\"\nfabric = \"bag\"\ndischarge = 0.1\n{keys}")
    };
    assert_eq!(said(sphere(), &with(INSIDE, "")), "nothing");
    let mut open = sphere();
    open.triangles.pop();
    open.parts.pop();
    for (mesh, text, told) in [
        (open, format!("external_pressure = 1e5\n{INSIDE}"), "an open sheet has no outside"),
        (sphere(), with(ALIKE, ""), "none is `inside` of this fabric"),
        (sphere(), with(INSIDE, "face = \"lid\"\n"), "the parts of its mesh are: \"sphere\""),
        (
            sphere(),
            format!("[[fabric.part]]\nface = \"lid\"\nfriction = 0.5\n{ALIKE}"),
            "fabric \"bag/lid\": its mesh has no such part, and the parts of its mesh are: \"sphere\"",
        ),
        (sphere(), with(INSIDE, "position = [0.0, 0.0, 0.0]\ndiameter = 0.01\n"), "has no triangle"),
        (sphere(), with(INSIDE, "external_pressure = 1e5\n"), "`external_pressure` of a vent on fabric"),
        (sphere(), format!("external_pressure = 1e5\n{INSIDE}{ORIFICE}"), "orifice \"inlet\" lies outside"),
        (sphere(), with(INSIDE, "wall = \"box\"\n"), "both `wall` and `fabric`"),
        (sphere(), with(INSIDE, "").replace("fabric = \"bag\"", ""), "exactly one of `wall`, `fabric`"),
    ] {
        let said = said(mesh, &text);
        assert!(said.contains(told), "{told}: {said}");
    }
}
