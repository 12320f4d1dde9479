use super::*;
use crate::plan::Cause;
use crate::scene::{Face, Method, parse, to_toml};
use crate::simulation::{Model, ModelError};

/// A litre at three bar that empties through a round hole into air.
fn emptying() -> String {
    include_str!("../../../../scenes/effusion.toml")
        .replace("segments = 32\n", "segments = 32\nflow_only = true\n")
        .replace("pressure = 100000.0", "pressure = 300000.0")
        .replace("pressure = 1.0", "pressure = 100000.0")
        .replace("method = \"none\"\nparticles = 20000", "method = \"closest-approach\"\naccuracy = 0.05")
        + "\n[[probe]]\nname = \"middle\"\nregion = { box = { min = [-0.02, -0.02, -0.02], max = [0.02, 0.02, 0.02] } }\n"
}

fn scene(text: &str) -> Scene {
    parse(text, "test.toml", std::path::Path::new("")).unwrap()
}

fn part_of(text: &str) -> Result<Part, String> {
    let scene = scene(text);
    let seen = Model::new(Scene { model: crate::scene::ModelRequest::default(), ..scene.clone() }).unwrap();
    let measured =
        crate::simulation::model::measure::measured(&scene, &seen.vessel, &seen.surface_models, &seen.moving, &[]);
    part(&scene, &seen.vessel, &measured).unwrap()
}

/// What is inside stays as it was, the hole is a vent of its area, and what comes out is a scene that can be written and read.
#[test]
fn a_part_is_what_is_inside_of_the_box() {
    let whole = scene(&emptying());
    let Part { scene, kept, holes, vents } = part_of(&emptying()).unwrap();
    assert_eq!((kept, vents, holes[0].0.as_str()), (vec![0], vec![0], "hole"));
    assert!(holes[0].1.contains("in place of chamber `outer`"), "{}", holes[0].1);
    assert_eq!((scene.walls.len(), scene.walls[0].gas, scene.walls[0].is_convex_cavity()), (1, GasSide::Inside, true));
    assert_eq!((&scene.chambers[..], &scene.probes), (&whole.chambers[..1], &whole.probes));
    let [vent] = &scene.vents[..] else { panic!("{:?}", scene.vents) };
    let area = std::f64::consts::PI * 0.01 * 0.01;
    assert!((vent.area.unwrap() / area - 1.0).abs() < 1e-9 && vent.external_pressure == 100000.0, "{vent:?}");
    assert_eq!(vent.face, Some(Face::Box { axis: 0, positive: true }));
    let again = parse(&to_toml(&scene), "test.toml", std::path::Path::new("")).unwrap();
    assert_eq!(again.vents, scene.vents);
    assert_eq!(again.walls, scene.walls);
}

/// Nothing that is asked for is left out, and nothing that stays is cut in two: else it is told what stands in the way.
#[test]
fn a_part_that_would_lack_something_is_none() {
    let refused = |change: &dyn Fn(String) -> String| part_of(&change(emptying())).unwrap_err();
    let with = |more: &'static str| refused(&move |text| text + more);
    let cases = [
        (refused(&|text| text[..text.find("\n[[probe]]").unwrap()].to_owned()), "all chambers are asked for"),
        (with("[[surface]]\nname = \"far\"\nwall = \"outer\"\nface = \"+x\"\n"), "surface \"far\" is behind it"),
        (with("[[surface]]\nname = \"all\"\nwall = \"inner\"\n"), "on the wall with the hole"),
        (with("[[surface]]\nname = \"own\"\nwall = \"inner\"\nface = \"+x\"\n"), "on the wall with the hole"),
        (
            refused(&|text| text.replace("max = [0.02, 0.02, 0.02]", "max = [0.02, 0.02, 0.08]")),
            "probe \"middle\" is behind it",
        ),
        (
            refused(&|text| {
                text.replace("flow_only = true\n", "flow_only = true\n[[wall.hole]]\nname = \"other\"\nface = \"-x\"\ncenter = [0.0, 0.0]\ndiameter = 0.01\n")
            }),
            "hole \"other\" of the same wall",
        ),
        (
            refused(&|text| {
                text.replace("max = [0.05, 0.05, 0.05] } }\npressure", "max = [0.05, 0.05, 0.04] } }\npressure")
            }),
            "\"outer\" is on both sides",
        ),
    ];
    for (found, expected) in cases {
        assert!(found.contains(expected), "{found:?} is not {expected:?}");
    }
    assert!(part_of(&(emptying() + "[[surface]]\nname = \"side\"\nwall = \"inner\"\nface = \"-y\"\n")).is_ok());
    // The tank keeps what it has: its far wall is asked for.
    let tank = include_str!("../../../../scenes/tank.toml")
        .replace("size = [0.04, 0.04]", "size = [0.04, 0.04]\nflow_only = true");
    assert!(part_of(&tank).unwrap_err().contains("probe \"vent jet\" is behind it"));
}

