//! A crowd of particles for the search of neighbours, and the search of all pairs that it is held against.

use std::collections::BTreeSet;

use corpuscle::subdomain::{GpuParticle, GpuStep};

use crate::choose::DIAMETER;
use crate::neighbour_lists::{TAILS, complete_lists, lists, put_flights, put_room, put_to_complete};
use crate::oracle::random::Stream;
use crate::rig::*;

pub const COUNT: usize = 1500;

/// Particles by cell, whose neighbours are searched for.
pub struct Crowd {
    pub world: World,
    /// Mid-step points by (cell, order), some beyond the grid.
    pub midpoints: Vec<[u32; 3]>,
    pub rig: Rig,
    /// Of the step, s.
    pub dt: f32,
    /// Of the halo, 0 on a device alone.
    pub depth: u32,
}

pub fn crowd(seed: u32) -> Crowd {
    let world = World::plain();
    let cells = world.cells();
    let mut stream = Stream::new(seed);
    let cell = world.grid.cell;
    let mut midpoints: Vec<[u32; 3]> = (0..COUNT)
        .map(|k| {
            let beyond = if k % 50 == 0 { 4.0 * cell } else { 0.0 };
            world.fixed(std::array::from_fn(|a| stream.between(world.low[a] - beyond, world.high[a] + beyond)))
        })
        .collect();
    // Some in one place.
    for k in (7..COUNT).step_by(60) {
        midpoints[k] = midpoints[k - 1];
    }
    midpoints.sort_by_key(|&p| cells.index(cells.cell(p)));
    let of: Vec<u32> = midpoints.iter().map(|&p| cells.index(cells.cell(p))).collect();
    crowd_at(World::plain(), midpoints, of)
}

/// Some of a crowd are marked so.
pub fn may_meet_a_wall(s: usize) -> bool {
    s.is_multiple_of(7)
}

/// Mid-step points in the order of their cells.
pub fn crowd_at(world: World, midpoints: Vec<[u32; 3]>, of: Vec<u32>) -> Crowd {
    let cells = world.cells();
    let start: Vec<u32> = (0..=cells.count() as u32).map(|c| of.partition_point(|&own| own < c) as u32).collect();
    let packed: Vec<u32> =
        midpoints.iter().zip(&of).map(|(&p, &c)| cells.packed(p) | u32::from(world.class(c) != CLEAR) << 31).collect();
    let mut rig = Rig::new(&world);
    rig.put("cell_start", &start);
    rig.put("midpoints", &packed);
    rig.put("cells", &of);
    rig.put("sorted", &vec![GpuParticle::default(); COUNT]);
    rig.put("choices", &vec![[7u32; 2]; COUNT]);
    rig.put("incomplete", &vec![NOBODY; COUNT]);
    put_flights(&mut rig, &free_flights(COUNT));
    Crowd { world, midpoints, rig, dt: 0.0, depth: 0 }
}

impl Crowd {
    pub fn run(&mut self) -> Vec<Vec<u32>> {
        self.run_near(TAILS, CELL_NEAR2)
    }

    /// With room for tails of so many entries.
    pub fn run_near(&mut self, tails: usize, near2: u32) -> Vec<Vec<u32>> {
        let (count, dt, depth) = (COUNT as u32, self.dt, self.depth);
        self.rig.step(GpuStep { count, near2, dt, depth, ..GpuStep::default() });
        put_room(&mut self.rig, COUNT, tails);
        self.rig.put("neighbour_count", &vec![0u32; COUNT]);
        // As `order` leaves it.
        self.rig.put("marks", &(0..COUNT).map(|s| if may_meet_a_wall(s) { NEAR } else { 0 }).collect::<Vec<_>>());
        let near: Vec<u32> = (0..COUNT as u32).filter(|&s| may_meet_a_wall(s as usize)).collect();
        put_to_complete(&mut self.rig, COUNT, &near);
        self.rig.put("rechoose", &vec![NOBODY; COUNT + 64 * LIST_SHARDS]);
        self.rig.run("neighbours", COUNT);
        complete_lists(&self.rig, LIST_INCOMPLETE);
        lists(&self.rig, COUNT, tails)
    }

    pub fn all_pairs(&self) -> Vec<BTreeSet<u32>> {
        self.pairs_near(CELL_NEAR2)
    }

    pub fn pairs_near(&self, near2: u32) -> Vec<BTreeSet<u32>> {
        let cells = self.world.cells();
        let near = |i: usize, j: usize| {
            let (p, q) = (self.midpoints[i], self.midpoints[j]);
            i != j && cells.touching(p, q) && cells.packed_near(p, q, near2)
        };
        (0..COUNT).map(|i| (0..COUNT).filter(|&j| near(i, j)).map(|j| j as u32).collect()).collect()
    }
}

/// A crowd of these, with diameters that they can meet by.
pub fn flying(mut particles: Vec<GpuParticle>, dt: f32) -> Crowd {
    let world = World::plain();
    let cells = world.cells();
    let middle = |p: &GpuParticle| cells.middle(p.position, p.velocity, dt);
    particles.sort_by_key(|p| cells.index(cells.cell(middle(p))));
    let midpoints: Vec<[u32; 3]> = particles.iter().map(middle).collect();
    let of: Vec<u32> = midpoints.iter().map(|&p| cells.index(cells.cell(p))).collect();
    let packed = (128.0 * DIAMETER / world.grid.cell).powi(2).floor();
    let mut crowd = crowd_at(world, midpoints, of);
    crowd.rig.constant("DIAMETER", DIAMETER);
    crowd.rig.constant("DIAMETER2_PACKED", packed);
    crowd.rig.put("sorted", &particles);
    put_flights(&mut crowd.rig, &free_flights(COUNT));
    crowd.dt = dt;
    crowd
}
