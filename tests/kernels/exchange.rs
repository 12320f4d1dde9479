//! `bin`, `pack`, `pack_updates`, `message_starts`, `fill_outbox`, `fill_updates` and `receive` on a device among others:
//! exactly.

use std::collections::BTreeSet;

use corpuscle::subdomain::{GpuFlight, GpuNewborn, GpuParticle, GpuStep, GpuUpdate};

use crate::local::Local;
use crate::neighbour_lists::{self, DIRECT, put_flights, put_lists};
use crate::oracle::random::Stream;
use crate::rig::*;

const COUNT: usize = 2000;
const DT: f32 = 1e-5;

/// Binned are the particles of the own cells and the halo, all others and the dead are dropped; on the border list
/// are the earlier particles in cells that others own or have in their halo; arrivals are binned with them later.
#[test]
fn bin_keeps_own_and_halo_and_lists_those_that_others_need() {
    let world = World::plain();
    let cells = world.cells();
    let local = Local::new(&world);
    let mut stream = Stream::new(50);
    let mut particles = world.particles(&mut stream, COUNT, 400.0);
    let (count, born, arrivals) = (1700, 100, 200);
    for dead in particles[..count].iter_mut().step_by(7) {
        dead.tag = NOBODY;
    }
    let cell = |p: &GpuParticle| cells.cell(cells.middle(p.position, p.velocity, DT));
    let of = |p: &GpuParticle| if p.tag == NOBODY { None } else { local.bin(cell(p)) };
    let mut rig = Rig::new(&world);
    // Those that enter are put there.
    let entering =
        |particle: &mut GpuParticle| GpuNewborn { particle: std::mem::take(particle), ..GpuNewborn::default() };
    let mut slots = particles.clone();
    rig.put("newborns", &slots[count..count + born].iter_mut().map(entering).collect::<Vec<_>>());
    rig.put("particles", &slots);
    rig.put("bins", &vec![[7u32; 2]; COUNT]);
    rig.put("cell_counts", &vec![0u32; local.step().bins as usize]);
    rig.put("border", &vec![[NOBODY; 2]; COUNT]);
    let capacity = COUNT as u32;
    let placed = GpuStep { count: count as u32, newborns: born as u32, capacity, dt: DT, ..local.step() };
    let first = count + born;
    for (here, more) in [(first, 0), (COUNT, arrivals)] {
        let start = if more > 0 { first as u32 } else { 0 };
        rig.step(GpuStep { arrivals: more as u32, first: start, ..placed });
        rig.run("bin", here - start as usize);
        let found: Vec<[u32; 2]> = rig.get("bins", COUNT);
        let mut counts = vec![0u32; placed.bins as usize];
        for (bin, particle) in found[..here].iter().zip(&particles) {
            assert_eq!(bin[0], of(particle).unwrap_or(NOBODY));
            if let Some(bin) = of(particle) {
                counts[bin as usize] += 1;
            }
        }
        assert_eq!(rig.get::<u32>("cell_counts", counts.len()), counts);
        // The slots of a bin are 0, 1, ..: none twice.
        let kept = found[..here].iter().filter(|bin| bin[0] != NOBODY);
        let places: BTreeSet<[u32; 2]> = kept.clone().copied().collect();
        assert_eq!(places.len(), kept.count());
        assert!(places.iter().all(|&[bin, slot]| slot < counts[bin as usize]));
        let dropped = particles[..here].iter().filter(|p| of(p).is_none()).count();
        assert_eq!(rig.counter(COUNT_DROPPED) as usize, dropped);
        assert!(dropped > here / 4 && dropped < here - 200, "some are dropped and some are not: {dropped}");
        assert!(found[here..].iter().all(|bin| *bin == [7, 7]));
        let came = particles[first..here].iter().filter(|p| local.own.holds(cell(p))).count();
        assert_eq!(rig.counter(MOVED) as usize, came);
        assert_eq!(came > 0, more > 0, "arrivals for the own cells");
    }
    let expected: Vec<[u32; 2]> = (0..count)
        .filter(|&i| particles[i].tag != NOBODY && !local.inner.holds(cell(&particles[i])))
        .map(|i| [i as u32, local.index(cell(&particles[i]))])
        .collect();
    let mut border: Vec<[u32; 2]> = rig.get("border", rig.counter(LIST_BORDER) as usize);
    border.sort_unstable();
    assert_eq!(border, expected);
    // The check can fail: some live particles are not on the list.
    assert!(particles[..count].iter().any(|p| p.tag != NOBODY && local.inner.holds(cell(p))));
}