/// Parts of the box with surfaces of their own stay, that with the hole as well; the outside is behind it.
#[test]
fn parts_of_the_box_stay_but_for_its_outside() {
    let part = |face: &str| format!("[[wall.part]]\nface = \"{face}\"\ntemperature = 300.0\n");
    let parts = "flow_only = true\n".to_string() + &["outside", "-y", "+x"].map(part).concat();
    let scene = part_of(&emptying().replace("flow_only = true\n", &parts)).unwrap().scene;
    let names: Vec<String> = scene.surface_ids().map(|id| scene.surface_name(id)).collect();
    assert_eq!(names, ["inner", "inner/-y", "inner/+x"]);
    let again = parse(&to_toml(&scene), "test.toml", std::path::Path::new("")).unwrap();
    assert_eq!(again.walls, scene.walls);
    let surface_models = Model::new(scene).unwrap().surface_models.placed;
    assert_eq!(surface_models.len(), 2);
    assert!(
        surface_models.iter().all(|placed| placed.vents.len() == usize::from(placed.surface.part == Some(1))),
        "{surface_models:?}"
    );
}

/// Where only the flow matters, a hole is modelled if that is cheaper at the accuracy, and resolved if what is left out would be too
/// much; the reasons say both sides. Without a wish nothing is modelled.
#[test]
fn the_better_of_both_is_chosen() {
    let planned = |text: &str| {
        let model = Model::new(scene(text)).unwrap();
        let plan = model.explained();
        let why = plan.reasons.iter().find(|reason| reason.quantity == "hole hole").unwrap().clone();
        (model, why)
    };
    let (model, why) = planned(&emptying());
    assert_eq!((why.value.as_str(), model.scene.chambers.len()), ("modelled", 1), "{}", why.why);
    assert!(why.why.contains("resolved: ") && why.why.contains("a [[vent]] of"), "{}", why.why);
    let modelled = model.choice.as_ref().unwrap().forecast.seconds;
    // The scene that is written down is planned as the run was, so the run can be resumed.
    assert_eq!(model.plan.to_toml(), Model::new(scene(&to_toml(&model.scene))).unwrap().plan.to_toml());
    let (model, why) = planned(&emptying().replace("flow_only = true\n", ""));
    assert_eq!((why.value.as_str(), model.scene.chambers.len()), ("resolved", 2));
    assert!(model.choice.unwrap().forecast.seconds > 3.0 * modelled);
    // The pressure behind rises as far as that before the hole falls: a constant one is no model of it.
    let filling = emptying().replace("pressure = 100000.0\n", "pressure = 200000.0\n").replace("0.15", "0.06");
    let (model, why) = planned(&filling.replace("accuracy = 0.05", "accuracy = 0.1"));
    assert_eq!(why.value, "resolved", "{}", why.why);
    assert!(why.why.contains("no better") || why.why.contains("cannot be modelled: then"), "{}", why.why);
    assert_eq!(model.scene.chambers.len(), 2);
    let (model, why) = planned(&emptying().replace("accuracy = 0.05", "particles = 2000"));
    assert_eq!((why.value.as_str(), model.plan.method), ("resolved", Method::ClosestApproach));
    assert!(why.why.contains("lets a plan with an accuracy"), "{}", why.why);
    // What is resolved although it might be modelled is planned again as it was: its scene has no wish any more.
    assert_eq!(model.plan.to_toml(), Model::new(scene(&to_toml(&model.scene))).unwrap().plan.to_toml());
    let (model, _) = planned(&filling.replace("accuracy = 0.05", "accuracy = 0.1"));
    assert_eq!(model.plan.to_toml(), Model::new(scene(&to_toml(&model.scene))).unwrap().plan.to_toml());
}

