//! `neighbours` and `complete_lists` against a search of all pairs: exactly.

use std::collections::BTreeSet;

use corpuscle::subdomain::{FULL_SHARE, GpuFlight, GpuNewborn, GpuParticle, GpuStep};

use crate::choose::DT;
use crate::crowd::{COUNT, crowd, crowd_at, flying, may_meet_a_wall};
use crate::neighbour_lists::{DIRECT, TAILS, complete_lists, flights, put_flights, put_room, tails_of, to_complete_of};
use crate::oracle::random::Stream;
use crate::oracle::walls::parted;
use crate::rig::*;

/// The search begins the flights, those of newborns at their entry; where diameters are capped they have begun before.
#[test]
fn flights_begin_with_the_search() {
    let mut crowd = crowd(18);
    let mut stream = Stream::new(19);
    let entries: Vec<GpuNewborn> =
        (0..40).map(|_| GpuNewborn { start: 1e-6 * stream.uniform() as f32, ..GpuNewborn::default() }).collect();
    // Every tenth has entered in this step.
    let id = |s: usize| if s.is_multiple_of(10) { 5000 + s as u32 / 10 % 30 } else { s as u32 };
    let tagged = |s| GpuParticle { tag: GpuParticle::tag(2, id(s)), ..GpuParticle::default() };
    crowd.rig.put("sorted", &(0..COUNT).map(tagged).collect::<Vec<_>>());
    crowd.rig.put("newborns", &entries);
    let before = GpuFlight { start: 3.0, wall: 4.0, partner: 5, collisions: FULL_SHARE << 16 | 6 };
    for capped in [false, true] {
        put_flights(&mut crowd.rig, &[before; COUNT]);
        crowd.rig.constant("CAPPED", f64::from(u8::from(capped)));
        for name in ["neighbour_count", "marks"] {
            crowd.rig.put(name, &vec![0u32; COUNT]);
        }
        put_room(&mut crowd.rig, COUNT, TAILS);
        crowd.rig.put("rechoose", &vec![NOBODY; COUNT + 64 * LIST_SHARDS]);
        let count = COUNT as u32;
        let (newborn_offset, newborn_first_id) = (7, 5000);
        crowd.rig.step(GpuStep {
            count,
            total: count,
            newborns: 30,
            newborn_offset,
            newborn_first_id,
            ..GpuStep::default()
        });
        crowd.rig.run("neighbours", COUNT);
        for (s, &flight) in flights(&crowd.rig, COUNT).iter().enumerate() {
            let start = match id(s).checked_sub(5000) {
                Some(k) => entries[7 + k as usize].start,
                None => 0.0,
            };
            let begun = GpuFlight { start, wall: NEVER, partner: NOBODY, collisions: 0 };
            assert_eq!(flight, if capped { before } else { begun }, "{s}");
        }
    }
}

/// Each list is the set that a search of all pairs finds by the packed rule, and holds every other particle
/// nearer than the edge of a cell.
#[test]
fn lists_are_those_of_a_search_of_all_pairs_and_miss_nobody_near() {
    all_are_found(true);
}

/// The same by the kernels of a device that has no others, which ask less.
#[test]
fn lists_of_a_device_alone_are_those_of_a_search_of_all_pairs() {
    all_are_found(false);
}

