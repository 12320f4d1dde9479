//! `collide_moved`: in the cells that a moving wall touches, gas collides as beside the same wall at rest in its place, and
//! never through it.

use std::f64::consts::PI;

use corpuscle::geometry::{MovingWalls, TriangleGrid, Vessel, cell_gas, still_points};
use corpuscle::scene::{GasSide, Shape, Wall};
use corpuscle::subdomain::{CellTable, GpuFlight, GpuMotion, GpuParticle, GpuStep, MOTION_ENTRIES, Walls};

use crate::collide::{Cloud, DIAMETER, DT, first_step, sums};
use crate::fly::{self, outside_bounds};
use crate::neighbour_lists::{self, put_flights, put_to_complete};
use crate::oracle::random::Stream;
use crate::oracle::vector::{Vector, minus, norm};
use crate::oracle::walls::Triangle;
use crate::rig::*;

/// Some two dozen in a cell: many pairs in few runs.
const COUNT: usize = 8000;
const TANK: Vector = [0.06, 0.07, 0.08];
/// From where a wall is at the start of the run to where it is in the step, m.
const WAY: Vector = [0.0205, 0.004, -0.003];
/// Of a plate as wide as the tank.
const ALONG: Vector = [0.0205, 0.0, 0.0];

fn plate(center: Vector, normal: Vector, u: Vector, size: [f64; 2]) -> Shape {
    Shape::Plane { center, normal, u, size, thickness: 0.001, holes: vec![] }
}

fn shifted(place: Vector, way: Vector) -> Vector {
    std::array::from_fn(|axis| place[axis] + way[axis])
}

fn ball(way: Vector) -> Shape {
    Shape::Sphere { center: shifted([0.0152, 0.03, 0.041], way), radius: 0.0137, subdivisions: 2 }
}

/// A tilted plate that ends in the gas.
fn edge(way: Vector) -> Shape {
    plate(shifted([0.0155, 0.031, 0.043], way), [0.8, 0.0, 0.6], [0.0, 1.0, 0.0], [0.0435, 0.0475])
}

/// The second of two walls moves.
struct MovingWorld {
    world: World,
    /// Without it.
    rest: Vessel,
    triangles: TriangleGrid,
    motion: GpuMotion,
    /// The one at rest, and the other as it is at the start of the step, m from the corner of the grid.
    resting: Vec<Triangle>,
    moving: Vec<Triangle>,
}

fn moving_world(walls: &[Wall; 2], moved: Vector, velocity: Vector) -> MovingWorld {
    let mut world = World::new(walls, 0.01);
    let grid = world.grid;
    let vessel = Vessel::build(walls).unwrap();
    let rest = vessel.without(|wall| wall == 1).measured().unwrap();
    let margin = Walls::tolerance(&grid);
    let body = |wall: usize| (wall == 1).then_some(0);
    let moving = MovingWalls { still: &rest, count: 1, number: &body };
    let triangles = TriangleGrid::build_still(&vessel, &grid, margin, &moving).unwrap();
    let moves = |source: usize| body(vessel.triangles[source].wall as usize);
    world.walls = Walls::new(&triangles, &grid, &[], &[], |source| moves(source).is_some()).moving(&triangles, moves);
    let quanta: [i32; 3] = moved.map(|way| (way / grid.quantum()).round() as i32);
    let way = quanta.map(|quanta| f64::from(quanta) * grid.quantum());
    let own = |k: &usize| moves(*k).is_some();
    let place = |k: usize| world.triangles[k].map(|corner| std::array::from_fn(|axis| corner[axis] + way[axis]));
    let moving: Vec<Triangle> = (0..vessel.triangles.len()).filter(own).map(place).collect();
    let resting = (0..vessel.triangles.len()).filter(|k| !own(k)).map(|k| world.triangles[k]).collect();
    let cell = |fold: fn(f64, f64) -> f64, sign: f64| -> [u32; 3] {
        std::array::from_fn(|axis| {
            let ends = moving.iter().flatten().flat_map(|corner| {
                [corner[axis], corner[axis] + velocity[axis] * f64::from(fly::DT)].map(|end| end + sign * margin)
            });
            (ends.reduce(fold).unwrap() / grid.cell) as u32
        })
    };
    let motion = GpuMotion {
        moved: quanta,
        velocity: velocity.map(|v| v as f32),
        low: cell(f64::min, -1.0),
        high: cell(f64::max, 1.0),
        ..GpuMotion::default()
    };
    let motion = world.walls.bodies[0].complete(motion);
    MovingWorld { world, rest, triangles, motion, resting, moving }
}

