//! `complete_lists` within a bound of f64, `advect` to the last bit of v dt.

use corpuscle::scene::{GasSide, Shape};
use corpuscle::subdomain::{GpuFlight, GpuNewborn, GpuParticle, GpuStep};

use crate::neighbour_lists::{self, put_flights, put_to_complete};
use crate::oracle::random::Stream;
use crate::oracle::vector::{Vector, along, minus, norm, scaled};
use crate::oracle::walls::{Triangle, crossings};
use crate::rig::*;

const COUNT: usize = 2000;
pub const DT: f32 = 3e-5;

/// How many of the device's wall times are outside the bounds of the f64 test against `walls`: triangles as they are at the start of the
/// step, and their velocity.
///
/// A distance from a plane errs by 10 u of the world's size and two quanta (rounding of differences, normal
/// and dot product), the approach speed by 8 u |v|; divided by the approach speed that is an error of time.
/// Flights within `slack` of an edge may meet the triangle or not.
pub fn outside_bounds(
    world: &World,
    walls: &[(Vec<Triangle>, Vector)],
    particles: &[GpuParticle],
    flights: &[GpuFlight],
    found: &[GpuFlight],
) -> usize {
    let slack = 4.0 * world.walls.tolerance;
    let size = norm(world.high);
    let wrong = |k: usize| {
        let (v, start) = (particles[k].velocity.map(f64::from), f64::from(flights[k].start));
        let x = along(world.metres(particles[k].position), v, start);
        let error = |approach: f64| {
            (10.0 * U * size + 2.0 * world.grid.quantum() + 8.0 * U * norm(v) * f64::from(DT)) / approach
                + 4.0 * U * f64::from(DT)
        };
        let (mut latest, mut earliest) = (f64::INFINITY, f64::INFINITY);
        // In the frame of each wall, in which it has gone nowhere when the flight starts.
        let hits = walls.iter().flat_map(|(triangles, velocity)| {
            crossings(triangles, along(x, *velocity, -start), minus(v, *velocity), slack)
        });
        for hit in hits {
            let time = start + hit.time.max(0.0);
            if hit.inset > slack && time + error(hit.approach) < f64::from(DT) {
                latest = latest.min(time + error(hit.approach));
            }
            if hit.inset > -slack && time - error(hit.approach) < f64::from(DT) {
                earliest = earliest.min(time - error(hit.approach));
            }
        }
        let time = f64::from(found[k].wall);
        if found[k].wall == NEVER { latest < f64::INFINITY } else { time < earliest || time > latest }
    };
    (0..particles.len()).filter(|&k| wrong(k)).count()
}

/// The time of a flight's first wall is that of f64 within the rounding of f32; flights that start on a wall
/// and turn into it hit at once.
#[test]
fn wall_times_are_those_of_a_swept_test_in_f64() {
    let world = World::plain();
    let mut stream = Stream::new(15);
    let mut particles = world.particles(&mut stream, COUNT, 700.0);
    for (k, particle) in particles.iter_mut().enumerate().take(60) {
        let axis = k % 3;
        let face = if k % 2 == 0 { world.low } else { world.high };
        particle.position[axis] = world.fixed(face)[axis];
    }
    let flights: Vec<GpuFlight> = free_flights(COUNT)
        .into_iter()
        .enumerate()
        .map(|(k, flight)| GpuFlight { start: if k >= 60 && k % 4 == 0 { 1e-6 } else { 0.0 }, ..flight })
        .collect();
    let mut rig = Rig::new(&world);
    rig.put("sorted", &particles);
    put_flights(&mut rig, &flights);
    // Of those on the list one is there for its neighbours alone.
    let entries: Vec<u32> = (0..COUNT as u32 - 1).collect();
    let mut marks = vec![NEAR; COUNT];
    marks[COUNT - 2] = UNSCREENED;
    put_to_complete(&mut rig, COUNT, &entries);
    rig.put("marks", &marks);
    rig.put("neighbour_count", &vec![0u32; COUNT]);
    rig.step(GpuStep { count: COUNT as u32, dt: DT, ..GpuStep::default() });
    rig.run("complete_lists", entries.len());
    assert_eq!(rig.counter(LIST_NEAR_WALLS), COUNT as u32 - 2);
    let found: Vec<GpuFlight> = neighbour_lists::flights(&rig, COUNT);
    assert_eq!(found[COUNT - 2..], flights[COUNT - 2..], "may meet no wall, or not on the list");
    let (p, f, w) = (&particles[..COUNT - 2], &flights[..COUNT - 2], &found[..COUNT - 2]);
    let at_rest = |triangles: &[Triangle]| [(triangles.to_vec(), [0.0; 3])];
    assert_eq!(outside_bounds(&world, &at_rest(&world.triangles), p, f, w), 0);
    let hits = w.iter().filter(|flight| flight.wall < NEVER).count();
    assert!(hits > COUNT / 4 && hits < COUNT, "{hits}");
    let at_once = (0..60).filter(|&k| found[k].wall == 0.0).count();
    assert!((15..45).contains(&at_once), "half of those on a wall turn into it: {at_once}");
    // The check can fail: walls moved by a ten-thousandth are told apart by most flights that hit.
    let moved: Vec<Triangle> = world.triangles.iter().map(|t| t.map(|corner: Vector| scaled(corner, 1.0001))).collect();
    assert!(outside_bounds(&world, &at_rest(&moved), p, f, w) > hits / 2);
}

