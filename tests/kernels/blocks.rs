//! `blocks`: number, energy and fast particles, exactly.

use corpuscle::subdomain::{GpuGas, GpuParticle, GpuStep};

use crate::oracle::random::Stream;
use crate::rig::*;

const COUNT: usize = 4000;
const LEVELS: usize = 6;
const BLOCK_BITS: u32 = 1;
const ENERGY_SCALE: f64 = 64.0;
/// A cell in the largest step takes 1000 m/s.
const TIME_STEP: f64 = 1e-5;

#[test]
fn blocks_sum_number_and_energy_and_count_the_fast() {
    let world = World::plain();
    let cells = world.cells();
    let counts = world.grid.blocks(BLOCK_BITS);
    let blocks = counts.iter().product::<u32>() as usize;
    let masses = [1.0f32, 0.25];
    let mut stream = Stream::new(37);
    let mut particles = world.particles(&mut stream, COUNT, 1.0);
    for particle in &mut particles {
        // Whole numbers: their squares add up without rounding.
        let scale = 1 << stream.below(4);
        particle.velocity = [0; 3].map(|_| ((stream.below(1023) as i32 - 511) * scale) as f32);
    }
    let mut expected = vec![0u64; 2 * blocks];
    let mut fast = [0u32; LEVELS];
    for p in &particles {
        let b = cells.cell(p.position).map(|c| c >> BLOCK_BITS);
        let block = ((b[2] * counts[1] + b[1]) * counts[0] + b[0]) as usize;
        let speed2 = p.velocity.iter().map(|&v| f64::from(v) * f64::from(v)).sum::<f64>();
        expected[2 * block] += 1;
        let energy = 0.5 * f64::from(masses[usize::from(p.gas())]) * speed2 * ENERGY_SCALE;
        // Halves, if any, round to even.
        expected[2 * block + 1] += energy.round_ties_even() as u64;
        for (level, count) in fast.iter_mut().enumerate() {
            let reach = speed2.sqrt() * TIME_STEP / f64::from(1u32 << level) / world.grid.cell;
            assert!((reach - 1.0).abs() > 8.0 * U, "no speed is within rounding of a limit");
            *count += u32::from(reach > 1.0);
        }
    }
    // Dead slots count for nothing.
    let dead = GpuParticle { tag: NOBODY, velocity: [1e9; 3], ..particles[0] };
    particles.extend([dead; 40]);
    let mut rig = Rig::new(&world);
    for (name, value) in [
        ("BLOCK_BITS", f64::from(BLOCK_BITS)),
        ("BLOCKS_X", f64::from(counts[0])),
        ("BLOCKS_Y", f64::from(counts[1])),
        ("BLOCKS", blocks as f64),
        ("TIME_STEP", TIME_STEP),
        ("LEVELS", LEVELS as f64),
        ("BLOCK_ENERGY_SCALE", ENERGY_SCALE),
    ] {
        rig.constant(name, value);
    }
    rig.gases(&masses.map(|mass| GpuGas { mass, ..GpuGas::default() }));
    rig.put("particles", &particles);
    rig.put("block_sums", &vec![0u32; blocks * BLOCK_WORDS + LEVELS]);
    rig.step(GpuStep { count: COUNT as u32 + 30, newborns: 10, ..GpuStep::default() });
    rig.run("blocks", COUNT + 40);
    let words: Vec<u32> = rig.get("block_sums", blocks * BLOCK_WORDS + LEVELS);
    let (sums, found_fast) = words.split_at(blocks * BLOCK_WORDS);
    let sums: Vec<u64> = sums.chunks_exact(2).map(|w| u64::from(w[0]) | u64::from(w[1]) << 32).collect();
    assert_eq!(sums, expected);
    assert_eq!(found_fast, fast);
    assert_eq!(rig.counter(TALLY_OVERFLOW), 0);
    // The check can fail: sums carry, and levels differ.
    assert!(sums.iter().any(|&sum| sum > 1 << 32) && fast[0] > fast[1] && fast[1] > fast[2] && fast[2] > 0);
}
