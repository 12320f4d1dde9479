//! `tally`: sums over zones and gases, exactly. Velocities and spins are such that f32 loses nothing.

use corpuscle::subdomain::{GpuParticle, GpuStep, GpuZone};

use crate::oracle::random::Stream;
use crate::oracle::vector::{dot, minus, norm};
use crate::rig::*;

const COUNT: usize = 5000;
/// Three, so that a workgroup has two of them and another one.
const GASES: usize = 3;
/// Tally units per m/s and per (m/s)^2.
const VELOCITY_SCALE: f64 = 65536.0;
const ENERGY_SCALE: f64 = 4096.0;

fn zones(world: &World) -> Vec<GpuZone> {
    let middle = world.fixed(std::array::from_fn(|k| 0.5 * (world.low[k] + world.high[k])));
    let top = world.fixed(world.high).map(|q| q + 1);
    let everywhere = GpuZone::default();
    vec![
        everywhere,
        // Two chambers; the second is what the first leaves.
        GpuZone { kind: 1, low: world.fixed(world.low), high: [middle[0], middle[1], top[2]], ..everywhere },
        everywhere,
        GpuZone { kind: 1, low: world.fixed(world.low), high: middle, ..everywhere },
        GpuZone { kind: 2, low: middle, radius: 0.025, ..everywhere },
        GpuZone { kind: 3, low: middle, axis: [0.6, 0.0, 0.8], height: 0.03, radius: 0.02, ..everywhere },
    ]
}

/// Whether a zone holds a point; `None` within 10 u of the world's size of a round surface.
fn contains(world: &World, zone: &GpuZone, p: [u32; 3]) -> Option<bool> {
    let slack = 10.0 * U * norm(world.high);
    let d = minus(world.metres(p), world.metres(zone.low));
    let sure = |inset: f64| (inset.abs() > slack).then_some(inset > 0.0);
    match zone.kind {
        0 => Some(true),
        1 => Some((0..3).all(|k| p[k] >= zone.low[k] && p[k] < zone.high[k])),
        2 => sure(f64::from(zone.radius) - norm(d)),
        _ => {
            let height = dot(d, zone.axis.map(f64::from));
            let away = (dot(d, d) - height * height).max(0.0).sqrt();
            sure(height.min(f64::from(zone.height) - height).min(f64::from(zone.radius) - away))
        }
    }
}

fn rig(world: &World, zones: &[GpuZone], particles: &[GpuParticle], chambers: u32) -> Rig {
    let mut rig = Rig::new(world);
    rig.constant("GASES", GASES as f64);
    rig.constant("CHAMBERS", f64::from(chambers));
    rig.constant("VELOCITY_SCALE", VELOCITY_SCALE);
    rig.constant("ENERGY_SCALE", ENERGY_SCALE);
    rig.put("particles", particles);
    rig.put("zones", zones);
    rig.put("zone_sums", &vec![0u32; zones.len() * GASES * ZONE_WORDS]);
    rig.step(GpuStep { count: particles.len() as u32, ..GpuStep::default() });
    rig.run_groups("tally", [zones.len() as u32, particles.len().div_ceil(2048) as u32, GASES.div_ceil(2) as u32]);
    rig
}

fn sums(rig: &Rig, zones: usize) -> Vec<[i64; 6]> {
    let words: Vec<u32> = rig.get("zone_sums", zones * GASES * ZONE_WORDS);
    let long = |w: &[u32]| (u64::from(w[0]) | u64::from(w[1]) << 32).cast_signed();
    words.chunks_exact(ZONE_WORDS).map(|w| std::array::from_fn(|k| long(&w[2 * k..]))).collect()
}