/// The wall as it is in the step, at rest; and the same gas beside the wall that has moved there from where it is at the start of the run.
fn at_rest_and_moved(seed: u32, shape: &dyn Fn(Vector) -> Shape, gas: GasSide, moved: Vector) -> [Cloud; 2] {
    let at = |way: Vector| [tank(TANK), wall(shape(way), gas)];
    let mut still = Cloud::of(seed, &at(moved), COUNT);
    let MovingWorld { world, rest, triangles, motion, .. } = moving_world(&at([0.0; 3]), moved, [0.0; 3]);
    let grid = &world.grid;
    assert_eq!(*grid, still.world.grid);
    let gas = cell_gas(&rest, grid, &triangles, |_| false);
    let points = still_points(&rest, grid, &triangles, &[[motion.low, motion.high]]);
    let table = CellTable::new(&gas, grid).unwrap().moving(&gas, &points);
    // Only those in the cells at issue, in both.
    let near = |p: &GpuParticle| {
        let c = still.world.cells().cell(p.position);
        (0..3).all(|axis| c[axis] >= motion.low[axis] && c[axis] <= motion.high[axis])
    };
    still.particles.retain(near);
    let cells = still.world.cells();
    let mut start = vec![0u32; still.start.len()];
    for p in &still.particles {
        start[cells.index(cells.cell(p.position)) as usize + 1..].iter_mut().for_each(|later| *later += 1);
    }
    still.start = start;
    let (particles, start) = (still.particles.clone(), still.start.clone());
    [still, Cloud { world, table, particles, start, motion: Some(motion), variant: device().variant() }]
}

/// Collisions of some runs, those through walls left out.
fn collisions(cloud: &Cloud, seeds: u32) -> f64 {
    let of = |seed: u32| {
        let rig = cloud.run(first_step(), seed);
        assert_eq!(rig.counter(LOST), 0);
        f64::from(rig.cell_collisions() - rig.counter(BLOCKED))
    };
    (0..seeds).map(of).sum()
}

/// Pairs times pi sigma^2 g dt, of the velocities at the start: those of two masses start with one speed, become more unequal,
/// and so collide a few per cent more often by the end of a step.
fn swept(members: &[GpuParticle]) -> f64 {
    let of = |a: &GpuParticle, b: &GpuParticle| {
        let g = norm(minus(a.velocity.map(f64::from), b.velocity.map(f64::from)));
        PI * DIAMETER * DIAMETER * g * f64::from(DT)
    };
    members.iter().enumerate().map(|(k, a)| members[k + 1..].iter().map(|b| of(a, b)).sum::<f64>()).sum()
}

/// Particles on the left of the plate and on its right, and the room that each has in a cell.
fn sides(cloud: &Cloud, cell: usize, faces: [f64; 2]) -> [(Vec<GpuParticle>, f64); 2] {
    let grid = &cloud.world.grid;
    let [nx, ny] = [grid.cells[0] as usize, grid.cells[1] as usize];
    let index = [cell % nx, cell / nx % ny, cell / nx / ny];
    let low: Vector = std::array::from_fn(|axis| grid.origin[axis] + index[axis] as f64 * grid.cell);
    let length = |axis: usize, from: f64, to: f64| ((low[axis] + grid.cell).min(to) - low[axis].max(from)).max(0.0);
    let area = length(1, 0.0, TANK[1]) * length(2, 0.0, TANK[2]);
    let of = |left: bool| {
        let here = |p: &&GpuParticle| (grid.to_metres(p.position)[0] < faces[0]) == left;
        let members = cloud.particles[cloud.cell(cell)].iter().filter(here).copied().collect();
        (members, area * if left { length(0, 0.0, faces[0]) } else { length(0, faces[1], TANK[0]) })
    };
    [of(true), of(false)]
}

