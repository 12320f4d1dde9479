//! `bounce` in a box, against reflection in f64.

use corpuscle::subdomain::{GpuFlight, GpuGas, GpuParticle, GpuStep};

use crate::neighbour_lists::put_flights;
use crate::oracle::random::Stream;
use crate::oracle::vector::{Vector, along, minus, norm};
use crate::oracle::walls::{bounced, corner, normal, reflect_in_box, reflected};
use crate::rig::*;

const DT: f32 = 3e-5;

/// Copies of the tallies, and words of each.
const COPIES: usize = 5;
const COPY_WORDS: usize = 32;

const GASES: [GpuGas; 2] = [
    GpuGas { mass: 1.0, exchange: 0.4, inverse_beta: 1.0, inverse_beta1: 0.5 },
    GpuGas { mass: 0.25, exchange: 0.0, inverse_beta: 0.0, inverse_beta1: 1.0 },
];

/// One dispatch over all particles, flights from `flights`.
fn bounce(world: &World, particles: &[GpuParticle], flights: &[GpuFlight], surfaces: bool) -> Rig {
    let mut rig = Rig::new(world);
    rig.constant("SURFACES", f64::from(u8::from(surfaces)));
    rig.constant("IMPULSE_SCALE", 1024.0);
    rig.gases(&GASES);
    rig.put("sorted", particles);
    put_flights(&mut rig, flights);
    rig.put("bouncing", &(0..particles.len() as u32).collect::<Vec<_>>());
    rig.constant("COPIES", COPIES as f64);
    rig.constant("COPY_WORDS", COPY_WORDS as f64);
    rig.put("surface_sums", &[0u32; COPIES * COPY_WORDS]);
    rig.set_counter(LIST_BOUNCE, particles.len() as u32);
    rig.step(GpuStep { count: particles.len() as u32, dt: DT, ..GpuStep::default() });
    rig.run("bounce", particles.len());
    rig
}

/// Metres by which a flight of `hits` reflections may end off its f64 place. Each hit's place errs by 10 u of
/// the world's size, 8 u of the flown way and two quanta, and what follows the hit is mirrored, so twice that.
fn bound(world: &World, v: Vector, hits: u32) -> f64 {
    let one = 10.0 * U * norm(world.high) + 8.0 * U * norm(v) * f64::from(DT) + 2.0 * world.grid.quantum();
    f64::from(1 + 2 * hits) * one
}

/// The number of particles that are not where unfolding the box puts them; hits in all.
fn wrong(world: &World, before: &[GpuParticle], flights: &[GpuFlight], after: &[GpuParticle]) -> (usize, u32) {
    let (mut wrong, mut total) = (0, 0);
    for ((old, flight), new) in before.iter().zip(flights).zip(after) {
        let v = old.velocity.map(f64::from);
        let start = f64::from(flight.start);
        let from = along(world.metres(old.position), v, start);
        let (x, v_end, hits) = reflect_in_box(from, v, f64::from(DT) - start, world.low, world.high);
        total += hits;
        let off = bound(world, v, hits);
        let mut fine = norm(minus(world.metres(new.position), x)) < 2.0 * off && new.tag == old.tag;
        for k in 0..3 {
            // At a wall to within rounding the last hit may be this step's or the next one's.
            let at_wall = (x[k] - world.low[k]).abs().min((x[k] - world.high[k]).abs()) < 2.0 * off;
            let found = f64::from(new.velocity[k]);
            let close = |expected: f64| (found - expected).abs() <= 8.0 * U * f64::from(1 + hits) * norm(v);
            fine &= close(v_end[k]) || at_wall && close(-v_end[k]);
        }
        wrong += usize::from(!fine);
    }
    (wrong, total)
}

/// A flight in a box ends where mirror images put it, however many walls, and also where it is aimed at a
/// corner or an edge exactly.
#[test]
fn flights_in_a_box_are_those_of_mirror_images() {
    let world = World::plain();
    let mut stream = Stream::new(17);
    let count = 3000;
    let mut particles = world.particles(&mut stream, count, 700.0);
    let middle = world.fixed(along(world.low, minus(world.high, world.low), 0.5));
    for (k, particle) in particles.iter_mut().enumerate().take(1000) {
        // Hits a corner (the first 400) or a point of an edge at a random time.
        let mut target = world.fixed(corner(world.low, world.high, k % 8));
        if k >= 400 {
            target[k % 3] = middle[k % 3];
        }
        let velocity = stream.normals().map(|v| (v * 1000.0).round());
        let back = |axis: usize| {
            // From inside: towards the target along each axis.
            let inwards = if target[axis] > middle[axis] { 1.0 } else { -1.0 };
            (velocity[axis].abs() + 1.0) * inwards
        };
        let v: Vector =
            std::array::from_fn(|axis| if target[axis] == middle[axis] { velocity[axis] } else { back(axis) });
        let time = 1e-5 * stream.uniform();
        particle.velocity = v.map(|v| v as f32);
        particle.position = world.fixed(along(world.metres(target), v, -time));
    }
    let flights: Vec<GpuFlight> = free_flights(count)
        .into_iter()
        .enumerate()
        .map(|(k, flight)| GpuFlight { start: if k >= 1000 && k % 3 == 0 { 1e-6 } else { 0.0 }, ..flight })
        .collect();
    // Late flights must start in the box.
    for (particle, flight) in particles.iter_mut().zip(&flights) {
        let moved = particle.velocity.map(|v| f64::from(v) * f64::from(flight.start));
        particle.position = world.fixed(minus(world.metres(particle.position), moved));
    }
    let rig = bounce(&world, &particles, &flights, false);
    let after: Vec<GpuParticle> = rig.get("particles", count);
    let (off, hits) = wrong(&world, &particles, &flights, &after);
    assert_eq!(off, 0);
    let bounces = rig.counter(BOUNCES);
    // A hit at the very end of the step may be this step's or the next one's.
    assert!(bounces.abs_diff(hits) <= hits / 1000, "{bounces} of {hits}");
    assert!(hits > count as u32, "{hits}");
    assert_eq!([rig.counter(OUTSIDE), rig.counter(TRUNCATED)], [0, 0]);
    assert!(f64::from(rig.counter(OVERSHOOT)) * world.grid.quantum() < world.walls.tolerance);
    // What rounding took from the kinetic energy is in the spin of a gas that has one.
    for (old, new) in particles.iter().zip(&after) {
        let gas = GASES[usize::from(old.gas())];
        let energy = |p: &GpuParticle| {
            0.5 * f64::from(gas.mass) * p.velocity.map(|v| f64::from(v).powi(2)).iter().sum::<f64>() + f64::from(p.spin)
        };
        assert!((energy(new) / energy(old) - 1.0).abs() < if gas.exchange > 0.0 { 2.0 * U } else { 64.0 * U });
    }
    // The check can fail: flights faster by a ten-thousandth end elsewhere.
    let faster: Vec<GpuParticle> =
        particles.iter().map(|p| GpuParticle { velocity: p.velocity.map(|v| v * 1.0001), ..*p }).collect();
    assert!(wrong(&world, &faster, &flights, &after).0 > count / 2);
}

