//! Meshes of the primitives, where the gas is, and how much of it.

use super::*;
use crate::geometry::check_closed;
use glam::DVec3;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::Shape as _;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

const UP: Face = Face::Box { axis: 2, positive: true };
const LEFT: Face = Face::Box { axis: 1, positive: false };

fn all_shapes() -> Vec<Wall> {
    let square = Outline::Rectangle { size: [0.05, 0.04] };
    let round = Outline::Circle { diameter: 0.06, segments: 24 };
    let holes = vec![
        hole("a", UP, [0.4, 0.3], square),
        hole("b", UP, [0.5, 0.3], round),
        hole("c", LEFT, [0.45, 0.42], square),
    ];
    let normal = DVec3::new(1.0, 2.0, 2.0).normalize();
    let u = normal.any_orthonormal_vector();
    let plane = Shape::Plane {
        center: [0.8, 0.7, 0.6],
        normal: normal.to_array(),
        u: u.to_array(),
        size: [0.3, 0.2],
        thickness: 0.02,
        holes: vec![hole("d", Face::Plane, [0.05, -0.02], round), hole("e", Face::Plane, [-0.06, 0.0], square)],
    };
    let cylinder =
        Shape::Cylinder { base: [1.3, 0.3, 0.2], axis: normal.to_array(), radius: 0.1, height: 0.2, segments: 17 };
    vec![
        tank([2.0, 1.0, 1.0]),
        pierced_box([0.3, 0.2, 0.3], [0.6, 0.4, 0.5], 0.01, holes),
        wall("plate", plane, GasSide::Both),
        wall("rod", cylinder, GasSide::Outside),
        sphere("ball", [1.7, 0.7, 0.7], 0.15, 3, GasSide::Outside),
    ]
}

/// What the solid of each wall of `all_shapes` holds, by the shapes' formulae.
fn right_volumes() -> [f64; 5] {
    let (square, round) = (0.05 * 0.04, PI * 0.03f64.powi(2));
    [
        2.0,
        0.32 * 0.22 * 0.22 - 0.3 * 0.2 * 0.2 - 0.01 * (2.0 * square + round),
        0.02 * (0.3 * 0.2 - square - round),
        0.2 * PI * 0.01,
        4.0 / 3.0 * PI * 0.15f64.powi(3),
    ]
}

#[test]
fn every_primitive_is_closed_with_the_volume_of_its_formula() {
    let vessel = Vessel::build(&all_shapes()).unwrap();
    let vertices: Vec<DVec3> = vessel.vertices.iter().map(|v| DVec3::from(*v)).collect();
    for (k, right) in right_volumes().into_iter().enumerate() {
        let triangles: Vec<[u32; 3]> =
            vessel.triangles.iter().filter(|t| t.wall == k as u32).map(|t| t.vertices).collect();
        check_closed("w", &vertices, &triangles).unwrap();
        let found = vessel.walls[k].volume;
        assert!((found / right - 1.0).abs() < 1e-12, "{}: {found} {right}", vessel.walls[k].name);
        let parry = oracle(&vessel, k as u32).mass_properties(1.0).mass();
        assert!((found / parry - 1.0).abs() < 1e-9, "{}: {found} {parry}", vessel.walls[k].name);
        assert!(check_closed("w", &vertices, &triangles[1..]).is_err());
    }
    assert!(!vessel.overlaps());
    let solids: f64 = vessel.walls[1..].iter().map(|w| w.volume).sum();
    assert!((vessel.gas_volume() - (2.0 - solids)).abs() < 1e-12);
}

#[test]
fn normals_point_into_the_gas() {
    for vessel in [Vessel::build(&all_shapes()).unwrap(), Vessel::build(&[tank([1.0, 2.0, 3.0])]).unwrap()] {
        for t in &vessel.triangles {
            let [a, b, c] = t.vertices.map(|v| DVec3::from(vessel.vertices[v as usize]));
            let step = 1e-6 * (b - a).cross(c - a).normalize();
            let centre = (a + b + c) / 3.0;
            assert!(vessel.is_gas((centre + step).to_array()), "{t:?}");
            assert!(!vessel.is_gas((centre - step).to_array()), "{t:?}");
        }
    }
}

