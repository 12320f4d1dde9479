use super::chooser::AIM;
use super::*;
use crate::plan::forecast::{SeenProbe, SeenSurface};
use crate::plan::tests::tank;
use crate::plan::{Plan, plan};
use crate::scene::types::ModelRequest;
use crate::scene::{DiameterCap, Face, Probe, Region, Surface, Switch};

/// The published tank with a wall that is measured and a probe before the hole.
fn seen() -> (Scene, Measured, Outlook) {
    let (mut scene, measured) = tank();
    scene.model = ModelRequest::default();
    scene.surfaces = vec![Surface { name: "far".into(), wall: 0, face: Some(Face::Box { axis: 0, positive: true }) }];
    let region = Region::Box { min: [0.25, -0.03, -0.03], max: [0.31, 0.03, 0.03] };
    scene.probes = vec![Probe { name: "jet".into(), region }];
    let outlook = Outlook {
        sources: vec![Some(0)],
        surfaces: vec![SeenSurface { faces: vec![(1, 0.15)], whole: false }],
        probes: vec![SeenProbe { chamber: 1, volume: 2.16e-4 }],
        ..Outlook::default()
    };
    (scene, measured, outlook)
}

fn chosen(change: impl FnOnce(&mut ModelRequest)) -> Result<Choice, PlanError> {
    let (mut scene, measured, outlook) = seen();
    change(&mut scene.model);
    choose(&scene, &measured, &outlook)
}

fn wished(accuracy: f64) -> Choice {
    chosen(|model| model.wish.accuracy = Some(accuracy)).unwrap()
}

/// A smaller error takes more particles and costs more; the probe in the jet keeps a control volume from sufficing.
#[test]
fn smaller_errors_cost_more() {
    let (coarse, fine) = (wished(0.1), wished(0.04));
    assert!(coarse.forecast.error <= 0.1 && fine.forecast.error <= 0.04);
    assert_eq!(fine.request.method, Some(Method::HalfTurn));
    assert!(fine.request.particles > coarse.request.particles);
    assert!(fine.forecast.seconds > 2.0 * coarse.forecast.seconds);
    // Neither is finer than it must be: a tenth less particles would miss what was aimed at.
    for (choice, accuracy) in [(&coarse, 0.1), (&fine, 0.04)] {
        assert!(choice.forecast.error > 0.93 * AIM * accuracy, "{}", choice.forecast.error);
    }
}

/// Gas that flows into space of no chamber is in no forecast and in no control volume; nor is what passes between chambers that touch.
#[test]
fn empty_space_and_open_borders_are_no_control_volume() {
    let (mut scene, mut measured, mut outlook) = seen();
    scene.probes.clear();
    outlook.probes.clear();
    scene.model.wish.accuracy = Some(0.06);
    let method = |scene: &Scene, measured: &Measured, outlook: &Outlook| {
        choose(scene, measured, outlook).map(|choice| choice.request.method)
    };
    assert_eq!(method(&scene, &measured, &outlook), Ok(Some(Method::ControlVolume)));
    // Of the same gas on both sides.
    outlook.borders = vec![[0, 1]];
    let first = scene.chambers[0].clone();
    scene.chambers[1] = crate::scene::Chamber { name: "other".into(), region: None, ..first.clone() };
    assert_eq!(method(&scene, &measured, &outlook), Ok(Some(Method::ClosestApproach)));
    outlook.borders.clear();
    // What holes have is in no chamber either.
    measured.gas_volume = measured.chamber_volumes.iter().sum::<f64>() / 0.995;
    assert_eq!(method(&scene, &measured, &outlook), Ok(Some(Method::ControlVolume)));
    measured.gas_volume *= 1.02;
    let refused = method(&scene, &measured, &outlook).unwrap_err();
    assert!(refused.to_string().starts_with("an accuracy or a budget: 2.45"), "{refused}");
    scene.model = ModelRequest { method: Some(Method::ControlVolume), ..ModelRequest::default() };
    assert!(matches!(plan(&scene, &measured), Err(PlanError::EmptySpace { .. })));
    scene.model.method = Some(Method::ClosestApproach);
    assert!(plan(&scene, &measured).is_ok());
    scene.model.switch = Some(Switch::At(0.5 * scene.end_time));
    assert!(matches!(plan(&scene, &measured), Err(PlanError::EmptySpace { asked: "`switch`", .. })));
}

/// Why a method was taken is what it was taken for: its cost within an accuracy, its error within a budget.
#[test]
fn the_reason_for_the_method_is_the_one_that_counted() {
    let why = |choice: Choice| {
        let (mut scene, measured, _) = seen();
        scene.model = choice.request.clone();
        let mut planned = plan(&scene, &measured).unwrap();
        choice.explain(&mut planned);
        planned.reasons.into_iter().find(|reason| reason.quantity == "method").unwrap().why
    };
    let within = why(chosen(|model| model.wish.particle_budget = Some(200_000)).unwrap());
    assert!(within.starts_with("the least error within the budget"), "{within}");
    let accurate = why(wished(0.06));
    assert!(accurate.starts_with("a control volume does not suffice: "), "{accurate}");
    assert!(!accurate.contains("()"), "{accurate}");
}