fn all_are_found(among_others: bool) {
    let mut crowd = crowd(12);
    crowd.rig.constant("HALO", f64::from(u8::from(among_others)));
    let lists = crowd.run();
    let expected = crowd.all_pairs();
    let cells = crowd.world.cells();
    let mut beyond = 0;
    for (s, list) in lists.iter().enumerate() {
        let set: BTreeSet<u32> = list.iter().copied().collect();
        assert_eq!(set.len(), list.len(), "each once");
        assert_eq!(set, expected[s], "particle {s}");
        for j in (0..COUNT).filter(|&j| j != s) {
            let near = cells.nearer_than_a_cell(crowd.midpoints[s], crowd.midpoints[j]);
            assert!(!near || set.contains(&(j as u32)), "{s} misses {j}");
            beyond += usize::from(!near && set.contains(&(j as u32)));
        }
    }
    assert_eq!(crowd.rig.counter(TAILS_WANTED), 0);
    // Both kinds of lists, and room is taken for the long ones alone.
    let lengths = || expected.iter().map(BTreeSet::len);
    assert!(lengths().any(|length| length > DIRECT) && lengths().any(|length| length <= DIRECT));
    assert_eq!(crowd.rig.counter(LIST_TAILS) as usize, tails_of(lengths()));
    // Those that may meet a wall, whose lists are long, or with a neighbour, of which one or they themselves are near a wall: each once.
    let near_wall = |s: u32| crowd.world.class(cells.index(cells.cell(crowd.midpoints[s as usize]))) != CLEAR;
    let to_screen = |s: &u32| {
        let list = &expected[*s as usize];
        !list.is_empty() && (near_wall(*s) || list.iter().any(|&j| near_wall(j)))
    };
    let long = |s: &u32| expected[*s as usize].len() > DIRECT;
    let incomplete: Vec<u32> =
        (0..COUNT as u32).filter(|s| may_meet_a_wall(*s as usize) || to_screen(s) || long(s)).collect();
    assert_eq!(to_complete_of(&crowd.rig), incomplete);
    assert!(incomplete.len() < COUNT, "some are short and clear of walls");
    assert!(incomplete.iter().any(|s| !long(s)) && incomplete.iter().any(|s| !to_screen(s)));
    assert!(crowd.rig.get::<u32>("marks", COUNT).iter().all(|mark| mark & (UNSCREENED | LONG) == 0));
    // The check can fail: the packed rule is wider than the edge of a cell, but by few pairs.
    let total: usize = lists.iter().map(Vec::len).sum();
    assert!(beyond > 0 && beyond < total / 10, "{beyond} of {total}");
}

/// In shorter steps lists are shorter, down to those of particles in one place, and hold whom a search of all pairs finds.
#[test]
fn lists_of_shorter_steps_are_those_of_a_search_of_all_pairs() {
    let mut crowd = crowd(17);
    let mut before = usize::MAX;
    for near2 in [12_000, 6_000, 1_500, 40, 1] {
        let lists = crowd.run_near(TAILS, near2);
        let expected = crowd.pairs_near(near2);
        for (s, list) in lists.iter().enumerate() {
            assert_eq!(list.iter().copied().collect::<BTreeSet<u32>>(), expected[s], "particle {s}, {near2}");
        }
        let total: usize = lists.iter().map(Vec::len).sum();
        assert!(total < before && total > 0, "{near2}");
        before = total;
    }
}

/// Long lists get their tail and lose from it who stands behind a wall, by one thread; some are short then.
#[test]
fn tails_lose_exactly_those_behind_a_wall() {
    let world = crate::screen::parted_tank();
    let cells = world.cells();
    let mut stream = Stream::new(20);
    // At rest, so that flights start where the search looks.
    let mut particles = world.particles(&mut stream, COUNT, 0.0);
    particles.sort_by_key(|p| cells.index(cells.cell(p.position)));
    let midpoints: Vec<[u32; 3]> = particles.iter().map(|p| p.position).collect();
    let of = midpoints.iter().map(|&p| cells.index(cells.cell(p))).collect();
    let mut crowd = crowd_at(world, midpoints, of);
    crowd.rig.put("sorted", &particles);
    let found = crowd.run();
    let near_wall = |s: usize| crowd.world.class(cells.index(cells.cell(crowd.midpoints[s]))) != CLEAR;
    let place = |s: usize| crowd.world.metres(crowd.midpoints[s]);
    let slack = 4.0 * crowd.world.walls.tolerance;
    let (mut lost, mut shortened, mut long) = (0, 0, 0);
    for (s, (list, pairs)) in found.iter().zip(crowd.all_pairs()).enumerate() {
        let list: BTreeSet<u32> = list.iter().copied().collect();
        assert!(list.is_subset(&pairs), "particle {s}");
        for &j in &pairs {
            let other = j as usize;
            let tested = near_wall(s) || near_wall(other);
            match parted(&crowd.world.triangles, place(s), place(other), slack) {
                Some(true) if tested => assert!(!list.contains(&j), "{s} has {j}, behind a wall"),
                None if tested => {}
                _ => assert!(list.contains(&j), "{s} lacks {j}"),
            }
        }
        lost += pairs.len() - list.len();
        shortened += usize::from(pairs.len() > DIRECT && list.len() <= DIRECT);
        long += usize::from(list.len() > DIRECT && list.len() < pairs.len());
    }
    // The check can fail: many are behind the plate.
    assert!(lost > 100 && shortened > 0 && long > 50, "{lost} lost, {shortened} shortened, {long} long");
}

