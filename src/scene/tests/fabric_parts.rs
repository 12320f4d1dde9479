//! Parts of fabrics with surfaces of their own: which keys they have, and what is refused.

use super::super::*;
use super::parsed;

fn text(fabric: &str, parts: &str) -> String {
    format!(
        "end_time = 1\n[[gas]]\nname = 'air'\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[wall]]\nname = 'box'\nshape = 'box'\nmin = [0, 0, 0]\nmax = [1, 1, 1]\ngas = 'inside'\n\
         [[wall.part]]\nface = '+x'\ntemperature = 500\n\
         [[fabric]]\nname = 'bag'\nfile = 'scenes/bag.obj'\n{fabric}\n{parts}\n\
         [[chamber]]\nname = 'all'\npressure = 1e5\ntemperature = 300\ngas = 'air'\n"
    )
}

fn part(face: &str, keys: &str) -> String {
    format!("[[fabric.part]]\nface = '{face}'\n{keys}\n")
}

/// What is not given is the fabric's; `accommodation` and `heat_transfer` are one choice.
#[test]
fn parts_have_the_keys_of_their_fabric_where_they_give_none() {
    use HeatTransfer::{Accommodation, Coefficient};
    let surface =
        |temperature, transfer, friction| SurfaceModel { heat: Some(WallHeat { temperature, transfer }), friction };
    let fabric = "temperature = 400\naccommodation = 0.5\nfriction = 0.2";
    let parts = part("panel", "temperature = 600")
        + &part("tube", "heat_transfer = 9\nfriction = 0")
        + &part("strap", "friction = 1");
    let scene = parsed(&text(fabric, &parts));
    let all = [
        ("box", SurfaceModel::default()),
        ("box/+x", surface(500.0, Accommodation(1.0), 0.0)),
        ("bag", surface(400.0, Accommodation(0.5), 0.2)),
        ("bag/panel", surface(600.0, Accommodation(0.5), 0.2)),
        ("bag/tube", surface(400.0, Coefficient(9.0), 0.0)),
        ("bag/strap", surface(400.0, Accommodation(0.5), 1.0)),
    ];
    let found: Vec<_> = scene.surface_ids().map(|id| (scene.surface_name(id), *scene.surface_model(id))).collect();
    assert_eq!(found, all.map(|(name, model)| (name.to_string(), model)));
    assert_eq!(scene.surface_title(scene.surface_of(1, Some(Face::Part(0)))), "fabric `bag/panel`");
    // A part of a mirror has the defaults of a fabric; the fabric stays a mirror.
    let scene = parsed(&text("", &part("panel", "temperature = 600")));
    assert!(scene.fabrics[0].surface.is_mirror() && !scene.has_mirrors_only());
    assert_eq!(scene.fabrics[0].surface_parts[0].surface, surface(600.0, Accommodation(1.0), 0.0));
    assert_eq!(scene.surface_of(1, None).part, None);
    assert_eq!(
        scene.heated_surfaces().map(|(id, _)| scene.surface_name(id)).collect::<Vec<_>>(),
        ["box/+x", "bag/panel"]
    );
}

/// Vents and parts name the mesh's parts alike, before and behind the tables of a turn; the lines are those of the parts.
#[test]
fn parts_are_read_and_written_beside_vents_and_turns() {
    let turn = "[fabric.turn]\naxis = [0, 0, 1]\ncenter = [0, 0, 0]\nangular_velocity = 1.0\n";
    let vents = "[[vent]]\nname = 'v'\nfabric = 'bag'\nface = 'tube'\ndischarge = 0.5\n\
                 [[vent]]\nname = 'w'\nfabric = 'bag'\nface = 'rest'\ndischarge = 0.5\n";
    let own = part("panel", "temperature = 600") + &part("tube", "friction = 0.5");
    for parts in [format!("{turn}{own}{vents}"), format!("{own}{turn}{vents}")] {
        let scene = parsed(&text("friction = 0.1", &parts));
        assert!(scene.fabrics[0].turn.is_some() && scene.fabrics[0].surface_parts.len() == 2);
        assert_eq!(parsed(&to_toml(&scene)), scene);
    }
    let scene = parsed(&text("friction = 0.1", &format!("{own}{vents}")));
    let fabric = &scene.fabrics[0];
    assert_eq!(fabric.parts, ["tube", "rest", "panel"]);
    let faces: Vec<String> = fabric.surface_parts.iter().map(|part| fabric.face_name(part.face)).collect();
    assert_eq!(
        (faces, scene.vents[0].face),
        (vec!["panel".to_string(), "tube".to_string()], Some(fabric.surface_parts[1].face))
    );
    assert_eq!(parsed(&to_toml(&scene)), scene);
    // The check can fail: another part is another scene.
    assert_ne!(parsed(&to_toml(&scene).replace("face = \"panel\"", "face = \"panels\"")), scene);
    assert_eq!(scene.lines.of_error("fabric \"bag/tube\": is wrong"), Some(22));
}

#[test]
fn parts_that_cannot_be_are_refused() {
    let refused =
        |fabric: &str, parts: &str| parse(&text(fabric, parts), "test.toml", Path::new("")).unwrap_err().to_string();
    let panel = part("panel", "temperature = 600");
    for (fabric, parts, what) in [
        (
            "",
            part("", "temperature = 600"),
            "`fabric[0].part[0].face`: found an empty name, allowed: the name of a part of the mesh",
        ),
        (
            "",
            panel.clone() + &panel,
            "line 23: `fabric[0].part[1].face`: found \"panel\" for the second time, allowed: each part of a fabric once",
        ),
        (
            "temperature = 300",
            part("panel", ""),
            "line 19: `fabric[0].part[0]`: found a part without a key of its surface, allowed: at least one of `temperature`",
        ),
        ("", part("panel", "accommodation = 1"), "`accommodation` of a part of a fabric without `temperature`"),
        (
            "",
            part("panel", "temperature = 1\naccommodation = 1\nheat_transfer = 1"),
            "`fabric[0].part[0].heat_transfer`: found both `accommodation` and `heat_transfer`",
        ),
        (
            "",
            part("panel", "temperature = -1"),
            "`fabric[0].part[0].temperature`: found -1, allowed: a positive number (K)",
        ),
        ("", part("panel", "friction = 2"), "found 2, allowed: a number from 0 to 1"),
        ("", "[[fabric.part]]\ntemperature = 600\n".to_string(), "face"),
        ("", "[fabric.part]\nface = 'panel'\n".to_string(), "allowed: an array"),
    ] {
        let told = refused(fabric, &parts);
        assert!(told.contains(what), "{told}");
    }
}
