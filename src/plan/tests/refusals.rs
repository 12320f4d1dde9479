//! What a plan warns of, and what it refuses.

use super::*;

/// Each warning fires when it should; `the_tank_at_a_million` has none of them.
#[test]
fn warnings_fire() {
    let warns = |part: &str, change: &dyn Fn(&mut Scene, &mut Measured)| {
        let plan = planned(|scene, measured| change(scene, measured)).unwrap();
        assert!(plan.warnings.iter().any(|warning| warning.contains(part)), "{part}: {:?}", plan.warnings);
    };
    warns("Knudsen", &|scene, _| scene.model.particles = Some(20_000));
    let into_thin = |share: f64| {
        planned(|scene, _| scene.chambers[1].pressure *= share).unwrap().warnings.iter().any(|w| w.contains("fronts"))
    };
    assert!(into_thin(1e-3) && !into_thin(0.6) && !into_thin(1.0));
    warns("are few", &|scene, _| scene.model.particles = Some(900));
    let gap = |length| Some(Passage { length, walls: [0, 1], middle: [0.1, 0.0, -0.02] });
    let walled = |scene: &mut Scene| scene.walls = vec![wall("tank"), wall("plate")];
    warns(
        "the smallest passage, 2 mm between walls `tank` and `plate` near (100, 0, -20) mm, with",
        &|scene, measured| {
            walled(scene);
            measured.smallest_gap = gap(2e-3);
        },
    );
    warns("a modelled vent; let the walls overlap if they were meant to touch", &|scene, measured| {
        walled(scene);
        measured.smallest_gap = gap(2e-3);
    });
    warns("the smallest passage, 2 mm of opening `vent`, with", &|_, measured| measured.openings[0].length = 2e-3);
    warns("the thinnest body, 0.0001 mm: thickness", &|_, measured| measured.thinnest_body = Some(1e-7));
    warns(
        "the narrowest gap, 0.0001 mm between walls `tank` and `plate` near (100, 0, -20) mm: thickness",
        &|scene, measured| {
            walled(scene);
            measured.smallest_gap = gap(1e-7);
        },
    );
    warns("occupancy", &|scene, _| scene.model.occupancy = Some(0.35));
    warns("lost", &|scene, _| scene.model.time_step = Some(3e-6));
    warns("wall hits", &|_, measured| measured.wall_area = 1e4);
    warns("chamber `inner box` at the start: occupancy 0.", &|scene, _| {
        scene.chambers[0].pressure = 1e6;
        scene.model.diameter_cap = Some(DiameterCap::Off);
    });
    warns("lost", &|scene, _| {
        scene.model.rounds = Some(1);
        scene.model.time_step = Some(3e-7);
    });
    warns("fly", &|scene, _| {
        scene.model.method = Some(Method::None);
        scene.model.time_step = Some(3e-6);
    });
    for part in ["fly", "over collision time"] {
        warns(part, &|scene, _| {
            scene.model.method = Some(Method::Cell);
            scene.model.time_step = Some(3e-5);
        });
    }
    warns("a cell of", &|scene, measured| {
        scene.model.method = Some(Method::Cell);
        measured.openings[0].length = 2e-3;
    });
}

#[test]
fn what_cannot_be_planned_is_refused() {
    use PlanError::*;
    let refused = |change: &dyn Fn(&mut Scene, &mut Measured)| planned(|s, m| change(s, m)).unwrap_err();
    let empty = refused(&|scene, _| scene.model.particles = Some(20));
    let EmptyChamber { needed, .. } = &empty else { panic!("{empty}") };
    let needed = *needed;
    assert!(planned(|scene, _| scene.model.particles = Some(needed)).is_ok(), "the help's number must do");
    assert!(matches!(refused(&|s, _| s.model.particles = Some(1 << 27)), TooManyParticles { .. }));
    assert!(planned(|s, _| s.model.particles = Some((1 << 27) - 10)).is_ok());
    assert!(matches!(refused(&|s, _| s.model.diameter = Some(1e-6)), Grid(_)));
    let refined = |s: &mut Scene, _: &mut Measured| (s.model.diameter, s.model.time_step) = (Some(1e-4), Some(1e-8));
    assert!(matches!(refused(&refined), TooManyCells { .. }));
    assert_eq!(refused(&|s, _| s.model.rounds = Some(0)), Rounds { found: 0, limit: 8 });
    assert!(matches!(refused(&|s, _| s.model.collision_number = Some(1.0)), CollisionNumber { .. }));
    assert!(matches!(refused(&|_, m| m.chamber_volumes[0] = 0.0), NoVolume { .. }));
    assert_eq!(refused(&|_, m| m.chamber_volumes.truncate(1)), Volumes { volumes: 1, chambers: 2 });
    assert!(matches!(refused(&|s, _| s.gases = vec![s.gases[0].clone(); 17]), TooManyGases { .. }));
    let nothing = |s: &mut Scene, m: &mut Measured| {
        s.chambers.clear();
        s.orifices.clear();
        m.chamber_volumes.clear();
    };
    assert_eq!(refused(&nothing), NoGas);
    let late = |s: &mut Scene, _: &mut Measured| s.model.switch = Some(Switch::At(s.end_time));
    assert!(matches!(refused(&late), SwitchTime { .. }));
    let unseen = |s: &mut Scene, _: &mut Measured| {
        (s.probes, s.surfaces) = (Vec::new(), Vec::new());
        s.model.switch = Some(Switch::WhenUniform { lasting: 1e-3 });
    };
    assert_eq!(refused(&unseen), SwitchUnseen);
    let long = |s: &mut Scene, _: &mut Measured| s.model.switch = Some(Switch::WhenUniform { lasting: s.end_time });
    assert!(matches!(refused(&long), SwitchTime { .. }));
    let rigid = |s: &mut Scene, _: &mut Measured| {
        s.model.method = Some(Method::HardSphere);
        s.surfaces = vec![Surface { name: "wall".into(), wall: 0, face: None }];
        s.model.switch = Some(Switch::WhenUniform { lasting: 1e-3 });
    };
    assert_eq!(refused(&rigid), SwitchOfRigidSpheres);
}
