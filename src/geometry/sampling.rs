//! Sums over many lines along x, at the points of a low-discrepancy sequence, on all cores.
//!
//! The order of the additions depends on the number of lines only, never on the number of threads.

use super::lines::Crossing;

/// Lines per partial sum.
const CHUNK: u64 = 2048;

/// Room for one line's crossings and intervals.
#[derive(Default)]
pub(super) struct Line {
    pub crossings: Vec<Crossing>,
    pub gas: Vec<(f64, f64)>,
    pub spare: Vec<(f64, f64)>,
}

/// Point `i` of the R2 sequence in the unit square (M. Roberts 2018): multiples of 1/g and 1/g^2 with
/// g^3 = g + 1, modulo one, in 64-bit integers.
pub(super) fn r2(i: u64) -> [f64; 2] {
    const STEP: [u64; 2] = [0xC13F_A9A9_02A6_328F, 0x91E1_0DA5_C79E_7B1D];
    STEP.map(|step| {
        let fraction = step.wrapping_mul(i).wrapping_add(1 << 63);
        // 52 bits and a half: strictly between 0 and 1.
        ((fraction >> 12) as f64 + 0.5) / (1u64 << 52) as f64
    })
}

/// Sum of `f` over 0..count.
pub(super) fn sum<const K: usize>(count: u64, f: impl Fn(u64, &mut Line) -> [f64; K] + Sync) -> [f64; K] {
    let partial = map(count.div_ceil(CHUNK) as usize, |chunk, line| {
        let first = chunk as u64 * CHUNK;
        let mut sum = [0.0; K];
        for i in first..(first + CHUNK).min(count) {
            add(&mut sum, f(i, line));
        }
        sum
    });
    let mut total = [0.0; K];
    partial.into_iter().for_each(|part| add(&mut total, part));
    total
}

fn add<const K: usize>(sum: &mut [f64; K], more: [f64; K]) {
    for k in 0..K {
        sum[k] += more[k];
    }
}

/// `f` of 0..count in order, shared out among threads.
pub(super) fn map<T: Send>(count: usize, f: impl Fn(usize, &mut Line) -> T + Sync) -> Vec<T> {
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get()).min(count).max(1);
    let share = |thread: usize| {
        let mut line = Line::default();
        (thread..count).step_by(threads).map(|i| f(i, &mut line)).collect::<Vec<T>>()
    };
    if threads == 1 {
        return share(0);
    }
    let shares: Vec<Vec<T>> = std::thread::scope(|scope| {
        let handles: Vec<_> = (0..threads).map(|t| scope.spawn(move || share(t))).collect();
        handles
            .into_iter()
            .map(|handle| handle.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    });
    let mut shares: Vec<_> = shares.into_iter().map(Vec::into_iter).collect();
    (0..count).filter_map(|i| shares[i % threads].next()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sequence_integrates_an_indicator_far_better_than_random_points() {
        let count = 1 << 18;
        let inside = |i: u64, _: &mut Line| {
            let [y, z] = r2(i);
            [f64::from(u8::from(y * y + z * z < 1.0))]
        };
        let quarter = sum(count, inside)[0] / count as f64;
        let error = (quarter - std::f64::consts::FRAC_PI_4).abs();
        // Random points: standard error 8e-4.
        assert!(error < 3e-5, "{error}");
        // A lattice that is no lattice at all (every point the same) fails it.
        let bad = sum(count, |_, line| inside(0, line))[0] / count as f64;
        assert!((bad - std::f64::consts::FRAC_PI_4).abs() > 0.1);
    }

    #[test]
    fn results_come_in_order() {
        assert_eq!(map(1000, |i, _| i), (0..1000).collect::<Vec<_>>());
        assert_eq!(sum(5000, |i, _| [i as f64, 1.0]), [4999.0 * 2500.0, 5000.0]);
    }
}
