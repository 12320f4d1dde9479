//! Parts of walls with surfaces of their own: which keys they have, and what is refused.

use super::super::*;
use super::parsed;

fn text(wall: &str, parts: &str) -> String {
    format!(
        "end_time = 1\n[[gas]]\nname = 'air'\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[wall]]\nname = 'can'\nshape = 'cylinder'\nbase = [0, 0, 0]\naxis = [0, 0, 1]\nradius = 1\nheight = 1\n\
         gas = 'inside'\n{wall}\n{parts}\n\
         [[chamber]]\nname = 'all'\npressure = 1e5\ntemperature = 300\ngas = 'air'\n"
    )
}

fn part(face: &str, keys: &str) -> String {
    format!("[[wall.part]]\nface = '{face}'\n{keys}\n")
}

/// What is not given is the wall's; `accommodation` and `heat_transfer` are one choice.
#[test]
fn parts_have_the_keys_of_their_wall_where_they_give_none() {
    use HeatTransfer::{Accommodation, Coefficient};
    let surface =
        |temperature, transfer, friction| SurfaceModel { heat: Some(WallHeat { temperature, transfer }), friction };
    let wall = "temperature = 400\naccommodation = 0.5\nfriction = 0.2";
    let parts = part("top", "temperature = 600")
        + &part("side", "heat_transfer = 9\nfriction = 0")
        + &part("base", "friction = 1");
    let scene = parsed(&text(wall, &parts));
    let all = [
        ("can", surface(400.0, Accommodation(0.5), 0.2)),
        ("can/top", surface(600.0, Accommodation(0.5), 0.2)),
        ("can/side", surface(400.0, Coefficient(9.0), 0.0)),
        ("can/base", surface(400.0, Accommodation(0.5), 1.0)),
    ];
    let found: Vec<_> = scene.surface_ids().map(|id| (scene.surface_name(id), *scene.surface_model(id))).collect();
    assert_eq!(found, all.map(|(name, model)| (name.to_string(), model)));
    assert_eq!(parsed(&to_toml(&scene)), scene);
    assert_eq!(scene.surface_of(0, Some(Face::Side)).part, Some(1));
    // A part of a mirror has the defaults of a wall; the wall stays a mirror.
    let scene = parsed(&text("", &part("top", "temperature = 600")));
    assert!(scene.walls[0].surface.is_mirror() && scene.has_heat() && !scene.has_mirrors_only());
    assert_eq!(scene.walls[0].parts[0].surface, surface(600.0, Accommodation(1.0), 0.0));
    assert_eq!(scene.surface_of(0, Some(Face::Side)).part, None);
    assert!(parsed(&text("", "")).has_mirrors_only());
}

#[test]
fn parts_that_cannot_be_are_refused() {
    let refused =
        |wall: &str, parts: &str| parse(&text(wall, parts), "test.toml", Path::new("")).unwrap_err().to_string();
    let top = part("top", "temperature = 600");
    for (wall, parts, what) in [
        (
            "",
            part("tip", "temperature = 600"),
            "line 16: `wall[0].part[0].face`: found \"tip\" of the wall \"can\", which is a cylinder, allowed: a face of a cylinder: `base`, `top`, `side`",
        ),
        (
            "",
            top.clone() + &top,
            "line 19: `wall[0].part[1].face`: found \"top\" for the second time, allowed: each part of a wall once",
        ),
        ("", part("top", ""), "allowed: at least one of `temperature`"),
        ("", part("top", "accommodation = 1"), "`accommodation` of a part of a wall without `temperature`"),
        (
            "",
            part("top", "temperature = 1\naccommodation = 1\nheat_transfer = 1"),
            "both `accommodation` and `heat_transfer`",
        ),
        (
            "",
            part("top", "temperature = -1"),
            "`wall[0].part[0].temperature`: found -1, allowed: a positive number (K)",
        ),
        ("", part("top", "friction = 2"), "found 2, allowed: a number from 0 to 1"),
        ("", "[[wall.part]]\ntemperature = 600\n".to_string(), "face"),
        ("", "[[wall.part]]\nname = 'top'\n".to_string(), "name"),
    ] {
        let told = refused(wall, &parts);
        assert!(told.contains(what), "{told}");
    }
}
