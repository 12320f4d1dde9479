//! What snapshots tell of elastic fabric.

use std::fs;

use corpuscle::geometry::NodeFrames;
use corpuscle::output::{FabricSnapshot, SnapshotWriter, TriangleSet};
use corpuscle::scene::Method;
use tempfile::TempDir;

use crate::scenes::{ALIKE, Scene};
use crate::sheets::sheet;

/// A sheet held at its edges whose reference is so much of it along each axis, after a few steps among few particles.
fn stretched(shares: [f64; 3]) -> (Scene, FabricSnapshot) {
    let mesh = sheet(0.05, [1e-3, 0.099], 4);
    let mut reference = mesh.clone();
    for place in &mut reference.nodes {
        *place = std::array::from_fn(|axis| 0.05 + shares[axis] * (place[axis] - 0.05));
    }
    let elastic =
        "fixed = \"edge\"\n[fabric.material]\nthickness = 6e-4\ndensity = 800.0\nyoung = 1e9\npoisson = 0.3\n";
    let scene = Scene {
        particles: 400,
        end: 4e-5,
        step: Some(1e-6),
        chambers: ALIKE.replace("1e5", "1e2"),
        elastic: elastic.into(),
        reference: Some(reference),
        ..Scene::new(Method::None, mesh, None)
    };
    let fabric = scene.run().1.outcome.fabric;
    (scene, fabric)
}

/// A sheet lies across the axis of which all its nodes have the same place.
fn across(scene: &Scene) -> usize {
    let nodes = &scene.mesh.nodes;
    (0..3).find(|&axis| nodes.iter().all(|node| node[axis] == nodes[0][axis])).expect("a flat sheet")
}

#[test]
fn a_stretched_sheet_has_the_strain_and_stress_of_its_law() {
    let (scene, fabric) = stretched([0.99; 3]);
    let fields = fabric.fields.expect("a membrane");
    assert_eq!(fields.triangles.len(), scene.mesh.triangles.len());
    let strain = 1.0 / 0.99 - 1.0;
    let stress = (1.0 + strain) * 1e9 / 0.7 * (strain + 0.5 * strain * strain);
    for triangle in &fields.triangles {
        assert_eq!(triangle.tension, 2);
        for k in 0..2 {
            assert!((f64::from(triangle.strain[k]) / strain - 1.0).abs() < 1e-3, "{triangle:?}, not {strain}");
            assert!((f64::from(triangle.stress[k]) / stress - 1.0).abs() < 1e-3, "{triangle:?}, not {stress}");
        }
    }
    // Its edges rest, and the thin gas has set the rest in motion.
    let speeds: Vec<f32> = fields.velocities.iter().map(|v| v.iter().map(|v| v * v).sum::<f32>().sqrt()).collect();
    let moving = speeds.iter().filter(|&&speed| speed > 0.0).count();
    assert_eq!(moving, 9, "of 5 by 5 nodes the inner ones: {speeds:?}");
    assert!(speeds.iter().all(|&speed| speed < 0.1), "{speeds:?}");
}

/// Pulled along one axis and shortened along the other it has wrinkles, and shortened along both it is slack.
#[test]
fn a_shortened_sheet_has_no_stress_across_its_wrinkles() {
    let flat = across(&stretched([0.99; 3]).0);
    let mut shares = [1.02; 3];
    shares[(flat + 1) % 3] = 0.99;
    for (shares, tension) in [(shares, 1), ([1.02; 3], 0)] {
        let fields = stretched(shares).1.fields.expect("a membrane");
        for triangle in &fields.triangles {
            assert_eq!((triangle.tension, triangle.stress[1]), (tension, 0.0));
            assert_eq!(triangle.stress[0] > 1e6, tension == 1, "{triangle:?}");
            assert!((triangle.strain[1] + 0.02 / 1.02).abs() < 1e-3, "{triangle:?}");
        }
    }
}

/// A file with fields is still the motion of another run, and names what it has.
#[test]
fn fields_stand_in_the_file_beside_the_particles() {
    let (scene, fabric) = stretched([0.99; 3]);
    let folder = TempDir::new().expect("a folder");
    let mut writer = SnapshotWriter::create(folder.path()).expect("a folder");
    let (owners, names) = (vec![0; scene.mesh.triangles.len()], vec!["bag".to_owned()]);
    let triangles =
        TriangleSet { vertices: &fabric.nodes, triangles: &scene.mesh.triangles, owners: &owners, names: &names };
    for time in [0.0, 1e-3] {
        writer.write(time, &[]).expect("a snapshot");
        writer.write_fabric(triangles, fabric.fields.as_ref()).expect("its fabric");
    }
    let snapshots = folder.path().join("snapshots");
    let frames = NodeFrames::read(&snapshots.join("fabric.pvd")).expect("a series");
    assert_eq!((frames.frame_count(), frames.frame(1)), (2, &fabric.nodes[..]));
    let bytes = fs::read(snapshots.join("fabric_000001.vtp")).expect("a file");
    let text = String::from_utf8_lossy(&bytes);
    for name in [
        "velocity",
        "max_principal_strain",
        "min_principal_strain",
        "max_principal_stress",
        "min_principal_stress",
        "tension",
    ] {
        assert!(text.contains(&format!("Name=\"{name}\"")), "{name}");
    }
    let mut fields = fabric.fields.expect("a membrane");
    fields.triangles.pop();
    let error = writer.write_fabric(triangles, Some(&fields)).unwrap_err().to_string();
    assert_eq!(error, "the fields of fabric are of 31 triangles, and there are 32");
}