#[test]
fn faces_are_those_of_the_box_and_of_the_cavity() {
    let vessel = Vessel::build(&all_shapes()).unwrap();
    let area = |wall: u32, face: Option<Face>| -> f64 {
        let chosen = vessel.triangles.iter().filter(|t| t.wall == wall && t.face == face);
        chosen
            .map(|t| {
                let [a, b, c] = t.vertices.map(|v| DVec3::from(vessel.vertices[v as usize]));
                (b - a).cross(c - a).length() / 2.0
            })
            .sum()
    };
    assert!((area(0, Some(UP)) - 2.0).abs() < 1e-12);
    assert!((area(1, Some(UP)) - (0.3 * 0.2 - 0.05 * 0.04 - PI * 0.03 * 0.03)).abs() < 1e-12);
    assert!((area(1, Some(LEFT)) - (0.3 * 0.2 - 0.05 * 0.04)).abs() < 1e-12);
    let of_plane = [Face::Front, Face::Back, Face::Rim].map(|face| area(2, Some(face)));
    assert!((of_plane.iter().sum::<f64>() - vessel.walls[2].area).abs() < 1e-12);
    assert!((of_plane[0] - of_plane[1]).abs() < 1e-12 && of_plane[2] > 0.0);
}

#[test]
fn holes_are_found_where_they_were_cut() {
    let vessel = Vessel::build(&all_shapes()).unwrap();
    assert_eq!(
        vessel.holes.iter().map(|h| (h.name.as_str(), h.wall)).collect::<Vec<_>>(),
        [("c", 1), ("a", 1), ("b", 1), ("d", 2), ("e", 2)]
    );
    let [c, a, b] = [0, 1, 2].map(|k| &vessel.holes[k]);
    assert!(DVec3::from(a.center).distance(DVec3::new(0.4, 0.3, 0.505)) < 1e-15 && a.normal == [0.0, 0.0, 1.0]);
    assert!(DVec3::from(c.center).distance(DVec3::new(0.45, 0.195, 0.42)) < 1e-15);
    assert_eq!(DVec3::from(c.normal), -DVec3::Y);
    assert!((a.area - 0.002).abs() < 1e-15 && (a.perimeter - 0.18).abs() < 1e-15 && (a.thickness - 0.01).abs() < 1e-15);
    // The circle's area, on a polygon with a longer rim.
    assert!((b.area - PI * 9e-4).abs() < 1e-15 && b.perimeter > TAU * 0.03 && b.perimeter < 1.01 * TAU * 0.03);
    for h in &vessel.holes {
        // Gas all along the axis of the hole, and solid beside it.
        for s in [-0.49, 0.0, 0.49] {
            let p = DVec3::from(h.center) + s * h.thickness * DVec3::from(h.normal);
            assert!(vessel.is_gas(p.to_array()), "{}", h.name);
            let aside = p + 0.04 * DVec3::from(h.normal).any_orthonormal_vector();
            assert!(!vessel.is_gas(aside.to_array()), "{}", h.name);
        }
    }
}

#[test]
fn a_plate_let_into_the_walls_divides_the_volume() {
    let plane = |size: f64| Shape::Plane {
        center: [0.5, 0.5, 0.5],
        normal: [1.0, 0.0, 0.0],
        u: [0.0, 1.0, 0.0],
        size: [size, size],
        thickness: 0.1,
        holes: vec![hole("h", Face::Plane, [0.1, 0.2], Outline::Rectangle { size: [0.2, 0.1] })],
    };
    let right = 1.0 - 0.1 + 0.1 * 0.2 * 0.1;
    for (size, overlaps, tolerance) in [(1.0, false, 1e-12), (1.06, true, 1e-5), (1.5, true, 2e-4)] {
        let vessel = Vessel::build(&[tank([1.0; 3]), wall("plate", plane(size), GasSide::Both)]).unwrap();
        assert_eq!(vessel.overlaps(), overlaps, "{size}");
        assert!((vessel.gas_volume() - right).abs() < tolerance, "{size}: {}", vessel.gas_volume() - right);
        assert_eq!(vessel.gas_intervals(0.1, 0.1), [(0.0, 0.45), (0.55, 1.0)]);
        assert_eq!(vessel.gas_intervals(0.6, 0.7), [(0.0, 1.0)]);
    }
}