/// `advect` flies those that meet no wall to x0 + v dt (exactly, but for the order of the factors of v dt) and
/// lists exactly the others, in all three variants of the kernel: with rounds of pairs, with collisions within cells, without.
#[test]
fn advect_flies_the_free_and_lists_the_others() {
    let world = World::plain();
    let cells = world.cells();
    for (collisions, rounds) in [(true, true), (true, false), (false, false)] {
        let mut stream = Stream::new(16);
        let mut particles = world.particles(&mut stream, COUNT, 200.0);
        let first_id = 500_000;
        // Some have got out, to a corner of the grid: without rounds `bounce` counts them.
        let lost = 200..220;
        for particle in &mut particles[lost.clone()] {
            (particle.position, particle.velocity) = ([(1 << cells.bits) / 2; 3], [0.0; 3]);
        }
        // The last have entered in this step.
        let first = COUNT - 50;
        for (k, particle) in particles[first..].iter_mut().enumerate() {
            particle.tag = GpuParticle::tag(0, first_id + k as u32);
        }
        let entering = |&particle| GpuNewborn { particle, start: DT * stream.uniform() as f32, pad: [0; 3] };
        let born: Vec<GpuNewborn> = particles[first..].iter().map(entering).collect();
        let flights: Vec<GpuFlight> = free_flights(COUNT)
            .into_iter()
            .map(|flight| GpuFlight {
                wall: if stream.below(2) == 0 { stream.uniform() as f32 * DT } else { NEVER },
                ..flight
            })
            .collect();
        let meets_wall = |k: usize| {
            if rounds {
                return flights[k].wall < DT;
            }
            // Those that enter in this step go to `bounce`, which knows when.
            k >= first || world.may_hit(&particles[k], 0.0, DT)
        };
        let mut rig = Rig::new(&world);
        rig.constant("COLLISIONS", f64::from(u8::from(collisions)));
        rig.constant("ROUNDS_OF_PAIRS", f64::from(u8::from(rounds)));
        let nowhere = vec![GpuParticle::default(); COUNT];
        rig.put("sorted", if collisions { &particles } else { &nowhere });
        if rounds {
            put_flights(&mut rig, &flights);
        } else {
            rig.put("particles", if collisions { &nowhere } else { &particles });
        }
        rig.put("newborns", &born);
        rig.put("bouncing", &vec![0u32; COUNT]);
        // Of those without such a mark no flight is looked at.
        let mark = |k: usize| {
            let marks = [NEAR, TURNED_TO_WALL];
            if rounds && (meets_wall(k) || k.is_multiple_of(5)) { marks[k % 2] } else { 0 }
        };
        rig.put("marks", &(0..COUNT).map(mark).collect::<Vec<_>>());
        rig.put("cell_start", &[0u32]);
        rig.step(GpuStep {
            peers: 1,
            count: first as u32,
            newborns: 50,
            capacity: COUNT as u32,
            newborn_first_id: first_id,
            dt: DT,
            ..GpuStep::default()
        });
        let words = |rig: &Rig| rig.get::<[u32; RECORD]>("particles", COUNT);
        let old = words(&rig);
        rig.run("advect", COUNT);
        let (found, new): (Vec<GpuParticle>, _) = (rig.get("particles", COUNT), words(&rig));
        let (mut bouncing, mut outside) = (Vec::new(), 0);
        for (k, &before) in particles.iter().enumerate() {
            if meets_wall(k) {
                bouncing.push(k as u32);
                assert_eq!(new[k], old[k]);
                continue;
            }
            let end = cells.shifted(before.position, before.velocity, DT);
            // A driver may multiply v, dt and the quanta per metre in another order: up to two roundings each.
            let off = (0..3).map(|a| end[a].wrapping_sub(found[k].position[a]).cast_signed().unsigned_abs()).max();
            let flown = before.velocity.iter().fold(0.0f32, |most, v| most.max(v.abs())) * DT * cells.quanta_per_metre;
            assert!(f64::from(off.unwrap()) <= (4.0 * U * f64::from(flown)).ceil(), "{off:?} quanta of {flown}");
            assert_eq!(found[k], GpuParticle { position: found[k].position, ..before });
            let cell = found[k].position.map(|q| q >> cells.bits);
            let in_grid = cell.iter().zip(cells.counts).all(|(&c, n)| c < n);
            outside += u32::from(rounds && (!in_grid || world.class(cells.index(cell)) == SOLID));
        }
        assert_eq!(rig.list("bouncing", LIST_BOUNCE), bouncing);
        assert_eq!(rig.counter(OUTSIDE), outside);
        assert!(bouncing.len() > COUNT / 4 && bouncing.len() < COUNT - 100, "{}", bouncing.len());
        // Flights that ignore walls are seen to leave; without rounds all that may are left to `bounce`, and the lost.
        assert!(!rounds || outside > lost.len() as u32, "{outside}");
        assert!(rounds || lost.clone().all(|k| bouncing.contains(&(k as u32))));
        if collisions && !rounds {
            let layers: Vec<u32> = rig.get("marks", COUNT);
            let marked: Vec<u32> = (0..COUNT as u32).filter(|&k| layers[k as usize] & NEAR != 0).collect();
            assert_eq!((marked.len() as u32, marked), (rig.counter(LIST_NEAR_WALLS), bouncing));
        }
    }
}

