//! `reset`, newborns and `lost`: exactly.

use corpuscle::gpu::KernelVariant;
use corpuscle::subdomain::{GpuNewborn, GpuParticle, GpuStep};

use crate::oracle::random::Stream;
use crate::rig::*;

/// `reset` empties the lists and their dispatches, and the sums of stretches as far as it has threads for, and touches no other counter.
#[test]
fn reset_empties_every_list_and_nothing_else() {
    for variant in variants() {
        reset_empties_every_list_in(variant);
    }
}

fn reset_empties_every_list_in(variant: KernelVariant) {
    let mut rig = Rig::new(&World::plain());
    rig.variant = variant;
    let mut stream = Stream::new(1);
    let noise: Vec<u32> = (0..COUNTER_WORDS).map(|_| stream.word() | 1).collect();
    rig.put("counters", &noise);
    rig.put("dispatches", &noise);
    rig.put("rechoose_dispatches", &noise);
    rig.put("on_demand_dispatches", &noise);
    let sums: Vec<u32> = (0..200).map(|_| stream.word() | 1).collect();
    rig.put("stretch_sums", &sums);
    rig.run_groups("reset", [2, 1, 1]);
    let left: Vec<u32> = rig.get("stretch_sums", sums.len());
    assert_eq!(left[..128], [0; 128]);
    // The check can fail: there were more.
    assert_eq!(left[128..], sums[128..]);
    // Folded into two dimensions, and more threads than there are stretches.
    rig.run_groups("reset", [2, 4, 1]);
    assert_eq!(rig.get::<u32>("stretch_sums", sums.len()), vec![0; sums.len()]);
    let counters: Vec<u32> = rig.get("counters", COUNTER_WORDS);
    // The check can fail: what is not the length of a list keeps its noise.
    for (word, (&found, &noise)) in counters.iter().zip(&noise).enumerate() {
        assert_eq!(found, if word < LISTS || is_of_shard(variant, word) { 0 } else { noise }, "{variant:?} {word}");
    }
    let empty = [[0u32, 1, 1]; LISTS];
    assert_eq!(rig.get::<[u32; 3]>("dispatches", LISTS), empty);
    assert_eq!(rig.get::<[u32; 3]>("rechoose_dispatches", LISTS), empty);
    assert_eq!(rig.get::<[u32; 3]>("on_demand_dispatches", LISTS), empty);
}

/// `bin`, and without collisions `advect`, puts the newborns of this step behind the particles; those without room are counted.
#[test]
fn newborns_come_behind_the_particles_and_those_without_room_are_counted() {
    let world = World::plain();
    let mut stream = Stream::new(2);
    let before = world.particles(&mut stream, 300, 400.0);
    let born: Vec<GpuNewborn> = world
        .particles(&mut stream, 500, 400.0)
        .into_iter()
        .map(|particle| GpuNewborn { particle, start: stream.uniform() as f32, pad: [0; 3] })
        .collect();
    for (kernel, room) in [("bin", 900usize), ("bin", 412), ("advect", 900), ("advect", 412)] {
        let mut rig = Rig::new(&world);
        let mut slots = before.clone();
        // (Behind them are the tails of neighbour lists.)
        slots.resize(room + 7, GpuParticle::default());
        rig.put("particles", &slots);
        rig.put("newborns", &born);
        rig.put("sorted", &[GpuParticle::default(); 2]);
        rig.put("bouncing", &[0u32; 900]);
        rig.put("bins", &[[7u32; 2]; 900]);
        rig.put("cell_counts", &vec![0u32; world.grid.cell_count()]);
        rig.constant("COLLISIONS", 0.0);
        rig.constant("ROUNDS_OF_PAIRS", 0.0);
        let capacity = room as u32;
        // Nobody moves, so that it is where it was.
        let newborn_first_id = u32::MAX / 2;
        rig.step(GpuStep {
            count: 300,
            newborns: 200,
            newborn_offset: 77,
            newborn_first_id,
            capacity,
            ..GpuStep::default()
        });
        rig.run(kernel, 500);
        let found = 200.min(room - 300);
        for (slot, born) in slots[300..300 + found].iter_mut().zip(&born[77..]) {
            *slot = born.particle;
        }
        assert!(rig.get::<GpuParticle>("particles", room + 7) == slots, "{kernel}, {room}");
        // The check can fail: of the two rooms the smaller one does.
        assert_eq!(rig.counter(CAPACITY_FAILED), 200 - found as u32);
        if kernel == "bin" {
            let binned: Vec<[u32; 2]> = rig.get("bins", 500);
            assert!(binned.iter().enumerate().all(|(k, bin)| (bin[0] == NOBODY) == (k >= 300 + found)));
        }
    }
}

/// `lost` adds the pairs of the extra round, and the collisions of all others, less those that another device
/// counts, to the sums.
#[test]
fn lost_adds_the_extra_round_to_the_sample() {
    let mut stream = Stream::new(3);
    let mut words: Vec<u32> = (0..COUNTER_WORDS).map(|_| stream.below(1 << 20)).collect();
    words[FOREIGN] = words[0] / 2;
    for rounds in [1, 3, 8] {
        let mut rig = Rig::new(&World::plain());
        rig.put("counters", &words);
        rig.constant("ROUNDS", rounds as f64);
        rig.run_groups("lost", [1, 1, 1]);
        let mut expected = words.clone();
        expected[LOST] += words[rounds];
        expected[SAMPLED] += words[..rounds].iter().sum::<u32>() - words[FOREIGN];
        let found: Vec<u32> = rig.get("counters", COUNTER_WORDS);
        assert_eq!(found, expected);
        assert_ne!(found, words, "the check can fail");
    }
}
