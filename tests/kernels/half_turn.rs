//! The method `half-turn`: `list_ids` and `arrange_by_id`, the order of the particles; `collision_cells`, how tiles are halved; `half_turn` and
//! `half_turn_cut`, what becomes of the velocities.

use std::collections::BTreeSet;

use corpuscle::scene::{GasSide, Shape};
use corpuscle::subdomain::{GpuGas, GpuParticle, GpuStep};

use crate::oracle::half_turn::{Body, collision_cells, tiled_bin, turned};
use crate::oracle::random::Stream;
use crate::oracle::vector::{Vector, dot, minus, norm};
use crate::rig::*;

const COUNT: usize = 4000;
const SPEED: f64 = 300.0;
const MOST: u32 = 21;
const TILE: u32 = 64;

fn rig_of(world: &World, gases: &[GpuGas]) -> Rig {
    let mut rig = Rig::new(world);
    rig.gases(gases);
    for (name, value) in [("TILED", 1.0), ("BORDER", 0.0), ("CELL_SEED_HIGH", 9.0), ("MOST_MEMBERS", f64::from(MOST))] {
        rig.constant(name, value);
    }
    rig
}

fn without_spin(mass: f64) -> GpuGas {
    GpuGas { mass: mass as f32, exchange: 0.0, inverse_beta: 0.0, inverse_beta1: 0.0 }
}

/// Two degrees of freedom.
fn with_spin(mass: f64) -> GpuGas {
    GpuGas { exchange: 0.3, inverse_beta: 1.0, inverse_beta1: 0.5, ..without_spin(mass) }
}

/// A step in a lattice of tiles over the whole grid.
fn step_in(lattice: u32, world: &World, count: usize) -> (GpuStep, [u32; 3]) {
    let tiles = world.grid.cells.map(|cells| (cells - 2) / 4 + 1);
    let bins = TILE * tiles.iter().product::<u32>();
    let step = GpuStep {
        count: count as u32,
        index: 6 + lattice,
        low: [lattice & 1; 3],
        size: tiles.map(|n| 4 * n),
        bins,
        lattice,
        newborn_first_id: u32::MAX,
        dt: 1e-6,
        ..GpuStep::default()
    };
    (step, tiles)
}

fn bin_of(particle: &GpuParticle, world: &World, lattice: u32, tiles: [u32; 3]) -> u32 {
    let cell = world.cells().cell(particle.position).map(|at| at - (lattice & 1));
    tiled_bin(cell, tiles, lattice as usize % 3) as u32
}

/// In all lattices: by bin, in a bin by id, whatever the order of the threads was; and each tile is halved down to few particles or a cell.
#[test]
fn particles_lie_by_id_and_tiles_are_halved() {
    let world = World::new(&[tank([0.1, 0.12, 0.09])], 0.01);
    let mut stream = Stream::new(5);
    let mut particles = world.particles(&mut stream, COUNT, SPEED);
    // Denser to one side: tiles of all kinds.
    for (k, p) in particles.iter_mut().enumerate() {
        if k % 3 > 0 {
            let corner = world.fixed(world.low);
            p.position = std::array::from_fn(|axis| (p.position[axis] - corner[axis]) / 4 + corner[axis]);
        }
    }
    let mut all_alone = 0;
    for lattice in 0..6 {
        let (step, tiles) = step_in(lattice, &world, COUNT);
        let bins: Vec<u32> = particles.iter().map(|p| bin_of(p, &world, lattice, tiles)).collect();
        let mut counts = vec![0u32; step.bins as usize];
        let slots: Vec<[u32; 2]> = bins
            .iter()
            .map(|&bin| {
                counts[bin as usize] += 1;
                [bin, counts[bin as usize] - 1]
            })
            .collect();
        let start: Vec<u32> = std::iter::once(0)
            .chain(counts.iter().scan(0, |sum, count| {
                *sum += count;
                Some(*sum)
            }))
            .collect();
        let mut rig = rig_of(&world, &[without_spin(1.0)]);
        rig.constant("DIVIDED_GAS", 0.0);
        rig.put("particles", &particles);
        rig.put("bins", &slots);
        rig.put("cell_start", &start);
        rig.put("slots", &vec![0u32; COUNT]);
        rig.put("sorted", &vec![GpuParticle::default(); COUNT]);
        rig.step(step);
        rig.run("list_ids", COUNT);
        rig.run("arrange_by_id", COUNT);
        let mut expected = particles.clone();
        expected.sort_by_key(|p| (bin_of(p, &world, lattice, tiles), p.id()));
        assert_eq!(rig.get::<GpuParticle>("sorted", COUNT), expected, "lattice {lattice}");

        rig.put("collision_cells", &vec![[0u32; 2]; COUNT]);
        rig.put("cut_cells", &vec![[0u32; 2]; COUNT]);
        rig.run("collision_cells", step.bins as usize);
        let (mut found, mut alone) = (BTreeSet::new(), 0);
        for tile in (0..step.bins as usize).step_by(TILE as usize) {
            for (first, bins) in collision_cells(&counts[tile..tile + TILE as usize], MOST) {
                let ends = [start[tile + first], start[tile + first + bins]];
                match ends[1] - ends[0] {
                    0 => {}
                    1 => alone += 1,
                    _ => assert!(found.insert(ends)),
                }
            }
        }
        let listed: Vec<[u32; 2]> = rig.get("collision_cells", rig.counter(LIST_COLLISION_CELLS) as usize);
        assert_eq!(listed.iter().copied().collect::<BTreeSet<_>>(), found, "lattice {lattice}");
        assert_eq!((listed.len(), rig.counter(FREE_FLIGHTS), rig.counter(LIST_CUT_CELLS)), (found.len(), alone, 0));
        let sizes: BTreeSet<u32> = found.iter().map(|[begin, end]| end - begin).collect();
        assert!(sizes.len() > 15 && *sizes.last().unwrap_or(&0) > MOST, "cells of all kinds: {sizes:?}");
        all_alone += alone;
    }
    assert!(all_alone > 0);
}