/// A particle goes to exactly the peers whose cells, with the halo around, hold its cell, where all in the halo are needed
/// (whom else, tests/kernels/halo.rs shows). One whose owner is
/// unknown is counted, and so is what finds no room, which is not written.
#[test]
fn pack_sends_to_those_whose_cells_and_halo_hold_the_cell() {
    let world = World::plain();
    let local = Local::new(&world);
    let mut stream = Stream::new(51);
    let particles = world.particles(&mut stream, COUNT, 400.0);
    let mut border: Vec<(usize, [u32; 3])> =
        (0..COUNT / 2).map(|k| (2 * k, std::array::from_fn(|axis| 1 + stream.below(local.grid[axis] - 2)))).collect();
    let to = |cell: [u32; 3]| (0..).zip(&local.others).filter(move |(_, other)| other.away(cell) <= local.depth);
    // As many as fill their buffer to the last: one of sendings of 12 bytes is rounded up to 16.
    while border.iter().map(|&(_, cell)| to(cell).count()).sum::<usize>() % 4 != 0 {
        border.pop();
    }
    let mut expected: Vec<(u32, u32)> = Vec::new();
    let (mut strays, mut movers) = (0, 0);
    for &(i, cell) in &border {
        expected.extend(to(cell).map(|(p, _)| (p, particles[i].tag)));
        let theirs = local.others.iter().any(|other| other.holds(cell));
        movers += usize::from(theirs);
        strays += u32::from(!theirs && !local.own.holds(cell));
    }
    expected.sort_unstable();
    for (room, flight) in [(expected.len(), 0), (400, 0), (expected.len(), 3)] {
        let mut rig = Rig::new(&world);
        rig.put("particles", &particles);
        rig.put("border", &border.iter().map(|&(i, cell)| [i as u32, local.index(cell)]).collect::<Vec<_>>());
        rig.put("peers", &local.peers());
        let unwritten = GpuParticle { tag: NOBODY, ..GpuParticle::default() };
        rig.put("outbox", &vec![unwritten; COUNT * 4]);
        put_sendings(&mut rig, room);
        rig.set_counter(LIST_BORDER, border.len() as u32);
        rig.step(GpuStep { count: COUNT as u32, flight, ..local.step() });
        rig.run("pack", border.len() + 64);
        assert_eq!(rig.counter(LIST_OUTBOX) as usize, expected.len());
        // Where not all others are peers, who flew too far strays as well.
        let unknown = |cell| !local.own.holds(cell) && !local.others.iter().any(|other| other.holds(cell));
        let strayed = |cell| unknown(cell) || flight > 0 && local.own.away(cell) > flight;
        let expected_strays = border.iter().filter(|&&(_, cell)| strayed(cell)).count() as u32;
        assert_eq!(rig.counter(STRAYS), expected_strays);
        assert!(flight == 0 || expected_strays > strays + 20);
        let starts = message_starts(&rig, local.others.len());
        rig.run("fill_outbox", expected.len() + 64);
        let sent: Vec<GpuParticle> = rig.get("outbox", COUNT * 4);
        let written = starts[local.others.len()] as usize;
        assert_eq!(written, expected.len().min(room));
        assert!(sent[written..].iter().all(|particle| *particle == unwritten));
        for particle in &sent[..written] {
            assert!(particles.contains(particle), "whole");
        }
        let peers = (0..local.others.len()).flat_map(|p| vec![p as u32; (starts[p + 1] - starts[p]) as usize]);
        let mut found: Vec<(u32, u32)> = peers.zip(&sent).map(|(peer, particle)| (peer, particle.tag)).collect();
        found.sort_unstable();
        if room >= expected.len() {
            assert_eq!(found, expected);
        } else {
            assert!(found.iter().all(|entry| expected.contains(entry)));
        }
    }
    // The check can fail: there are strays, movers, and particles for two.
    assert!(strays > 20 && movers > 100 && expected.len() > movers && expected.len() > 400);
}

