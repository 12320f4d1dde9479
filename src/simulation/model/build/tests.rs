use super::*;
use crate::scene::{Method, parse};
use crate::subdomain::{Features, Patches};

fn model(text: &str) -> Model {
    Model::new(parse(text, "test.toml", std::path::Path::new("")).unwrap()).unwrap()
}

const BOX: &str = "end_time = 1e-3\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
    [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
    [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n";

fn refusal(text: &str) -> Option<String> {
    let scene = parse(text, "test.toml", std::path::Path::new("")).unwrap();
    Model::new(scene).err().map(|error| error.to_string())
}

/// A plate may cross a disc between all points of its ring.
#[test]
fn an_orifice_that_a_wall_crosses_is_refused() {
    let with = |height: f64| {
        let plate = format!(
            "[[wall]]\nname = \"plate\"\nshape = \"plane\"\ncenter = [0.05, 0.05, {height}]\nnormal = [0.0, 0.0, 1.0]\n\
             u = [1.0, 0.0, 0.0]\nsize = [0.12, 0.12]\nthickness = 0.002\n"
        );
        let orifice = "[[orifice]]\nname = \"inlet\"\nposition = [0.0, 0.05, 0.05]\ndirection = [1.0, 0.0, 0.0]\n\
            area = 0.002\ngas = \"air\"\ntemperature = 300.0\nmass_flow = [[0.0, 2.0], [1e-3, 2.0]]\n";
        refusal(&format!("{BOX}{plate}{orifice}"))
    };
    let refused = with(0.06).expect("a plate crosses the disc");
    assert!(
        refused.contains("orifice \"inlet\": its disc, of a radius of 0.02523 m, is not in the gas: ("),
        "{refused}"
    );
    // The disc's radius is 25.2 mm.
    assert_eq!(with(0.0765), None);
}

/// An orifice as wide as a cylinder of facets has its ring on their corners; a control volume has no use for its disc.
#[test]
fn an_orifice_as_wide_as_its_cylinder_is_for_control_volumes() {
    let with = |share: f64, model: &str| {
        let area = share * std::f64::consts::PI * 0.05 * 0.05;
        refusal(&format!(
            "end_time = 1e-3\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
             [[wall]]\nname = \"tube\"\nshape = \"cylinder\"\nbase = [0.0, 0.0, 0.0]\naxis = [1.0, 0.0, 0.0]\n\
             radius = 0.05\nheight = 0.2\nsegments = 24\ngas = \"inside\"\n\
             [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
             [[orifice]]\nname = \"inlet\"\nposition = [0.0, 0.0, 0.0]\ndirection = [1.0, 0.0, 0.0]\narea = {area}\n\
             gas = \"air\"\ntemperature = 300.0\nmass_flow = [[0.0, 0.1], [1e-3, 0.1]]\n[model]\n{model}\n"
        ))
    };
    assert!(with(1.0, "particles = 1000").expect("facets cut some off").contains("not in the gas"));
    assert_eq!(with(1.0, "method = \"control-volume\""), None);
    // The middles of 24 facets are at .997 of the radius.
    assert_eq!(with(0.99, "particles = 1000"), None);
}

/// What a run would only find when it switches, or writes its rows, is refused before.
#[test]
fn a_probe_that_a_control_volume_does_not_know_is_refused() {
    let probe = "[[probe]]\nname = \"p\"\nregion = { sphere = { center = [-0.01, 0.05, 0.05], radius = 0.03 } }\n";
    let with = |model: &str| refusal(&format!("{BOX}{probe}[model]\n{model}\n"));
    for model in ["switch = 2.5e-4", "method = \"control-volume\""] {
        let refused = with(model).expect(model);
        assert!(refused.contains("the middle of probe \"p\""), "{refused}");
    }
    assert_eq!(with("particles = 1000"), None);
}

/// Vents, heat and fast walls by the one table: a vent of more than hits its place for particles alone, heat that is cut for
/// control volumes too.
#[test]
fn what_hits_cannot_carry_is_warned_of() {
    let vent = include_str!("../../../../scenes/vent.toml");
    let piston = include_str!("../../../../scenes/piston.toml");
    let warned = |text: &str, method: Method, change: &dyn Fn(&mut Scene), part: &str| {
        let mut scene = parse(text, "test.toml", std::path::Path::new("")).unwrap();
        change(&mut scene);
        scene.model = crate::scene::ModelRequest { method: Some(method), ..Default::default() };
        let plan = Model::new(scene).unwrap().plan;
        plan.warnings.iter().filter(|text| text.contains(part)).count()
    };
    let hot = |scene: &mut Scene| {
        let heat = scene.walls.iter_mut().find_map(|wall| wall.surface.heat.as_mut()).unwrap();
        heat.transfer = crate::scene::HeatTransfer::Coefficient(1e7);
    };
    let [particles, volume] = [Method::ClosestApproach, Method::ControlVolume];
    for method in [particles, volume] {
        assert_eq!(warned(vent, method, &|_| (), "all hits can carry"), 0);
        assert_eq!(warned(vent, method, &hot, "all hits can carry"), 1);
    }
    let wide = |scene: &mut Scene| scene.vents.iter_mut().for_each(|vent| vent.area = Some(1.0));
    assert_eq!(warned(vent, particles, &|_| (), "largest flux"), 0);
    assert!(warned(vent, particles, &wide, "of all hits on it") > 0);
    assert_eq!(warned(vent, volume, &wide, "largest flux"), 0);
    let cold = |scene: &mut Scene| scene.chambers.iter_mut().for_each(|chamber| chamber.temperature = 0.005);
    assert_eq!(warned(piston, particles, &|_| (), "of the coldest gas"), 0);
    assert_eq!(warned(piston, particles, &cold, "of the coldest gas"), 1);
}

/// The plan's mass flow of a vent is that of the start: of one that the pressure of the start opens, and of no other.
#[test]
fn a_vent_that_is_open_at_the_start_flows_then() {
    let flow = |opening: f64| {
        let mut scene =
            parse(include_str!("../../../../scenes/vent.toml"), "test.toml", std::path::Path::new("")).unwrap();
        scene.chambers.iter_mut().for_each(|chamber| chamber.pressure = 3e5);
        scene.vents[0].opening_pressure = opening;
        Model::new(scene).unwrap().plan.vents[0].initial_mass_flow
    };
    assert!(flow(0.0) > 0.0);
    assert_eq!((flow(1.0), flow(1e9)), (flow(0.0), 0.0));
}

/// What the plan says is left out is what the kernels are compiled without, scene by scene.
#[test]
fn kernels_are_compiled_without_what_the_scene_lacks() {
    let helium = include_str!("../../../../scenes/box.toml").replace("gamma = 1.4", "gamma = 1.6667");
    let scenes = [
        include_str!("../../../../scenes/box.toml"),
        include_str!("../../../../scenes/effusion.toml"),
        include_str!("../../../../scenes/tank.toml"),
        include_str!("../../../../scenes/vent.toml"),
        include_str!("../../../../scenes/corner.toml"),
        include_str!("../../../../scenes/piston.toml"),
        &helium,
    ];
    let mut ever = [[false; 2]; 8];
    for text in scenes {
        let model = model(text);
        let (_, patches) = crate::simulation::model::patches::patches(&model);
        let patches = Patches {
            surfaces: patches.len(),
            surface_models: model.surface_models.placed.len(),
            vents: model.scene.vents.len(),
            passages: 0,
            motions: model.moving.count(),
            fabrics: 0,
            membrane: false,
            smoothed: false,
        };
        let features = Features::of(&model.plan, patches, false, false);
        let flags = [
            ("collisions", features.collisions),
            ("spin energy", features.spin),
            ("heat capacities that depend on the temperature", features.curves),
            ("inflow", features.orifices),
            ("measured surfaces", features.surfaces),
            ("walls that are no mirrors", features.surface_models),
            ("vents", features.vents),
            ("walls that move", features.moving),
        ];
        for (index, (name, compiled)) in flags.into_iter().enumerate() {
            assert_eq!(model.plan.left_out.contains(&name), !compiled, "{}: {name}", model.scene.title);
            ever[index][usize::from(compiled)] = true;
        }
    }
    // The check can fail: but for curves, each was once there and once not.
    assert!(ever.iter().enumerate().all(|(index, seen)| index == 2 || (seen[0] && seen[1])), "{ever:?}");
    assert!(model(&helium).plan.left_out.contains(&"spin energy"));
}