/// Beside walls at any angle and on both sides of a thin plate: who is not left to `bounce` meets no triangle by the f64 test.
#[test]
fn flights_that_walls_are_no_matter_to_meet_none() {
    let tilts = [
        ([0.6, 0.0, 0.8], [0.8, 0.0, -0.6], 0.008),
        ([0.48, -0.6, 0.64], [0.8, 0.0, -0.6], 0.006),
        ([-0.8, 0.6, 0.0], [0.0, 0.0, 1.0], 0.01),
    ];
    for (normal, u, cell) in tilts {
        let plate = Shape::Plane {
            center: [0.03, 0.035, 0.04],
            normal,
            u,
            size: [0.03, 0.04],
            thickness: 0.002,
            holes: vec![],
        };
        let world = World::new(&[tank([0.06, 0.07, 0.08]), wall(plate, GasSide::Both)], cell);
        let particles = world.particles(&mut Stream::new(18), COUNT, 40.0);
        let mut rig = Rig::new(&world);
        rig.constant("COLLISIONS", 0.0);
        rig.constant("ROUNDS_OF_PAIRS", 0.0);
        rig.put("particles", &particles);
        rig.put("sorted", &vec![GpuParticle::default(); COUNT]);
        rig.put("bouncing", &vec![0u32; COUNT]);
        rig.put("cell_start", &[0u32]);
        rig.step(GpuStep { count: COUNT as u32, dt: DT, ..GpuStep::default() });
        rig.run("advect", COUNT);
        let bouncing = rig.list("bouncing", LIST_BOUNCE);
        let cells = world.cells();
        let (slack, mut beside) = (4.0 * world.walls.tolerance, 0);
        for (k, particle) in particles.iter().enumerate().filter(|(k, _)| !bouncing.contains(&(*k as u32))) {
            let velocity = particle.velocity.map(f64::from);
            let met = crossings(&world.triangles, world.metres(particle.position), velocity, slack)
                .iter()
                .any(|hit| hit.time < f64::from(DT) && hit.inset > slack);
            assert!(!met, "particle {k}");
            beside += usize::from(world.class(cells.index(cells.cell(particle.position))) == CUT);
        }
        // Of the gas in cells with walls many a flight is told to be free, and of all not all are.
        assert!(beside > COUNT / 20 && bouncing.len() > COUNT / 20, "{beside}, {}", bouncing.len());
    }
}

