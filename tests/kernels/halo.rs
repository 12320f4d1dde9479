//! Which particles become ghosts: all that a chain of neighbours joins to the own ones, and few others.

use std::collections::BTreeSet;

use corpuscle::subdomain::{FULL_SHARE, GpuFlight, GpuParticle, GpuPeer, GpuStep, GpuUpdate};

use crate::local::Extent;
use crate::neighbour_lists::put_flights;
use crate::oracle::random::Stream;
use crate::rig::*;

const COUNT: usize = 4000;
const DT: f32 = 1e-5;
/// In a step in which whole diameters meet within .78 of a cell, of which the diameter is .7.
const NEAR2: u32 = 10_000;
const DIAMETER2: u32 = 8_000;
/// Cells of a block's edge, log2.
const BLOCK_BITS: u32 = 1;

/// Particles in the order of their cells, in blocks whose gas leaves different shares of the cross-section; a device owns
/// the cells of `near`, which end at the border of the grid on some sides, and another all others.
struct Crowd {
    world: World,
    particles: Vec<GpuParticle>,
    cell: Vec<[u32; 3]>,
    near: Extent,
    shares: Vec<u32>,
    share: Vec<u32>,
}

impl Crowd {
    fn new(seed: u32) -> Crowd {
        let world = World::new(&[tank([0.12, 0.10, 0.11])], 0.01);
        let cells = world.cells();
        let mut stream = Stream::new(seed);
        let mut particles = world.particles(&mut stream, COUNT, 500.0);
        // Some fly far beyond the walls and the grid.
        for particle in particles.iter_mut().step_by(20) {
            particle.velocity = particle.velocity.map(|v| 40.0 * v);
        }
        let of = |p: &GpuParticle| cells.cell(cells.middle(p.position, p.velocity, DT));
        particles.sort_by_key(|p| (cells.index(of(p)), p.id()));
        let cell: Vec<[u32; 3]> = particles.iter().map(of).collect();
        let blocks = world.grid.blocks(BLOCK_BITS);
        let shares: Vec<u32> = (0..blocks.iter().product())
            .map(|_: u32| if stream.below(4) == 0 { FULL_SHARE } else { 1 + stream.below(FULL_SHARE) })
            .collect();
        let share_of = |cell: &[u32; 3]| {
            let b = cell.map(|c| c >> BLOCK_BITS);
            shares[((b[2] * blocks[1] + b[1]) * blocks[0] + b[0]) as usize]
        };
        let share = cell.iter().map(share_of).collect();
        let near = Extent { low: [1, 3, 4], high: [5, world.grid.cells[1] - 1, 7] };
        Crowd { world, particles, cell, near, shares, share }
    }

    /// By the rule of the lists: nearer than either of the two reaches.
    fn neighbours(&self) -> Vec<Vec<usize>> {
        let cells = self.world.cells();
        let midpoints: Vec<[u32; 3]> =
            self.particles.iter().map(|p| cells.middle(p.position, p.velocity, DT)).collect();
        let near = |a: usize, b: usize| {
            let share = self.share[a].min(self.share[b]);
            let near2 = NEAR2 - DIAMETER2 * (FULL_SHARE - share) / FULL_SHARE;
            a != b && cells.touching(midpoints[a], midpoints[b]) && cells.packed_near(midpoints[a], midpoints[b], near2)
        };
        (0..COUNT).map(|a| (0..COUNT).filter(|&b| near(a, b)).collect()).collect()
    }

    /// Links from the particles of `near` to each; None where there is no chain.
    fn links(&self, neighbours: &[Vec<usize>]) -> Vec<Option<u32>> {
        let mut links: Vec<Option<u32>> = self.cell.iter().map(|&cell| self.near.holds(cell).then_some(0)).collect();
        let mut front: Vec<usize> = (0..COUNT).filter(|&s| links[s].is_some()).collect();
        for count in 1.. {
            let beside = front.iter().flat_map(|&a| &neighbours[a]);
            let reached: BTreeSet<usize> = beside.copied().filter(|&b| links[b].is_none()).collect();
            if reached.is_empty() {
                break;
            }
            for &b in &reached {
                links[b] = Some(count);
            }
            front = reached.into_iter().collect();
        }
        links
    }