/// Buffers for so many sendings.
fn put_sendings(rig: &mut Rig, room: usize) {
    rig.put("sendings", &vec![[0u32; 3]; room]);
    rig.put("peer_counts", &[0u32; 64]);
    rig.put("peer_starts", &[7u32; 64]);
}

/// Where each of the messages begins, and where the last one ends; the counts are zero afterwards.
fn message_starts(rig: &Rig, peers: usize) -> Vec<u32> {
    rig.run_groups("message_starts", [1, 1, 1]);
    assert_eq!(rig.get::<u32>("peer_counts", 64), vec![0; 64]);
    let starts: Vec<u32> = rig.get("peer_starts", peers + 2);
    assert_eq!((starts[0], starts[peers + 1]), (0, 7), "peers and no more");
    assert!(starts[..=peers].is_sorted());
    starts[..=peers].to_vec()
}

/// Messages begin at the exclusive prefix sums of the counts, for any number of peers.
#[test]
fn messages_begin_at_the_prefix_sums() {
    let world = World::plain();
    let mut stream = Stream::new(54);
    for peers in [1usize, 2, 127, 128, 129, 383] {
        let counts: Vec<u32> = (0..peers).map(|_| stream.below(1000)).collect();
        let mut rig = Rig::new(&world);
        rig.put("peer_counts", &counts);
        rig.put("peer_starts", &vec![u32::MAX; peers + 1]);
        rig.step(GpuStep { count: 1, peers: peers as u32, ..GpuStep::default() });
        rig.run_groups("message_starts", [1, 1, 1]);
        let expected: Vec<u32> = (0..=peers).map(|p| counts[..p].iter().sum()).collect();
        assert_eq!(rig.get::<u32>("peer_starts", peers + 1), expected);
        assert_eq!(rig.get::<u32>("peer_counts", peers), vec![0; peers]);
    }
}

/// A crowd in the order of the bins: the cell of each, and where each bin starts.
fn crowd(local: &Local, stream: &mut Stream) -> (Vec<[u32; 3]>, Vec<u32>) {
    let all = local.cells();
    let mut cells: Vec<[u32; 3]> = (0..COUNT).map(|_| all[stream.below(all.len() as u32) as usize]).collect();
    cells.sort_by_key(|&cell| local.bin(cell));
    let bins: Vec<u32> = cells.iter().filter_map(|&cell| local.bin(cell)).collect();
    let starts = (0..=local.step().bins).map(|bin| bins.partition_point(|&own| own < bin) as u32).collect();
    (cells, starts)
}

fn flights(stream: &mut Stream) -> Vec<GpuFlight> {
    let mut flights = free_flights(COUNT);
    for flight in &mut flights {
        *flight = GpuFlight { start: stream.uniform() as f32, partner: stream.word(), collisions: 2, ..*flight };
    }
    flights
}

