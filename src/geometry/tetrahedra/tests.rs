use super::*;
use crate::geometry::{MeshShape, Motion, TriangleMesh};

fn tetrahedra(mesh: &TriangleMesh) -> (ClosedSurface, Tetrahedra) {
    let surface = ClosedSurface::new(&mesh.nodes, &mesh.triangles, "a bag").unwrap();
    let all = Tetrahedra::new(&surface, &mesh.nodes, &mesh.triangles);
    (surface, all)
}

fn points(all: &Tetrahedra, number: u32) -> Vec<[f64; 3]> {
    // Steele, Lea and Flood 2014.
    let mut state = 3_u64;
    let mut uniform = || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..number).map(|_| all.point(std::array::from_fn(|_| uniform())).unwrap()).collect()
}

/// Turned about all axes, and far away.
fn placed(mut mesh: TriangleMesh) -> TriangleMesh {
    let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.4, 0.9, -0.3);
    for node in &mut mesh.nodes {
        *node = (turn * DVec3::from(*node) + DVec3::new(30.0, -70.0, 200.0)).to_array();
    }
    mesh
}

/// A bag of two flat sheets 1:1000 apart that is folded to and fro along x: layers of a hundredth of its side.
fn folded() -> TriangleMesh {
    let mut mesh = MeshShape::Teabag { side: 1.0, elements: 40, gap: 1e-3 }.mesh([0.0; 3]).unwrap();
    let (leg, height) = (0.25, 0.01);
    for node in &mut mesh.nodes {
        let [x, y, z] = *node;
        let along = (x + 0.5) / leg;
        let fold = (along.floor() as i32).min(3);
        let on_leg = along - f64::from(fold);
        if (1..4).contains(&(along.round() as i32)) && (along - along.round()).abs() < 1e-9 {
            // In the fold the thickness is along x.
            *node = [leg * (along.round() % 2.0) - z, y, height * along.round()];
            continue;
        }
        let there = if fold % 2 == 0 { on_leg } else { 1.0 - on_leg };
        // A leg rises to the next; its thickness is across it, which is turned over in every second one.
        *node = [leg * there, y, height * (f64::from(fold) + on_leg) + if fold % 2 == 0 { z } else { -z }];
    }
    mesh
}

fn shaken() -> TriangleMesh {
    let bag = MeshShape::Teabag { side: 1.0, elements: 12, gap: 0.2 }.mesh([0.0; 3]).unwrap();
    let shake = Motion::Shake { speed: 1.0, amplitude: Some(0.03), seed: 7 };
    TriangleMesh { nodes: shake.frames(&bag, 40, 1.0).unwrap().at(0.9), ..bag }
}

fn meshes() -> Vec<TriangleMesh> {
    let shapes = [
        MeshShape::Sphere { radius: 1.0, subdivisions: 3 },
        MeshShape::Cushion { radius: 0.5, rings: 12, gap: 5e-4 },
        MeshShape::Teabag { side: 1.0, elements: 20, gap: 1e-3 },
        MeshShape::Cylinder { radius: 0.2, height: 1.0, around: 24, along: Some(3), closed: true },
    ];
    let mut meshes: Vec<TriangleMesh> = shapes.iter().map(|shape| shape.mesh([0.0; 3]).unwrap()).collect();
    meshes.extend([folded(), shaken()]);
    // A hollow: a sphere turned inwards within another.
    let mut hollow = meshes[0].clone();
    let first = hollow.nodes.len() as u32;
    hollow.nodes.extend(meshes[0].nodes.iter().map(|node| node.map(|x| 0.5 * x)));
    hollow.triangles.extend(meshes[0].triangles.iter().map(|t| [t[0] + first, t[2] + first, t[1] + first]));
    meshes.push(hollow);
    let turned: Vec<TriangleMesh> = meshes.iter().cloned().map(placed).collect();
    meshes.into_iter().chain(turned).collect()
}

