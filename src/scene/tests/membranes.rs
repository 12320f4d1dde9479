//! Fabric with a material: its keys, its units, and its way back.

use std::path::Path;

use super::super::*;

/// SI; the numbers in angles are marked with the powers of mass, length and time of their units.
const SCENE: &str = "
units = 'UNITS'
end_time = <0.01 0 0 1>
gravity = [<0.0 0 1 -2>, <0.5 0 1 -2>, <-9.81 0 1 -2>]
[[gas]]
name = 'air'
molar_mass = <0.029 1 0 0>
gamma = 1.4
[[wall]]
name = 'box'
shape = 'box'
min = [<0.0 0 1 0>, <0.0 0 1 0>, <0.0 0 1 0>]
max = [<0.1 0 1 0>, <0.1 0 1 0>, <0.1 0 1 0>]
gas = 'inside'
[[fabric]]
name = 'woven'
file = 'scenes/bag.obj'
scale = <1.0 0 1 0>
reference = 'scenes/bag.obj'
reference_scale = 1.05
reference_time = <2e-3 0 0 1>
added_mass = <0.1 1 -2 0>
wall_friction = 0.2
external_pressure = <101325.0 1 -1 -2>
fixed = [{ box = { min = [<0.0 0 1 0>, <0.0 0 1 0>, <0.0 0 1 0>], max = [<0.1 0 1 0>, <0.1 0 1 0>, <0.01 0 1 0>] } }, \
{ sphere = { center = [<0.05 0 1 0>, <0.05 0 1 0>, <0.09 0 1 0>], radius = <0.02 0 1 0> } }]
[fabric.material]
thickness = <3.3e-4 0 1 0>
density = <800.0 1 -3 0>
young = [<4e8 1 -1 -2>, <3e8 1 -1 -2>]
shear = <5e6 1 -1 -2>
fibre = [0, 3, 4]
damping = 0.1
[[fabric]]
name = 'film'
file = 'scenes/bag.obj'
scale = <1.0 0 1 0>
fixed = 'edge'
[fabric.material]
thickness = <1e-4 0 1 0>
density = <900.0 1 -3 0>
young = <2e9 1 -1 -2>
poisson = 0.4
[[fabric]]
name = 'coated'
file = 'scenes/bag.obj'
scale = <1.0 0 1 0>
material = { thickness = <1e-4 0 1 0>, density = <900.0 1 -3 0>, young = [<2e8 1 -1 -2>, <3e8 1 -1 -2>], poisson = 0.2, shear = <1e6 1 -1 -2>, fibre = [1, 0, 0] }
[[fabric]]
name = 'paddle'
file = 'scenes/bag.obj'
scale = <1.0 0 1 0>
[fabric.turn]
axis = [0, 3, 4]
center = [<0.05 0 1 0>, <0.05 0 1 0>, <0.02 0 1 0>]
angular_velocity = [[<0.0 0 0 1>, <0.0 0 0 -1>], [<0.001 0 0 1>, <100.0 0 0 -1>]]
[[fabric]]
name = 'door'
file = 'scenes/bag.obj'
scale = <1.0 0 1 0>
turn = { axis = [0, 0, 1], center = [<0.05 0 1 0>, <0.05 0 1 0>, <0.02 0 1 0>], angle = [[<0.0 0 0 1>, 0.0], [<0.001 0 0 1>, 1.57]] }
[[chamber]]
name = 'in'
inside = 'woven'
pressure = <2e5 1 -1 -2>
temperature = 300
gas = 'air'
";

/// The scene in units of so many kg, m and s.
fn in_units(name: &str, [mass, length, time]: [f64; 3]) -> String {
    let mut parts = SCENE.split('<');
    let mut text = parts.next().expect("a start").replace("UNITS", name);
    for part in parts {
        let (marked, rest) = part.split_once('>').expect("an end");
        let numbers: Vec<f64> = marked.split(' ').map(|word| word.parse().expect("a number")).collect();
        let [value, of_mass, of_length, of_time] = numbers[..] else { panic!("{marked}") };
        let unit = mass.powf(of_mass) * length.powf(of_length) * time.powf(of_time);
        text += &format!("{:?}{rest}", value / unit);
    }
    text
}

fn parsed(text: &str) -> Scene {
    parse(text, "test.toml", Path::new(env!("CARGO_MANIFEST_DIR"))).unwrap_or_else(|error| panic!("{error:?}\n{text}"))
}