/// A ghost leaves a dead slot and meets no wall here: its owner flies it.
#[test]
fn ghosts_leave_dead_slots() {
    let world = World::plain();
    let mut stream = Stream::new(56);
    let particles = world.particles(&mut stream, COUNT, 200.0);
    let mut flights = free_flights(COUNT);
    for flight in flights.iter_mut().step_by(3) {
        flight.wall = 0.5 * DT;
    }
    let mut layers: Vec<u32> =
        (0..COUNT).map(|_| stream.below(3) | [0, SHARED, NEAR][stream.below(3) as usize]).collect();
    for mark in layers.iter_mut().step_by(3) {
        *mark |= TURNED_TO_WALL;
    }
    let mut rig = Rig::new(&world);
    rig.put("sorted", &particles);
    put_flights(&mut rig, &flights);
    rig.put("marks", &layers);
    rig.put("bouncing", &vec![0u32; COUNT]);
    rig.put("cell_start", &[0u32]);
    rig.step(GpuStep { count: COUNT as u32, dt: DT, depth: 2, peers: 1, ..GpuStep::default() });
    rig.run("advect", COUNT);
    let found: Vec<GpuParticle> = rig.get("particles", COUNT);
    let own = |s: &usize| layers[*s] & 0xff == 0;
    for s in 0..COUNT {
        if !own(&s) {
            assert_eq!(found[s].tag, NOBODY);
        } else if flights[s].wall > DT {
            assert_eq!((found[s].tag, found[s].velocity), (particles[s].tag, particles[s].velocity));
        }
    }
    let bouncing: Vec<u32> = (0..COUNT).step_by(3).filter(own).map(|s| s as u32).collect();
    assert_eq!(rig.list("bouncing", LIST_BOUNCE), bouncing);
    // The check can fail: there are ghosts, and own particles with marks.
    assert!((0..COUNT).filter(own).any(|s| layers[s] != 0) && bouncing.len() < COUNT / 6);
}

/// On a device alone the places behind the last particle, whose number the host learns late, are dead; no mark of theirs is asked for.
#[test]
fn places_behind_the_last_particle_are_dead() {
    let world = World::plain();
    let particles = world.particles(&mut Stream::new(58), COUNT, 200.0);
    let last = COUNT - 70;
    let mut rig = Rig::new(&world);
    rig.put("sorted", &particles);
    put_flights(&mut rig, &free_flights(COUNT));
    rig.put("marks", &vec![1u32; COUNT]);
    rig.put("bouncing", &vec![0u32; COUNT]);
    rig.set_step_state(PRESENT, last as u32);
    rig.step(GpuStep { count: COUNT as u32, dt: DT, ..GpuStep::default() });
    rig.run("advect", COUNT);
    let found: Vec<GpuParticle> = rig.get("particles", COUNT);
    for s in 0..COUNT {
        assert_eq!(found[s].tag, if s < last { particles[s].tag } else { NOBODY }, "{s}");
    }
}
