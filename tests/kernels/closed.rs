//! Law: no flight passes a closed mesh, whatever edge or corner it is aimed at.
//!
//! Found by it: flights whose end wrapped beyond 2^31 quanta (box), flights from behind a wall whose place on
//! its plane was far back (icosphere), and grazing flights whose place rounding moved off every triangle of a
//! fan (cylinder).

use corpuscle::scene::{Face, GasSide, Hole, Outline, Shape};
use corpuscle::subdomain::{GpuGas, GpuStep, GpuTriangle};

use crate::oracle::random::Stream;
use crate::oracle::vector::{minus, norm, scaled};
use crate::oracle::walls::{lost, point_on};
use crate::rig::*;

const COUNT: usize = 4000;
const DT: f32 = 1e-5;
const ROUNDS: usize = 4;

fn box_world() -> World {
    World::plain()
}

fn hollow_box_with_hole() -> World {
    let hole = Hole {
        name: "hole".into(),
        face: Face::Box { axis: 0, positive: true },
        center: [0.03, 0.03],
        outline: Outline::Rectangle { size: [0.01, 0.01] },
        flow_only: false,
    };
    let inner = Shape::Box { min: [0.02; 3], max: [0.04; 3], thickness: Some(0.004), holes: vec![hole] };
    World::new(&[tank([0.07, 0.06, 0.06]), wall(inner, GasSide::Both)], 0.006)
}

fn cylinder() -> World {
    let shape =
        Shape::Cylinder { base: [1.0, 2.0, 3.0], axis: [0.48, 0.6, 0.64], radius: 0.02, height: 0.06, segments: 24 };
    World::new(&[wall(shape, GasSide::Inside)], 0.007)
}

fn icosphere() -> World {
    let shape = Shape::Sphere { center: [-5.0, 0.3, 0.7], radius: 0.03, subdivisions: 2 };
    World::new(&[wall(shape, GasSide::Inside)], 0.007)
}

fn thin_plate() -> World {
    let plate = Shape::Plane {
        center: [0.03, 0.03, 0.03],
        normal: [0.6, 0.0, 0.8],
        u: [0.8, 0.0, -0.6],
        size: [0.03, 0.03],
        thickness: 0.001,
        holes: vec![],
    };
    World::new(&[tank([0.06; 3]), wall(plate, GasSide::Both)], 0.008)
}

/// What went wrong with flights aimed at the mesh's edges and corners: seen outside by the device at any time,
/// outside by the winding number at the end.
struct Leaks {
    by_device: u32,
    by_winding: usize,
    bounces: u32,
    overshoot: f64,
    truncated: u32,
}

/// Flies particles of no collisions: `ROUNDS` times they are aimed at random corners, edges and faces, and fly
/// some cells far; between, they fly on as they were reflected. `open` lets everything pass one triangle.
fn fly(world: &World, seed: u32, open: Option<usize>) -> Leaks {
    let mut stream = Stream::new(seed);
    let mut rig = Rig::new(world);
    if let Some(hole) = open {
        let mut triangles = world.walls.triangles.clone();
        triangles[hole] = GpuTriangle { normal: [0.0; 3], ..triangles[hole] };
        rig.put("triangles", &triangles);
    }
    for (flag, on) in [("COLLISIONS", 0.0), ("ROUNDS_OF_PAIRS", 0.0), ("ORIFICES", 0.0), ("SURFACES", 0.0)] {
        rig.constant(flag, on);
    }
    rig.gases(&[GpuGas { mass: 1.0, exchange: 0.0, inverse_beta: 0.0, inverse_beta1: 1.0 }; 2]);
    for dummy in ["sorted", "surface_sums"] {
        rig.put(dummy, &[0u32; 12]);
    }
    rig.put("bouncing", &(0..COUNT as u32).collect::<Vec<_>>());
    rig.set_counter(LIST_BOUNCE, COUNT as u32);
    rig.step(GpuStep { count: COUNT as u32, dt: DT, ..GpuStep::default() });
    let slack = 4.0 * world.walls.tolerance;
    let mut particles = world.particles(&mut stream, 6 * COUNT, 400.0);
    particles.retain(|p| !lost(&world.triangles, world.metres(p.position), 0.0));
    particles.truncate(COUNT);
    assert_eq!(particles.len(), COUNT, "enough gas in the box");
    for _ in 0..ROUNDS {
        for particle in &mut particles {
            let triangle = &world.triangles[stream.below(world.triangles.len() as u32) as usize];
            let mut weights = [0, 1, 2].map(|_| stream.uniform());
            // Corners and edges far more often than faces.
            match stream.below(5) {
                0 | 1 => weights[..2].fill(0.0),
                2 | 3 => weights[0] = 0.0,
                _ => {}
            }
            weights.rotate_left(stream.below(3) as usize);
            let target = point_on(triangle, weights);
            let way = minus(target, world.metres(particle.position));
            // Up to some eight cells in a step, the target within reach or not.
            let reach = stream.between(0.2, 8.0) * world.grid.cell;
            let velocity = scaled(way, reach / norm(way).max(1e-6) / f64::from(DT));
            particle.velocity = velocity.map(|v| v as f32);
        }
        rig.put("particles", &particles);
        for _ in 0..4 {
            rig.run("bounce", COUNT);
        }
        particles = rig.get("particles", COUNT);
    }
    Leaks {
        by_device: rig.counter(OUTSIDE),
        by_winding: particles.iter().filter(|p| lost(&world.triangles, world.metres(p.position), slack)).count(),
        bounces: rig.counter(BOUNCES),
        overshoot: f64::from(rig.counter(OVERSHOOT)) * world.grid.quantum(),
        truncated: rig.counter(TRUNCATED),
    }
}

fn assert_tight(name: &str, world: &World, seed: u32) {
    let leaks = fly(world, seed, None);
    assert_eq!((leaks.by_device, leaks.by_winding), (0, 0), "{name}");
    assert!(leaks.bounces as usize > 4 * COUNT, "{name}: {} bounces", leaks.bounces);
    assert!(leaks.overshoot <= world.walls.tolerance, "{name}: {} m", leaks.overshoot);
    assert!((leaks.truncated as usize) < COUNT / 20, "{name}: {} cut short", leaks.truncated);
}

#[test]
fn a_box_is_tight() {
    assert_tight("box", &box_world(), 20);
}

#[test]
fn a_hollow_box_with_a_hole_is_tight() {
    assert_tight("hollow box", &hollow_box_with_hole(), 21);
}

#[test]
fn a_cylinder_is_tight() {
    assert_tight("cylinder", &cylinder(), 22);
}

#[test]
fn an_icosphere_is_tight() {
    assert_tight("icosphere", &icosphere(), 23);
}

#[test]
fn a_plate_of_a_millimetre_is_tight() {
    assert_tight("plate", &thin_plate(), 24);
}

/// The check can fail: with one triangle open both counts see the leak.
#[test]
fn a_missing_triangle_is_seen_to_leak() {
    let leaks = fly(&icosphere(), 25, Some(0));
    assert!(leaks.by_device > 0 && leaks.by_winding > 0, "{} {}", leaks.by_device, leaks.by_winding);
}
