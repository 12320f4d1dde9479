//! The scenes of the repository, the unit systems, defaults and the schema.

mod any_scene;
mod fabric_parts;
mod membranes;
mod wall_parts;

use std::path::Path;

use super::*;

fn repository_scene(name: &str) -> Scene {
    load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)).unwrap()
}

fn parsed(text: &str) -> Scene {
    parse(text, "test.toml", Path::new("")).unwrap_or_else(|error| panic!("{:?}\n{text}", miette::Report::new(error)))
}

fn integral(curve: &Curve) -> f64 {
    curve.points.windows(2).map(|p| 0.5 * (p[0][1] + p[1][1]) * (p[1][0] - p[0][0])).sum()
}

fn box_volume(min: [f64; 3], max: [f64; 3], margin: f64) -> f64 {
    (0..3).map(|axis| max[axis] - min[axis] + 2.0 * margin).product()
}

/// Gas volume of the tank scene, m3: the tank less the shell of the inner box, plus the hole through it.
fn tank_volume(scene: &Scene) -> f64 {
    let Shape::Box { min, max, .. } = &scene.walls[0].shape else { panic!() };
    let tank = box_volume(*min, *max, 0.0);
    let Shape::Box { min, max, thickness: Some(thickness), holes } = &scene.walls[1].shape else { panic!() };
    let Outline::Rectangle { size } = holes[0].outline else { panic!() };
    let shell = box_volume(*min, *max, *thickness) - box_volume(*min, *max, 0.0);
    tank - shell + size[0] * size[1] * thickness
}

/// Air and inflator particles at equal moles per particle: n = p V / (R T) and m / M.
fn tank_particles(scene: &Scene, volume: f64) -> [u64; 2] {
    let chamber = &scene.chambers[0];
    let air = chamber.pressure * volume / (GAS_CONSTANT * chamber.temperature);
    let inflow = integral(&scene.orifices[0].mass_flow) / scene.gases[1].molar_mass;
    let per_mole = scene.model.particles.unwrap() as f64 / (air + inflow);
    [air, inflow].map(|moles| (moles * per_mole / 1000.0).round() as u64 * 1000)
}

#[test]
fn the_tank_holds_60_litres_and_gets_78_grams_which_makes_472_000_and_528_000_particles() {
    let scene = repository_scene("tank.toml");
    let volume = tank_volume(&scene);
    assert!((volume - 0.060).abs() < 1e-15, "{volume}");
    let mass = integral(&scene.orifices[0].mass_flow);
    assert!((mass - 0.0782).abs() < 1e-15, "{mass}");
    assert_eq!(tank_particles(&scene, volume), [472_000, 528_000]);
    // The solid of the inner box matters: without it the numbers are others.
    assert_ne!(tank_particles(&scene, volume + 0.000561), [472_000, 528_000]);
}

#[test]
fn the_tanks_inflator_lies_on_the_inner_face_and_its_disc_fits_there() {
    let scene = repository_scene("tank.toml");
    let Shape::Box { min, max, .. } = &scene.walls[1].shape else { panic!() };
    let orifice = &scene.orifices[0];
    assert_eq!(orifice.position, [min[0], 0.5 * (min[1] + max[1]), 0.5 * (min[2] + max[2])]);
    assert!((orifice.area / std::f64::consts::PI).sqrt() < 0.5 * (max[1] - min[1]));
    assert_eq!(scene.chambers[0].region, Some(Region::Box { min: *min, max: *max }));
}

#[test]
fn the_box_gets_a_quarter_of_a_million_wall_hits() {
    let scene = repository_scene("box.toml");
    let Shape::Box { min, max, .. } = &scene.walls[0].shape else { panic!() };
    let edge = max[0] - min[0];
    let density = scene.model.particles.unwrap() as f64 / box_volume(*min, *max, 0.0);
    let gas = &scene.gases[0];
    let speed = (8.0 * GAS_CONSTANT * scene.chambers[0].temperature / (std::f64::consts::PI * gas.molar_mass)).sqrt();
    let hits = density * speed * 6.0 * edge * edge / 4.0 * scene.end_time;
    assert!((hits / 2.5e5 - 1.0).abs() < 0.02, "{hits}");
    let HeatCapacity::Constant(cv) = gas.heat else { panic!() };
    assert!((cv / GAS_CONSTANT - 2.5).abs() < 1e-12);
}