#[test]
fn overlapping_spheres_leave_the_volume_of_their_union() {
    let ball = |name: &str, x: f64| sphere(name, [x, 0.5, 0.5], 0.2, 5, GasSide::Outside);
    let vessel = Vessel::build(&[tank([1.0; 3]), ball("a", 0.4), ball("b", 0.6)]).unwrap();
    // Two caps of height r - d/2 = 0.1.
    let lens = 2.0 * PI * 0.1f64.powi(2) * (3.0 * 0.2 - 0.1) / 3.0;
    let right = 1.0 - (2.0 * 4.0 / 3.0 * PI * 0.2f64.powi(3) - lens);
    assert!(vessel.overlaps());
    assert!((vessel.gas_volume() - right).abs() < 1e-4, "{}", vessel.gas_volume() - right);
    // Without the lens it would be off by 1e-2.
    assert!(lens > 1e-2);
}

/// What is beyond the space that all cavities share changes nothing, to the last bit, wherever it is.
#[test]
fn bodies_outside_leave_the_volume() {
    let alone = Vessel::build(&[tank([0.1; 3])]).unwrap().gas_volume();
    for far in [0.3, 4.0, 7.0] {
        let body = sphere("far", [far; 3], 0.05, 2, GasSide::Outside);
        let vessel = Vessel::build(&[tank([0.1; 3]), body]).unwrap();
        assert_eq!(vessel.gas_volume(), alone, "at {far} m");
    }
}

/// Of what sticks out of a tank only the part inside counts, however long it is; of cavities only what they share.
#[test]
fn what_sticks_out_and_cavities_that_meet_leave_what_is_inside() {
    let block = |min: [f64; 3], max: [f64; 3], gas: GasSide| {
        let middle = std::array::from_fn(|k| (min[k] + max[k]) / 2.0);
        let shape = Shape::Plane {
            center: middle,
            normal: [1.0, 0.0, 0.0],
            u: [0.0, 1.0, 0.0],
            size: [max[1] - min[1], max[2] - min[2]],
            thickness: max[0] - min[0],
            holes: vec![],
        };
        wall("rod", shape, gas)
    };
    let rod = block([-0.01, 0.04, 0.04], [20.0, 0.06, 0.06], GasSide::Both);
    let vessel = Vessel::build(&[tank([0.1; 3]), rod]).unwrap();
    assert!((vessel.gas_volume() / 0.96e-3 - 1.0).abs() < 1e-4, "{}", vessel.gas_volume());
    let other = |min: [f64; 3], max: [f64; 3]| {
        let shape = Shape::Box { min, max, thickness: None, holes: vec![] };
        wall("other", shape, GasSide::Inside)
    };
    let vessel = Vessel::build(&[tank([0.1; 3]), other([0.05; 3], [0.3; 3])]).unwrap();
    assert!((vessel.gas_volume() / 0.125e-3 - 1.0).abs() < 1e-4, "{}", vessel.gas_volume());
    assert_eq!(build_error(&[tank([0.1; 3]), other([0.2; 3], [0.3; 3])]), GeometryError::NoGas);
}

