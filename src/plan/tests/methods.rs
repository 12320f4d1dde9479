//! The methods: which is taken, and what it decides.

use super::*;

#[test]
fn free_flight_has_no_collisions() {
    let plan = planned(|scene, _| scene.model.method = Some(Method::None)).unwrap();
    assert_eq!((plan.diameter, plan.rounds, plan.occupancy), (0.0, 0, 0.0));
    assert!(plan.mean_free_path.is_infinite());
    // At the pressure of the atmosphere molecules do collide.
    assert!(plan.warnings.len() == 1 && plan.warnings[0].contains("Knudsen number 1.641e-6"), "{:?}", plan.warnings);
    let thin = planned(|scene, _| {
        scene.model.method = Some(Method::None);
        scene.orifices.clear();
        scene.chambers.iter_mut().for_each(|chamber| chamber.pressure = 1e-2);
    });
    assert_eq!(thin.unwrap().warnings, Vec::<String>::new());
    assert!(near(plan.grid.cell, kinetics::mean_spacing(plan.particles as f64 / 0.06), 1e-12));
    let speed = 4.0 * kinetics::thermal_square(980.0, 0.0280134).sqrt();
    assert!(speed * plan.time_step < plan.grid.cell && speed * plan.time_step > 0.95 * plan.grid.cell);
}

/// The method `cell`: six particles in a cell, hardly one of which leaves it in a step, at most two collisions each.
#[test]
fn cells_hold_a_few_particles() {
    let cell = |change: &dyn Fn(&mut Scene)| {
        planned(|scene, _| {
            scene.model.method = Some(Method::Cell);
            change(scene);
        })
        .unwrap()
    };
    let plan = cell(&|_| ());
    let density = plan.particles as f64 / 0.06;
    assert!(near(density * plan.grid.cell.powi(3), 6.0, 1e-9));
    assert_eq!((plan.rounds, plan.collision_limit), (0, 2.0));
    let speed = 4.4 * kinetics::thermal_square(980.0, 0.0280134).sqrt();
    assert!(speed * plan.time_step <= plan.grid.cell && speed * plan.time_step > 0.95 * plan.grid.cell);
    assert!(plan.warnings.len() == 1 && plan.warnings[0].contains("at most 0.03"), "{:?}", plan.warnings);
    let of_cell = plan.reasons.iter().find(|reason| reason.quantity == "collisions per cell").unwrap();
    let closest = planned(|_, _| ()).unwrap();
    assert!(plan.time_step > 2.0 * closest.time_step && plan.diameter == closest.diameter);
    // Dense gas is limited by its collisions: two per particle are six in a cell, where blocks of 384 are densest.
    let dense = cell(&|scene| scene.model.occupancy = Some(0.5));
    let value = |reason: &Reason| reason.value.parse::<f64>().unwrap();
    let most = dense.reasons.iter().find(|reason| reason.quantity == "collisions per cell").unwrap();
    assert!(value(of_cell) < value(most) && near(1.168 * value(most), 6.0, 1e-2), "{} {}", of_cell.value, most.value);
    // Thin gas has the mean free path.
    let thin = cell(&|scene| scene.model.occupancy = Some(0.02));
    assert!(near(thin.grid.cell, thin.mean_free_path, 1e-9) && thin.grid.cell > plan.grid.cell);
    // But no more particles than one thread has time for.
    let thinner = cell(&|scene| scene.model.occupancy = Some(0.001));
    assert!(near(density * thinner.grid.cell.powi(3), 20.0, 1e-9) && thinner.mean_free_path > thinner.grid.cell);
}

/// Rigid spheres touch before their closest approach: larger cells; and the plan says what they do to the pressure.
#[test]
fn rigid_spheres_come_with_a_warning() {
    let plan = planned(|scene, _| scene.model.method = Some(Method::HardSphere)).unwrap();
    assert!(near(plan.occupancy, 0.01, 1e-9));
    let reach = 3.0 * kinetics::thermal_square(980.0, 0.0280134).sqrt() * plan.time_step;
    assert!(plan.grid.cell >= plan.diameter + reach && plan.grid.cell < 1.001 * (plan.diameter + reach));
    assert!(plan.warnings.iter().any(|warning| warning.contains("press 4.1 % harder")), "{:?}", plan.warnings);
}