/// Half-turn is taken where it is cheaper, and the plan says than what; not where the gas itself is rarefied, where a
/// key of another method is given, or with so few particles that a hole is less than five spacings wide.
#[test]
fn half_turn_is_chosen_where_it_is_cheaper() {
    let planned = |change: &dyn Fn(&mut Scene)| {
        let (mut scene, measured, outlook) = seen();
        scene.model.wish.accuracy = Some(0.02);
        change(&mut scene);
        let choice = choose(&scene, &measured, &outlook).unwrap();
        scene.model = choice.request.clone();
        let mut planned = plan(&scene, &measured).unwrap();
        choice.explain(&mut planned);
        let why =
            |of: &str| planned.reasons.iter().find(|reason| reason.quantity == of).map(|reason| reason.why.clone());
        (choice.request.method, choice.forecast.seconds, why("method").unwrap(), why("methods compared").unwrap())
    };
    let (method, seconds, why, _) = planned(&|_| ());
    assert_eq!(method, Some(Method::HalfTurn));
    let (_, others, ..) = planned(&|scene| scene.model.method = Some(Method::ClosestApproach));
    assert!(others > 5.0 * seconds, "{seconds} s of {others} s");
    assert!(why.contains("; closest-approach with ") && why.contains(" would cost "), "{why}");
    let (method, _, _, compared) = planned(&|scene| scene.model.collision_number = Some(5.0));
    assert_eq!(method, Some(Method::ClosestApproach));
    assert!(compared.contains("not half-turn: it has no `collision_number`"), "{compared}");
    let thinner = |times: f64| {
        planned(&|scene: &mut Scene| {
            scene.chambers.iter_mut().for_each(|chamber| chamber.pressure *= times);
            scene.orifices[0].mass_flow.points.iter_mut().for_each(|point| point[1] *= times);
        })
    };
    // At 1 atm molecules fly 65 nm, and the hole is 4 cm.
    assert_eq!(thinner(1e-3).0, Some(Method::HalfTurn));
    let (method, _, _, compared) = thinner(1e-4);
    assert_eq!(method, Some(Method::ClosestApproach));
    assert!(compared.contains("not half-turn: the gas itself is rarefied: Kn 0.016"), "{compared}");
    let with = |particles: u64, named: bool| {
        planned(&|scene| {
            scene.model.particles = Some(particles);
            scene.model.wish.accuracy = Some(0.8);
            scene.model.method = named.then_some(Method::HalfTurn);
        })
        .0
    };
    // V (2.41/l)^3 is 13,100.
    assert_eq!([12_500, 13_500].map(|n| with(n, false)), [Method::ClosestApproach, Method::HalfTurn].map(Some));
    assert_eq!(with(12_500, true), Some(Method::HalfTurn), "who names it has it");
}

#[test]
fn the_next_plans_are_cheaper_and_better() {
    let choice = wished(0.06);
    let (cheaper, better) = (choice.forecast.cheaper.unwrap(), choice.forecast.better.unwrap());
    assert!(cheaper.seconds < choice.forecast.seconds && cheaper.error <= 2.0 * choice.forecast.error);
    assert!(better.seconds > choice.forecast.seconds && better.error <= 0.5 * choice.forecast.error);
}

/// A run halves its steps while a chamber is dense, and the cost counts it.
#[test]
fn dense_chambers_cost_more_steps() {
    let times = |pressure: f64, cap: Option<DiameterCap>| {
        let (mut scene, measured, outlook) = seen();
        scene.model.particles = Some(100_000);
        scene.model.wish.accuracy = Some(0.3);
        scene.chambers[0].pressure *= pressure;
        scene.model.diameter_cap = cap;
        let choice = choose(&scene, &measured, &outlook).unwrap();
        scene.model = choice.request;
        let plan = plan(&scene, &measured).unwrap();
        let mean = 0.5 * (plan.initial_particles + plan.particles) as f64;
        choice.forecast.particle_steps / (mean * plan.end_time / plan.time_step)
    };
    let off = Some(DiameterCap::Off);
    assert!((times(1.0, off) - 1.0).abs() < 1e-3, "{}", times(1.0, off));
    assert!((1.2..4.0).contains(&times(30.0, off)), "{}", times(30.0, off));
    // A cap on the diameter keeps the steps.
    assert!(times(30.0, None) < times(30.0, off));
}

