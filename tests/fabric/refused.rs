//! What scenes with fabric cannot have, and files that are none of its.

use std::fs;

use corpuscle::geometry::{MeshShape, Motion as NodeMotion, NodeFrames};
use corpuscle::scene::{self, Method};
use corpuscle::simulation::Model;
use tempfile::TempDir;

use crate::scenes::{Scene, inside_and_outside};

fn ball() -> Scene {
    let mesh = MeshShape::Sphere { radius: 0.03, subdivisions: 1 }.mesh([0.05; 3]).expect("a sphere");
    let frames = NodeMotion::Scale { factor: 0.9 }.frames(&mesh, 3, 1e-3).expect("frames");
    Scene { chambers: inside_and_outside(1e5, 1e5), ..Scene::new(Method::HalfTurn, mesh, Some(frames)) }
}

/// What is said of a scene whose text and files are changed.
fn said(scene: &Scene, change: impl Fn(String, &TempDir) -> String) -> String {
    let folder = TempDir::new().expect("a folder");
    let text = change(scene.text(&folder), &folder);
    match scene::parse(&text, "test.toml", folder.path()) {
        Err(error) => format!("{error:?}"),
        Ok(scene) => match Model::new(scene) {
            Err(error) => error.to_string(),
            Ok(_) => "nothing".into(),
        },
    }
}

#[test]
fn what_fabric_cannot_have_is_told() {
    let scene = ball();
    assert_eq!(said(&scene, |text, _| text), "nothing");
    for (from, to, told) in [
        ("half-turn", "cell", "the method `cell` is not possible in a scene with [[fabric]]"),
        ("half-turn", "control-volume", "the method `control-volume` is not possible"),
        ("method = \"half-turn\"\nparticles = 3000", "accuracy = 0.1", "`accuracy`"),
        ("inside = \"bag\"", "inside = \"bog\"", "the name of a fabric"),
        ("name = \"bag\"\nfile", "name = \"box\"\nfile", "which is the name of a wall"),
        ("bag.obj", "bug.obj", "which does not exist"),
        ("\"bag.nodes\"", "\"bag.obj\"", "a file name that ends with .nodes"),
        (
            "inside = \"bag\"",
            "region = { sphere = { center = [0.0, 0.0, 0.0], radius = 1.0 } }",
            "with a `region` in a scene with fabric",
        ),
    ] {
        let said = said(&scene, |text, _| {
            assert!(text.contains(from), "{from}: {text}");
            text.replace(from, to)
        });
        assert!(said.contains(told), "{to}: {said}");
    }
}

/// A bag whose triangles all face inwards, and the file of its motion that has them so, too: it is turned.
#[test]
fn a_bag_inside_out_is_turned() {
    let mut mesh = MeshShape::Sphere { radius: 0.03, subdivisions: 1 }.mesh([0.05; 3]).expect("a sphere");
    mesh.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    let frames = NodeMotion::Scale { factor: 0.9 }.frames(&mesh, 3, 1e-3).expect("frames");
    let model = Scene { mesh, frames: Some(frames), ..ball() }.model();
    assert!(model.fabric.measures(0.0)[0][0] > 0.0 && model.plan.chambers[0].volume > 0.0);
}

#[test]
fn files_that_do_not_belong_together_are_told() {
    let scene = ball();
    let other = MeshShape::Sphere { radius: 0.03, subdivisions: 2 }.mesh([0.05; 3]).expect("a sphere");
    let mixed = Scene { mesh: other, ..ball() };
    let told = said(&mixed, |text, _| text);
    assert!(told.contains("its motion has 42 nodes, and its mesh 162"), "{told}");

    let jump = |frames: &NodeFrames| {
        let mut positions: Vec<Vec<[f64; 3]>> = (0..frames.frame_count()).map(|k| frames.frame(k).to_vec()).collect();
        positions[1][7] = [7.0; 3];
        NodeFrames::new(frames.times().to_vec(), positions, frames.triangles().to_vec()).expect("frames")
    };
    let jumping = Scene { frames: scene.frames.as_ref().map(jump), ..ball() };
    let told = said(&jumping, |text, _| text);
    assert!(told.contains("node 7") || told.contains("node 8"), "{told}");

    let told = said(&scene, |text, folder| {
        let path = folder.path().join("bag.nodes");
        let bytes = fs::read(&path).expect("the file");
        fs::write(&path, &bytes[..bytes.len() / 2]).expect("written");
        text
    });
    assert!(told.contains("bag.nodes") && !told.contains("nothing"), "{told}");

    // A hole in the surface: it has no inside.
    let mut open = ball();
    open.mesh.triangles.pop();
    open.mesh.parts.pop();
    open.frames = None;
    let told = said(&open, |text, _| text);
    assert!(told.contains("whose surface is open"), "{told}");
}
