//! What a step leaves for the one that follows: particles counted in their cells where they fly.

use corpuscle::gpu::KernelVariant;
use corpuscle::subdomain::{GpuFlight, GpuGas, GpuNewborn, GpuStep};

use crate::fly::DT;
use crate::neighbour_lists::put_flights;
use crate::oracle::random::Stream;
use crate::rig::*;

pub const COUNT: usize = 1500;
const BORN: usize = 40;
/// Newborns that find no room.
const LATE: usize = 15;
pub const SLOTS: usize = COUNT + BORN;

/// A step of a device alone, before `advect`: some meet walls, the last slots are of nobody, and others enter in the step that follows.
pub fn flying(world: &World, rounds: bool, variant: KernelVariant) -> (Rig, GpuStep) {
    let mut stream = Stream::new(61);
    let particles = world.particles(&mut stream, COUNT, 500.0);
    let born: Vec<GpuNewborn> = world
        .particles(&mut stream, BORN + 3, 400.0)
        .into_iter()
        .map(|particle| GpuNewborn { particle, ..GpuNewborn::default() })
        .collect();
    let mut rig = Rig::new(world);
    rig.variant = variant;
    rig.constant("COLLISIONS", 1.0);
    rig.constant("ROUNDS_OF_PAIRS", f64::from(u8::from(rounds)));
    rig.constant("FLOWN", if rounds { 0.5 } else { 0.0 });
    rig.gases(&[GpuGas { mass: 1.0, ..GpuGas::default() }; 2]);
    rig.put("sorted", &particles);
    let flights: Vec<GpuFlight> = free_flights(COUNT)
        .into_iter()
        .zip(&particles)
        .map(|(flight, particle)| GpuFlight {
            wall: if world.may_hit(particle, 0.0, DT) { 0.0 } else { NEVER },
            ..flight
        })
        .collect();
    put_flights(&mut rig, &flights);
    rig.put_records(|records, _| records.resize(SLOTS, [7; RECORD]));
    rig.put("marks", &[NEAR; COUNT]);
    rig.put("newborns", &born);
    rig.put("bouncing", &[0u32; COUNT]);
    rig.put("surface_sums", &[0u32; 64]);
    rig.put("bins", &[[7u32; 2]; SLOTS]);
    rig.put("cell_counts", &vec![0u32; world.grid.cell_count()]);
    rig.set_step_state(PRESENT, COUNT as u32 - 30);
    let step = GpuStep {
        count: COUNT as u32,
        dt: DT,
        newborn_offset: 3,
        newborn_first_id: 600_000,
        capacity: (SLOTS - LATE) as u32,
        next_newborns: BORN as u32,
        ..GpuStep::default()
    };
    rig.step(step);
    rig.set_step_state(INTERVAL_STEPS, 2);
    (rig, step)
}

/// `advect` and `bounce` count as `bin` would in the step that follows: the same cells, in which each has a place of its own.
#[test]
fn particles_are_counted_where_they_fly_as_bin_counts_them() {
    let world = World::plain();
    let cells = world.grid.cell_count();
    for (variant, rounds) in variants().into_iter().flat_map(|variant| [(variant, true), (variant, false)]) {
        let (mut rig, step) = flying(&world, rounds, variant);
        rig.run("advect", SLOTS);
        let hits = rig.counter(LIST_BOUNCE) as usize;
        rig.run("bounce", hits);
        assert_eq!(rig.counter(CAPACITY_FAILED) as usize, LATE);
        let (counts, bins): (Vec<u32>, Vec<[u32; 2]>) = (rig.get("cell_counts", cells), rig.get("bins", SLOTS));
        let flown: Vec<u32> = rig.get("particles", 8 * SLOTS);
        // The step that follows, without that.
        rig.put("cell_counts", &vec![0u32; cells]);
        rig.put("bins", &[[7u32; 2]; SLOTS]);
        rig.step(GpuStep { newborns: BORN as u32, next_newborns: 0, slot: 1, ..step });
        rig.run("bin", SLOTS);
        let (counted, binned): (Vec<u32>, Vec<[u32; 2]>) = (rig.get("cell_counts", cells), rig.get("bins", SLOTS));
        assert_eq!(counts, counted, "{variant:?} {rounds}");
        let cell_of = |bins: &[[u32; 2]]| bins.iter().map(|bin| bin[0]).collect::<Vec<_>>();
        assert_eq!(cell_of(&bins), cell_of(&binned));
        assert!(rig.get::<u32>("particles", 8 * SLOTS) == flown, "newborns are there already");
        let mut places: Vec<[u32; 2]> = bins.iter().copied().filter(|bin| bin[0] != NOBODY).collect();
        places.sort_unstable();
        let expected = |cell: usize| (0..counts[cell]).map(move |place| [cell as u32, place]);
        assert_eq!(places, (0..cells).flat_map(expected).collect::<Vec<_>>());
        // The check can fail: all but those of nobody and without room are counted, and some have bounced.
        assert_eq!(places.len(), SLOTS - 30 - LATE);
        assert!(hits > 50 && hits < COUNT - 100, "{hits}");
        // In the last step of an interval nobody is.
        let (mut rig, step) = flying(&world, rounds, variant);
        rig.step(GpuStep { next_newborns: 0, ..step });
        rig.set_step_state(INTERVAL_STEPS, 1);
        rig.run("advect", SLOTS);
        rig.run("bounce", hits);
        assert_eq!(rig.get::<[u32; 2]>("bins", SLOTS), [[7; 2]; SLOTS]);
        assert_eq!(rig.get::<u32>("cell_counts", cells), vec![0; cells]);
    }
}

/// On a device that is stalled nobody is counted, and nobody enters.
#[test]
fn nobody_is_counted_on_a_stalled_device() {
    let world = World::plain();
    let (rig, _) = flying(&world, true, device().variant());
    rig.set_stalled(STALLED, 1);
    let before: Vec<u32> = rig.get("particles", 8 * SLOTS);
    rig.run("advect", SLOTS);
    assert!(rig.get::<[u32; 2]>("bins", SLOTS).iter().all(|bin| bin[0] == NOBODY));
    assert_eq!(rig.get::<u32>("cell_counts", world.grid.cell_count()), vec![0; world.grid.cell_count()]);
    assert!(rig.get::<u32>("particles", 8 * SLOTS) == before);
}