#[test]
fn the_effusion_scene_ends_when_about_30_per_cent_of_the_pressure_is_gone() {
    let scene = repository_scene("effusion.toml");
    assert_eq!(scene.model.method, Some(Method::None));
    let Shape::Box { min, max, holes, .. } = &scene.walls[1].shape else { panic!() };
    let Outline::Circle { diameter, .. } = holes[0].outline else { panic!() };
    let area = std::f64::consts::PI * diameter * diameter / 4.0;
    let gas = &scene.gases[0];
    let speed = (8.0 * GAS_CONSTANT * scene.chambers[0].temperature / (std::f64::consts::PI * gas.molar_mass)).sqrt();
    // A particle that leaves takes 2 kT of the 3/2 kT that a particle has on average.
    let rate = 4.0 / 3.0 * speed * area / 4.0 / box_volume(*min, *max, 0.0);
    let left = (-rate * scene.end_time).exp();
    assert!((0.62..0.75).contains(&left), "{left}");
}

/// A scene with every kind of quantity; `<number quantity>` is a number in SI to be written in other units.
const EVERY_QUANTITY: &str = r#"
title = "units"
units = "UNITS"
end_time = <0.125 time>
[[gas]]
name = "air"
molar_mass = <0.02897 molar_mass>
cp = <29.125 heat>
[[gas]]
name = "steam"
molar_mass = <0.018015 molar_mass>
cv = <25.5 heat>
[[gas]]
name = "argon"
molar_mass = <0.039948 molar_mass>
gamma = 1.667
[[wall]]
name = "tank"
shape = "box"
gas = "inside"
min = [<-1.0 length>, <-1.5 length>, <-1.25 length>]
max = [<1.0 length>, <1.5 length>, <1.25 length>]
[[wall]]
name = "hollow"
shape = "box"
min = [<-0.3 length>, <-0.3 length>, <-0.3 length>]
max = [<0.3 length>, <0.3 length>, <0.3 length>]
thickness = <0.007 length>
[[wall.hole]]
name = "square"
face = "-y"
center = [<0.1 length>, <-0.1 length>]
size = [<0.05 length>, <0.07 length>]
[[wall.hole]]
name = "round"
face = "+z"
center = [<0.1 length>, <-0.1 length>]
diameter = <0.05 length>
flow_only = true
[[wall]]
name = "pipe"
shape = "cylinder"
gas = "outside"
base = [<0.5 length>, <0.5 length>, <0.5 length>]
axis = [1, 2, 2]
radius = <0.03 length>
height = <0.11 length>
[[wall]]
name = "ball"
shape = "sphere"
gas = "outside"
center = [<-0.5 length>, <0.5 length>, <0.5 length>]
radius = <0.04 length>
[[wall]]
name = "plate"
shape = "plane"
center = [<-0.5 length>, <-0.5 length>, <0.5 length>]
normal = [0, 3, 4]
u = [1, 0, 0]
size = [<0.2 length>, <0.3 length>]
thickness = <0.01 length>
[[chamber]]
name = "inner"
region = { cylinder = { base = [<0.0 length>, <0.0 length>, <-0.2 length>], axis = [0, 0, 1], radius = <0.1 length>, height = <0.4 length> } }
pressure = <101325.0 pressure>
temperature = 293.0
gas = { air = 0.5, steam = 0.25, argon = 0.25 }
[[chamber]]
name = "rest"
pressure = <98765.0 pressure>
temperature = 300.0
gas = "air"
[[opening]]
name = "gap"
between = ["inner", "rest"]
area = <0.0123 area>
[[orifice]]
name = "inflator"
position = [<0.0 length>, <0.0 length>, <0.25 length>]
direction = [0, 0, -2]
area = <0.001 area>
mass_flow = [[<0.001 time>, <0.5 mass_flow>], [<0.06 time>, <1.25 mass_flow>]]
temperature = [[<0.0 time>, 700], [<0.03 time>, 900]]
gas = "steam"
jet = { mach = 1.5, cone_angle = 12.5 }
[[probe]]
name = "probe"
region = { sphere = { center = [<0.7 length>, <0.7 length>, <0.7 length>], radius = <0.05 length> } }
[[surface]]
name = "lid"
wall = "tank"
face = "+z"
[model]
diameter = <0.0021 length>
time_step = <0.00001 time>
"#;

fn in_units(units: &str, per_si: impl Fn(&str) -> f64) -> String {
    let mut text = String::new();
    let mut parts = EVERY_QUANTITY.split('<');
    text.push_str(&parts.next().unwrap().replace("UNITS", units));
    for part in parts {
        let (marked, rest) = part.split_once('>').unwrap();
        let (number, quantity) = marked.split_once(' ').unwrap();
        text.push_str(&format!("{:?}{rest}", number.parse::<f64>().unwrap() * per_si(quantity)));
    }
    text
}

/// How many of the unit make one SI unit: GPa, MPa, kg/ms, t/s and so on, by hand.
fn kg_mm_ms(quantity: &str) -> f64 {
    match quantity {
        "length" | "time" => 1e3,
        "area" => 1e6,
        "pressure" => 1e-9,
        "mass_flow" => 1e-3,
        "molar_mass" | "heat" => 1.0,
        other => panic!("{other}"),
    }
}

