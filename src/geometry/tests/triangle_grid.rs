//! Which cells each triangle touches, and what the other cells are.

use super::*;
use crate::geometry::triangle_grid::{EARLIER_Y, EARLIER_Z};
use crate::geometry::{CLEARANCE_UNIT, CellClass, Clearance, Grid, MovingWalls, TriangleGrid, clearances};
use glam::{DVec2, DVec3};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::query::details::intersection_test_aabb_triangle;
use parry3d_f64::shape::Triangle;
use proptest::prelude::*;

fn scene(turn: [f64; 3]) -> Vessel {
    let axis = DVec3::from(turn).try_normalize().unwrap_or(DVec3::Z);
    let plate = Shape::Plane {
        center: [0.5; 3],
        normal: axis.to_array(),
        u: axis.any_orthonormal_vector().to_array(),
        size: [0.5, 0.3],
        thickness: 0.03,
        holes: vec![hole("h", Face::Plane, [0.1, 0.0], Outline::Circle { diameter: 0.1, segments: 12 })],
    };
    Vessel::build(&[tank([1.0, 1.1, 0.9]), wall("plate", plate, GasSide::Both)]).unwrap()
}

fn cell_box(grid: &Grid, cell: usize) -> (DVec3, DVec3) {
    let [nx, ny, _] = grid.cells.map(|n| n as usize);
    let index = [cell % nx, cell / nx % ny, cell / nx / ny].map(|i| i as f64);
    let min = DVec3::from(grid.origin) + grid.cell * DVec3::from(index);
    (min, min + DVec3::splat(grid.cell))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Never a touched cell missed; none listed that is further away than rounding.
    #[test]
    fn lists_are_those_of_the_oracle(turn in prop::array::uniform3(-1.0..1.0f64), margin in 0.0..0.02f64) {
        let vessel = scene(turn);
        let grid = Grid::around(vessel.bounds.0, vessel.bounds.1, 0.11).unwrap();
        let built = TriangleGrid::build(&vessel, &grid, margin).unwrap();
        let touches = |cell: usize, t: usize, slack: f64| {
            let (min, max) = cell_box(&grid, cell);
            let grown = DVec3::splat(margin + slack);
            let [low, high] = [min - grown, max + grown].map(|p| Vector::from_array(p.to_array()));
            let [a, b, c] =
                built.triangles[t].corners.map(|c| Vector::from_array(grid.to_metres(c.map(|q| q as u32))));
            intersection_test_aabb_triangle(&Aabb::new(low, high), &Triangle::new(a, b, c))
        };
        let (mut listed, mut unlisted) = (0, 0);
        for cell in 0..grid.cell_count() {
            let list = built.in_cell(cell);
            prop_assert!(list.is_sorted());
            for t in 0..built.triangles.len() {
                if list.contains(&(t as u32)) {
                    listed += 1;
                    prop_assert!(touches(cell, t, 1e-6), "cell {cell} lists {t}");
                } else {
                    unlisted += 1;
                    prop_assert!(!touches(cell, t, -1e-6), "cell {cell} misses {t}");
                }
            }
        }
        // Both answers occur, so either kind of mistake would be seen.
        prop_assert!(listed > 100 && unlisted > 100);
    }

    /// A wall that moves is in the lists of its own box alone, each cell's as if it were at rest; a row has those of its cells, marked
    /// where a row before it has them too.
    #[test]
    fn a_body_has_the_lists_of_its_cells(turn in prop::array::uniform3(-1.0..1.0f64), margin in 0.0..0.02f64) {
        let vessel = scene(turn);
        let grid = Grid::around(vessel.bounds.0, vessel.bounds.1, 0.11).unwrap();
        let at_rest = TriangleGrid::build(&vessel, &grid, margin).unwrap();
        let rest = vessel.without(|wall| wall == 1);
        let moves = |wall: usize| (wall == 1).then_some(0);
        let moving = MovingWalls { still: &rest, count: 1, number: &moves };
        let built = TriangleGrid::build_still(&vessel, &grid, margin, &moving).unwrap();
        let body = &built.bodies[0];
        let of_body = |t: &u32| vessel.triangles[*t as usize].wall == 1;
        let [nx, ny, nz] = body.size;
        let mut found = 0;
        for cell in 0..grid.cell_count() {
            let (own, others): (Vec<u32>, Vec<u32>) = at_rest.in_cell(cell).iter().partition(|t| of_body(t));
            prop_assert_eq!(built.in_cell(cell), &others[..]);
            let [gx, gy, _] = grid.cells.map(|n| n as usize);
            let at = [cell % gx, cell / gx % gy, cell / gx / gy];
            let there: [i64; 3] = std::array::from_fn(|axis| at[axis] as i64 - i64::from(body.low[axis]));
            if (0..3).all(|axis| (0..i64::from(body.size[axis])).contains(&there[axis])) {
                let [x, y, z] = there.map(|n| n as u32);
                prop_assert_eq!(body.cells.of_place(((z * ny + y) * nx + x) as usize), &own[..]);
                found += own.len();
            } else {
                prop_assert!(own.is_empty());
            }
        }
        prop_assert!(found > 20);
        let row = |y: u32, z: u32| body.rows.of_place((z * ny + y) as usize);
        let number = |entry: u32| entry & !(EARLIER_Y | EARLIER_Z);
        let holds = |y: u32, z: u32, t: u32| row(y, z).iter().any(|&entry| number(entry) == t);
        for (z, y) in (0..nz).flat_map(|z| (0..ny).map(move |y| (z, y))) {
            prop_assert!(row(y, z).windows(2).all(|two| number(two[0]) < number(two[1])));
            for x in 0..nx {
                let own = body.cells.of_place(((z * ny + y) * nx + x) as usize);
                prop_assert!(own.iter().all(|&t| holds(y, z, t)));
            }
            for &entry in row(y, z) {
                let earlier = [y > 0 && holds(y - 1, z, number(entry)), z > 0 && holds(y, z - 1, number(entry))];
                prop_assert_eq!([entry & EARLIER_Y > 0, entry & EARLIER_Z > 0], earlier);
            }
        }
    }

    /// Of a cell without triangles every point is what the class says.
    #[test]
    fn classes_are_those_of_points(turn in prop::array::uniform3(-1.0..1.0f64), offset in prop::array::uniform3(0.0..1.0f64)) {
        let vessel = scene(turn);
        let grid = Grid::around(vessel.bounds.0, vessel.bounds.1, 0.037).unwrap();
        let built = TriangleGrid::build(&vessel, &grid, 0.001).unwrap();
        let mut seen = [0; 4];
        for cell in 0..grid.cell_count() {
            let (min, max) = cell_box(&grid, cell);
            let p = (min + (max - min) * DVec3::from(offset)).to_array();
            let class = built.class[cell];
            seen[class as usize] += 1;
            prop_assert_eq!(class == CellClass::Cut, !built.in_cell(cell).is_empty());
            match class {
                CellClass::Clear | CellClass::Gas => prop_assert!(vessel.is_gas(p)),
                CellClass::Solid => prop_assert!(!vessel.is_gas(p)),
                CellClass::Cut => {}
            }
        }
        prop_assert!(seen.iter().all(|&n| n > 0), "{seen:?}");
    }
}