/// Collision cells of 2 to 31 particles each within some cells of the grid.
fn some_cells(stream: &mut Stream, world: &World, masses: usize) -> (Vec<GpuParticle>, Vec<[u32; 2]>) {
    let mut particles = Vec::new();
    let mut cells = Vec::new();
    for k in 0..300u32 {
        let begin = particles.len() as u32;
        let corner = world.place(stream);
        for _ in 0..2 + k % 30 {
            let edge = 1 << world.grid.cell_bits;
            particles.push(GpuParticle {
                position: corner.map(|at| at + stream.below(2 * edge)),
                tag: GpuParticle::tag(stream.below(masses as u32) as u8, particles.len() as u32),
                // A stream, and shear.
                velocity: stream.normals().map(|v| (SPEED * (v + 2.0)) as f32),
                spin: (SPEED * SPEED * stream.half_chi_square(2)) as f32,
            });
        }
        cells.push([begin, particles.len() as u32]);
    }
    (particles, cells)
}

fn run_half_turn(world: &World, gases: &[GpuGas], particles: &[GpuParticle], cells: &[[u32; 2]], index: u32) -> Rig {
    let mut rig = rig_of(world, gases);
    rig.put("sorted", particles);
    rig.put("collision_cells", cells);
    rig.set_counter(LIST_COLLISION_CELLS, cells.len() as u32);
    let (step, _) = step_in(0, world, particles.len());
    rig.step(GpuStep { index, ..step });
    rig.run("half_turn", cells.len());
    rig
}

fn masses_of(gases: &[GpuGas]) -> Vec<f64> {
    gases.iter().map(|gas| f64::from(gas.mass)).collect()
}

/// Momentum, energy and the size of the momentum.
fn sums(particles: &[GpuParticle], masses: &[f64]) -> (Vector, f64, f64) {
    let (mut momentum, mut energy, mut size) = ([0.0; 3], 0.0, 0.0);
    for p in particles {
        let (mass, v) = (masses[usize::from(p.gas())], p.velocity.map(f64::from));
        (0..3).for_each(|k| momentum[k] += mass * v[k]);
        energy += 0.5 * mass * dot(v, v) + f64::from(p.spin);
        size += mass * norm(v);
    }
    (momentum, energy, size)
}

fn assert_kept(before: &[GpuParticle], after: &[GpuParticle], masses: &[f64], what: &str) {
    let ((p0, e0, before_size), (p1, e1, after_size)) = (sums(before, masses), sums(after, masses));
    let size = before_size.max(after_size);
    assert!(norm(minus(p1, p0)) <= 128.0 * U * size, "{what}: momentum {p0:?} {p1:?}");
    // What rounding did to it is put right up to the rounding of one number.
    assert!((e1 - e0).abs() <= 16.0 * U * e0, "{what}: energy {e0} {e1}");
    for (a, b) in before.iter().zip(after) {
        assert_eq!((a.position, a.tag), (b.position, b.tag), "{what}");
        assert!(b.spin >= 0.0 && b.velocity.iter().all(|v| v.is_finite()), "{what}: {b:?}");
    }
}

