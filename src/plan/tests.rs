use super::*;
use crate::gas::kinetics;
use crate::geometry::Passage;
use crate::scene::*;

mod gases;

fn gas(name: &str, molar_mass: f64, cv: f64) -> Gas {
    Gas { name: name.into(), molar_mass, heat: HeatCapacity::Constant(cv * GAS_CONSTANT) }
}

fn chamber(name: &str) -> Chamber {
    let mixture = Mixture(vec![(0, 1.0)]);
    Chamber { name: name.into(), region: None, pressure: 101_325.0, temperature: 293.0, mixture }
}

/// A box of a metre around gas.
fn wall(name: &str) -> Wall {
    let shape = Shape::Box { min: [0.0; 3], max: [1.0; 3], thickness: None, holes: vec![] };
    Wall { name: name.into(), shape, gas: GasSide::Inside, surface: SurfaceModel::default(), parts: vec![] }
}

/// The published tank: 60 L of air, 78.2 g of nitrogen at 700 K in 60 ms, a hole of 40 x 40 mm.
pub(in crate::plan) fn tank() -> (Scene, Measured) {
    let peak = 0.0782 / (0.5 * 0.01 + 0.5 * (1.0 + 0.25) * 0.02 + 0.5 * 0.25 * 0.03);
    let inflator = Orifice {
        name: "inflator".into(),
        position: [0.0; 3],
        direction: [1.0, 0.0, 0.0],
        area: 1e-4,
        mass_flow: Curve { points: vec![[0.0, 0.0], [0.01, peak], [0.03, 0.25 * peak], [0.06, 0.0]] },
        temperature: Curve { points: vec![[0.0, 700.0]] },
        mixture: Mixture(vec![(1, 1.0)]),
        jet: None,
    };
    let scene = Scene {
        title: "tank".into(),
        units: UnitSystem::Si,
        end_time: 0.1,
        seed: 1,
        gases: vec![gas("air", 0.0289647, 2.5), gas("nitrogen", 0.0280134, 2.5)],
        walls: vec![],
        chambers: vec![chamber("inner box"), chamber("tank")],
        openings: vec![],
        orifices: vec![inflator],
        probes: vec![],
        surfaces: vec![],
        vents: vec![],
        motions: vec![],
        model: ModelRequest { particles: Some(1_000_000), ..ModelRequest::default() },
        output: OutputRequest { rows: 200, snapshots: 10 },
        lines: Lines::default(),
    };
    let hole = Opening { name: "vent".into(), between: [0, 1], area: 1.6e-3, length: 0.04 };
    let measured = Measured {
        gas_volume: 0.06,
        chamber_volumes: vec![0.002304, 0.057696],
        bounds_min: [0.0; 3],
        bounds_max: [0.4, 0.4, 0.4],
        openings: vec![hole],
        smallest_gap: None,
        thinnest_body: None,
        wall_area: 1.0,
        probe_volumes: vec![],
        vents: vec![],
        modelled_surfaces: vec![],
        motion: None,
        walls: vec![],
        open_to_empty: false,
        touching: vec![],
        open_sections: vec![],
        hindered: vec![],
        gaps_beside: vec![],
        strokes: vec![],
        dry_motions: vec![],
        dry_surfaces: vec![],
        sources: vec![],
        backed_vents: vec![],
        facing_orifices: vec![],
    };
    (scene, measured)
}

fn planned(change: impl FnOnce(&mut Scene, &mut Measured)) -> Result<Plan, PlanError> {
    let (mut scene, mut measured) = tank();
    change(&mut scene, &mut measured);
    plan(&scene, &measured)
}

fn near(found: f64, expected: f64, tolerance: f64) -> bool {
    (found / expected - 1.0).abs() < tolerance
}