#[test]
fn malformed_walls_are_refused_by_name() {
    let ball = |gas| sphere("ball", [0.5; 3], 0.2, 1, gas);
    let shell = |center: [f64; 2], size: f64| {
        let holes = vec![
            hole("first", UP, [0.4, 0.4], Outline::Circle { diameter: 0.1, segments: 8 }),
            hole("vent", UP, center, Outline::Rectangle { size: [size, size] }),
        ];
        build_error(&[tank([1.0; 3]), pierced_box([0.3; 3], [0.7; 3], 0.05, holes)])
    };
    assert_eq!(build_error(&[ball(GasSide::Outside)]), GeometryError::Unbounded);
    assert_eq!(build_error(&[tank([0.1; 3]), sphere("b", [5.0; 3], 1.0, 1, GasSide::Inside)]), GeometryError::NoGas);
    assert!(matches!(build_error(&[ball(GasSide::Both)]), GeometryError::Side { found: "both", .. }));
    let message = shell([0.7, 0.5], 0.1).to_string();
    assert_eq!(message, "wall `shell`: hole `vent` does not lie within its face");
    assert_eq!(shell([0.45, 0.4], 0.04).to_string(), "wall `shell`: hole `vent` overlaps hole `first`");
    assert!(matches!(shell([0.6, 0.6], -0.1), GeometryError::Hole { .. }));
    assert!(matches!(build_error(&[tank([1.0, 0.0, 1.0])]), GeometryError::Shape { .. }));
    assert!(matches!(build_error(&[tank([1.0, f64::NAN, 1.0])]), GeometryError::Shape { .. }));
    let plain = Shape::Box {
        min: [0.0; 3],
        max: [1.0; 3],
        thickness: None,
        holes: vec![hole("h", UP, [0.5; 2], Outline::Rectangle { size: [0.1; 2] })],
    };
    assert!(build_error(&[wall("w", plain, GasSide::Inside)]).to_string().contains("needs a wall with a thickness"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Containment by rays along x agrees with the oracle's pseudo-normals.
    #[test]
    fn a_point_is_in_the_gas_where_the_oracle_says(
        center in prop::array::uniform3(0.3..0.7f64),
        axis in prop::array::uniform3(-1.0..1.0f64),
        points in prop::collection::vec(prop::array::uniform3(-0.1..1.1f64), 32),
    ) {
        let axis = DVec3::from(axis);
        prop_assume!(axis.length() > 0.1);
        let axis = axis.normalize();
        let rod = Shape::Cylinder { base: center, axis: axis.to_array(), radius: 0.12, height: 0.15, segments: 11 };
        let vessel = Vessel::build(&[tank([1.0; 3]), wall("rod", rod, GasSide::Outside)]).unwrap();
        let mut mesh = oracle(&vessel, 1);
        mesh.set_flags(parry3d_f64::shape::TriMeshFlags::ORIENTED).unwrap();
        for p in points {
            let point = Vector::from_array(p);
            let inside = p.iter().all(|c| (0.0..1.0).contains(c));
            prop_assert_eq!(vessel.is_gas(p), inside && !mesh.contains_local_point(point), "{:?}", p);
        }
        // The centre of the rod is a case of the other answer.
        let middle = DVec3::from(center) + 0.07 * axis;
        prop_assert!(!vessel.is_gas(middle.to_array()) && mesh.contains_local_point(Vector::from_array(middle.to_array())));
    }

    /// Points on a lattice that holds vertices, edges and diagonals of the walls: never inconsistent.
    #[test]
    fn intervals_and_depths_agree_also_on_edges(line in prop::array::uniform2(-1i32..=9), x in -1i32..=17) {
        let walls = [tank([1.0; 3]), hollow_box([0.25; 3], [0.75; 3], 0.125)];
        let vessel = Vessel::build(&walls).unwrap();
        let [y, z] = line.map(|k| f64::from(k) / 8.0);
        let x = f64::from(x) / 16.0 + 1.0 / 32.0;
        let within = vessel.gas_intervals(y, z).iter().any(|&(a, b)| a < x && x < b);
        prop_assert_eq!(vessel.is_gas([x, y, z]), within);
        prop_assert!((0..=1).contains(&vessel.solid_depth([x, y, z])));
    }
}
