//! `bin` and `order`: the particles by cell, exactly; `arrange` and `arrange_crowded`: by cell, and by id where `collide` wants it.

use corpuscle::gpu::KernelVariant;
use corpuscle::subdomain::{
    CROWD, GpuFlight, GpuMotion, GpuNewborn, GpuPart, GpuParticle, GpuStep, MEMBERS, MOTION_ENTRIES,
};

use crate::neighbour_lists::{self, put_flights, put_to_complete, to_complete_of};
use crate::oracle::cells::Cells;
use crate::oracle::random::Stream;
use crate::rig::*;

const COUNT: usize = 2000;
/// Slots behind those of the last cell.
const EMPTY: usize = 70;
/// What `layers` has of a slot without particle.
const LAYER: u32 = 0xff;
/// A typical flight is a third of a cell; some leave the grid.
const SPEED: f64 = 400.0;
const DT: f32 = 1e-5;

struct Sorted {
    world: World,
    cells: Cells,
    particles: Vec<GpuParticle>,
    /// The cell of each particle's mid-step point.
    cell: Vec<u32>,
    start: Vec<u32>,
}

fn sorted(seed: u32) -> Sorted {
    let world = World::plain();
    let cells = world.cells();
    let mut stream = Stream::new(seed);
    let mut particles = world.particles(&mut stream, COUNT, SPEED);
    for fast in particles.iter_mut().step_by(100) {
        fast.velocity = fast.velocity.map(|v| 30.0 * v);
    }
    let cell: Vec<u32> =
        particles.iter().map(|p| cells.index(cells.cell(cells.middle(p.position, p.velocity, DT)))).collect();
    let mut start = vec![0u32; cells.count() + 1];
    for &c in &cell {
        for later in &mut start[c as usize + 1..] {
            *later += 1;
        }
    }
    Sorted { world, cells, particles, cell, start }
}

fn step() -> GpuStep {
    GpuStep { count: COUNT as u32, dt: DT, newborn_first_id: u32::MAX, ..GpuStep::default() }
}

#[test]
fn bin_counts_every_particle_in_the_cell_of_its_mid_step_point() {
    let Sorted { world, cells, particles, cell, start } = sorted(7);
    let mut rig = Rig::new(&world);
    rig.put("particles", &particles);
    rig.put("bins", &vec![[NOBODY; 2]; COUNT]);
    rig.put("cell_counts", &vec![0u32; cells.count()]);
    rig.step(step());
    rig.run("bin", COUNT);
    let counts: Vec<u32> = start.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert_eq!(rig.get::<u32>("cell_counts", cells.count()), counts);
    let bins: Vec<[u32; 2]> = rig.get("bins", COUNT);
    assert_eq!(bins.iter().map(|bin| bin[0]).collect::<Vec<_>>(), cell);
    // The slots of a cell are 0, 1, .. in some order.
    let mut places: Vec<u32> = bins.iter().map(|bin| start[bin[0] as usize] + bin[1]).collect();
    places.sort_unstable();
    assert_eq!(places, (0..COUNT as u32).collect::<Vec<_>>());
    // The check can fail: the cell at the start of the step is another one for many.
    let at_start = particles.iter().map(|p| cells.index(cells.cell(p.position)));
    assert!(at_start.zip(&cell).filter(|(a, b)| a != *b).count() > COUNT / 20);
}