/// The diameter is that of the mean density, and falls where gas is denser: from 1.5 times on, unless the scene says where.
#[test]
fn the_diameter_is_capped_where_gas_is_dense() {
    let cap = |change: &dyn Fn(&mut Scene)| planned(|scene, _| change(scene));
    let diameter_in = |plan: &Plan, density| kinetics::capped_diameter(plan.diameter, plan.diameter_cap, density);
    let plan = cap(&|_| {}).unwrap();
    let mean = 6.0 * plan.occupancy / (std::f64::consts::PI * plan.diameter.powi(3));
    assert_eq!(plan.diameter_cap, Some(0.7));
    assert_eq!(diameter_in(&plan, 1.49 * mean), plan.diameter);
    assert!(near(diameter_in(&plan, 8.0 * 1.5 * mean), 0.5 * plan.diameter, 1e-3));
    assert!(near(kinetics::occupancy(20.0 * mean, diameter_in(&plan, 20.0 * mean)), 0.18, 3e-3));
    assert!(plan.reasons.iter().any(|reason| reason.quantity == "diameter at most"));
    assert!(!plan.left_out.iter().any(|what| what.contains("local density")));
    // What is asked for is kept at the mean density.
    let large = cap(&|scene| scene.model.occupancy = Some(0.2)).unwrap();
    let mean = 6.0 * large.occupancy / (std::f64::consts::PI * large.diameter.powi(3));
    assert!(near(diameter_in(&large, 1.4 * mean) / large.diameter, 1.0, 1e-12), "{:?}", large.diameter_cap);
    // No denser gas has more than the occupancy that is warned of, unless the mean has.
    let large = cap(&|scene| scene.model.occupancy = Some(0.3)).unwrap();
    let mean = 6.0 * large.occupancy / (std::f64::consts::PI * large.diameter.powi(3));
    assert!(near(diameter_in(&large, mean) / large.diameter, 1.0, 1e-12), "{:?}", large.diameter_cap);
    assert!(near(kinetics::occupancy(8.0 * mean, diameter_in(&large, 8.0 * mean)), 0.3, 1e-9));
    let asked = |spacings| cap(&|scene| scene.model.diameter_cap = Some(DiameterCap::Spacings(spacings)));
    assert_eq!(asked(0.62).unwrap().diameter_cap, Some(0.62));
    assert!(matches!(asked(0.6), Err(PlanError::CapOfAll { asked: 0.6, spacings }) if near(spacings, 0.612, 1e-3)));
    // None where it is not wanted, of no use, or the method has none.
    for none in [
        cap(&|scene| scene.model.diameter_cap = Some(DiameterCap::Off)),
        cap(&|scene| scene.model.method = Some(Method::Cell)),
        planned(|scene, measured| {
            scene.orifices.clear();
            scene.chambers[0].region = None;
            scene.openings.clear();
            measured.openings.clear();
            scene.chambers.truncate(1);
            measured.chamber_volumes.truncate(1);
        }),
    ] {
        assert_eq!(none.unwrap().diameter_cap, None);
    }
    let rigid = cap(&|scene| {
        scene.model.method = Some(Method::HardSphere);
        scene.model.diameter_cap = Some(DiameterCap::Spacings(0.5));
    });
    assert!(matches!(rigid, Err(PlanError::CapOf { method: "hard-sphere" })));
}

