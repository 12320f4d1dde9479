//! A device that is stalled, as its neighbour lists had too little room: what is left as it is, and `recall`.

use corpuscle::subdomain::{GpuGas, GpuNewborn, GpuParticle, GpuStep, GpuZone};

use crate::neighbour_lists::put_flights;
use crate::oracle::random::Stream;
use crate::rig::*;

const COUNT: usize = 300;
const LEVELS: usize = 4;

/// Particles are back in their slots, but for those that entered in the step, which will again.
#[test]
fn recall_puts_back_all_but_those_that_entered() {
    let world = World::plain();
    let mut stream = Stream::new(91);
    let sorted = world.particles(&mut stream, COUNT, 300.0);
    let beyond = GpuParticle { velocity: [7.0; 3], ..GpuParticle::default() };
    // Ids are below 2 COUNT; every second id from `first` on is of one that entered here.
    let (first, newborns) = (COUNT as u32, COUNT as u32 / 2);
    let mut expected = sorted.clone();
    let entered = expected.iter_mut().filter(|particle| particle.id() >= first);
    let number = entered.map(|particle| particle.tag = NOBODY).count();
    assert!(number > 50 && number < COUNT - 50, "{number}");
    expected.resize(COUNT + 20, beyond);
    let mut rig = Rig::new(&world);
    rig.put("sorted", &sorted);
    rig.put("particles", &vec![beyond; COUNT + 20]);
    let (count, total) = (COUNT as u32, COUNT as u32);
    rig.step(GpuStep { count, total, newborns, newborn_first_id: first, stride: 2, ..GpuStep::default() });
    rig.run("recall", COUNT);
    assert!(rig.get::<GpuParticle>("particles", COUNT + 20) == expected);
}

/// What comes after the search of a step that was stalled changes nothing, and what does so otherwise can be told.
#[test]
fn a_stalled_device_changes_nothing() {
    let world = World::plain();
    let mut stream = Stream::new(92);
    let sorted = world.particles(&mut stream, COUNT, 300.0);
    let partners: Vec<[u32; 2]> = (0..COUNT as u32).map(|s| [s ^ 1, 5]).collect();
    let chosen: Vec<u32> = (0..COUNT as u32).collect();
    let mut rig = Rig::new(&world);
    for (name, value) in [
        ("ROUNDS", 2.0),
        ("CHAMBERS", 0.0),
        ("VELOCITY_SCALE", 65536.0),
        ("ENERGY_SCALE", 4096.0),
        ("BLOCKS", 1.0),
        ("TIME_STEP", 1e-5),
        ("LEVELS", LEVELS as f64),
        ("BLOCK_ENERGY_SCALE", 64.0),
    ] {
        rig.constant(name, value);
    }
    rig.gases(&[GpuGas { mass: 1.0, ..GpuGas::default() }; 2]);
    let nothing = vec![0u32; COUNT];
    rig.put("sorted", &sorted);
    rig.put("particles", &sorted);
    rig.set_step_state(PRESENT, COUNT as u32);
    rig.put("choices", &partners);
    rig.put("rechoose", &chosen);
    rig.put("pairs", &nothing);
    rig.put("bouncing", &nothing);
    rig.put("marks", &vec![CHOOSES; COUNT]);
    rig.put("zones", &[GpuZone::default()]);
    rig.step(GpuStep { count: COUNT as u32, dt: 1e-6, ..GpuStep::default() });
    rig.set_choosers(0, COUNT);
    // What each of them leaves: particles, pairs, sums and counters.
    let mut left_by = |kernel: &str, stalled: u32| {
        rig.put("zone_sums", &[0u32; 2 * ZONE_WORDS]);
        rig.put("block_sums", &[0u32; BLOCK_WORDS + LEVELS]);
        rig.set_stalled(STALLED, stalled);
        if kernel == "advect" {
            put_flights(&mut rig, &free_flights(COUNT));
        }
        match kernel {
            "tally" => rig.run_groups("tally", [1, 1, 1]),
            _ => rig.run(kernel, COUNT),
        }
        rig.set_stalled(STALLED, 0);
        let mut left: Vec<u32> = rig.get("zone_sums", 2 * ZONE_WORDS);
        left.extend(rig.get::<u32>("block_sums", BLOCK_WORDS + LEVELS));
        left.extend(rig.get::<u32>("particles", 8 * COUNT));
        left.extend(rig.get::<u32>("pairs", COUNT));
        left.extend(rig.get::<u32>("counters", COUNTER_WORDS));
        left
    };
    for kernel in ["match_pairs", "tally", "blocks", "advect"] {
        let before = left_by(kernel, 5);
        assert!(left_by(kernel, 1) == before, "{kernel} of a device that is stalled");
        assert!(left_by(kernel, 0) != before, "{kernel} does nothing at all");
    }
}

/// In the steps that follow nobody is in any cell, and nobody enters.
#[test]
fn the_steps_of_a_stalled_device_have_nobody() {
    let world = World::plain();
    let particles = world.particles(&mut Stream::new(93), COUNT, 300.0);
    let born = vec![GpuNewborn { particle: particles[1], ..GpuNewborn::default() }; 40];
    let mut rig = Rig::new(&world);
    rig.put("newborns", &born);
    let (count, newborns, capacity) = (COUNT as u32 - 40, 40, COUNT as u32);
    rig.step(GpuStep { count, newborns, capacity, ..GpuStep::default() });
    for stalled in [0, 1] {
        rig.put("particles", &particles);
        rig.put("bins", &[[7u32; 2]; COUNT]);
        rig.put("cell_counts", &vec![0u32; world.grid.cell_count()]);
        rig.set_stalled(STALLED, stalled);
        rig.run("bin", COUNT);
        let counted: u32 = rig.get::<u32>("cell_counts", world.grid.cell_count()).iter().sum();
        assert_eq!(counted, if stalled == 1 { 0 } else { COUNT as u32 });
        let bins: Vec<[u32; 2]> = rig.get("bins", COUNT);
        assert!(bins.iter().all(|bin| (bin[0] == NOBODY) == (stalled == 1)));
        assert_eq!(rig.get::<GpuParticle>("particles", COUNT) == particles, stalled == 1);
    }
}