/// A plate that has moved into a layer of cells parts them: each side collides at the rate of its pairs in its room, and
/// conserves its momentum.
#[test]
fn gas_on_the_two_sides_of_a_moving_plate_collides_by_itself() {
    let at = |way: Vector| plate([0.0135 + way[0], 0.035, 0.04], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [TANK[1], TANK[2]]);
    let [_, cloud] = at_rest_and_moved(71, &at, GasSide::Both, ALONG);
    let faces = [0.0335, 0.0345];
    let cells = 0..cloud.start.len() - 1;
    let (mut expected, mut at_start) = (0.0, 0.0);
    let whole = cloud.world.grid.cell.powi(3);
    for (members, room) in cells.clone().flat_map(|cell| sides(&cloud, cell, faces)) {
        // A side of one particle may have no room, by rounding.
        if members.len() > 1 {
            expected += swept(&members) / room;
            at_start += swept(&members) / whole;
        }
    }
    let seeds = 8;
    let (expected, at_start) = (f64::from(seeds) * expected, f64::from(seeds) * at_start);
    let found = collisions(&cloud, seeds);
    println!("{found} collisions of {expected:.1}; {at_start:.1} with the volumes of the start");
    // The lattice has 89 points along x, so a room of .4 of a cell is good to half of 1/89 in .4.
    let allowed = 4.0 * expected.sqrt() + expected / 178.0 / 0.4;
    assert!(expected > 1500.0 && (found - expected).abs() < allowed, "{found} of {expected} +- {allowed}");
    // The check can fail: with the volumes of the start there would be half as many.
    assert!((at_start - expected).abs() > allowed);

    let exchanged = |cloud: &Cloud| {
        let rig = cloud.run(GpuStep { peers: 1, dt: 4.0 * DT, ..first_step() }, 5);
        let after: Vec<GpuParticle> = rig.get("sorted", cloud.particles.len());
        let told: Vec<u32> = rig.get("neighbour_count", cloud.particles.len());
        let mut through = 0;
        for cell in cells.clone() {
            let range = cloud.cell(cell);
            assert!(cloud.particles[range.clone()] == after[range.clone()] || told[range.start] > 0);
            let behind = |p: &GpuParticle| cloud.world.grid.to_metres(p.position)[0] < faces[0];
            let left = |list: &[GpuParticle]| -> Vec<GpuParticle> { list.iter().copied().filter(behind).collect() };
            let ((before, _, size), (after, ..)) =
                (sums(&left(&cloud.particles[range.clone()])), sums(&left(&after[range])));
            through += u32::from(norm(minus(after, before)) > 32.0 * U * size);
        }
        through
    };
    assert_eq!(exchanged(&cloud), 0, "cells exchanged momentum through the plate");
    // The check can fail: with the walls of the start they do.
    assert!(exchanged(&Cloud { motion: None, ..cloud }) > 10);
}