/// `half-turn` where nothing stands against it, and the plan says why; else `closest-approach`, and the plan says why not.
#[test]
fn a_continuum_with_wide_holes_takes_half_turn() {
    let unasked = |change: &dyn Fn(&mut Scene, &mut Measured)| {
        let plan = planned(|scene, measured| {
            scene.model = ModelRequest { particles: Some(100_000), ..ModelRequest::default() };
            change(scene, measured);
        })
        .unwrap();
        let why = plan.reasons[0].why.clone();
        assert_eq!((&*plan.reasons[0].quantity, &*plan.reasons[0].value), ("method", plan.method.name()));
        (plan, why)
    };
    let (plan, why) = unasked(&|_, _| ());
    assert_eq!((plan.method, plan.diameter, plan.rounds), (Method::HalfTurn, 0.0, 0));
    // Molecules of air fly 62 nm, the hole has a radius of 40 mm, and d = (.06/1e5)^(1/3) = 8.43 mm.
    assert!(why.contains("Kn 1.641e-6 of its molecules") && why.contains("9.485 mean spacings wide"), "{why}");
    let has = |plan: &Plan, quantity: &str| plan.reasons.iter().any(|reason| reason.quantity == quantity);
    assert!(!has(&plan, "collision number"), "it has none");
    let (closed, why) = unasked(&|_, measured| measured.openings.clear());
    assert!(closed.method == Method::HalfTurn && !why.contains("hole"), "{why}");
    let thin = |scene: &mut Scene, _: &mut Measured| {
        scene.chambers.iter_mut().for_each(|chamber| chamber.pressure *= 1e-4);
        scene.orifices[0].mass_flow.points.iter_mut().for_each(|point| point[1] *= 1e-4);
    };
    type Change = dyn Fn(&mut Scene, &mut Measured);
    let against: [(&Change, &str); 9] = [
        (&|scene, _| scene.model.occupancy = Some(0.1), "it has no `occupancy`"),
        (&|scene, _| scene.model.diameter = Some(2e-3), "it has no `diameter`"),
        (&|scene, _| scene.model.diameter_cap = Some(DiameterCap::Off), "it has no `diameter_cap`"),
        (&|scene, _| scene.model.rounds = Some(4), "it has no `rounds`"),
        (&|scene, _| scene.model.collision_number = Some(5.0), "it has no `collision_number`"),
        (&thin, "rarefied: Kn 0.0164"),
        (&|_, measured| measured.openings[0].length = 3e-6, "rarefied: Kn 0.02"),
        (
            &|_, measured| measured.openings[0].length = 16.8e-3,
            "opening `vent` is 3.984 mean spacings wide, at least 4",
        ),
        (&|_, measured| measured.motion = Some(moving()), "walls move"),
    ];
    for (change, part) in against {
        let (plan, why) = unasked(change);
        assert_eq!(plan.method, Method::ClosestApproach, "{part}");
        assert!(why.contains("; not half-turn: ") && why.contains(part), "{part} is not in {why}");
        assert!(has(&plan, "collision number"));
    }
    // At four spacings it is taken; so is what is asked for, whatever the hole.
    let wide = |scene: &mut Scene, measured: &mut Measured| {
        (scene.model.particles, measured.openings[0].length) = (Some(100_000), 16.9e-3);
    };
    assert_eq!(unasked(&wide).0.method, Method::HalfTurn);
    let named = |scene: &mut Scene, measured: &mut Measured| {
        (scene.model.method, measured.openings[0].length) = (Some(Method::HalfTurn), 1e-3);
    };
    let (plan, why) = unasked(&named);
    assert_eq!((plan.method, &*why), (Method::HalfTurn, "asked for"));
}

/// The number of particles that nobody asked for is that of the method which is taken: d = .1 x .04 / .55 across the hole of
/// `half-turn`. A hole that the most of them leave narrower than four spacings has `closest-approach`.
#[test]
fn the_number_of_particles_is_that_of_the_method() {
    let unasked = |length: f64| {
        planned(|scene, measured| {
            scene.model = ModelRequest::default();
            measured.openings[0].length = length;
        })
        .unwrap()
    };
    let plan = unasked(0.04);
    assert_eq!(plan.method, Method::HalfTurn);
    assert!(near(plan.particles as f64, 0.06 / (0.1 * 0.04 / 0.55f64).powi(3), 0.01), "{}", plan.particles);
    let tiny = unasked(3e-3);
    assert!(tiny.method == Method::ClosestApproach && tiny.particles.abs_diff(10_000_000) < 3, "{}", tiny.particles);
}

fn moving() -> MeasuredMotion {
    MeasuredMotion { final_gas_volume: 0.05, least_share: 0.8, fastest: 10.0 }
}