/// The tally of a surface is the sum of the impulses of the hits on its triangles: hits exactly, impulse within
/// half a unit and the rounding of f32 per hit.
#[test]
fn surfaces_tally_the_impulse_of_their_hits() {
    let world = World::plain();
    let mut stream = Stream::new(18);
    let slack = 100.0 * world.walls.tolerance;
    let path = |p: &GpuParticle| {
        bounced(&world.triangles, world.metres(p.position), p.velocity.map(f64::from), f64::from(DT), slack)
    };
    let ends_clear = |x: Vector| (0..3).all(|k| (x[k] - world.low[k]).min(world.high[k] - x[k]) > slack);
    let particles: Vec<GpuParticle> = world
        .particles(&mut stream, 2400, 700.0)
        .into_iter()
        .filter(|p| path(p).is_some_and(|(x, _, _)| ends_clear(x)))
        .take(2000)
        .collect();
    assert_eq!(particles.len(), 2000);
    let rig = bounce(&world, &particles, &free_flights(2000), true);
    let mut expected = [[0.0f64; 5]; 3];
    for p in &particles {
        let mass = f64::from(GASES[usize::from(p.gas())].mass);
        let (_, _, hits) = path(p).unwrap();
        let mut v = p.velocity.map(f64::from);
        for triangle in hits {
            let n = normal(&world.triangles[triangle]);
            let turned = reflected(v, n);
            // The world of tests gives surface k mod 3 to triangle k.
            let sum = &mut expected[triangle % 3];
            for k in 0..3 {
                sum[k] += mass * (v[k] - turned[k]) * 1024.0;
            }
            sum[3] += 2.0 * mass * -(v[0] * n[0] + v[1] * n[1] + v[2] * n[2]) * 1024.0;
            sum[4] += 1.0;
            v = turned;
        }
    }
    let words: Vec<u32> = rig.get("surface_sums", COPIES * COPY_WORDS);
    let long = |at: usize| (u64::from(words[at]) | u64::from(words[at + 1]) << 32).cast_signed();
    // Each workgroup has its own: all are used, and nothing is written behind one.
    for copy in words.chunks_exact(COPY_WORDS) {
        assert!(copy[8] > 0);
        assert!(copy[3 * SURFACE_WORDS..].iter().all(|&word| word == 0));
    }
    for (surface, expected) in expected.iter().enumerate() {
        let at = |k: usize| surface * SURFACE_WORDS + 2 * k;
        let word = |k: usize| (0..COPIES).map(|copy| long(copy * COPY_WORDS + at(k))).sum::<i64>() as f64;
        assert_eq!(word(4), expected[4]);
        for (k, expected) in expected.iter().enumerate().take(4) {
            // Impulses are some 10^6 units; f32 keeps 8 u of them.
            let allowed = word(4) * (0.5 + 8.0 * U * 6e6);
            assert!((word(k) - expected).abs() < allowed, "{} {expected} {allowed}", word(k));
        }
        // The check can fail: a hundredth of one hit in a thousand would be seen.
        assert!(word(4) * (0.5 + 8.0 * U * 6e6) < 1e-5 * expected[3]);
    }
}

/// Without rounds `advect` leaves the lost to `bounce`, which flies and counts them.
#[test]
fn those_outside_are_counted() {
    let world = World::plain();
    let mut particles = world.particles(&mut Stream::new(29), 100, 0.0);
    let corner = [(1 << world.grid.cell_bits) / 2; 3];
    for particle in &mut particles[..7] {
        particle.position = corner;
    }
    let rig = bounce(&world, &particles, &free_flights(100), false);
    assert_eq!(rig.counter(OUTSIDE), 7);
    assert_eq!(rig.get::<GpuParticle>("particles", 7), particles[..7]);
}