/// Whatever its shape, a wall that moves leaves the gas the room that is there: of a thick piston, a ball, and a tilted plate
/// that ends in the gas, around whose edge pairs do not see each other.
#[test]
fn a_moving_wall_leaves_the_room_that_is_there() {
    let piston = |way: Vector| Shape::Box {
        min: shifted([0.001, 0.004, 0.01], way),
        max: shifted([0.0135, 0.058, 0.069], way),
        thickness: None,
        holes: vec![],
    };
    let shapes: [(&dyn Fn(Vector) -> Shape, GasSide); 3] =
        [(&piston, GasSide::Outside), (&ball, GasSide::Outside), (&edge, GasSide::Both)];
    let mut fewer = false;
    for (seed, (shape, gas)) in (81..).zip(shapes) {
        let [still, moved] = at_rest_and_moved(seed, shape, gas, WAY);
        let vessel = Vessel::build(&[tank(TANK), wall(shape(WAY), gas)]).unwrap();
        let grid = &moved.world.grid;
        let [nx, ny] = [grid.cells[0] as usize, grid.cells[1] as usize];
        // By a lattice that is finer than the kernel's.
        let room = |cell: usize| {
            let corner = [cell % nx, cell / nx % ny, cell / nx / ny];
            let places = (0..EVERY.pow(3)).map(|k| [k % EVERY, k / EVERY % EVERY, k / EVERY / EVERY]);
            let place = |k: [usize; 3]| -> Vector {
                std::array::from_fn(|axis| {
                    grid.origin[axis] + (corner[axis] as f64 + (k[axis] as f64 + 0.5) / EVERY as f64) * grid.cell
                })
            };
            let gas = places.filter(|&k| vessel.is_gas(place(k))).count();
            grid.cell.powi(3) * gas as f64 / EVERY.pow(3) as f64
        };
        let cells = (0..moved.start.len() - 1).filter(|&cell| moved.cell(cell).len() > 1);
        let seeds = 8;
        let expected: f64 = cells.map(|cell| swept(&moved.particles[moved.cell(cell)]) / room(cell)).sum();
        let expected = expected * f64::from(seeds);
        let [at_rest, found] = [&still, &moved].map(|cloud| collisions(cloud, seeds));
        // Without the wall.
        let gone = GpuMotion { moved: [1 << 30, 0, 0], ..moved.motion.unwrap() };
        let open = collisions(&Cloud { motion: Some(gone), ..moved }, seeds);
        println!("{found} collisions of {expected:.1}; {at_rest} beside the wall at rest, {open} without it");
        // Rooms are good to half of a lattice of 89 points in the mean cell, which is most of one; those of parts at rest too.
        let allowed = |other: f64| 4.0 * other.sqrt() + 0.015 * other;
        assert!(expected > 600.0 && (found - expected).abs() < allowed(expected), "{found} of {expected}");
        assert!((found - at_rest).abs() < allowed(2.0 * at_rest), "{found} and {at_rest}");
        fewer |= (open - expected).abs() > allowed(expected);
    }
    // The check can fail: as if the piston were not there, there are far fewer.
    assert!(fewer);
}

/// Points of a cell along an axis.
const EVERY: usize = 40;

/// Where there are more triangles than a workgroup has room for, it goes through the lists of the wall, with the same results.
#[test]
fn without_room_for_the_triangles_of_a_cell_the_results_are_the_same() {
    let shapes: [(&dyn Fn(Vector) -> Shape, GasSide); 2] = [(&ball, GasSide::Outside), (&edge, GasSide::Both)];
    let mut divided = false;
    for (shape, gas) in shapes {
        let [_, cloud] = at_rest_and_moved(91, shape, gas, WAY);
        let count = cloud.particles.len();
        let [listed, gone_through] = [512.0, 0.0].map(|most| {
            let rig = cloud.run_with(&[("MOST_LISTED", most)], GpuStep { peers: 1, ..first_step() }, 3);
            let words = ["marks", "neighbour_count"].map(|name| rig.get::<u32>(name, count));
            (rig.get::<GpuParticle>("sorted", count), words, rig.cell_collisions(), rig.counter(BLOCKED))
        });
        assert!(listed.2 > 50 && listed.0 != cloud.particles, "{} collisions", listed.2);
        assert!(listed == gone_through);
        divided |= listed.1[0].iter().any(|&part| part > 0);
    }
    assert!(divided, "no cell has parts");
}

/// m/s: the wall flies half a cell in the step.
const FLIGHT: Vector = [150.0, -60.0, 40.0];