/// Of particles without spin, of six and more: what the reference has, where the axes of the stress are told apart.
#[test]
fn velocities_make_half_a_turn() {
    let world = World::new(&[tank([0.1, 0.12, 0.09])], 0.01);
    let mut stream = Stream::new(8);
    for gases in [vec![without_spin(1.0)], vec![without_spin(1.0), without_spin(0.02)]] {
        let masses = masses_of(&gases);
        let (mut particles, cells) = some_cells(&mut stream, &world, gases.len());
        particles.iter_mut().for_each(|p| p.spin = 0.0);
        let rig = run_half_turn(&world, &gases, &particles, &cells, 3);
        let after: Vec<GpuParticle> = rig.get("sorted", particles.len());
        let (mut compared, mut few) = (0, 0);
        for &[begin, end] in &cells {
            let range = begin as usize..end as usize;
            let (before, after) = (&particles[range.clone()], &after[range]);
            assert_kept(before, after, &masses, &format!("{} particles", before.len()));
            few += if before.len() < 6 { before.len() as u32 } else { 0 };
            let body = |p: &GpuParticle| Body {
                mass: masses[usize::from(p.gas())],
                place: world.metres(p.position),
                velocity: p.velocity.map(f64::from),
            };
            let bodies: Vec<Body> = before.iter().map(body).collect();
            let (expected, apart) = turned(&bodies);
            if before.len() < 6 || apart < 0.03 {
                continue;
            }
            compared += 1;
            let fastest = bodies.iter().map(|body| norm(body.velocity)).fold(0.0, f64::max);
            for (found, expected) in after.iter().zip(&expected) {
                let off = norm(minus(found.velocity.map(f64::from), *expected));
                // Of the axes some roundings over their distance.
                assert!(off < 2e-5 / apart * fastest, "{} particles, {off} of {fastest}, {apart}", before.len());
            }
        }
        assert!(compared > 100, "{compared} compared");
        // And perhaps some that lie in a plane.
        assert!(rig.counter(UNFITTED) >= few && rig.counter(UNFITTED) < few + 150);
        assert_eq!(rig.counter(FREE_FLIGHTS), 0);
    }
}

/// Twice in a row gives the velocities of the start, but for their rounding.
#[test]
fn the_half_turn_is_its_own_inverse() {
    let world = World::new(&[tank([0.1, 0.12, 0.09])], 0.01);
    let gases = [without_spin(1.0)];
    let (mut particles, cells) = some_cells(&mut Stream::new(9), &world, 1);
    particles.iter_mut().for_each(|p| p.spin = 0.0);
    let many: Vec<[u32; 2]> = cells.into_iter().filter(|[begin, end]| end - begin >= 6).collect();
    let once: Vec<GpuParticle> = run_half_turn(&world, &gases, &particles, &many, 3).get("sorted", particles.len());
    let twice: Vec<GpuParticle> = run_half_turn(&world, &gases, &once, &many, 4).get("sorted", particles.len());
    let (mut back, mut all) = (0, 0);
    for (a, b) in particles.iter().zip(&twice) {
        let off = norm(minus(a.velocity.map(f64::from), b.velocity.map(f64::from)));
        back += u32::from(off < 1e-3 * SPEED);
        all += 1;
    }
    // (Of stresses that are nearly equal rounding may choose others.)
    assert!(f64::from(back) > 0.9 * f64::from(all), "{back} of {all}");
    assert!(particles.iter().zip(&once).filter(|(a, b)| a.velocity != b.velocity).count() > 3000);
}

/// Energy goes to and from spin; as much as there was is there. From no spin at all, and with gas that has none beside it.
#[test]
fn spin_takes_its_share_and_energy_is_kept() {
    let world = World::new(&[tank([0.1, 0.12, 0.09])], 0.01);
    let mut stream = Stream::new(10);
    for gases in [vec![with_spin(1.0)], vec![with_spin(0.3), without_spin(1.0)]] {
        let masses = masses_of(&gases);
        for cold in [false, true] {
            let (mut particles, cells) = some_cells(&mut stream, &world, gases.len());
            for p in &mut particles {
                if cold || p.gas() == 1 {
                    p.spin = 0.0;
                }
            }
            let after: Vec<GpuParticle> =
                run_half_turn(&world, &gases, &particles, &cells, 3).get("sorted", particles.len());
            let mut changed = 0;
            for &[begin, end] in &cells {
                let range = begin as usize..end as usize;
                let (before, after) = (&particles[range.clone()], &after[range]);
                assert_kept(before, after, &masses, &format!("{} particles, cold {cold}", before.len()));
                assert!(after.iter().all(|p| p.gas() == 0 || p.spin == 0.0));
                let spin = |all: &[GpuParticle]| all.iter().map(|p| f64::from(p.spin)).sum::<f64>();
                changed += u32::from((spin(after) - spin(before)).abs() > 1e-3 * spin(after));
            }
            assert!(changed > 150, "{changed} cells exchanged energy with spin");
        }
    }
}