/// Each particle on the list goes, as it is, to every near peer that has it as a ghost, and is taken off the list.
#[test]
fn updates_go_to_those_who_have_the_ghost() {
    let world = World::plain();
    let local = Local::new(&world);
    let mut stream = Stream::new(52);
    let particles = world.particles(&mut stream, COUNT, 400.0);
    let flights = flights(&mut stream);
    let (cells, _) = crowd(&local, &mut stream);
    let changed: Vec<u32> = (0..COUNT as u32).filter(|_| stream.below(3) == 0).collect();
    let bins: Vec<u32> = cells.iter().filter_map(|&cell| local.bin(cell)).collect();
    let marks = SHARED | LISTED | NEAR;
    let mut expected: Vec<(u32, u32, GpuUpdate)> = Vec::new();
    for &s in &changed {
        let k = s as usize;
        // The third other has no ghosts of this device.
        for (peer, _) in (0..2).zip(&local.others).filter(|(_, other)| other.away(cells[k]) <= local.depth) {
            let (particle, flight) = (particles[k], flights[k]);
            let update = GpuUpdate { particle, flight, cell: local.index(cells[k]), ..GpuUpdate::default() };
            expected.push((peer, particle.tag, update));
        }
    }
    expected.sort_unstable_by_key(|entry| (entry.0, entry.1));
    for room in [COUNT * 2, 50] {
        let mut rig = Rig::new(&world);
        rig.put("sorted", &particles);
        put_flights(&mut rig, &flights);
        rig.put("cells", &bins);
        rig.put("midpoints", &vec![0u32; COUNT]);
        rig.put("marks", &vec![marks; COUNT]);
        rig.put("changed", &changed);
        rig.put("peers", &local.peers());
        rig.put("updates_out", &vec![GpuUpdate::default(); room]);
        put_sendings(&mut rig, room);
        rig.set_counter(LIST_CHANGED, changed.len() as u32);
        rig.step(GpuStep { count: COUNT as u32, ..local.step() });
        rig.run("pack_updates", COUNT);
        assert_eq!(rig.counter(LIST_UPDATES) as usize, expected.len());
        let starts = message_starts(&rig, local.others.len());
        rig.run("fill_updates", expected.len() + 64);
        let written: Vec<GpuUpdate> = rig.get("updates_out", room.min(expected.len()));
        let to = |k: usize| starts.partition_point(|&start| start as usize <= k) as u32 - 1;
        let mut found: Vec<(u32, u32, GpuUpdate)> =
            written.iter().enumerate().map(|(k, update)| (to(k), update.particle.tag, *update)).collect();
        found.sort_unstable_by_key(|entry| (entry.0, entry.1));
        if room > 50 {
            assert_eq!(found, expected);
        } else {
            assert!(found.iter().all(|entry| expected.contains(entry)));
        }
        let layers: Vec<u32> = rig.get("marks", COUNT);
        let listed = |s: usize| changed.binary_search(&(s as u32)).is_ok();
        assert!((0..COUNT).all(|s| layers[s] == if listed(s) { marks & !LISTED } else { marks }));
    }
    // The check can fail: some go to nobody, some to two.
    assert!(expected.len() > changed.len() / 3 && expected.len() < 2 * changed.len());
    assert!(expected.len() > 100);
}

