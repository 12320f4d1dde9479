//! Kernels that do in one what two do one after the other, of few particles.

use std::collections::BTreeSet;

use bytemuck::bytes_of;
use corpuscle::subdomain::{GpuParticle, GpuStep};

use crate::binned::{SLOTS, flying};
use crate::choose::Cloud;
use crate::oracle::random::Stream;
use crate::rig::*;
use crate::settle::{ROUND, meetings, parted_tank, prepared};

/// The same particles. (A GPU may round otherwise in another kernel, which counts where a pair hardly meets.)
fn assert_alike(name: &str, found: &[GpuParticle], expected: &[GpuParticle]) {
    let exactly = device().adapter().is_cpu();
    let speed = |particle: &GpuParticle| particle.velocity.map(f64::from).iter().map(|v| v * v).sum::<f64>().sqrt();
    let near = |found: &GpuParticle, expected: &GpuParticle| {
        let off = |k: usize| f64::from((found.velocity[k] - expected.velocity[k]).abs());
        found.tag == expected.tag && (0..3).all(|k| off(k) <= 1e-4 * speed(expected))
    };
    let alike = |(found, expected): &(&GpuParticle, &GpuParticle)| {
        bytes_of(*found) == bytes_of(*expected) || !exactly && near(found, expected)
    };
    let others = found.iter().zip(expected).filter(|pair| !alike(pair)).count();
    let most = if exactly { 0 } else { expected.len() / 100 };
    assert!(found.len() == expected.len() && others <= most, "{name}: {others} of {}", found.len());
}

/// `settle_chosen` collides those pairs that `match_pairs` would list, and does with them what `settle` does: also where a wall parts them, and among others.
#[test]
fn settling_those_that_chose_is_matching_and_settling() {
    for (variant, reach) in variants().into_iter().flat_map(|variant| [(variant, 0), (variant, 1)]) {
        let mut stream = Stream::new(71);
        let cloud = Cloud::new(&mut stream, parted_tank(), 1600, 0.9);
        let count = cloud.particles.len();
        let mutual = meetings(&cloud);
        // Of each pair one or both have just chosen, the others in the round before; and some of no pair.
        let mut chose: BTreeSet<usize> = (0..count).filter(|_| stream.below(8) == 0).collect();
        chose.extend(mutual.iter().flat_map(|&(i, j, _)| match stream.below(3) {
            0 => vec![i],
            1 => vec![j],
            _ => vec![i, j],
        }));
        let mut entries: Vec<u32> = chose.iter().map(|&s| s as u32).collect();
        stream.shuffle(&mut entries);
        // Own particles and ghosts of three layers.
        let layer: Vec<u32> = (0..count).map(|_| if reach > 0 { stream.below(4) } else { 0 }).collect();
        let marks = |s: usize| layer[s] | CHOOSES | if chose.contains(&s) { CHOOSES << ROUND } else { 0 };
        let layers: Vec<u32> = (0..count).map(marks).collect();
        let run = |merged: bool| {
            let mut rig = prepared(&cloud, &mutual, true, false);
            rig.variant = variant;
            rig.constant("ROUNDS", 3.0);
            rig.constant("MERGED", f64::from(u8::from(merged)));
            rig.put("marks", &layers);
            rig.put("pairs", &vec![[0u32; 2]; count / 2 + 64 * LIST_SHARDS]);
            rig.step(GpuStep { reach, depth: 4, ..cloud.step(ROUND) });
            rig.set_sharded(ROUND as usize, 0);
            // That of an odd round is in the second half where kernels are merged.
            let half = count + 64 * LIST_SHARDS;
            let mut list = vec![0u32; 2 * half];
            let at = if merged { half } else { 0 };
            list[at..at + entries.len()].copy_from_slice(&entries);
            rig.put("rechoose", &list);
            rig.set_choosers(ROUND as usize, entries.len());
            rig.set_choosers(ROUND as usize + 1, 0);
            if merged {
                rig.run("settle_chosen", entries.len());
            } else {
                rig.run("match_pairs", entries.len());
                rig.run("settle", count / 2 + 64 * LIST_SHARDS);
            }
            rig
        };
        let [split, merged] = [false, true].map(run);
        let name = format!("{variant:?}, reach {reach}");
        let state = |rig: &Rig| rig.get::<GpuParticle>("sorted", count);
        assert_alike(&name, &state(&merged), &state(&split));
        // (Whether a wall is met by the end of the step goes with the last digit.)
        let marks =
            |rig: &Rig| rig.get::<u32>("marks", count).iter().map(|mark| mark & !TURNED_TO_WALL).collect::<Vec<_>>();
        assert_eq!(marks(&merged), marks(&split), "{name}");
        let again = ROUND as usize + 1;
        assert_eq!(merged.choosers(again, count), split.choosers(again, count), "{name}");
        for counter in [ROUND as usize, COLLISIONS_LOW, BLOCKED, FOREIGN, FAST_PAIRS, MISPLACED, CUT_SHORT] {
            assert_eq!(merged.counter(counter), split.counter(counter), "{name}: {counter}");
        }
        // The check can fail: pairs collide, some are parted by the plate, and among others some are left, and some are counted, by them.
        let settled = merged.counter(COLLISIONS_LOW) as usize;
        assert!(settled > 50 && merged.counter(BLOCKED) > 0 && state(&merged) != cloud.particles, "{name}");
        assert_eq!(settled < mutual.len(), reach > 0, "{name}");
        assert_eq!(merged.counter(FOREIGN) > 0, reach > 0, "{name}");
    }
}