#[test]
fn zones_sum_number_velocity_and_energies_of_each_gas() {
    let world = World::plain();
    let zones = zones(&world);
    let mut stream = Stream::new(35);
    let mut particles = world.particles(&mut stream, COUNT + 50, 1.0);
    // None within rounding of a round zone's surface.
    particles.retain(|p| zones.iter().all(|zone| contains(&world, zone, p.position).is_some()));
    particles.truncate(COUNT);
    for particle in &mut particles {
        // Whole numbers below 512: their squares add up without rounding, in any order or contraction.
        particle.velocity = [0; 3].map(|_| (stream.below(1023) as i32 - 511) as f32);
        particle.spin = stream.below(1 << 18) as f32;
        particle.tag = GpuParticle::tag(stream.below(GASES as u32) as u8, particle.id());
    }
    let expected = |chambers: usize| -> Vec<[i64; 6]> {
        let mut sums = vec![[0i64; 6]; GASES * zones.len()];
        for p in &particles {
            let inside = |z: usize| contains(&world, &zones[z], p.position).unwrap();
            for z in (0..zones.len()).filter(|&z| inside(z)) {
                if z <= chambers && (1..z).any(inside) {
                    continue;
                }
                let sum = &mut sums[GASES * z + usize::from(p.gas())];
                let speed2: f32 = p.velocity.iter().map(|v| v * v).sum();
                sum[0] += 1;
                for (total, v) in sum[1..4].iter_mut().zip(p.velocity) {
                    *total += i64::from(v as i32) * VELOCITY_SCALE as i64;
                }
                sum[4] += speed2 as i64 * (ENERGY_SCALE / 2.0) as i64;
                sum[5] += p.spin as i64 * ENERGY_SCALE as i64;
            }
        }
        sums
    };
    let found = rig(&world, &zones, &particles, 2);
    let sums = sums(&found, zones.len());
    assert_eq!(sums, expected(2));
    assert_eq!(found.counter(TALLY_OVERFLOW), 0);
    // The carry was needed, and some sums are negative.
    assert!(sums[0][4] > 1 << 33 && sums.iter().any(|sum| sum[1] < 0));
    // The check can fail: with one chamber the second zone is everything.
    assert_ne!(sums, expected(1));
    // That chamber has not all of the gas, of which there is a sum of its own.
    let found = rig(&world, &zones, &particles, 1);
    assert_eq!(self::sums(&found, zones.len()), expected(1));
}

/// A value beyond the range is counted in each zone and left out, never wrapped.
#[test]
fn a_value_out_of_range_is_counted() {
    let world = World::plain();
    let mut stream = Stream::new(36);
    let mut particles = world.particles(&mut stream, 100, 1.0);
    particles[3].velocity = [20_000.0, 0.0, 0.0];
    particles[50].spin = 2e6;
    let two = [GpuZone::default(), GpuZone::default()];
    let found = rig(&world, &two, &particles, 0);
    assert_eq!(found.counter(TALLY_OVERFLOW), 4);
    let numbers: i64 = sums(&found, 2).iter().map(|sum| sum[0]).sum();
    assert_eq!(numbers, 2 * 98);
    // The check can fail: slow ones are all there.
    particles[3].velocity = [2.0; 3];
    particles[50].spin = 2.0;
    assert_eq!(rig(&world, &two, &particles, 0).counter(TALLY_OVERFLOW), 0);
}

/// Dead slots count for nothing, whatever they hold.
#[test]
fn dead_slots_are_not_tallied() {
    let world = World::plain();
    let mut stream = Stream::new(57);
    let mut particles = world.particles(&mut stream, 1000, 1.0);
    for dead in particles.iter_mut().step_by(4) {
        *dead = GpuParticle { tag: NOBODY, velocity: [1e9; 3], spin: 1e30, ..*dead };
    }
    let found = rig(&world, &[GpuZone::default()], &particles, 0);
    assert_eq!(found.counter(TALLY_OVERFLOW), 0);
    assert_eq!(sums(&found, 1).iter().map(|sum| sum[0]).sum::<i64>(), 750);
    // The check can fail: alive they would be out of range.
    for dead in particles.iter_mut().step_by(4) {
        dead.tag = 0;
    }
    assert_eq!(rig(&world, &[GpuZone::default()], &particles, 0).counter(TALLY_OVERFLOW), 250);
}