fn t_mm_s(quantity: &str) -> f64 {
    match quantity {
        "length" | "heat" => 1e3,
        "time" => 1.0,
        "area" => 1e6,
        "pressure" => 1e-6,
        "mass_flow" | "molar_mass" => 1e-3,
        other => panic!("{other}"),
    }
}

/// The greatest relative difference between the numbers of two scenes; infinite where anything else differs.
fn difference(a: &Scene, b: &Scene) -> f64 {
    fn compare(a: &toml::Value, b: &toml::Value) -> f64 {
        use toml::Value::*;
        match (a, b) {
            (Float(a), Float(b)) if a == b => 0.0,
            (Float(a), Float(b)) => (a - b).abs() / a.abs().max(b.abs()),
            (Array(a), Array(b)) if a.len() == b.len() => {
                a.iter().zip(b).map(|(a, b)| compare(a, b)).fold(0.0, f64::max)
            }
            (Table(a), Table(b)) if a.keys().eq(b.keys()) => {
                a.values().zip(b.values()).map(|(a, b)| compare(a, b)).fold(0.0, f64::max)
            }
            (a, b) if a == b => 0.0,
            _ => f64::INFINITY,
        }
    }
    let value = |scene| toml::Value::Table(to_toml(scene).parse().unwrap());
    compare(&value(a), &value(b))
}

#[test]
fn one_scene_in_three_unit_systems_is_the_same_scene() {
    let si = parsed(&in_units("SI", |_| 1.0));
    let [ms, t] = [in_units("kg-mm-ms", kg_mm_ms), in_units("t-mm-s", t_mm_s)].map(|text| parsed(&text));
    assert_eq!([si.units, ms.units, t.units], [UnitSystem::Si, UnitSystem::KgMmMs, UnitSystem::TMmS]);
    assert!(difference(&si, &ms) < 1e-12, "{}", difference(&si, &ms));
    assert!(difference(&si, &t) < 1e-12, "{}", difference(&si, &t));
    // And the comparison sees every single number: one that is off by 1e-9 shows.
    for quantity in ["length", "time", "area", "pressure", "mass_flow", "molar_mass", "heat"] {
        let off = parsed(&in_units("t-mm-s", |q| t_mm_s(q) * if q == quantity { 1.0 + 1e-9 } else { 1.0 }));
        assert!(difference(&si, &off) > 1e-10, "{quantity}");
    }
}

/// The tank of scenes/tank.toml, its numbers moved into the systems by hand.
#[test]
fn the_tank_in_three_unit_systems_is_the_same_tank() {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/tank.toml")).unwrap();
    let si = parsed(&text);
    for (name, factor) in [("kg-mm-ms", kg_mm_ms as fn(&str) -> f64), ("t-mm-s", t_mm_s)] {
        let mut document: toml::Table = text.parse().unwrap();
        document["units"] = name.into();
        for (key, value) in document.iter_mut() {
            convert(key, value, &factor);
        }
        assert!(difference(&si, &parsed(&document.to_string())) < 1e-12, "{name}");
    }
}

fn convert(key: &str, value: &mut toml::Value, factor: &dyn Fn(&str) -> f64) {
    let quantity = match key {
        "end_time" => "time",
        "min" | "max" | "thickness" | "center" | "size" | "position" => "length",
        "area" | "pressure" | "molar_mass" => key,
        "mass_flow" => {
            for point in value.as_array_mut().unwrap() {
                convert("end_time", &mut point[0], factor);
                let flow = point[1].as_float().unwrap() * factor("mass_flow");
                point[1] = flow.into();
            }
            return;
        }
        "gas" | "wall" | "hole" | "chamber" | "orifice" | "surface" | "probe" | "region" | "box" => "",
        _ => return,
    };
    match value {
        toml::Value::Table(table) => table.iter_mut().for_each(|(key, value)| convert(key, value, factor)),
        toml::Value::Array(array) => array.iter_mut().for_each(|value| convert(key, value, factor)),
        toml::Value::Float(number) => *number *= factor(quantity),
        _ => {}
    }
}

#[test]
fn the_repositorys_scenes_read_back_as_they_were_resolved() {
    for name in ["tank.toml", "box.toml", "effusion.toml"] {
        let scene = repository_scene(name);
        let text = to_toml(&scene);
        assert_eq!(parsed(&text), scene);
        assert_ne!(parsed(&text.replacen("end_time = 0.", "end_time = 0.9", 1)), scene);
    }
    let everything = parsed(&in_units("SI", |_| 1.0));
    assert_eq!(parsed(&to_toml(&everything)), everything);
}