/// At equal moles per particle a million are 472,000 of air and 528,000 from the inflator.
#[test]
fn the_tank_at_a_million() {
    let plan = planned(|_, _| ()).unwrap();
    assert!(plan.initial_particles.abs_diff(472_000) < 500, "{}", plan.initial_particles);
    assert!(plan.injected_particles.abs_diff(528_000) < 500, "{}", plan.injected_particles);
    assert!(plan.particles.abs_diff(1_000_000) <= 2);
    assert_eq!(plan.gases[0].particles, plan.initial_particles);
    // U = U0 + H: (2.4956 x 293 + 1.4 x 2.7915 x 700) / 5.2871 = 655.8 K; filling reaches 1.4 x 700 K.
    assert!(near(plan.temperature_reference, 655.8, 1e-3), "{}", plan.temperature_reference);
    assert!(near(plan.temperature_max, 980.0, 1e-12));
    assert!(near(plan.diameter, 2.396e-3, 1e-3) && near(plan.occupancy, 0.12, 1e-5));
    // By the cells: sigma / (6 sqrt(R 980 / M)) = 7.40e-7 s, h = sigma sqrt(1.25).
    assert!(near(plan.time_step, 7.40e-7, 2e-3), "{}", plan.time_step);
    assert!(near(plan.grid.cell, 2.396e-3 * 1.25f64.sqrt(), 1e-3), "{}", plan.grid.cell);
    assert_eq!((plan.rounds, plan.collision_limit, plan.block_cells_log2), (8, 0.5, 3));
    assert!(plan.warnings.is_empty(), "{:?}", plan.warnings);
    // The check can fail: heavier inflator gas is fewer particles.
    let heavy = planned(|scene, _| scene.gases[1].molar_mass = 0.044).unwrap();
    assert!(heavy.injected_particles < 450_000);
}

#[test]
fn a_plan_keeps_its_invariants() {
    let holds = |plan: &Plan, scene: &Scene| {
        let steps = plan.end_time / plan.time_step;
        let lightest = scene.gases.iter().map(|gas| gas.molar_mass).fold(f64::INFINITY, f64::min);
        let fastest = 6.0 * kinetics::thermal_square(plan.temperature_max, lightest).sqrt();
        let reach = (plan.diameter.powi(2) + (0.5 * fastest * plan.time_step).powi(2)).sqrt();
        let counted: u64 = plan.chambers.iter().flat_map(|chamber| &chamber.particles).sum();
        (steps - steps.round()).abs() < 1e-6
            && plan.grid.cell >= reach
            && plan.grid.cell < 1.001 * reach
            && counted == plan.initial_particles
            && plan.particles == plan.initial_particles + plan.injected_particles
            && plan.particles == plan.gases.iter().map(|gas| gas.particles).sum::<u64>()
    };
    for particles in [2_000, 20_000, 300_000, 1_000_000] {
        for time_step in [None, Some(1e-6), Some(3.3e-6)] {
            for end_time in [0.1, 0.037] {
                let (mut scene, measured) = tank();
                scene.end_time = end_time;
                scene.model.particles = Some(particles);
                scene.model.time_step = time_step;
                let mut plan = plan(&scene, &measured).unwrap();
                assert!(holds(&plan, &scene));
                assert!(time_step.is_none_or(|asked| plan.time_step <= asked * (1.0 + 1e-9)));
                plan.grid.cell *= 0.999;
                assert!(!holds(&plan, &scene), "a smaller cell breaks the rule");
            }
        }
    }
}

/// A step that divides the end time is kept; thin gas is limited by the cells, a smaller x limit by tau.
#[test]
fn time_steps() {
    let step = |step| planned(|scene, _| scene.model.time_step = Some(step)).unwrap().time_step;
    assert!(near(step(0.1 / 130_000.0), 0.1 / 130_000.0, 1e-12));
    let rounds = |rounds| planned(|scene, _| scene.model.rounds = Some(rounds)).unwrap();
    let two = rounds(2);
    let state = kinetics::thermal_square(two.temperature_reference, 0.02845);
    let tau = kinetics::collision_time(two.particles as f64 / 0.06, two.diameter, state);
    // .1 in blocks that are denser and hotter than the mean by three standard errors of their particles.
    let in_block = two.particles as f64 / 0.06 * (two.grid.cell * f64::from(1 << two.block_cells_log2)).powi(3);
    let uneven = 1.0 + 1.0 / in_block + 3.0 * (1.0 / in_block + 1.0 / (6.0 * in_block)).sqrt();
    assert!(near(uneven * two.time_step / tau, 0.1, 5e-3), "{} {uneven}", two.time_step / tau);
    assert!((1.2..1.45).contains(&uneven));
    assert!(rounds(1).time_step < 0.25 * two.time_step && two.time_step < rounds(3).time_step);
    assert!(rounds(1).warnings.is_empty());
}