#[test]
fn clear_cells_are_those_with_no_triangle_in_27() {
    let vessel = scene([0.3, 0.2, 1.0]);
    let grid = Grid::around(vessel.bounds.0, vessel.bounds.1, 0.041).unwrap();
    let built = TriangleGrid::build(&vessel, &grid, 0.002).unwrap();
    let [nx, ny, nz] = grid.cells;
    for (x, y, z) in (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| (x, y, z)))) {
        let class = built.class[grid.cell_index([x, y, z])];
        let border = [(x, nx), (y, ny), (z, nz)].iter().any(|&(i, n)| i == 0 || i == n - 1);
        if border {
            assert!(matches!(class, CellClass::Solid | CellClass::Cut));
            continue;
        }
        let near = |dx: u32, dy: u32, dz: u32| built.class[grid.cell_index([x + dx - 1, y + dy - 1, z + dz - 1])];
        let lonely = (0..27).all(|k| near(k % 3, k / 3 % 3, k / 9) != CellClass::Cut);
        assert_eq!(class == CellClass::Clear, lonely && class != CellClass::Solid);
    }
}

#[test]
fn fixed_triangles_keep_ids_and_normals() {
    let vessel = scene([1.0, 2.0, 3.0]);
    let grid = Grid::around(vessel.bounds.0, vessel.bounds.1, 0.02).unwrap();
    let built = TriangleGrid::build(&vessel, &grid, 0.0).unwrap();
    assert_eq!(built.triangles.len(), vessel.triangles.len());
    for (k, (fixed, t)) in built.triangles.iter().zip(&vessel.triangles).enumerate() {
        assert_eq!((fixed.source, fixed.ids), (k as u32, t.vertices));
        let [a, b, c] = t.vertices.map(|v| DVec3::from(vessel.vertices[v as usize]));
        let normal = (b - a).cross(c - a).normalize();
        let error = DVec3::from(fixed.normal.map(f64::from)).distance(normal);
        // A quantum (6e-10 m) over the height of the flattest triangle.
        assert!(error < 1e-5, "{error} {t:?}");
        for (corner, v) in fixed.corners.iter().zip(t.vertices) {
            assert_eq!(corner.map(|q| q as u32), grid.to_fixed(vessel.vertices[v as usize]).unwrap());
        }
    }
}