/// Where there is no room for all tails, some lists keep what is interleaved, and what all wanted is told.
#[test]
fn tails_without_room_are_reported_with_the_room_they_need() {
    let mut crowd = crowd(13);
    let expected = crowd.all_pairs();
    let wanted = tails_of(expected.iter().map(BTreeSet::len));
    let room = (wanted / 2).next_multiple_of(4);
    let found = crowd.run_near(room, CELL_NEAR2);
    assert_eq!(crowd.rig.counter(TAILS_WANTED) as usize, wanted);
    let mut cut = 0;
    for (list, expected) in found.iter().zip(&expected) {
        cut += usize::from(list.len() < expected.len());
        assert!(list.len() == expected.len() || list.len() == DIRECT && expected.len() > DIRECT);
        assert!(list.iter().all(|j| expected.contains(j)));
    }
    let long = expected.iter().filter(|list| list.len() > DIRECT).count();
    assert!(cut > 0 && cut < long, "{cut} of {long}");
    // A device alone stalls there, with all its particles; one among others is not.
    assert_eq!([STALLED, STALLED_PARTICLES].map(|word| crowd.rig.stalled(word) as usize), [1, COUNT]);
    for word in [STALLED, STALLED_PARTICLES] {
        crowd.rig.set_stalled(word, 0);
    }
    crowd.depth = 2;
    crowd.run_near(room, CELL_NEAR2);
    assert_eq!([STALLED, STALLED_PARTICLES].map(|word| crowd.rig.stalled(word)), [0, 0]);
    // With that room all have it.
    let found = crowd.run_near(wanted.next_multiple_of(4), CELL_NEAR2);
    assert!(found.iter().zip(&expected).all(|(list, expected)| list.len() == expected.len()));
}

/// Slots behind those of the last cell, which hold nobody, neither look for anybody nor are found.
#[test]
fn slots_behind_the_last_cell_hold_nobody() {
    let mut crowd = crowd(18);
    let held = COUNT - 70;
    let cells = crowd.world.cells();
    let mut of: Vec<u32> = crowd.midpoints.iter().map(|&p| cells.index(cells.cell(p))).collect();
    let start: Vec<u32> =
        (0..=cells.count() as u32).map(|c| of[..held].partition_point(|&own| own < c) as u32).collect();
    crowd.rig.put("cell_start", &start);
    // As memory is at first.
    of[held..].fill(0);
    crowd.rig.put("cells", &of);
    let found = crowd.run();
    for (s, expected) in crowd.all_pairs().iter().enumerate() {
        let expected: BTreeSet<u32> = expected.iter().copied().filter(|&j| s < held && (j as usize) < held).collect();
        assert_eq!(found[s].iter().copied().collect::<BTreeSet<u32>>(), expected, "particle {s}");
    }
}

/// The outermost ghosts, whose neighbours are not all here, list those of them alone who choose, as far as there is room without a tail, and nobody where ghosts
/// wait until they are asked; those farther out list nobody. The lists of all others are as ever.
#[test]
fn the_outermost_ghosts_list_those_alone_who_choose() {
    let mut crowd = crowd(14);
    let pairs = crowd.all_pairs();
    let layers: Vec<u32> = (0..COUNT as u32).map(|s| (s % 4) | if s % 3 == 0 { SHARED | LISTED } else { 0 }).collect();
    let layer = |s: usize| layers[s] & 0xff;
    // All choose, or the outermost of those who would wait.
    for (depth, ghosts) in [(2, 0), (3, 0), (2, 1), (0, 0)] {
        put_room(&mut crowd.rig, COUNT, TAILS);
        crowd.rig.put("neighbour_count", &vec![0u32; COUNT]);
        crowd.rig.put("marks", &layers);
        crowd.rig.put("rechoose", &vec![NOBODY; COUNT + 64 * LIST_SHARDS]);
        let grid = crowd.world.grid.cells;
        crowd.rig.step(GpuStep {
            count: COUNT as u32,
            depth,
            ghosts,
            size: grid,
            bins: grid.iter().product(),
            ..GpuStep::default()
        });
        crowd.rig.run("neighbours", COUNT);
        let marks: Vec<u32> = crowd.rig.get("marks", COUNT);
        let long = marks.iter().filter(|&mark| mark & LONG != 0).count();
        complete_lists(&crowd.rig, LIST_INCOMPLETE);
        let counts: Vec<u32> = crowd.rig.get("neighbour_count", COUNT);
        let records: Vec<[u32; RECORD]> = crowd.rig.get("neighbours", COUNT);
        let (mut noted, mut cut, mut longer) = (0, 0, 0);
        for (s, pairs) in pairs.iter().enumerate() {
            if depth == 0 || layer(s) + ghosts < depth {
                assert_eq!(counts[s] as usize, pairs.len(), "{s}, depth {depth}");
                longer += usize::from(pairs.len() > DIRECT);
                continue;
            }
            let choosers: BTreeSet<u32> = pairs.iter().copied().filter(|&j| layer(j as usize) < depth).collect();
            let expected = if ghosts == 0 && layer(s) == depth { choosers } else { BTreeSet::new() };
            assert_eq!(counts[s] as usize, expected.len(), "{s}, depth {depth}");
            let kept = expected.len().min(DIRECT);
            let found: BTreeSet<u32> = records[s][RECORD - DIRECT..][..kept].iter().copied().collect();
            assert!(found.len() == kept && found.is_subset(&expected), "{s}, depth {depth}");
            noted += usize::from(kept > 0);
            cut += usize::from(expected.len() > DIRECT);
        }
        // No room is made for what is cut; and who does not choose is on no list of those who do.
        assert_eq!(long, longer, "depth {depth}");
        let first = crowd.rig.choosers(0, COUNT);
        assert!(depth == 0 || first.iter().all(|&s| layer(s as usize) < depth));
        assert!(if depth > 0 && ghosts == 0 { noted > 100 && cut > 10 } else { noted == 0 }, "{noted}, {cut}");
    }
}

