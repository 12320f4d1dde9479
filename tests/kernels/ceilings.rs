//! `ceiling_copy`, `ceiling_arithmetic`, `ceiling_loads` and `ceiling_flights` do the work that `corpuscle bench` counts: every
//! word is copied, every multiplication and addition is made, every read is of another word, every particle is moved.

use crate::oracle::random::Stream;
use crate::rig::*;

const ITEMS: usize = 1000;

#[test]
fn all_words_are_copied() {
    let mut stream = Stream::new(3);
    let words: Vec<[u32; 4]> = (0..ITEMS).map(|_| std::array::from_fn(|_| stream.word())).collect();
    let mut rig = Rig::new(&World::plain());
    rig.put("copy_from", &words);
    rig.put("copy_to", &vec![[0u32; 4]; ITEMS]);
    rig.run("ceiling_copy", ITEMS);
    assert_eq!(rig.get::<[u32; 4]>("copy_to", ITEMS), words);
}

/// a <- a factor + term, so many times, from four starts: their sum to f32 rounding.
#[test]
fn all_operations_are_made() {
    let loops = 40;
    let mut rig = Rig::new(&World::plain());
    rig.constant("LOOPS", f64::from(loops));
    rig.put("copy_to", &vec![[0u32; 4]; ITEMS]);
    rig.run("ceiling_arithmetic", ITEMS);
    for (k, found) in rig.get::<[f32; 4]>("copy_to", ITEMS).into_iter().enumerate() {
        let (factor, term) = (0.999 + 1e-9 * k as f64, 1e-3 * (k & 7) as f64);
        for (axis, &found) in found.iter().enumerate() {
            let start = 0.1 * (axis + 1) as f64;
            let sum: f64 =
                (0..4).map(|chain| (0..loops).fold(start + f64::from(chain) * term, |a, _| a * factor + term)).sum();
            assert!((f64::from(found) / sum - 1.0).abs() < 1e-5, "{k} {axis}: {found} {sum}");
        }
    }
}

/// The words at four places that go on by 13: their sums, exactly.
#[test]
fn all_words_are_read() {
    let loops = 40;
    let mut stream = Stream::new(4);
    let table: Vec<u32> = (0..4096).map(|_| stream.word()).collect();
    let mut rig = Rig::new(&World::plain());
    rig.constant("LOOPS", f64::from(loops));
    rig.put("copy_from", &table);
    rig.put("copy_to", &vec![[0u32; 4]; ITEMS]);
    rig.run("ceiling_loads", ITEMS);
    let expected = |k: usize| {
        [0, 1021, 2039, 3067].map(|from| {
            (0..loops).fold(0u32, |sum, i| sum.wrapping_add(table[(7 * k + from + 13 * i as usize) % 4096]))
        })
    };
    assert_eq!(rig.get::<[u32; 4]>("copy_to", ITEMS), (0..ITEMS).map(expected).collect::<Vec<_>>());
}

/// By its velocity, in quanta, rounded; what it is besides stays.
#[test]
fn all_particles_are_moved() {
    let mut stream = Stream::new(5);
    let particles: Vec<[u32; 8]> = (0..ITEMS as u32)
        .map(|k| {
            let [x, y, z, tag] = std::array::from_fn(|_| stream.word());
            [x, y, z, tag, (k as f32 - 0.3).to_bits(), (-2.0 * k as f32).to_bits(), 7.4f32.to_bits(), stream.word()]
        })
        .collect();
    let mut rig = Rig::new(&World::plain());
    rig.constant("QUANTA", 1.0);
    rig.put("copy_to", &particles);
    rig.run("ceiling_flights", ITEMS);
    let moved = |k: usize| {
        let mut particle = particles[k];
        for (axis, by) in [k as u32, (2 * k as u32).wrapping_neg(), 7].into_iter().enumerate() {
            particle[axis] = particle[axis].wrapping_add(by);
        }
        particle
    };
    assert_eq!(rig.get::<[u32; 8]>("copy_to", ITEMS), (0..ITEMS).map(moved).collect::<Vec<_>>());
}