/// `order` puts the particles into the places of their cells, as their slots say, and marks exactly those that may meet a wall;
/// where diameters are capped `start_flights` gives them flights, which start at a newborn's entry (else the search does).
#[test]
fn order_is_by_cells() {
    let Sorted { world, cells, mut particles, cell, start } = sorted(10);
    let mut stream = Stream::new(11);
    // The last 100 were born in this step.
    let (first_id, born) = (1_000_000, 100u32);
    let entries: Vec<GpuNewborn> =
        (0..born + 5).map(|_| GpuNewborn { start: DT * stream.uniform() as f32, ..GpuNewborn::default() }).collect();
    for (k, particle) in particles[COUNT - born as usize..].iter_mut().enumerate() {
        particle.tag = GpuParticle::tag(1, first_id + k as u32);
    }
    let begin = |p: &GpuParticle| match p.id().checked_sub(first_id) {
        Some(k) => entries[5 + k as usize].start,
        None => 0.0,
    };
    // Blocks of two cells a side, each with its own share of the cross-section.
    let blocks = world.grid.blocks(1);
    let shares: Vec<u32> = (0..blocks.iter().product()).map(|b: u32| 100 + b).collect();
    let share_of = |cell: u32| {
        let [nx, ny, _] = world.grid.cells;
        let b = [cell % nx, cell / nx % ny, cell / (nx * ny)].map(|k| k >> 1);
        shares[((b[2] * blocks[1] + b[1]) * blocks[0] + b[0]) as usize]
    };
    for shuffle in 0..2 {
        // Slots as another order of threads would give them.
        let mut placed: Vec<usize> = (0..COUNT).collect();
        stream.shuffle(&mut placed);
        placed.sort_by_key(|&k| cell[k]);
        let mut bins = vec![[0u32; 2]; COUNT];
        for (place, &k) in placed.iter().enumerate() {
            bins[k] = [cell[k], place as u32 - start[cell[k] as usize]];
        }
        let expected: Vec<GpuParticle> = placed.iter().map(|&k| particles[k]).collect();
        let meets = |s: &u32| world.may_hit(&expected[*s as usize], begin(&expected[*s as usize]), DT);
        let near_walls: Vec<u32> = (0..COUNT as u32).filter(meets).collect();
        let mut rig = Rig::new(&world);
        rig.put("particles", &particles);
        rig.put("newborns", &entries);
        rig.put("bins", &bins);
        rig.put("cell_start", &start);
        rig.put("sorted", &vec![GpuParticle::default(); COUNT]);
        for buffer in ["midpoints", "cells", "neighbour_count"] {
            rig.put(buffer, &vec![9u32; COUNT + EMPTY]);
        }
        rig.step(GpuStep {
            total: (COUNT + EMPTY) as u32,
            count: COUNT as u32 - born,
            newborns: born,
            newborn_offset: 5,
            newborn_first_id: first_id,
            dt: DT,
            ..GpuStep::default()
        });
        let capped = shuffle == 1;
        rig.constant("CAPPED", f64::from(u8::from(capped)));
        rig.constant("BLOCK_BITS", 1.0);
        rig.constant("BLOCKS_X", f64::from(blocks[0]));
        rig.constant("BLOCKS_Y", f64::from(blocks[1]));
        rig.put("cross_section_shares", &shares);
        put_to_complete(&mut rig, COUNT, &[]);
        rig.run("order", COUNT + EMPTY);
        assert_eq!(rig.get::<GpuParticle>("sorted", COUNT), expected, "shuffle {shuffle}");
        if capped {
            // These are where the particles were.
            put_flights(&mut rig, &vec![GpuFlight::default(); COUNT + EMPTY]);
            rig.run("start_flights", COUNT + EMPTY);
            let flights = neighbour_lists::flights(&rig, COUNT + EMPTY);
            let (flights, empty) = flights.split_at(COUNT);
            assert_eq!(empty, vec![GpuFlight::default(); EMPTY]);
            let new = |(p, &k): (&GpuParticle, &usize)| GpuFlight {
                start: begin(p),
                wall: NEVER,
                partner: NOBODY,
                collisions: share_of(cell[k]) << 16,
            };
            assert_eq!(flights, expected.iter().zip(&placed).map(new).collect::<Vec<_>>());
        }
        assert_eq!(rig.get::<u32>("cells", COUNT), placed.iter().map(|&k| cell[k]).collect::<Vec<_>>());
        assert_eq!(rig.get::<u32>("neighbour_count", COUNT + EMPTY), vec![0; COUNT + EMPTY]);
        let midpoints: Vec<u32> = rig.get("midpoints", COUNT);
        for (s, p) in expected.iter().enumerate() {
            let middle = cells.middle(p.position, p.velocity, DT);
            let flag = u32::from(world.near_triangle(cell[placed[s]])) << 31;
            assert_eq!(midpoints[s], cells.packed(middle) | flag);
        }
        assert_eq!(to_complete_of(&rig), near_walls);
        // Alone all are in layer 0 and nobody else's ghosts.
        let marked = |s: u32| if near_walls.contains(&s) { NEAR } else { 0 };
        let layers: Vec<u32> = rig.get("marks", COUNT + EMPTY);
        assert_eq!(layers[..COUNT], (0..COUNT as u32).map(marked).collect::<Vec<_>>());
        assert!(layers[COUNT..].iter().all(|&layer| layer == LAYER), "slots behind the last cell's hold nobody");
        assert!(near_walls.len() < COUNT - 50 && near_walls.len() > 50, "{}", near_walls.len());
        // The check can fail: the particles came in another order.
        assert_ne!(particles, expected);
    }
}