/// Whatever a state is: one velocity, one place, a line, a plane, hot beside cold, masses 1:70.
#[test]
fn no_state_breaks_it() {
    let world = World::new(&[tank([0.1, 0.12, 0.09])], 0.01);
    let gases = [with_spin(1.0), without_spin(1.0 / 70.0)];
    let masses = masses_of(&gases);
    type Change = fn(usize, &mut GpuParticle);
    let states: [(&str, Change); 8] = [
        ("one velocity", |_, p| p.velocity = [3000.0, 1.0, -7.0]),
        ("a cold stream with motes of velocity and some spin", |k, p| {
            (p.velocity, p.spin) = ([3000.0, 1e-21 * (k % 7) as f32, 1e-21 * (k % 3) as f32], 0.01);
        }),
        ("one place", |_, p| p.position = [1 << 24; 3]),
        ("a plane", |_, p| p.position[2] = 1 << 24),
        ("velocities in a line", |k, p| p.velocity = [k as f32 - 3.0, 0.0, 0.0]),
        ("hot beside cold", |k, p| p.velocity = p.velocity.map(|v| if k % 2 == 0 { 1e-3 * v } else { 30.0 * v })),
        ("no energy", |_, p| (p.velocity, p.spin) = ([0.0; 3], 0.0)),
        ("no spin, a fast stream", |_, p| (p.velocity[0], p.spin) = (p.velocity[0] + 3000.0, 0.0)),
    ];
    for (name, change) in states {
        let (mut particles, cells) = some_cells(&mut Stream::new(11), &world, 2);
        for (k, p) in particles.iter_mut().enumerate() {
            change(k, p);
        }
        let after: Vec<GpuParticle> =
            run_half_turn(&world, &gases, &particles, &cells, 3).get("sorted", particles.len());
        for &[begin, end] in &cells {
            let range = begin as usize..end as usize;
            assert_kept(&particles[range.clone()], &after[range], &masses, name);
        }
    }
}

/// A plate through the cells: each side keeps its own momentum and energy, and those that a hole lets see each other do not.
#[test]
fn particles_behind_a_wall_are_in_another_group() {
    let side = 0.08;
    let plate = wall(
        Shape::Box { min: [0.0, 0.0, 0.0357], max: [side, side, 0.0363], thickness: None, holes: vec![] },
        GasSide::Outside,
    );
    let world = World::new(&[tank([side; 3]), plate], 0.01);
    let gases = [without_spin(1.0)];
    let mut stream = Stream::new(12);
    let (step, tiles) = step_in(0, &world, COUNT);
    let mut particles = world.particles(&mut stream, COUNT, SPEED);
    let in_plate = |p: &GpuParticle| (0.0356..0.0364).contains(&(world.metres(p.position)[2] - world.low[2]));
    particles.retain(|p| !in_plate(p));
    particles.iter_mut().for_each(|p| p.tag &= GpuParticle::ID_MASK);
    particles.sort_by_key(|p| (bin_of(p, &world, 0, tiles), p.id()));
    let mut start = vec![0u32; step.bins as usize + 1];
    for p in &particles {
        start[bin_of(p, &world, 0, tiles) as usize + 1..].iter_mut().for_each(|later| *later += 1);
    }
    let count = particles.len();
    let mut rig = rig_of(&world, &gases);
    rig.put("sorted", &particles);
    rig.put("cell_start", &start);
    rig.put("collision_cells", &vec![[0u32; 2]; count]);
    rig.put("cut_cells", &vec![[0u32; 2]; count]);
    rig.put("order_by_id", &vec![0u32; count]);
    rig.step(GpuStep { count: count as u32, ..step });
    rig.run("collision_cells", step.bins as usize);
    let cut = rig.counter(LIST_CUT_CELLS);
    assert!(cut > 20, "{cut} cells are cut");
    rig.run("half_turn_cut", cut as usize);
    let after: Vec<GpuParticle> = rig.get("sorted", count);
    let ranges: Vec<[u32; 2]> = rig.get("cut_cells", cut as usize);
    let (mut both, mut changed) = (0, 0);
    for [begin, end] in ranges {
        // The highest bits say what cuts it: here walls.
        assert_eq!(end >> 30, 2);
        let end = end & 0x3fff_ffff;
        let of_side = |all: &[GpuParticle], upper: bool| -> Vec<GpuParticle> {
            let own = all[begin as usize..end as usize].iter().copied();
            own.filter(|p| (world.metres(p.position)[2] - world.low[2] > 0.036) == upper).collect()
        };
        let sides = [false, true].map(|upper| (of_side(&particles, upper), of_side(&after, upper)));
        for (before, after) in &sides {
            assert_kept(before, after, &[1.0], "a side");
            changed += before.iter().zip(after).filter(|(a, b)| a.velocity != b.velocity).count();
        }
        both += u32::from(sides.iter().all(|(before, _)| before.len() > 1));
    }
    assert!(both > 5 && changed > 200, "{both} cells with gas on both sides, {changed} particles");
    assert!(rig.counter(CUT_GROUPS) as usize > cut as usize);
}