/// A ghost takes the state of its update. It and who has it in his list may choose again, once: those in its own list if it
/// has one, else all who choose and are near enough. An update of a ghost that is not there is counted and changes nothing.
#[test]
fn ghosts_take_their_updates_and_those_around_choose_again() {
    const ROUND: u32 = 1;
    const NEAR2: u32 = 100 * 100;
    let world = World::plain();
    // Of ghosts in the one layer of cells around some are two links away.
    let local = Local { depth: 2, ..Local::new(&world) };
    let grid = world.cells();
    let mut stream = Stream::new(53);
    let (particles, flights_now) = (world.particles(&mut stream, COUNT, 400.0), flights(&mut stream));
    let (cells, starts) = crowd(&local, &mut stream);
    let mut anywhere = |cell: [u32; 3]| cell.map(|c| (c << grid.bits) + (stream.word() >> (32 - grid.bits)));
    let midpoints: Vec<[u32; 3]> = cells.iter().map(|&cell| anywhere(cell)).collect();
    let layers: Vec<u32> = cells
        .iter()
        .map(|&cell| if local.own.holds(cell) { SHARED } else { SHARED | NEAR | (1 + stream.below(2)) })
        .collect();
    let layer = |s: usize| layers[s] & 0xff;
    let some = |stream: &mut Stream| (0..stream.below(2 * DIRECT as u32)).map(|_| stream.below(COUNT as u32)).collect();
    let lists: Vec<Vec<u32>> = (0..COUNT).map(|_| some(&mut stream)).collect();
    let told: Vec<usize> = (0..COUNT).filter(|&s| layer(s) > 0 && stream.below(100) == 0).collect();
    let (others, other_flights) = (world.particles(&mut stream, COUNT, 300.0), flights(&mut stream));
    let update = |s: usize, particle: GpuParticle, flight: GpuFlight| GpuUpdate {
        particle: GpuParticle { tag: particles[s].tag, ..particle },
        flight,
        cell: local.index(cells[s]),
        ..GpuUpdate::default()
    };
    let mut updates: Vec<GpuUpdate> = told.iter().map(|&s| update(s, others[s], other_flights[s])).collect();
    // Two of nobody: an id that is not there, and one that is in another cell.
    let unknown = GpuParticle { tag: GpuParticle::tag(0, 3_000_000), ..others[0] };
    updates.push(GpuUpdate { particle: unknown, ..updates[0] });
    let elsewhere = (0..COUNT).find(|&s| cells[s] != cells[told[0]]).unwrap();
    updates.push(GpuUpdate { particle: particles[elsewhere], ..updates[0] });
    stream.shuffle(&mut updates);
    // The first entry says how many follow; what lies beyond is of an earlier message.
    updates.insert(0, GpuUpdate { cell: updates.len() as u32, ..GpuUpdate::default() });
    updates.push(GpuUpdate { particle: unknown, ..GpuUpdate::default() });
    // Some choose in the next round as it is.
    let listed_already: Vec<bool> = (0..COUNT).map(|_| stream.below(2) == 1).collect();
    let chooses = |s: usize| CHOOSES << ROUND | if listed_already[s] { CHOOSES << (ROUND + 1) } else { 0 };
    let marks: Vec<u32> = (0..COUNT).map(|s| layers[s] | chooses(s)).collect();
    // Where the outermost ghosts that choose wait until they are asked, none has a list. Else those farther out, who do not choose, list who
    // has them in theirs, as far as that is short.
    for (variant, ghosts) in variants().into_iter().flat_map(|variant| [(variant, 0), (variant, 1)]) {
        let mut rig = Rig::new(&world);
        rig.variant = variant;
        rig.put("sorted", &particles);
        put_flights(&mut rig, &flights_now);
        rig.put("midpoints", &midpoints.iter().map(|&p| grid.packed(p)).collect::<Vec<_>>());
        rig.put("marks", &marks);
        put_lists(&mut rig, &lists);
        rig.put("cell_start", &starts);
        rig.put("updates_in", &updates);
        rig.put("rechoose", &vec![0u32; COUNT + 64 * LIST_SHARDS]);
        rig.put("peers", &local.peers());
        rig.step(GpuStep { count: COUNT as u32, round: ROUND, ghosts, near2: NEAR2, ..local.step() });
        rig.run("receive", updates.len());
        assert_eq!(rig.counter(MISSING), 2);
        let (mut after, mut flights_after) = (particles.clone(), flights_now.clone());
        for &s in &told {
            after[s] = GpuParticle { tag: particles[s].tag, ..others[s] };
            flights_after[s] = other_flights[s];
        }
        assert_eq!(rig.get::<GpuParticle>("sorted", COUNT), after);
        assert_eq!(neighbour_lists::flights(&rig, COUNT), flights_after);
        let beside = |a: [u32; 3], b: [u32; 3]| (0..3).all(|k| a[k].abs_diff(b[k]) <= 1);
        let has_it = |s: usize, ghost: usize| {
            if s == ghost {
                true
            } else if ghosts == 0 && (layer(ghost) == 1 || lists[ghost].len() <= DIRECT) {
                lists[ghost].contains(&(s as u32))
            } else {
                let near = grid.packed_near(midpoints[s], midpoints[ghost], NEAR2);
                beside(cells[s], cells[ghost]) && near
            }
        };
        let again: Vec<u32> = (0..COUNT)
            .filter(|&s| layer(s) < local.depth && !listed_already[s])
            .filter(|&s| told.iter().any(|&ghost| has_it(s, ghost)))
            .map(|s| s as u32)
            .collect();
        assert_eq!(
            (rig.choosers(ROUND as usize + 1, COUNT), rig.counter(MISPLACED)),
            (again.clone(), 0),
            "{variant:?}"
        );
        // The check can fail: there are updates of both kinds, and particles that nothing near concerns.
        let open = listed_already.iter().filter(|&&listed| !listed).count();
        assert!(told.len() > 5 && again.len() > told.len() && again.len() < open - 50, "{} of {open}", again.len());
        assert!([1, 2].iter().all(|&away| told.iter().any(|&ghost| layer(ghost) == away)));
    }
}