/// What no vent can do is resolved: the flow of molecules that do not collide, and that through a hole as large as a wall. Where neither way
/// reaches the accuracy, it is told what stands in the way of a vent.
#[test]
fn what_no_vent_can_do_is_resolved() {
    let why = |text: &str| {
        let plan = Model::new(scene(text)).unwrap().explained();
        plan.reasons.into_iter().find(|reason| reason.quantity == "hole hole").unwrap()
    };
    let free = why(&emptying().replace("closest-approach", "none"));
    assert!(free.value == "resolved" && free.why.contains("free flight"), "{}", free.why);
    let wide = emptying().replace("diameter = 0.02", "diameter = 0.06").replace("accuracy = 0.05", "accuracy = 0.4");
    let wide = why(&wide);
    assert!(wide.value == "resolved" && wide.why.contains("p/sqrt(RT/M)"), "{}", wide.why);
    let asked = emptying() + "[[surface]]\nname = \"far\"\nwall = \"outer\"\nface = \"+x\"\n";
    let neither = Model::new(scene(&asked.replace("accuracy = 0.05", "accuracy = 0.0002"))).err().unwrap();
    let ModelError::Plan(crate::plan::PlanError::Accuracy { remedy, .. }) = neither else {
        panic!("{neither}");
    };
    assert!(remedy.contains("surface \"far\" is behind it"), "{remedy}");
}

/// Where space behind the hole is in no chamber, no plan of the whole knows what flows there, and so none of the part.
#[test]
fn empty_space_behind_a_hole_is_refused() {
    let mut half = scene(&emptying());
    let behind = half.chambers.last_mut().unwrap();
    assert!(behind.region.is_none(), "all that is left");
    behind.region = Some(crate::scene::Region::Box { min: [0.06, -0.3, -0.3], max: [0.3, 0.3, 0.3] });
    let refused = Model::new(half).err().unwrap();
    assert!(matches!(refused, ModelError::Plan(crate::plan::PlanError::EmptySpace { .. })), "{refused}");
}

/// What the part lacks of a pressure is a part of its forecast.
#[test]
fn what_is_left_out_counts() {
    let error = |pressure: &str| {
        let text =
            emptying().replace("pressure = 100000.0\n", &format!("pressure = {pressure}\n")).replace("0.15", "0.07");
        let model = Model::new(scene(&text.replace("accuracy = 0.05", "accuracy = 0.3"))).unwrap();
        let columns = model.choice.unwrap().forecast.columns;
        let parts = columns.iter().filter(|column| column.asked).flat_map(|column| &column.parts);
        parts.filter(|part| part.cause == Cause::LeftOut).map(|part| part.error).fold(0.0, f64::max)
    };
    // Into near-vacuum the flow hardly knows what is behind the hole.
    assert!(error("1.0") < 0.015, "{}", error("1.0"));
    assert!(error("200000.0") > 3.0 * error("1.0").max(0.005), "{}", error("200000.0"));
}