#[test]
fn triangles_off_the_grid_or_below_its_resolution_are_errors() {
    let vessel = scene([0.0, 0.0, 1.0]);
    let grid = Grid::around([0.0; 3], [0.5; 3], 0.1).unwrap();
    let error = TriangleGrid::build(&vessel, &grid, 0.0).unwrap_err();
    assert!(matches!(&error, GeometryError::OutsideGrid { wall, .. } if wall == "wall `tank`"), "{error}");

    let speck = sphere("speck", [0.5; 3], 1e-10, 0, GasSide::Outside);
    let vessel = Vessel::build(&[tank([1.0; 3]), speck]).unwrap();
    let grid = Grid::around(vessel.bounds.0, vessel.bounds.1, 0.1).unwrap();
    let error = TriangleGrid::build(&vessel, &grid, 0.0).unwrap_err();
    assert!(matches!(&error, GeometryError::DegenerateOnGrid { wall, .. } if wall == "wall `speck`"), "{error}");
}

/// Whether a place is before all planes of a cell's clearance, as `shaders/shared/walls.wgsl` has it.
fn is_before(clearance: Clearance, from_middle: DVec3) -> bool {
    clearance.planes.iter().all(|&plane| is_before_plane(plane, from_middle))
}

fn is_before_plane(plane: u32, from_middle: DVec3) -> bool {
    let [x, y, z, least] = plane.to_le_bytes().map(|byte| f64::from(byte as i8));
    DVec3::new(x, y, z).dot(from_middle) > CLEARANCE_UNIT * least
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// No wall, nor what is nearer to one than the margin, lies before the plane of a cell, and most cells beside walls have one.
    #[test]
    fn walls_lie_behind_the_planes_of_the_cells_near_them(turn in prop::array::uniform3(-1.0..1.0f64), margin in 0.0..2e-3f64) {
        let vessel = scene(turn);
        let grid = Grid::around(vessel.bounds.0, vessel.bounds.1, 0.07).unwrap();
        let built = TriangleGrid::build(&vessel, &grid, margin).unwrap();
        let planes = clearances(&built, &grid, margin);
        let near = (0..grid.cell_count()).filter(|&c| matches!(built.class[c], CellClass::Gas | CellClass::Cut));
        let (mut helped, mut cleared_beside, mut beside) = (0, 0, 0);
        prop_assert_eq!(near.clone().count(), planes.len());
        for (cell, &plane) in near.zip(&planes) {
            let (low, high) = cell_box(&grid, cell);
            let middle = 0.5 * (low + high);
            let reach = DVec3::splat(1.5 * grid.cell);
            for triangle in &vessel.triangles {
                let [a, b, c] = triangle.vertices.map(|v| DVec3::from(vessel.vertices[v as usize]));
                for k in 0..=40 {
                    for l in 0..=40 - k {
                        let (u, v) = (f64::from(k) / 40.0, f64::from(l) / 40.0);
                        let offset = a + u * (b - a) + v * (c - a) - middle;
                        // The margin before the wall, to either side.
                        let normal = (b - a).cross(c - a).normalize();
                        for offset in [offset + 0.99 * margin * normal, offset - 0.99 * margin * normal] {
                            if !offset.abs().cmple(reach).all() {
                                continue;
                            }
                            prop_assert!(!is_before_plane(plane.alone, offset / grid.cell), "cell {} {:x?}", cell, plane);
                            prop_assert!(!is_before(plane, offset / grid.cell), "cell {} {:x?} {}", cell, plane, offset);
                        }
                    }
                }
            }
            let cleared = is_before(plane, DVec3::ZERO);
            helped += usize::from(cleared);
            if built.class[cell] == CellClass::Gas {
                cleared_beside += usize::from(cleared);
                beside += 1;
            }
        }
        // Of most cells beside walls the middle is told to be clear of them; not of all that are cut.
        prop_assert!(cleared_beside * 10 > beside * 6, "{} of {}", cleared_beside, beside);
        prop_assert!(helped < planes.len());
    }
}