/// A flight meets a moving wall when f64 says so, and is among those that may meet a wall.
#[test]
fn flights_meet_a_moving_wall_where_it_is() {
    const COUNT: usize = 8000;
    let walls = [tank(TANK), wall(ball([0.0; 3]), GasSide::Outside)];
    let MovingWorld { world, motion, resting, moving, .. } = moving_world(&walls, WAY, FLIGHT);
    let mut stream = Stream::new(92);
    let mut particles = world.particles(&mut stream, 2 * COUNT, 100.0);
    let vessel = Vessel::build(&walls).unwrap();
    let was = |p: &GpuParticle| -> Vector {
        let place = world.grid.to_metres(p.position);
        std::array::from_fn(|axis| place[axis] - WAY[axis])
    };
    // Outside of the ball where it is now. (What was outside of the tank is no gas there, but none of the ball's.)
    let in_tank = |place: Vector| (0..3).all(|axis| place[axis] > 0.0 && place[axis] < TANK[axis]);
    particles.retain(|p| vessel.is_gas(was(p)) || !in_tank(was(p)));
    particles.truncate(COUNT);
    let flights: Vec<GpuFlight> = (0..particles.len())
        .zip(free_flights(COUNT))
        .map(|(k, flight)| GpuFlight { start: if k % 4 == 0 { 0.3 * fly::DT } else { 0.0 }, ..flight })
        .collect();
    let rig = || {
        let mut rig = Rig::new(&world);
        let mut table = [GpuMotion::default(); MOTION_ENTRIES];
        table[0] = motion;
        rig.uniform("motions", &table);
        rig.constant("MOVING", 1.0);
        rig.constant("MOTIONS", 1.0);
        rig.step(GpuStep { count: COUNT as u32, total: COUNT as u32, dt: fly::DT, ..GpuStep::default() });
        rig
    };
    let mut timed = rig();
    timed.put("sorted", &particles);
    put_flights(&mut timed, &flights);
    put_to_complete(&mut timed, COUNT, &(0..COUNT as u32).collect::<Vec<_>>());
    timed.put("marks", &vec![NEAR; COUNT]);
    timed.run("complete_lists", COUNT);
    let found: Vec<GpuFlight> = neighbour_lists::flights(&timed, COUNT);
    let both = |ball: &[Triangle], velocity: Vector| [(resting.clone(), [0.0; 3]), (ball.to_vec(), velocity)];
    let wrong = |walls: &[(Vec<Triangle>, Vector)]| outside_bounds(&world, walls, &particles, &flights, &found);
    assert_eq!(wrong(&both(&moving, FLIGHT)), 0);
    // The check can fail: dozens meet the ball, and would not at these times if it were gone, or stood still.
    let (gone, stood) = (wrong(&both(&[], [0.0; 3])), wrong(&both(&moving, [0.0; 3])));
    assert!(gone > 50 && stood > 50, "{gone} {stood}");

    let mut free = rig();
    free.constant("COLLISIONS", 0.0);
    free.constant("ROUNDS_OF_PAIRS", 0.0);
    free.put("particles", &particles);
    free.put("sorted", &particles);
    free.put("cell_start", &[0u32]);
    free.put("bouncing", &vec![0u32; COUNT]);
    free.run("advect", COUNT);
    let listed = free.list("bouncing", LIST_BOUNCE);
    let meets = |k: &usize| found[*k].wall < NEVER;
    let from_start = (0..COUNT).filter(|k| flights[*k].start == 0.0);
    assert!(from_start.filter(meets).all(|k| listed.binary_search(&(k as u32)).is_ok()));
    // Of those that no wall at rest has listed there are more in the cells around the ball's box.
    let no_other = |k: &usize| !world.may_hit(&particles[*k], 0.0, fly::DT);
    let boxed = |k: &usize| {
        let c = world.cells().cell(particles[*k].position);
        (0..3).all(|axis| c[axis] + 1 >= motion.low[axis] && c[axis] <= motion.high[axis] + 1)
    };
    let boxed = (0..COUNT).filter(no_other).filter(boxed).count();
    let near = listed.iter().filter(|k| no_other(&(**k as usize))).count();
    assert!(near > 50 && near < boxed * 3 / 4, "{near} of {boxed}");
}