/// On a device that is stalled nobody collides.
#[test]
fn nobody_settles_on_a_stalled_device() {
    let cloud = Cloud::new(&mut Stream::new(72), World::plain(), 1600, 0.9);
    let mut rig = prepared(&cloud, &meetings(&cloud), false, false);
    let count = cloud.particles.len();
    rig.constant("MERGED", 1.0);
    rig.put("marks", &vec![CHOOSES << ROUND; count]);
    rig.put("rechoose", &[(0..count as u32).collect(), vec![0; 64 * LIST_SHARDS]].concat().repeat(2));
    rig.set_choosers(ROUND as usize, count);
    rig.set_stalled(STALLED, 1);
    rig.run("settle_chosen", count);
    assert_eq!(rig.get::<GpuParticle>("sorted", count), cloud.particles);
    rig.set_stalled(STALLED, 0);
    rig.run("settle_chosen", count);
    assert_ne!(rig.get::<GpuParticle>("sorted", count), cloud.particles);
}

/// `fly` does what `advect` and `bounce` do.
#[test]
fn flying_is_advecting_and_bouncing() {
    let world = World::plain();
    for (variant, rounds) in variants().into_iter().flat_map(|variant| [(variant, true), (variant, false)]) {
        let run = |merged: bool| {
            let (rig, _) = flying(&world, rounds, variant);
            if merged {
                rig.run("fly", SLOTS);
            } else {
                rig.run("advect", SLOTS);
                rig.run("bounce", SLOTS);
            }
            rig
        };
        let [split, merged] = [false, true].map(run);
        let name = format!("{variant:?}, rounds {rounds}");
        let state = |rig: &Rig| rig.get::<GpuParticle>("particles", SLOTS);
        assert_alike(&name, &state(&merged), &state(&split));
        if device().adapter().is_cpu() {
            let cells =
                |rig: &Rig| rig.get::<[u32; 2]>("bins", SLOTS).into_iter().map(|bin| bin[0]).collect::<Vec<_>>();
            assert_eq!(cells(&merged), cells(&split), "{name}");
            assert_eq!(merged.get::<u32>("surface_sums", 64), split.get::<u32>("surface_sums", 64), "{name}");
        }
        for counter in [BOUNCES, OUTSIDE, TRUNCATED, LIST_NEAR_WALLS, CAPACITY_FAILED, CUT_SHORT] {
            assert_eq!(merged.counter(counter), split.counter(counter), "{name}: {counter}");
        }
        // Who bounces is in no list.
        assert_eq!(merged.counter(LIST_BOUNCE), 0);
        assert!(merged.counter(BOUNCES) > 50 && split.counter(LIST_BOUNCE) > 50, "{name}");
    }
}