#[test]
fn tetrahedra_fill_the_surface_and_nothing_else() {
    for (k, mesh) in meshes().iter().enumerate() {
        let (surface, all) = tetrahedra(mesh);
        let volume = crate::geometry::closed::signed_volume(
            &mesh.nodes.iter().map(|&node| DVec3::from(node)).collect::<Vec<_>>(),
            &mesh.triangles,
        );
        let outside = points(&all, 20_000).iter().filter(|&&point| !surface.contains(point)).count();
        eprintln!(
            "{k}: {} tetrahedra of {} triangles, {outside} points outside",
            all.corners.len(),
            mesh.triangles.len()
        );
        // (Rounding may put one that is drawn next to the surface behind it.)
        assert!((all.volume() / volume - 1.0).abs() < 1e-9, "{k}: {} {volume}", all.volume());
        assert!(outside <= 2, "{k}: {outside}");
    }
}

/// By the columns that lines through its box measure apart from it, in the lower and the upper half of each: chi-square, within 5 standard errors.
#[test]
fn points_are_uniform() {
    const NUMBER: u32 = 200_000;
    const SIDE: usize = 8;
    for (k, mesh) in meshes().iter().enumerate() {
        let (surface, all) = tetrahedra(mesh);
        let corners = mesh.nodes.iter().map(|&node| DVec3::from(node));
        let far = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = corners.fold(far, |(low, high), node| (low.min(node), high.max(node)));
        let bin = |point: DVec3| {
            let bins = DVec3::new(2.0, SIDE as f64, SIDE as f64) * (1.0 - 1e-12);
            let share = ((point - low) / (high - low) * bins).to_array();
            (share[0] as usize * SIDE + share[1] as usize) * SIDE + share[2] as usize
        };
        let mut expected = vec![0.0; 2 * SIDE * SIDE];
        let lines = 1_u64 << 18;
        let middle = 0.5 * (low.x + high.x);
        for i in 0..lines {
            let [u, v] = crate::geometry::sampling::r2(i);
            let (y, z) = (low.y + u * (high.y - low.y), low.z + v * (high.z - low.z));
            for (from, to) in surface.within(y, z) {
                for (a, b) in [(from, to.min(middle)), (from.max(middle), to)] {
                    if b > a {
                        expected[bin(DVec3::new(0.5 * (a + b), y, z))] += b - a;
                    }
                }
            }
        }
        let whole: f64 = expected.iter().sum();
        let mut found = vec![0.0; expected.len()];
        points(&all, NUMBER).iter().for_each(|&point| found[bin(DVec3::from(point))] += 1.0);
        let (mut chi, mut freedom) = (0.0, -1.0);
        for (found, share) in found.iter().zip(&expected) {
            let number = f64::from(NUMBER) * share / whole;
            // (Of bins with little in them the lines do not know the volume well enough.)
            if number > 200.0 {
                chi += (found - number) * (found - number) / number;
                freedom += 1.0;
            } else {
                assert!((found - number).abs() < 6.0 * number.sqrt().max(3.0), "{k}: {found} of {number}");
            }
        }
        eprintln!("{k}: chi-square {chi:.1} of {freedom}");
        assert!(freedom > 20.0 && (chi - freedom).abs() < 5.0 * (2.0f64 * freedom).sqrt(), "{k}: {chi} of {freedom}");
    }
}

/// The check can fail: by area alone a cushion, whose sheets meet at the rim, is not filled evenly.
#[test]
fn a_cushion_is_thinner_at_its_rim() {
    let mesh = MeshShape::Cushion { radius: 0.5, rings: 12, gap: 5e-4 }.mesh([0.0; 3]).unwrap();
    let (_, all) = tetrahedra(&mesh);
    let share = |from: f64| {
        let outer = points(&all, 20_000).iter().filter(|[x, y, _]| x.hypot(*y) > from).count();
        outer as f64 / 20_000.0
    };
    let by_area = 1.0 - 0.46 * 0.46 / 0.25;
    assert!(share(0.46) < 0.75 * by_area, "{} {by_area}", share(0.46));
}
