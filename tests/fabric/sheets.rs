//! Open fabric.

use corpuscle::geometry::{NodeFrames, TriangleMesh};
use corpuscle::scene::Method;
use corpuscle::simulation::initial_particles;

use crate::scenes::Scene;

/// A square sheet across x at a place, of so many elements a side, that reaches into the walls.
pub fn sheet(x: f64, [low, high]: [f64; 2], elements: u32) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let along = |k: u32| low + (high - low) * f64::from(k) / f64::from(elements);
    for j in 0..=elements {
        for i in 0..=elements {
            mesh.nodes.push([x, along(i), along(j)]);
        }
    }
    for j in 0..elements {
        for i in 0..elements {
            let a = j * (elements + 1) + i;
            let (b, c, d) = (a + 1, a + elements + 2, a + elements + 1);
            mesh.triangles.extend(if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
        }
    }
    mesh.parts = vec![None; mesh.triangles.len()];
    mesh
}

/// A sheet that goes along x as a piston compresses the gas before it and lets that behind it expand, as by the adiabatic law.
#[test]
fn a_sheet_is_a_piston() {
    for method in [Method::None, Method::HalfTurn, Method::ClosestApproach] {
        let end = 4e-3;
        let mesh = sheet(0.05, [-1e-4, 0.1001], 6);
        let times: Vec<f64> = (0..=100).map(|k| end * f64::from(k) / 100.0).collect();
        // Starts and ends at rest.
        let way = |t: f64| 0.02 * (t / end - (std::f64::consts::TAU * t / end).sin() / std::f64::consts::TAU);
        let frames = times.iter().map(|&t| mesh.nodes.iter().map(|&[x, y, z]| [x + way(t), y, z]).collect()).collect();
        let frames = NodeFrames::new(times.clone(), frames, mesh.triangles.clone()).expect("frames");
        let scene = Scene { end, rows: 20, particles: 8000, ..Scene::new(method, mesh, Some(frames)) };
        let (model, run) = scene.run();
        let last = run.rows.last().expect("rows");
        let at = 0.05 + way(last.time);
        // Left of it the gas expands from 5 to 7 cm, right of it is compressed from 5 to 3 cm.
        let law = |length: f64| 1e5 * (0.05f64 / length).powf(1.4);
        let grid = &model.plan.grid;
        let left = run.outcome.particles.iter().filter(|p| grid.to_metres(p.position)[0] < 0.05 + way(end)).count();
        let begun = initial_particles(&model).expect("initial particles");
        let start = begun.iter().filter(|p| grid.to_metres(p.position)[0] < 0.05).count();
        let [outer, inner] = last.fabrics[0].pressure;
        eprintln!(
            "{}: {left} left of it of {start}; {inner:.0} and {outer:.0} Pa, law {:.0} and {:.0} Pa",
            method.name(),
            law(at),
            law(0.1 - at),
        );
        assert_eq!(left, start, "{}: particles have passed", method.name());
        if method != Method::None {
            for (found, law) in [(inner, law(at)), (outer, law(0.1 - at))] {
                assert!((found / law - 1.0).abs() < 0.06, "{}: {found} Pa, law {law} Pa", method.name());
            }
        }
    }
}
