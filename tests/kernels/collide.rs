//! `collide`, `collide_crowded` and `collide_divided`: who collides, how often, and what is conserved (method.md, "Collisions").

use std::f64::consts::PI;

use corpuscle::geometry::{CELL_GENERATOR, CELL_POINTS, TriangleGrid, Vessel, cell_gas};
use corpuscle::gpu::KernelVariant;
use corpuscle::scene::{GasSide, Shape};
use corpuscle::subdomain::{CROWD, CellTable, GpuGas, GpuMotion, GpuParticle, GpuStep, MEMBERS, MOTION_ENTRIES, Walls};

use crate::oracle::random::Stream;
use crate::oracle::vector::{Vector, dot, minus, norm};
use crate::rig::*;

const COUNT: usize = 3000;
const SPEED: f64 = 300.0;
pub const DIAMETER: f64 = 2e-3;
/// A particle collides in about one step of six: energies hardly change on the way.
pub const DT: f32 = 2e-6;
/// Where no candidates were told of.
const UNTOLD: u32 = u32::MAX;
pub const MASSES: [f64; 2] = [1.0, 0.25];

pub struct Cloud {
    pub world: World,
    pub table: CellTable,
    /// By (cell, id), and where each cell starts.
    pub particles: Vec<GpuParticle>,
    pub start: Vec<u32>,
    /// Where walls move.
    pub motion: Option<GpuMotion>,
    /// Of the kernels.
    pub variant: KernelVariant,
}

impl Cloud {
    fn new(seed: u32, walls: &[corpuscle::scene::Wall]) -> Cloud {
        Cloud::of(seed, walls, COUNT)
    }

    pub fn of(seed: u32, walls: &[corpuscle::scene::Wall], count: usize) -> Cloud {
        let world = World::new(walls, 0.01);
        let vessel = Vessel::build(walls).unwrap();
        let triangles = TriangleGrid::build(&vessel, &world.grid, Walls::tolerance(&world.grid)).unwrap();
        let gas = cell_gas(&vessel, &world.grid, &triangles, |k| vessel.triangles[k].wall > 0);
        let table = CellTable::new(&gas, &world.grid).unwrap();
        let mut stream = Stream::new(seed);
        let mut particles = world.particles(&mut stream, count, SPEED);
        particles.retain(|p| vessel.is_gas(world.grid.to_metres(p.position)));
        let cells = world.cells();
        let cell = |p: &GpuParticle| cells.index(cells.cell(p.position));
        particles.sort_by_key(|p| (cell(p), p.id()));
        let mut start = vec![0u32; cells.count() + 1];
        for p in &particles {
            start[cell(p) as usize + 1..].iter_mut().for_each(|later| *later += 1);
        }
        Cloud { world, table, particles, start, motion: None, variant: device().variant() }
    }

    pub fn run(&self, step: GpuStep, seed: u32) -> Rig {
        self.run_with(&[], step, seed)
    }