/// The plan of the request is a plan as any other, and has the reasons of the choice.
#[test]
fn a_choice_is_a_request_that_says_it_all() {
    let choice = wished(0.1);
    let (mut scene, measured, _) = seen();
    scene.model = choice.request.clone();
    assert!(!scene.model.wish.is_any());
    let mut planned = plan(&scene, &measured).unwrap();
    let bare = planned.clone();
    assert!(bare.forecast.is_none() && planned.particles.abs_diff(choice.request.particles.unwrap()) <= 4);
    choice.explain(&mut planned);
    let text = planned.render();
    for part in [
        "predicted error",
        "predicted cost",
        "next cheaper",
        "next better",
        "hole vent",
        "a control volume does not suffice",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    assert_eq!(planned.reasons.iter().filter(|reason| reason.quantity == "particles").count(), 1);
    assert!(planned.to_toml().unwrap().contains("[[forecast.columns]]"));
    // Nothing that a run goes by has changed; what the forecast counts is not warned of besides.
    assert!(planned.warnings.iter().all(|text| bare.warnings.contains(text) && !text.contains("Knudsen")));
    planned.reasons = bare.reasons.clone();
    planned.warnings = bare.warnings.clone();
    planned.forecast = None;
    assert_eq!(planned, bare);
}

/// A probe has as many particles as it is not warned of, where the budget pays for them.
#[test]
fn limits_are_kept_where_that_can_be() {
    let of = |particles: u64| {
        let (mut scene, mut measured, outlook) = seen();
        measured.probe_volumes = vec![2.16e-4];
        scene.model.wish.particle_budget = Some(particles);
        let choice = choose(&scene, &measured, &outlook).unwrap();
        scene.model = choice.request.clone();
        let mut planned = plan(&scene, &measured).unwrap();
        choice.explain(&mut planned);
        let told = planned.reasons.iter().any(|reason| reason.quantity == "limits not kept");
        (told, planned.warnings.iter().any(|text| text.contains("probe `jet`")))
    };
    assert_eq!((of(2_000), of(200_000)), ((true, true), (false, false)));
}

/// More time or more particles are a smaller error, and never more than was given.
#[test]
fn budgets_are_kept() {
    let in_time = |budget| chosen(|model| model.wish.time_budget = Some(budget)).unwrap().forecast;
    let (short, long) = (in_time(60.0), in_time(600.0));
    assert!(short.seconds <= 60.0 && long.seconds <= 600.0 && long.seconds > 300.0);
    assert!(long.error < short.error);
    let few = chosen(|model| model.wish.particle_budget = Some(20_000)).unwrap();
    assert_eq!(few.request.particles, Some(20_000));
    let faster = chosen(|model| {
        model.wish.time_budget = Some(60.0);
        model.wish.device_rate = Some(3e8);
    });
    assert!(faster.unwrap().forecast.error < short.error);
}

#[test]
fn what_the_scene_asks_for_is_kept() {
    let choice = chosen(|model| {
        model.method = Some(Method::Cell);
        model.occupancy = Some(0.2);
        model.wish.accuracy = Some(0.2);
    });
    let request = choice.unwrap().request;
    assert_eq!((request.method, request.occupancy, request.rounds), (Some(Method::Cell), Some(0.2), None));
    let choice = chosen(|model| {
        model.particles = Some(30_000);
        model.wish.accuracy = Some(0.3);
    });
    let request = choice.unwrap().request;
    assert_eq!(request.particles, Some(30_000));
    assert_eq!(request.method, Some(Method::HalfTurn), "a control volume has no particles");
    for rounds in [3, 5] {
        let request = chosen(|model| (model.rounds, model.wish.accuracy) = (Some(rounds), Some(0.3))).unwrap().request;
        assert_eq!((request.rounds, request.method), (Some(rounds), Some(Method::ClosestApproach)));
    }
}

/// What cannot be had is refused with the best that can, what limits it and what to give up.
#[test]
fn impossible_wishes_are_refused() {
    let refused = |change: &dyn Fn(&mut ModelRequest)| chosen(|model| change(model)).unwrap_err();
    let few = refused(&|model| {
        model.particles = Some(2_000);
        model.wish.accuracy = Some(0.01);
    });
    let PlanError::Accuracy { asked, floor, best, remedy } = &few else { panic!("{few}") };
    assert!(*asked == 0.01 && *floor > 0.01 && best.contains("2,000") && remedy.contains("`particles`"));
    let rigid = refused(&|model| {
        model.method = Some(Method::HardSphere);
        model.wish.accuracy = Some(0.01);
    });
    let PlanError::Accuracy { best, remedy, .. } = &rigid else { panic!("{rigid}") };
    assert!(best.contains("pressure of rigid spheres") && remedy.contains("`method`"), "{rigid}");
    let short = refused(&|model| {
        model.method = Some(Method::ClosestApproach);
        model.wish.time_budget = Some(1e-6);
    });
    assert!(matches!(short, PlanError::TimeBudget { least, .. } if least > 1e-6));
    let switching = refused(&|model| {
        model.switch = Some(Switch::At(1e-3));
        model.wish.accuracy = Some(0.1);
    });
    assert!(matches!(switching, PlanError::WishOfSwitch));
}

/// A hole that takes more particles than the statistics is told, with the vent that could take its place; one that is
/// resolved is not.
#[test]
fn a_hole_that_is_not_resolved_could_be_modelled() {
    let said = |area: f64, length: f64| {
        let (mut scene, mut measured, outlook) = seen();
        scene.probes.clear();
        measured.openings[0] = crate::scene::Opening { area, length, ..measured.openings[0].clone() };
        scene.model.wish.particle_budget = Some(100_000);
        scene.model.method = Some(Method::ClosestApproach);
        let choice = choose(&scene, &measured, &Outlook { probes: vec![], ..outlook }).unwrap();
        scene.model = choice.request.clone();
        let mut planned = plan(&scene, &measured).unwrap();
        choice.explain(&mut planned);
        let hole = planned.reasons.iter().find(|reason| reason.quantity == "hole vent").unwrap();
        (hole.why.clone(), planned.particles as f64 * (planned.openings[0].knudsen / 0.1).powi(3))
    };
    let (why, resolving) = said(4e-4, 0.02);
    assert!(resolving > 2e5, "{resolving}");
    for part in ["to resolve it takes", "`area` = 0.0004 m2", "`external_pressure` = 101325 Pa", "chamber `tank`"] {
        assert!(why.contains(part), "{part} is not in {why}");
    }
    // The check can fail: a wide hole is resolved.
    let (why, resolving) = said(0.04, 0.2);
    assert!(resolving < 1e5 && !why.contains("[[vent]]"), "{why}");
}

/// A longer step is taken where it is cheaper, not where the scene has one, and never one that a guard warns of.
#[test]
fn steps_are_stretched_where_that_pays() {
    let planned = |change: &dyn Fn(&mut Scene, &mut Measured)| {
        let (mut scene, mut measured, outlook) = seen();
        scene.model.method = Some(Method::ClosestApproach);
        scene.model.particles = Some(100_000);
        scene.model.wish.accuracy = Some(0.3);
        change(&mut scene, &mut measured);
        let choice = choose(&scene, &measured, &outlook).unwrap();
        scene.model = choice.request.clone();
        let mut chosen = plan(&scene, &measured).unwrap();
        scene.model.time_step = None;
        let own = plan(&scene, &measured).unwrap();
        choice.explain(&mut chosen);
        (choice.request.time_step, chosen.time_step / own.time_step, chosen, own)
    };
    let (step, times, chosen, own) = planned(&|_, _| ());
    assert!(step.is_some() && times > 1.4, "{times}");
    let reason = chosen.reasons.iter().find(|reason| reason.quantity == "time step").unwrap();
    assert!(reason.why.contains("times that of a scene without a wish"), "{}", reason.why);
    assert!(chosen.warnings.iter().all(|warning| !warning.contains("time step")), "{:?}", chosen.warnings);
    let seconds = |plan: &Plan| plan.forecast.as_ref().unwrap().seconds;
    let (_, _, usual, _) = planned(&|scene, _| scene.model.time_step = Some(own.time_step));
    assert!(seconds(&chosen) < seconds(&usual));
    // Twice the step of dense particles, or of many walls, is beyond a limit; the usual one is not.
    for (name, change) in [
        (
            "rounds",
            &(|scene: &mut Scene, _: &mut Measured| scene.model.rounds = Some(2)) as &dyn Fn(&mut Scene, &mut Measured),
        ),
        ("walls", &|_, measured| measured.wall_area = 60.0),
    ] {
        let (step, times, chosen, own) = planned(change);
        assert!(step.is_none() && times == 1.0, "{name}: {times}");
        // (A hole is counted by the forecast.)
        assert!(chosen.warnings.iter().all(|text| own.warnings.contains(text)), "{name}: {:?}", chosen.warnings);
    }
    let (step, ..) = planned(&|scene, _| scene.model.time_step = Some(1e-6));
    assert_eq!(step, Some(1e-6));
    // One that the plan shortens costs what the shortened one does.
    let (_, _, chosen, _) = planned(&|scene, _| scene.model.time_step = Some(1.0));
    let steps = chosen.end_time / chosen.time_step;
    let mean = 0.5 * (chosen.initial_particles + chosen.particles) as f64;
    let told = chosen.forecast.as_ref().unwrap().particle_steps;
    assert!(chosen.warnings.iter().any(|text| text.contains("the shorter one is taken")), "{:?}", chosen.warnings);
    assert!(told >= 0.999 * mean * steps, "{told} of {}", mean * steps);
}