    fn rig(&self) -> Rig {
        let mut rig = Rig::new(&self.world);
        let blocks = self.world.grid.blocks(BLOCK_BITS);
        rig.constant("CAPPED", 1.0);
        rig.constant("DIAMETER2_PACKED", f64::from(DIAMETER2));
        rig.constant("BLOCK_BITS", f64::from(BLOCK_BITS));
        rig.constant("BLOCKS_X", f64::from(blocks[0]));
        rig.constant("BLOCKS_Y", f64::from(blocks[1]));
        rig.put("cross_section_shares", &self.shares);
        rig.put("particles", &self.particles);
        rig
    }

    /// Of a device that owns all cells but those of `near`, as if all particles were its own.
    fn step(&self, depth: u32) -> GpuStep {
        let grid = self.world.grid.cells;
        GpuStep {
            count: COUNT as u32,
            dt: DT,
            near2: NEAR2,
            depth,
            size: grid,
            bins: grid.iter().product(),
            own_low: [1; 3],
            own_high: grid.map(|cells| cells - 1),
            peers: 1,
            near_peers: 1,
            ..GpuStep::default()
        }
    }

    fn peers(&self) -> [GpuPeer; 1] {
        let signed = |cell: [u32; 3]| cell.map(|c| c as i32);
        [GpuPeer { low: signed(self.near.low), high: signed(self.near.high), ..GpuPeer::default() }]
    }

    fn bins(&self) -> Vec<u32> {
        self.cell.iter().map(|&cell| self.world.cells().index(cell)).collect()
    }

    /// The entries of `border` of all particles.
    fn border(&self) -> Vec<[u32; 2]> {
        (0..).zip(self.bins()).map(|(s, bin)| [s, bin]).collect()
    }
}

/// All that a chain joins are sent and brought up to date, and who is brought up to date has been sent. It is less than
/// the cells around hold.
#[test]
fn all_that_a_chain_of_neighbours_joins_are_sent() {
    let crowd = Crowd::new(80);
    let links = crowd.links(&crowd.neighbours());
    let astray = |p: &GpuParticle| crowd.world.cells().astray(crowd.world.cells().middle(p.position, p.velocity, DT));
    assert!(crowd.particles.iter().filter(|p| astray(p)).count() > COUNT / 30);
    for depth in [2, 4, 6] {
        let mut rig = crowd.rig();
        rig.put("border", &crowd.border());
        rig.put("peers", &crowd.peers());
        rig.put("outbox", &vec![GpuParticle::default(); COUNT]);
        rig.put("sendings", &vec![[0u32; 3]; COUNT]);
        rig.put("peer_counts", &[0u32; 4]);
        rig.put("peer_starts", &[0u32; 4]);
        rig.set_counter(LIST_BORDER, COUNT as u32);
        rig.step(crowd.step(depth));
        rig.run("pack", COUNT);
        rig.run_groups("message_starts", [1, 1, 1]);
        rig.run("fill_outbox", COUNT);
        let sent: Vec<GpuParticle> = rig.get("outbox", rig.counter(LIST_OUTBOX) as usize);
        let sent: BTreeSet<u32> = sent.iter().map(|particle| particle.tag).collect();

        let cells = crowd.world.cells();
        let midpoints: Vec<u32> =
            crowd.particles.iter().map(|p| cells.packed(cells.middle(p.position, p.velocity, DT))).collect();
        let mut rig = crowd.rig();
        rig.put("sorted", &crowd.particles);
        put_flights(&mut rig, &vec![GpuFlight::default(); COUNT]);
        rig.put("cells", &crowd.bins());
        rig.put("midpoints", &midpoints);
        rig.put("marks", &vec![SHARED | LISTED; COUNT]);
        rig.put("changed", &(0..COUNT as u32).collect::<Vec<_>>());
        rig.put("peers", &crowd.peers());
        rig.put("updates_out", &vec![GpuUpdate::default(); COUNT]);
        rig.put("sendings", &vec![[0u32; 3]; COUNT]);
        rig.put("peer_counts", &[0u32; 4]);
        rig.put("peer_starts", &[0u32; 4]);
        rig.set_counter(LIST_CHANGED, COUNT as u32);
        rig.step(crowd.step(depth));
        rig.run("pack_updates", COUNT);
        rig.run_groups("message_starts", [1, 1, 1]);
        rig.run("fill_updates", COUNT);
        let told: Vec<GpuUpdate> = rig.get("updates_out", rig.counter(LIST_UPDATES) as usize);
        let told: BTreeSet<u32> = told.iter().map(|update| update.particle.tag).collect();

        let around = (0..COUNT).filter(|&s| crowd.near.away(crowd.cell[s]) <= depth).count();
        let mut needed = 0;
        for (s, particle) in crowd.particles.iter().enumerate() {
            if links[s].is_some_and(|links| links <= depth) {
                assert!(sent.contains(&particle.tag) && told.contains(&particle.tag), "particle {s}, depth {depth}");
                needed += 1;
            }
        }
        assert!(told.is_subset(&sent));
        // The check can fail: many are needed, and fewer than the cells hold.
        assert!(needed > COUNT / 20 && sent.len() < around - around / 10, "{needed} < {} < {around}", sent.len());
    }
}