/// Where the diameter is capped lists are shorter by what the smaller diameter of a pair lacks, hold either of a pair or
/// neither, and miss nobody whom a pair of that diameter can meet.
#[test]
fn lists_of_capped_particles_are_shorter_and_miss_nobody_near() {
    let mut crowd = crowd(15);
    let mut stream = Stream::new(16);
    // The diameter is .9 of a cell's edge.
    let whole = (16384.0 * 0.9f64 * 0.9).floor();
    let shares: Vec<u32> =
        (0..COUNT).map(|s| if s % 3 == 0 { FULL_SHARE } else { 1 + stream.below(FULL_SHARE) }).collect();
    let flights: Vec<GpuFlight> =
        shares.iter().map(|&share| GpuFlight { collisions: share << 16, ..free_flights(1)[0] }).collect();
    put_flights(&mut crowd.rig, &flights);
    crowd.rig.constant("CAPPED", 1.0);
    crowd.rig.constant("DIAMETER2_PACKED", whole);
    let lists: Vec<BTreeSet<u32>> = crowd.run().into_iter().map(|list| list.into_iter().collect()).collect();
    let uncapped = crowd.all_pairs();
    let edge = crowd.world.grid.cell;
    let (mut near, mut shorter) = (0, 0);
    for (s, list) in lists.iter().enumerate() {
        assert!(list.is_subset(&uncapped[s]));
        shorter += usize::from(list.len() < uncapped[s].len());
        for &j in &uncapped[s] {
            let other = j as usize;
            assert_eq!(list.contains(&j), lists[other].contains(&(s as u32)), "{s} and {j}");
            if shares[s] == FULL_SHARE && shares[other] == FULL_SHARE {
                assert!(list.contains(&j));
            }
            // sigma^2 + (g dt/2)^2, of which the second is what the edge leaves to the largest diameter.
            let share = f64::from(shares[s].min(shares[other])) / f64::from(FULL_SHARE);
            let reach2 = edge * edge * (1.0 - whole / 16384.0 * (1.0 - share));
            let place = |k: usize| crowd.world.metres(crowd.midpoints[k]);
            let (p, q) = (place(s), place(other));
            let distance2: f64 = (0..3).map(|k| (p[k] - q[k]).powi(2)).sum();
            assert!(distance2 >= reach2 || list.contains(&j), "{s} misses {j}");
            near += usize::from(distance2 < reach2);
        }
    }
    let total: usize = lists.iter().map(BTreeSet::len).sum();
    assert!(shorter > COUNT / 3 && near > 9 * total / 10, "{shorter} shorter, {near} of {total} near");
}