/// In a box the planes are its faces, to two units at most: beside a face, along an edge, and in a corner.
#[test]
fn beside_flat_walls_the_planes_are_the_walls() {
    let size = DVec3::new(1.0, 1.03, 0.97);
    let vessel = Vessel::build(&[tank(size.to_array())]).unwrap();
    let grid = Grid::around(vessel.bounds.0, vessel.bounds.1, 0.1).unwrap();
    let built = TriangleGrid::build(&vessel, &grid, 1e-6).unwrap();
    let planes = clearances(&built, &grid, 1e-6);
    let sliver = 2.0 * CLEARANCE_UNIT / 127.0;
    let near: Vec<usize> =
        (0..grid.cell_count()).filter(|&c| matches!(built.class[c], CellClass::Gas | CellClass::Cut)).collect();
    let mut found = [0; 4];
    for (cell, plane) in near.iter().zip(planes) {
        let (low, high) = cell_box(&grid, *cell);
        let middle = 0.5 * (low + high);
        if !(middle.cmpgt(DVec3::ZERO) & middle.cmplt(size)).all() {
            continue;
        }
        let away = |axis: usize| middle[axis].min(size[axis] - middle[axis]) / grid.cell;
        let close: Vec<usize> = (0..3).filter(|&axis| away(axis) < 1.5).collect();
        let inward = |axis: usize| if middle[axis] < 0.5 * size[axis] { DVec3::AXES[axis] } else { -DVec3::AXES[axis] };
        // A sliver before all of them, and a little before one and a sliver before the others.
        let before: DVec3 = close.iter().map(|&axis| (sliver - away(axis)) * inward(axis)).sum();
        assert!(is_before(plane, before), "{cell} {plane:x?}");
        for &axis in &close {
            assert!(!is_before(plane, before + (1e-3 - sliver) * inward(axis)), "{cell} {plane:x?}");
        }
        if let &[axis] = close.as_slice() {
            let beside = DVec3::AXES[(axis + 1) % 3];
            assert!(is_before(plane, before + 1.4 * beside), "{cell} {plane:x?}");
        }
        found[close.len()] += 1;
    }
    assert!(found[1] > 100 && found[2] > 50 && found[3] >= 8, "{found:?}");
}

/// Between two walls that face each other there is a plane for either, and they leave all between free.
#[test]
fn between_walls_that_face_each_other_each_has_its_plane() {
    let vessel = Vessel::build(&[tank([1.0, 1.0, 0.1])]).unwrap();
    let grid = Grid::around(vessel.bounds.0, vessel.bounds.1, 0.1).unwrap();
    let built = TriangleGrid::build(&vessel, &grid, 1e-6).unwrap();
    let near = (0..grid.cell_count()).filter(|&c| matches!(built.class[c], CellClass::Gas | CellClass::Cut));
    let sliver = 2.0 * CLEARANCE_UNIT / 127.0 * grid.cell;
    let mut between = 0;
    for (cell, planes) in near.zip(clearances(&built, &grid, 1e-6)) {
        let (low, high) = cell_box(&grid, cell);
        let middle = 0.5 * (low + high);
        if middle.truncate().cmpge(DVec2::splat(0.2)).all() && middle.truncate().cmple(DVec2::splat(0.8)).all() {
            for z in [sliver, 0.05, 0.1 - sliver] {
                let place = middle.with_z(z) - middle;
                assert!(is_before(planes, place / grid.cell), "{cell} {planes:x?} {place}");
            }
            between += 1;
        }
    }
    assert!(between > 30, "{between}");
}