/// The layer of a ghost is at most its links from the own particles, at least its layer of cells, and one more at most
/// from neighbour to neighbour.
#[test]
fn layers_count_no_more_than_the_links_of_a_chain() {
    const DEPTH: u32 = 4;
    let crowd = Crowd::new(81);
    let neighbours = crowd.neighbours();
    let links = crowd.links(&neighbours);
    let bins = crowd.bins();
    let count = crowd.world.cells().count() as u32;
    let start: Vec<u32> = (0..=count).map(|c| bins.partition_point(|&own| own < c) as u32).collect();
    let mut rig = crowd.rig();
    // They lie in order.
    let slot = |s: usize| s as u32 - start[bins[s] as usize];
    rig.put("bins", &(0..COUNT).map(|s| [bins[s], slot(s)]).collect::<Vec<_>>());
    rig.put("cell_start", &start);
    rig.put("sorted", &vec![GpuParticle::default(); COUNT]);
    for buffer in ["midpoints", "cells", "neighbour_count", "incomplete"] {
        rig.put(buffer, &vec![9u32; COUNT]);
    }
    let (low, high) = (crowd.near.low, crowd.near.high);
    rig.step(GpuStep {
        own_low: low,
        own_high: high,
        inner_low: low,
        inner_high: high,
        arrivals: COUNT as u32,
        count: 0,
        // They wait until they are asked, and are searched for where the step begins.
        ghosts: 1,
        ..crowd.step(DEPTH)
    });
    rig.put("firsts", &vec![GpuParticle::default(); COUNT]);
    rig.run("order", COUNT);
    assert!(rig.get::<GpuParticle>("firsts", COUNT) == rig.get::<GpuParticle>("sorted", COUNT));
    let layers: Vec<u32> = rig.get::<u32>("marks", COUNT).iter().map(|mark| mark & 0xff).collect();
    let mut farther = 0;
    for s in 0..COUNT {
        let cells_away = crowd.near.away(crowd.cell[s]);
        assert!(layers[s] >= cells_away && (layers[s] == 0) == (cells_away == 0), "particle {s}");
        if let Some(links) = links[s].filter(|&links| links <= DEPTH) {
            assert!(layers[s] <= links, "particle {s}: {} > {links}", layers[s]);
        }
        for &other in neighbours[s].iter().filter(|&&other| layers[other] < DEPTH) {
            assert!(layers[s] <= layers[other] + 1, "{s} and {other}");
        }
        farther += usize::from(layers[s] > cells_away && cells_away > 0);
    }
    assert!(farther > COUNT / 20, "{farther} are farther by links than by cells");
}