    pub fn run_with(&self, constants: &[(&'static str, f64)], step: GpuStep, seed: u32) -> Rig {
        let mut rig = self.rig(step, seed);
        constants.iter().for_each(|(name, value)| rig.constant(name, *value));
        self.put_parts(&mut rig);
        collide(&rig, self.start.len() - 1);
        let divided = rig.counter(0);
        if divided > 0 {
            rig.run("collide_divided", divided as usize);
        }
        let moved = rig.counter(1);
        if moved > 0 {
            rig.run_groups("collide_moved", [moved, 1, 1]);
        }
        rig
    }

    /// The part of each particle of a cell that walls part, as the sort leaves it.
    fn put_parts(&self, rig: &mut Rig) {
        let divided = (0..self.start.len() - 1).filter(|&cell| self.table.volume[cell] >> 31 == 1);
        let crowded: Vec<u32> = divided.flat_map(|cell| self.cell(cell)).map(|s| s as u32).collect();
        let bins: Vec<[u32; 2]> =
            (0..self.start.len() - 1).flat_map(|cell| self.cell(cell).map(move |_| [cell as u32, 0])).collect();
        rig.put("particles", &self.particles);
        rig.put("bins", &bins);
        rig.put("cells", &vec![0u32; bins.len()]);
        rig.put("crowded", &crowded);
        rig.set_counter(LIST_CROWDED, crowded.len() as u32);
        rig.run("arrange_crowded", crowded.len());
    }

    /// Before any collision.
    fn rig(&self, step: GpuStep, seed: u32) -> Rig {
        let mut rig = Rig::new(&self.world);
        rig.variant = self.variant;
        rig.constant("CROSS_SECTION", PI * DIAMETER * DIAMETER);
        rig.constant("SEED_LOW", f64::from(seed));
        rig.constant("SEED_HIGH", 4.0);
        rig.constant("CELL_SEED_HIGH", 9.0);
        let gas = |mass: f64| GpuGas { mass: mass as f32, exchange: 0.5, inverse_beta: 1.0, inverse_beta1: 0.5 };
        rig.gases(&MASSES.map(gas));
        rig.put("sorted", &self.particles);
        rig.put("cell_start", &self.start);
        rig.put("cell_volume", &self.table.volume);
        rig.put("cell_parts", &self.table.parts);
        let mut slots: Vec<u32> = self.particles.iter().map(GpuParticle::id).collect();
        slots.resize(slots.len().next_multiple_of(4), 0);
        rig.put("slots", &slots);
        rig.put("order_by_id", &slots);
        rig.put("crowds", &vec![0u32; self.start.len()]);
        rig.put("divided", &vec![0u32; self.table.divided as usize + 1]);
        rig.put("neighbour_count", &vec![UNTOLD; self.particles.len()]);
        rig.put("moved", &vec![0u32; self.start.len()]);
        rig.put("still_gas", &self.table.still);
        rig.constant("CELL_POINTS", CELL_POINTS as f64);
        rig.constant("GENERATOR_Y", CELL_GENERATOR[1] as f64);
        rig.constant("GENERATOR_Z", CELL_GENERATOR[2] as f64);
        if let Some(motion) = self.motion {
            let mut table = [GpuMotion::default(); MOTION_ENTRIES];
            table[0] = motion;
            rig.uniform("motions", &table);
            rig.constant("MOVING", 1.0);
            rig.constant("MOTIONS", 1.0);
        }
        rig.step(GpuStep {
            count: self.particles.len() as u32,
            index: 3,
            dt: if step.dt > 0.0 { step.dt } else { DT },
            ..step
        });
        rig
    }

    /// Particles of a cell.
    pub fn cell(&self, cell: usize) -> std::ops::Range<usize> {
        self.start[cell] as usize..self.start[cell + 1] as usize
    }
}

/// In the first cells that no wall parts.
fn collide(rig: &Rig, cells: usize) {
    rig.run("collide", cells);
    let crowds = rig.counter(LIST_CROWDS);
    if crowds > 0 {
        rig.run("collide_crowded", crowds as usize);
    }
}

/// Momentum, energy, and the sizes that their rounding goes by.
pub fn sums(particles: &[GpuParticle]) -> (Vector, f64, f64) {
    let (mut momentum, mut energy, mut size) = ([0.0; 3], 0.0, 0.0);
    for p in particles {
        let (mass, v) = (MASSES[usize::from(p.gas())], p.velocity.map(f64::from));
        (0..3).for_each(|k| momentum[k] += mass * v[k]);
        energy += 0.5 * mass * dot(v, v) + f64::from(p.spin);
        size += mass * norm(v);
    }
    (momentum, energy, size)
}

pub fn first_step() -> GpuStep {
    GpuStep { newborn_first_id: u32::MAX, ..GpuStep::default() }
}

/// Each cell conserves momentum and energy, positions stay, and there are as many collisions as pairs times
/// pi sigma^2 g dt / V.
#[test]
fn cells_conserve_and_collide_at_the_rate_of_their_pairs() {
    let cloud = Cloud::new(61, &[tank([0.06, 0.07, 0.08])]);
    let (mut expected, mut found) = (0.0, 0u32);
    let runs = 8;
    for seed in 0..runs {
        let rig = cloud.run(first_step(), seed);
        let after: Vec<GpuParticle> = rig.get("sorted", cloud.particles.len());
        assert_eq!((rig.counter(LOST), rig.counter(BLOCKED), rig.counter(0)), (0, 0, 0));
        found += rig.cell_collisions();
        let mut changed = 0;
        for cell in 0..cloud.start.len() - 1 {
            let range = cloud.cell(cell);
            let (before, after) = (&cloud.particles[range.clone()], &after[range]);
            let (p0, e0, size) = sums(before);
            let (p1, e1, _) = sums(after);
            // A few roundings of each velocity in each of a few collisions.
            assert!(norm(minus(p1, p0)) <= 32.0 * U * size, "cell {cell}");
            assert!((e1 - e0).abs() <= 64.0 * U * e0, "cell {cell}: {e0} {e1}");
            for (a, b) in before.iter().zip(after) {
                assert_eq!((a.position, a.tag), (b.position, b.tag));
                changed += u32::from(a.velocity != b.velocity);
                assert!(b.spin >= 0.0);
            }
            let volume = f64::from(f32::from_bits(cloud.table.volume[cell]));
            for (k, a) in before.iter().enumerate() {
                for b in &before[k + 1..] {
                    let g = norm(minus(a.velocity.map(f64::from), b.velocity.map(f64::from)));
                    expected += PI * DIAMETER * DIAMETER * g * f64::from(DT) / volume;
                }
            }
        }
        // A collision changes two, who may collide again.
        assert!(changed > rig.cell_collisions() && changed <= 2 * rig.cell_collisions());
    }
    let (error, found) = (expected.sqrt(), f64::from(found));
    println!("{found} collisions of {expected:.1} +- {error:.1}");
    assert!(expected > 1000.0 && (found - expected).abs() < 4.0 * error);
    // The check can fail: at half the cross-section it would.
    assert!((0.5 * found - expected).abs() > 4.0 * error);
}

/// Of enough cells that workgroups change places, each is worked on once, the last ones too, that do not fill a part: so many
/// workgroups that they do not yet leave the same.
#[test]
fn workgroups_that_change_places_reach_every_cell_once() {
    const PERMUTED: usize = 16 * 8 * 64;
    let cloud = Cloud::of(64, &[tank([0.22, 0.22, 0.22])], 9 * 22 * 22 * 22);
    let cells = cloud.start.len() - 1;
    assert!(cells >= PERMUTED && !cells.is_multiple_of(PERMUTED), "{cells} cells");
    let step = GpuStep { peers: 1, ..first_step() };
    let whole = cloud.run(step, 6);
    let candidates: Vec<u32> = whole.get("neighbour_count", cloud.particles.len());
    for cell in 0..cells {
        if let [first, others @ ..] = &candidates[cloud.cell(cell)] {
            assert!(*first != UNTOLD && others.iter().all(|&other| other == 0), "cell {cell} was left out");
        }
    }
    let in_order = cloud.rig(step, 6);
    collide(&in_order, PERMUTED - 64);
    let alike = cloud.start[PERMUTED - 64] as usize;
    let after = |rig: &Rig| -> Vec<GpuParticle> { rig.get("sorted", alike) };
    assert!(after(&whole) == after(&in_order), "a cell was worked on twice, or as another");
    assert!(after(&whole) != cloud.particles[..alike]);
}

/// The slots from the last multiple of four at or before a cell's first to its last.
fn slots_of(cell: &std::ops::Range<usize>) -> usize {
    cell.end - cell.start / 4 * 4
}

/// Cells are worked on by id, in whatever order their particles lie: few or many, up to CROWD slots, and no more.
#[test]
fn the_order_in_which_particles_lie_changes_no_bit() {
    const CROWDED: usize = MEMBERS as usize + 1;
    const FULL: usize = CROWD as usize;
    let walls = [tank([0.06, 0.07, 0.08])];
    // On a GPU those of more than MEMBERS lie by id before they collide.
    let free = |cell: &std::ops::Range<usize>, variant| match variant {
        KernelVariant::Gpu => cell.len() <= MEMBERS as usize,
        _ => slots_of(cell) <= FULL,
    };
    let by_id = |cloud: &Cloud| {
        let limit = 3 * cloud.particles.len() as u32 / 4;
        let rig = cloud.run(GpuStep { newborn_first_id: limit, newborns: limit, ..GpuStep::default() }, 2);
        let mut after: Vec<GpuParticle> = rig.get("sorted", cloud.particles.len());
        after.sort_by_key(GpuParticle::id);
        (after, rig.cell_collisions())
    };
    for (count, sizes) in
        [(2600, 0..=CROWDED), (6000, CROWDED..=23), (10_000, 23..=37), (16_000, 38..=55), (21_000, 55..=FULL + 4)]
    {
        let cloud = Cloud::of(65, &walls, count);
        let cells = || (0..cloud.start.len() - 1).map(|cell| cloud.cell(cell));
        let shuffled = |all: bool, variant| {
            let mut stream = Stream::new(66);
            let mut other = Cloud::of(65, &walls, count);
            other.variant = variant;
            for cell in cells().filter(|cell| all || free(cell, variant)) {
                stream.shuffle(&mut other.particles[cell]);
            }
            other
        };
        for size in sizes {
            assert!(cells().any(|cell| cell.len() == size), "{count}: no cell of {size}");
        }
        let found = by_id(&cloud);
        assert!(found.1 > 100);
        for variant in variants() {
            let other = shuffled(false, variant);
            let moved = cells().any(|cell| cell.len() > 1 && free(&cell, variant));
            assert_eq!(other.particles != cloud.particles, moved, "{variant:?} {count}");
            if device().adapter().is_cpu() || variant == device().variant() {
                assert!(by_id(&other) == found, "{variant:?} {count}");
            }
            // The check can fail: those of more are taken as they lie.
            let full = cells().any(|cell| !free(&cell, variant));
            assert_eq!(by_id(&shuffled(true, variant)) != by_id(&other), full, "{variant:?} {count}");
        }
    }
}

/// Those that enter in this step do not collide, and others are not slower for it: a cell of theirs alone stays as it is.
#[test]
fn newborns_do_not_collide_yet() {
    let cloud = Cloud::new(62, &[tank([0.06, 0.07, 0.08])]);
    let limit = 4000;
    let rig = cloud.run(GpuStep { newborn_first_id: limit, newborns: 2000, ..GpuStep::default() }, 1);
    let after: Vec<GpuParticle> = rig.get("sorted", cloud.particles.len());
    let pairs = || cloud.particles.iter().zip(&after);
    assert!(pairs().filter(|(a, _)| a.id() >= limit).all(|(a, b)| a == b));
    assert!(pairs().any(|(a, b)| a.id() < limit && a != b));
    // The check can fail: without newborns some of these collide.
    let rig = cloud.run(first_step(), 1);
    let after: Vec<GpuParticle> = rig.get("sorted", cloud.particles.len());
    assert!(cloud.particles.iter().zip(&after).any(|(a, b)| a.id() >= limit && a != b));
}

/// Gas on the two sides of a plate is never paired: each side of each cell conserves its momentum. And the candidates of
/// a cell are told to the balance, among other devices.
#[test]
fn no_pair_collides_through_a_plate() {
    let plate = Shape::Plane {
        center: [0.031, 0.035, 0.04],
        normal: [1.0, 0.0, 0.0],
        u: [0.0, 1.0, 0.0],
        size: [0.07, 0.08],
        thickness: 0.001,
        holes: vec![],
    };
    let cloud = Cloud::new(63, &[tank([0.06, 0.07, 0.08]), wall(plate, GasSide::Both)]);
    assert!(cloud.table.divided > 40);
    let rig = cloud.run(GpuStep { peers: 1, ..first_step() }, 5);
    assert!(rig.counter(0) > 30, "cells that walls part");
    let after: Vec<GpuParticle> = rig.get("sorted", cloud.particles.len());
    let candidates: Vec<u32> = rig.get("neighbour_count", cloud.particles.len());
    let (mut collided, mut through) = (0, 0);
    for cell in (0..cloud.start.len() - 1).filter(|&cell| cloud.table.volume[cell] >> 31 == 1) {
        let range = cloud.cell(cell);
        let (before, after) = (&cloud.particles[range.clone()], &after[range.clone()]);
        let left = |p: &&GpuParticle| cloud.world.grid.to_metres(p.position)[0] < 0.031;
        let of_side = |particles: &[GpuParticle], side: bool| {
            sums(&particles.iter().filter(|p| left(p) == side).copied().collect::<Vec<_>>())
        };
        for side in [false, true] {
            let ((p0, _, size), (p1, ..)) = (of_side(before, side), of_side(after, side));
            through += u32::from(norm(minus(p1, p0)) > 32.0 * U * size);
        }
        collided += u32::from(before != after);
        if !range.is_empty() {
            let told = &candidates[range];
            assert!(told[1..].iter().all(|&other| other == 0));
            assert!(before == after || told[0] > 0);
        }
    }
    assert!(collided > 10 && through == 0, "{collided} cells, {through} exchanged momentum through the plate");
    // The check can fail: without parts the same cells do.
    let mut open = Cloud::new(63, &[tank([0.06, 0.07, 0.08])]);
    (open.particles, open.start) = (cloud.particles.clone(), cloud.start.clone());
    let rig = open.run(first_step(), 5);
    let after: Vec<GpuParticle> = rig.get("sorted", open.particles.len());
    let moved = cloud.particles.iter().zip(&after).filter(|(p, _)| cloud.world.grid.to_metres(p.position)[0] < 0.031);
    let change: Vector = moved.fold([0.0; 3], |sum, (a, b)| {
        std::array::from_fn(|k| sum[k] + MASSES[usize::from(a.gas())] * f64::from(b.velocity[k] - a.velocity[k]))
    });
    assert!(norm(change) > 1.0, "{change:?}");
}

/// A device that ends loops of so many turns too soon is told of, and no other (of which all is as it should be).
#[test]
fn loops_that_end_too_soon_are_told() {
    let mut cloud = Cloud::of(71, &[tank([0.06, 0.07, 0.08])], 40_000);
    // All in one cell.
    let cell = cloud.world.cells().index([3, 3, 3]) as usize;
    let count = cloud.particles.len();
    cloud.particles.sort_by_key(GpuParticle::id);
    let middle = [(2 * 3 + 1) << (cloud.world.grid.cell_bits - 1); 3];
    cloud.particles.iter_mut().for_each(|particle| particle.position = middle);
    cloud.start.iter_mut().enumerate().for_each(|(k, start)| *start = if k > cell { count as u32 } else { 0 });
    let rig = cloud.rig(GpuStep { peers: 1, dt: 1e-15, ..first_step() }, 5);
    rig.run("collide", cloud.start.len() - 1);
    assert_eq!((rig.counter(LIST_CROWDS), rig.counter(CUT_SHORT)), (1, 0));
    rig.run("collide_crowded", 1);
    let mean = |axis: usize| cloud.particles.iter().map(|p| f64::from(p.velocity[axis])).sum::<f64>() / count as f64;
    let mean = [mean(0), mean(1), mean(2)];
    let away = |p: &GpuParticle| norm(minus(p.velocity.map(f64::from), mean));
    let fastest = cloud.particles.iter().map(away).fold(0.0, f64::max);
    let volume = f64::from(f32::from_bits(cloud.table.volume[cell]));
    let pairs = 0.5 * (count as f64) * (count as f64 - 1.0);
    let wanted = pairs * PI * DIAMETER * DIAMETER * 2.0 * fastest * 1e-15 / volume;
    let found: u32 = rig.get::<u32>("neighbour_count", 1)[0];
    let told = rig.counter(CUT_SHORT) > 0;
    assert!(told || (f64::from(found) - wanted).abs() < 0.01 * wanted + 1.0, "{found} candidates, {wanted} expected");
}