/// An inflow after the end does not count.
#[test]
fn mass_beyond_the_end_does_not_count() {
    let whole = planned(|_, _| ()).unwrap();
    let short = planned(|scene, _| scene.end_time = 0.01).unwrap();
    assert!(short.particles.abs_diff(1_000_000) <= 2);
    assert!(short.injected_particles < whole.injected_particles / 2);
    assert!(short.moles_per_particle < whole.moles_per_particle);
}

#[test]
fn particles_are_chosen_by_noise_or_resolution() {
    let unasked = |change: &dyn Fn(&mut Scene, &mut Measured)| {
        planned(|scene, measured| {
            scene.model.particles = None;
            change(scene, measured);
        })
        .unwrap()
    };
    // No opening: 5.1 x .06 / (700 x .0096 x 1e-3 x .0025) = 1.8e4.
    let noise = unasked(&|_, measured| measured.openings.clear());
    assert!((15_000..22_000).contains(&noise.particles), "{}", noise.particles);
    // d = .1 x .04 / .79, N = .06 / d^3 = 4.6e5.
    let resolved = unasked(&|_, _| ());
    assert!(near(resolved.particles as f64, 4.62e5, 0.01), "{}", resolved.particles);
    assert!(resolved.openings[0].knudsen <= 0.1 && resolved.warnings.is_empty());
    assert!(resolved.reasons.iter().any(|reason| reason.quantity == "particles" && reason.why.contains("Kn 0.1")));
    let tiny = unasked(&|_, measured| measured.openings[0].length = 1e-3);
    assert!(tiny.particles.abs_diff(10_000_000) < 3);
    let free = unasked(&|scene, _| scene.model.method = Some(Method::None));
    assert_eq!(free.particles, noise.particles);
}

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
    assert!(matches!(refused(&|s, _| s.model.particles = Some(1 << 28)), TooManyParticles { .. }));
    assert!(planned(|s, _| s.model.particles = Some((1 << 28) - 10)).is_ok());
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

/// A switch is told with when.
#[test]
fn a_switch_is_among_the_reasons() {
    let plan = planned(|scene, _| scene.model.switch = Some(Switch::At(0.02))).unwrap();
    let told = plan.reasons.iter().find(|reason| reason.quantity == "control volume").unwrap();
    assert_eq!(told.value, "at 20 ms");
    assert!(planned(|_, _| ()).unwrap().reasons.iter().all(|reason| reason.quantity != "control volume"));
}

#[test]
fn equal_scenes_give_equal_text() {
    let plan = planned(|scene, _| scene.model.particles = Some(20_000)).unwrap();
    let again = planned(|scene, _| scene.model.particles = Some(20_000)).unwrap();
    assert_eq!(plan, again);
    let text = plan.render();
    for part in ["time step", "20,000", "inner box", "nitrogen", "vent", "warning: opening `vent`"] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    let toml: toml::Table = plan.to_toml().unwrap().parse().unwrap();
    assert_eq!(toml["particles"].as_integer(), Some(plan.particles as i64));
    assert_eq!(toml["time_step"].as_float(), Some(plan.time_step));
    assert_eq!(toml["grid"]["cells"].as_array().map(Vec::len), Some(3));
    let free = planned(|scene, _| scene.model.method = Some(Method::None)).unwrap();
    assert!(free.to_toml().unwrap().contains("mean_free_path = inf"));
    assert_ne!(free.render(), text);
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