#[test]
fn what_is_left_out_gets_its_default() {
    let scene = parse(
        "end_time = 1\n[[gas]]\nname = 'He'\nmolar_mass = 0.004\ngamma = 1.67\n[[wall]]\nname = 'w'\nshape = 'sphere'\n\
         center = [0, 0, 0]\nradius = 1\ngas = 'inside'\n[[chamber]]\nname = 'c'\npressure = 1\ntemperature = 1\ngas = 'He'\n",
        "some/folder/helium.toml",
        Path::new(""),
    )
    .unwrap();
    assert_eq!((scene.title.as_str(), scene.units, scene.seed), ("helium", UnitSystem::Si, 1));
    assert_eq!(scene.output, OutputRequest { rows: 200, snapshots: 10, report: None });
    assert_eq!(scene.model, ModelRequest::default());
    // A rounded 5/3 is a gas without internal energy.
    assert_eq!(scene.gases[0].heat, HeatCapacity::Constant(1.5 * GAS_CONSTANT));
    assert!(matches!(scene.walls[0].shape, Shape::Sphere { subdivisions: 3, .. }));
}

#[test]
fn the_smallest_scene_of_the_reference_is_a_scene() {
    let page = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/reference/scenes.md")).unwrap();
    let example = page.split("```toml\n").nth(1).unwrap().split("```").next().unwrap();
    assert_eq!(parsed(example).walls.len(), 1);
    // It is the smallest: without its wall it is none.
    assert!(parse(&example.replace("[[wall]]", "[[probe]]"), "page", Path::new("")).is_err());
}

#[test]
fn a_mesh_is_found_from_the_folder_of_the_scene_and_scaled_to_metres() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("bag.stl"), "").unwrap();
    let text = |scale: &str| {
        format!(
            "units = 'kg-mm-ms'\nend_time = 1\n[[gas]]\nname = 'a'\nmolar_mass = 0.03\ngamma = 1.4\n[[wall]]\nname = 'bag'\n\
             shape = 'mesh'\ngas = 'inside'\nfile = 'bag.stl'\n{scale}\n[[chamber]]\nname = 'c'\npressure = 1e-4\n\
             temperature = 300\ngas = 'a'\n"
        )
    };
    for (line, expected) in [("", 1e-3), ("scale = 25.4", 0.0254)] {
        let scene = parse(&text(line), "bag.toml", folder.path()).unwrap();
        let Shape::Mesh { path, scale, .. } = &scene.walls[0].shape else { panic!() };
        assert!(path.is_absolute() && path.is_file());
        assert!((scale / expected - 1.0).abs() < 1e-15);
        let again = parse(&to_toml(&scene), "bag.toml", Path::new("/nowhere")).unwrap();
        assert_eq!(Scene { units: UnitSystem::KgMmMs, ..again }, scene);
    }
    assert!(parse(&text(""), "bag.toml", Path::new("/nowhere")).is_err());
}

#[test]
fn the_schema_names_every_key_with_a_description() {
    let schema = schema();
    let properties = schema["properties"].as_object().unwrap();
    let document: toml::Table = in_units("SI", |_| 1.0).parse().unwrap();
    for key in document.keys() {
        assert!(properties[key]["description"].is_string(), "{key}");
    }
    assert_eq!(schema["additionalProperties"], false);
    for (name, definition) in schema["$defs"].as_object().unwrap() {
        for (key, property) in definition.get("properties").and_then(|p| p.as_object()).into_iter().flatten() {
            assert!(property["description"].is_string(), "{name}.{key}: {property}");
        }
    }
    assert!(properties.get("viscosity").is_none());
}

/// Whatever a request says beside its method, what is written of it is read again; and what methods have is kept.
#[test]
fn what_a_method_has_no_use_for_is_not_written() {
    let mut scene = repository_scene("box.toml");
    let methods =
        [Method::ClosestApproach, Method::HardSphere, Method::Cell, Method::None, Method::ControlVolume].map(Some);
    for method in methods {
        for diameter in [None, Some(1e-3)] {
            scene.model = ModelRequest {
                method,
                diameter,
                occupancy: if diameter.is_none() { Some(0.1) } else { None },
                diameter_cap: Some(DiameterCap::Spacings(0.7)),
                time_step: Some(1e-6),
                rounds: Some(3),
                collision_number: Some(5.0),
                ..ModelRequest::default()
            };
            let heeded = scene.model.clone().heeded();
            assert_eq!(parsed(&to_toml(&scene)).model, heeded, "{method:?}");
            assert_eq!(heeded == scene.model, method == Some(Method::ClosestApproach), "{method:?}");
        }
    }
}