#[test]
fn materials_are_read_and_written_as_they_were() {
    let scene = parsed(&in_units("SI", [1.0; 3]));
    assert_eq!(scene.gravity, [0.0, 0.5, -9.81]);
    let membrane = |index: usize| scene.fabrics[index].membrane.as_ref().expect("a membrane");
    let woven = membrane(0);
    assert_eq!(woven.material.elasticity, Elasticity::Woven { young: [4e8, 3e8], shear: 5e6, fibre: [0.0, 0.6, 0.8] });
    assert_eq!([woven.material.damping, membrane(1).material.damping], [0.1, 0.05]);
    assert_eq!(membrane(1).fixed, Fixed::Edge);
    let keys = |of: &Membrane| (of.reference_scale, of.reference_time, of.added_mass, of.wall_friction);
    assert_eq!([0, 1].map(|index| keys(membrane(index))), [(1.05, Some(2e-3), 0.1, 0.2), (1.0, None, 0.0, 0.0)]);
    assert_eq!(membrane(2).fixed, Fixed::Nothing);
    let Fixed::Within(regions) = &woven.fixed else { panic!() };
    assert_eq!(regions.len(), 2);
    assert_eq!(scene.fabrics[0].files().count(), 2);
    assert_eq!(parsed(&to_toml(&scene)), scene);
    // The check can fail: another number is another scene.
    assert_ne!(parsed(&to_toml(&scene).replace("damping = 0.1", "damping = 0.2")), scene);
}

#[test]
fn a_membrane_in_three_unit_systems_is_the_same() {
    let si = parsed(&in_units("SI", [1.0; 3]));
    for (name, units) in [("kg-mm-ms", [1.0, 1e-3, 1e-3]), ("t-mm-s", [1e3, 1e-3, 1.0])] {
        let other = parsed(&in_units(name, units));
        for system in [1.0, 1.0 + 1e-9] {
            let difference = super::difference(&Scene { units: UnitSystem::Si, ..other.clone() }, &scaled(&si, system));
            assert_eq!(difference < 1e-12, system == 1.0, "{name}: {difference}");
        }
    }
}

/// With moduli that are off by a factor.
fn scaled(scene: &Scene, factor: f64) -> Scene {
    let mut scene = scene.clone();
    for membrane in scene.fabrics.iter_mut().filter_map(|fabric| fabric.membrane.as_mut()) {
        if let Elasticity::Isotropic { young, .. } = &mut membrane.material.elasticity {
            *young *= factor;
        }
    }
    scene
}

#[test]
fn the_scenes_with_membranes_are_read() {
    let [teabag, cushion] = ["teabag.toml", "cushion.toml"].map(super::repository_scene);
    for scene in [&teabag, &cushion] {
        assert!(scene.fabrics[0].membrane.is_some() && scene.chambers[0].inside == Some(0));
        let again = parsed(&to_toml(scene));
        assert_eq!(&Scene { units: scene.units, ..again }, scene);
    }
    let vent = &cushion.vents[0];
    assert_eq!((cushion.fabric_at(vent.wall), vent.external_pressure), (Some(0), 101_325.0));
    assert_eq!((vent.face, &cushion.fabrics[0].parts[..]), (Some(Face::Part(0)), &["lower".to_string()][..]));
    assert_eq!(teabag.fabric_at(0), None);
}

/// A vent on fabric is against the pressure around it at the start.
#[test]
fn vents_and_surfaces_of_fabric_are_read_and_written() {
    let text =
        in_units("SI", [1.0; 3]).replace("name = 'film'\n", "name = 'film'\nfriction = 0.5\ntemperature = 350.0\n");
    let vents = "[[vent]]\nname = 'a'\nfabric = 'woven'\nface = 'one'\ndischarge = 0.5\n\
                 [[vent]]\nname = 'b'\nfabric = 'woven'\nface = 'other'\nposition = [0.1, 0.0, 0.0]\ndiameter = 0.1\n\
                 leak_velocity = [[0.0, 0.0], [1e5, 2.0]]\nopening_pressure = 3e4\n";
    let scene = parsed(&(text + vents));
    assert_eq!(parsed(&to_toml(&scene)), scene);
    assert_eq!(scene.vents[1].face, Some(Face::Part(1)));
    assert_eq!(scene.vents[0].external_pressure, 101_325.0);
    let film = scene.surface_ids().nth(2).expect("a wall, then fabrics");
    assert_eq!((scene.surface_name(film), scene.surface_model(film).friction), ("film".to_string(), 0.5));
    assert!(scene.has_heat() && !scene.has_mirrors_only());
    // Columns and reports name it.
    assert_eq!(scene.heated_surfaces().map(|(id, _)| scene.surface_title(id)).collect::<Vec<_>>(), ["fabric `film`"]);
}