/// Those that choose, and whom they choose, are the same in every variant of the kernels, in gas where a thread finds few and where it finds
/// more than it keeps; the dispatch covers the list.
#[test]
fn those_that_choose_are_the_same_in_every_form() {
    for near in [1.0, 0.7] {
        let mut particles = World::plain().particles(&mut Stream::new(20), COUNT, 400.0);
        let middle = particles[0].position;
        for particle in &mut particles {
            for (x, middle) in particle.position.iter_mut().zip(middle) {
                *x = middle.wrapping_add_signed((near * f64::from(x.wrapping_sub(middle) as i32)) as i32);
            }
        }
        let mut crowd = flying(particles, DT);
        let mut of_first = None;
        for variant in device().adapter().variants() {
            crowd.rig.variant = variant;
            crowd.rig.put("rechoose_dispatches", &[0u32; 3 * LISTS]);
            crowd.run();
            // Else whom a list has is a matter of the order of the threads.
            assert_eq!(crowd.rig.counter(TAILS_WANTED), 0, "there is room for all lists");
            let [groups, y, _] = crowd.rig.get::<[u32; 3]>("rechoose_dispatches", LIST_RECHOOSE + 1)[LIST_RECHOOSE];
            let choosers = crowd.rig.choosers(0, COUNT);
            let places = crowd.rig.sharded(LIST_RECHOOSE, COUNT);
            assert!(places.iter().all(|place| place / 64 < groups as usize), "the dispatch covers the list");
            assert!(choosers.len() > COUNT / 10 && (near < 1.0 || choosers.len() < COUNT), "{}", choosers.len());
            // A thread keeps four of those it finds, which are half of its list, until it enters them.
            let longest = crowd.rig.get::<u32>("neighbour_count", COUNT).into_iter().max().unwrap_or(0);
            assert!(near > 0.9 || longest > 16, "{longest}");
            assert!((groups as usize) < choosers.len() / 64 + 2 * LIST_SHARDS && y == 1, "{groups} {y}");
            crowd.rig.run_groups("choose", [groups, 1, 1]);
            let choices: Vec<[u32; 2]> = crowd.rig.get("choices", COUNT);
            let chosen: Vec<[u32; 2]> = choosers.iter().map(|&s| choices[s as usize]).collect();
            assert!(chosen.iter().filter(|choice| choice[0] != NOBODY).count() > 20);
            // (A GPU may round otherwise in each variant, and so let others pass who choose nobody.)
            let on_cpu = device().adapter().is_cpu();
            let partners = choosers
                .into_iter()
                .zip(chosen)
                .map(|(s, [partner, time])| [s, partner, if on_cpu { time } else { 0 }]);
            let found: Vec<[u32; 3]> = partners.filter(|[_, partner, _]| on_cpu || *partner != NOBODY).collect();
            assert!(of_first.get_or_insert_with(|| found.clone()) == &found, "{variant:?}");
        }
    }
}

/// The sieve before the choices keeps back nobody who has anybody to choose, of point particles and of rigid spheres, in steps
/// from short to long, and most of those who have not.
#[test]
fn those_kept_from_choosing_have_nobody_to_choose() {
    let mut stream = Stream::new(19);
    let world = World::plain();
    for (dt, rigid, wind) in [
        (1e-6, false, 0.0),
        (DT, false, 0.0),
        (1e-6, true, 0.0),
        (DT, true, 0.0),
        (1e-6, false, 9000.0),
        (DT, false, 9000.0),
    ] {
        let mut particles = world.particles(&mut stream, COUNT, 400.0);
        // With a wind of cells in a step, beyond the border too.
        particles.iter_mut().for_each(|p| p.velocity[0] += wind);
        // Two that fly together.
        particles[1] = GpuParticle { tag: particles[1].tag, ..particles[0] };
        let mut crowd = flying(particles, dt);
        crowd.rig.constant("RIGID", f64::from(u8::from(rigid)));
        crowd.run();
        let choosers = crowd.rig.choosers(0, COUNT);
        // Now all.
        crowd.rig.put("rechoose", &(0..COUNT as u32).collect::<Vec<_>>());
        crowd.rig.set_choosers(0, COUNT);
        crowd.rig.run("choose", COUNT);
        let choices: Vec<[u32; 2]> = crowd.rig.get("choices", COUNT);
        let choose = |s: &u32| choices[*s as usize][0] != NOBODY;
        let missed: Vec<u32> =
            (0..COUNT as u32).filter(choose).filter(|s| choosers.binary_search(s).is_err()).collect();
        assert!(missed.is_empty(), "dt {dt}, rigid {rigid}: {missed:?}");
        let chosen = (0..COUNT as u32).filter(choose).count();
        println!("dt {dt}, rigid {rigid}: {chosen} of {} that may, of {COUNT}", choosers.len());
        assert!(chosen > 20 && choosers.len() < 3 * chosen + COUNT / 20, "{chosen} of {}", choosers.len());
    }
}