/// Particles of the method `cell` come into the places of their cells: as their slots say, but by id in cells of more than a thread
/// puts in order by itself, in those that walls part and in those that walls may touch which move. Slots have the ids of those and of
/// crowded cells. Among others their cells are noted, and where walls part a cell the part of each.
#[test]
fn particles_of_cells_are_arranged() {
    const DIVIDED: u32 = 1 << 31;
    let Sorted { world, mut particles, mut cell, .. } = sorted(12);
    let cells = world.cells();
    let mut stream = Stream::new(13);
    // One cell has just as many as are few, another one more, others many more: all in the middle of the grid.
    let middle = [3, 4, 4];
    let crowds = [(MEMBERS, [0, 0, 0]), (MEMBERS + 1, [1, 0, 0]), (40, [0, 1, 0]), (CROWD + 1, [1, 1, 0])];
    let mut next = 0;
    for &(count, off) in &crowds {
        let there = cells.index([0, 1, 2].map(|k| middle[k] + off[k]));
        for at in cell.iter_mut() {
            if *at == there {
                *at = cells.index([1, 1, 1]);
            }
        }
        cell[next..next + count as usize].fill(there);
        next += count as usize;
    }
    let [nx, ny, _] = world.grid.cells;
    let place_of = |of: u32| [of % nx, of / nx % ny, of / (nx * ny)];
    // They lie in these cells.
    for (particle, &of) in particles.iter_mut().zip(&cell) {
        particle.position = place_of(of).map(|at| (2 * at + 1) << (cells.bits - 1));
    }
    // In the box around a wall that moves, but not where it is.
    let divided = cells.index([5, 2, 2]);
    // A wall that starts in the first of these cells has moved by one and a half along x; its box is larger.
    let (low, high) = ([5, 2, 2], [6, 3, 2]);
    let moved = |of: u32| {
        let at = place_of(of);
        at[0] == 6 && (0..3).all(|k| (low[k]..=high[k]).contains(&at[k]))
    };
    let mut list = world.walls.list.clone();
    let begin = list.len() as u32;
    list.extend([0, begin, begin + 1]);
    let moving = GpuMotion {
        moved: [3 << (cells.bits - 1), 0, 0],
        low,
        high,
        cells: begin + 1,
        body_low: low,
        body_size: [1; 3],
        ..GpuMotion::default()
    };
    let mut start = vec![0u32; cells.count() + 1];
    for &c in &cell {
        start[c as usize + 1..].iter_mut().for_each(|later| *later += 1);
    }
    let mut arrival: Vec<usize> = (0..COUNT).collect();
    stream.shuffle(&mut arrival);
    let mut filled = start.clone();
    let mut bins = vec![[0u32; 2]; COUNT];
    let mut by_slot = vec![GpuParticle::default(); COUNT];
    for &k in &arrival {
        let place = filled[cell[k] as usize];
        filled[cell[k] as usize] += 1;
        bins[k] = [cell[k], place - start[cell[k] as usize]];
        by_slot[place as usize] = particles[k];
    }
    let cases = [(false, 0), (true, 1)];
    for (variant, (walls, peers)) in variants().into_iter().flat_map(|variant| cases.map(|case| (variant, case))) {
        let ordered = |c: u32| {
            let [begin, end] = [start[c as usize], start[c as usize + 1]];
            // On a GPU no thread of `collide_crowded` puts a cell in order by itself.
            let crowded =
                if variant == KernelVariant::Gpu { end - begin > MEMBERS } else { end - begin / 4 * 4 > CROWD };
            crowded || walls && (c == divided || moved(c))
        };
        let mut expected = by_slot.clone();
        for c in (0..cells.count() as u32).filter(|&c| ordered(c)) {
            expected[start[c as usize] as usize..start[c as usize + 1] as usize].sort_by_key(GpuParticle::id);
        }
        let mut volume = vec![1e-9f32.to_bits(); cells.count()];
        volume[divided as usize] = DIVIDED | 2 << 24;
        let mut rig = Rig::new(&world);
        rig.variant = variant;
        rig.put("particles", &particles);
        rig.put("bins", &bins);
        rig.put("cell_start", &start);
        rig.put("cell_volume", &volume);
        // The point of the first part is out of sight, beyond the tank's side.
        let beyond = world.fixed([world.low[0] - 0.5 * world.grid.cell, 0.035, 0.04]);
        let part = |place: [u32; 3]| GpuPart { place, volume: 1e-9 };
        rig.put("cell_parts", &[part(beyond), part(world.fixed([0.03, 0.035, 0.04]))]);
        rig.put("slots", &vec![NOBODY; COUNT]);
        rig.put("sorted", &vec![GpuParticle::default(); COUNT]);
        for buffer in ["crowded", "cells", "marks"] {
            rig.put(buffer, &vec![9u32; COUNT + EMPTY]);
        }
        rig.constant("DIVIDED_GAS", f64::from(u8::from(walls)));
        if walls {
            let mut table = [GpuMotion::default(); MOTION_ENTRIES];
            table[0] = moving;
            rig.uniform("motions", &table);
            rig.put("wall_list", &list);
            rig.constant("MOVING", 1.0);
            rig.constant("MOTIONS", 1.0);
        }
        rig.step(GpuStep { total: (COUNT + EMPTY) as u32, peers, ..step() });
        rig.run("arrange", COUNT + EMPTY);
        let of_ordered: Vec<u32> = (0..COUNT as u32).filter(|&k| ordered(cell[k as usize])).collect();
        assert_eq!(rig.list("crowded", LIST_CROWDED), of_ordered);
        rig.run("arrange_crowded", of_ordered.len());
        assert_eq!(rig.get::<GpuParticle>("sorted", COUNT), expected, "walls {walls}");
        // The check can fail: by their slots they are not in order.
        assert_ne!(by_slot, expected);
        let noted_slot = |slot: usize| {
            let c = (0..cells.count()).find(|&c| (start[c]..start[c + 1]).contains(&(slot as u32))).expect("a cell");
            if ordered(c as u32) || start[c + 1] - start[c] > MEMBERS { by_slot[slot].id() } else { NOBODY }
        };
        assert_eq!(rig.get::<u32>("slots", COUNT), (0..COUNT).map(noted_slot).collect::<Vec<_>>());
        let mut noted = vec![9; COUNT + EMPTY];
        let mut layers = noted.clone();
        if peers > 0 {
            cell.iter().zip(&bins).for_each(|(&c, bin)| noted[(start[c as usize] + bin[1]) as usize] = c);
            layers[..COUNT].fill(0);
            layers[start[divided as usize] as usize..start[divided as usize + 1] as usize].fill(1 << 16);
            layers[COUNT..].fill(LAYER);
        }
        assert_eq!((rig.get::<u32>("cells", COUNT + EMPTY), rig.get::<u32>("marks", COUNT + EMPTY)), (noted, layers));
    }
    assert!((0..COUNT).any(|k| cell[k] == divided) && (0..COUNT).any(|k| moved(cell[k])));
}

/// Only walls that can part two points of the gas have neighbours screened; the surface of a convex cavity
/// cannot. (`World` takes every wall for one that can.)
#[test]
fn only_walls_that_part_the_gas_are_marked() {
    let world = World::plain();
    let vessel = corpuscle::geometry::Vessel::build(&[tank([0.06, 0.07, 0.08])]).unwrap();
    let margin = corpuscle::subdomain::Walls::tolerance(&world.grid);
    let fixed = corpuscle::geometry::TriangleGrid::build(&vessel, &world.grid, margin).unwrap();
    let none = corpuscle::subdomain::Walls::new(&fixed, &world.grid, &[], &[], |_| false);
    assert!(none.parting.iter().all(|&bits| bits == 0));
    let marked = |cell: u32| world.walls.parting[cell as usize / 32] >> (cell % 32) & 1 == 1;
    let cells = world.grid.cell_count() as u32;
    assert!((0..cells).all(|cell| marked(cell) == world.near_triangle(cell)));
    assert!((0..cells).any(marked) && !(0..cells).all(marked), "some cells are near a wall and some are not");
}
