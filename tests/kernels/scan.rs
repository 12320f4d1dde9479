//! `scan_sums`, `scan_stretches` and `scan_cells`: the parts of an exclusive prefix sum, exactly; and `clear_cells`.

use crate::oracle::random::Stream;
use crate::rig::*;

const CHUNK: usize = 64;
/// Cells of a workgroup.
const STRETCH: usize = 64 * CHUNK;

/// For so many bins.
fn rig(cells: usize) -> Rig {
    let mut rig = Rig::new(&World::plain());
    rig.step(corpuscle::subdomain::GpuStep { bins: cells as u32, ..Default::default() });
    rig
}

fn counts(stream: &mut Stream, cells: usize) -> Vec<u32> {
    (0..cells).map(|_| stream.below(9)).collect()
}

/// The sum of the counts before each entry, and after the last.
fn prefix(counts: &[u32]) -> Vec<u32> {
    let mut total = 0;
    let mut sums = vec![0];
    sums.extend(counts.iter().map(|count| {
        total += count;
        total
    }));
    sums
}

/// Numbers of cells around whole fours, chunks and workgroups of chunks.
const CELLS: [usize; 8] = [4, 61, 62, 63, 64, 64 * 64 - 1, 64 * 64 + 4, 90_001];

/// The counts, and zeros to the end of the chunk that has the cell behind the last.
fn with_end(counts: &[u32]) -> Vec<u32> {
    let mut all = counts.to_vec();
    all.resize(CHUNK * (counts.len() / CHUNK + 1), 0);
    all
}

fn sums(counts: &[u32], length: usize) -> Vec<u32> {
    counts.chunks(length).map(|part| part.iter().sum()).collect()
}

#[test]
fn scan_sums_adds_each_chunk_and_each_stretch() {
    let mut stream = Stream::new(4);
    for cells in CELLS {
        let mut rig = rig(cells);
        let mut counts = counts(&mut stream, cells);
        counts[cells - 1] = 3;
        let all = with_end(&counts);
        let (chunks, stretches) = (cells / CHUNK + 1, cells / STRETCH + 1);
        rig.put("cell_counts", &all);
        rig.put("chunk_sums", &vec![7u32; chunks]);
        rig.put("stretch_sums", &vec![0u32; stretches]);
        rig.run("scan_sums", chunks);
        assert_eq!(rig.get::<u32>("chunk_sums", chunks), sums(&all, CHUNK));
        assert_eq!(rig.get::<u32>("stretch_sums", stretches), sums(&all, STRETCH));
        // The check can fail: the last count matters.
        let mut without = all;
        without[cells - 1] = 0;
        assert_ne!(rig.get::<u32>("stretch_sums", stretches), sums(&without, STRETCH));
    }
}

#[test]
fn scan_stretches_is_an_exclusive_prefix_sum() {
    let mut stream = Stream::new(5);
    for stretches in [1, 4, 255, 256, 257, 1031, 5000] {
        // The cell behind the last is in the last stretch.
        let mut rig = rig(stretches * STRETCH - 1);
        let sums = counts(&mut stream, stretches);
        rig.put("stretch_sums", &sums);
        rig.run_groups("scan_stretches", [1, 1, 1]);
        let found: Vec<u32> = rig.get("stretch_sums", stretches);
        assert_eq!(found, prefix(&sums)[..stretches]);
        // The check can fail: it is not the inclusive sum.
        assert!(sums == vec![0; stretches] || found != prefix(&sums)[1..]);
    }
}

#[test]
fn scan_cells_puts_starts_in_place_of_counts() {
    let mut stream = Stream::new(6);
    for cells in CELLS {
        let mut rig = rig(cells);
        let mut counts = counts(&mut stream, cells);
        // Chunks without particles, among others and at the end.
        counts.chunks_mut(CHUNK).skip(1).step_by(3).for_each(|chunk| chunk.fill(0));
        let starts = prefix(&counts);
        let all = with_end(&counts);
        let of_stretches = prefix(&sums(&all, STRETCH));
        let mut of_chunks = sums(&all, CHUNK);
        // What is behind them is not counted.
        of_chunks.resize(64 * (cells / STRETCH + 1), 7);
        rig.put("chunk_sums", &of_chunks);
        rig.put("stretch_sums", &of_stretches[..cells / STRETCH + 1]);
        rig.put("cell_start", &all);
        rig.run("scan_cells", cells / CHUNK + 1);
        assert_eq!(rig.get::<u32>("cell_start", cells + 1), starts);
        assert_eq!(rig.step_state(PRESENT), starts[cells]);
        // Few stretches are summed here.
        let stretches = cells / STRETCH + 1;
        rig.constant("FEW_STRETCHES", stretches as f64);
        let mut of_stretches = sums(&all, STRETCH);
        of_stretches.resize(stretches.next_multiple_of(4), 7);
        rig.put("stretch_sums", &of_stretches);
        rig.put("cell_start", &all);
        rig.set_step_state(PRESENT, 7);
        rig.run("scan_cells", cells / CHUNK + 1);
        assert_eq!(rig.get::<u32>("cell_start", cells + 1), starts);
        assert_eq!(rig.step_state(PRESENT), starts[cells]);
        assert_ne!(starts[cells], 0, "the check can fail: there were particles");
    }
}

/// In every variant; chunks without particles are among others and at the end.
#[test]
fn scan_cells_is_the_same_in_every_variant() {
    let mut stream = Stream::new(7);
    for (variant, cells) in variants().into_iter().flat_map(|variant| CELLS.map(|cells| (variant, cells))) {
        let mut rig = rig(cells);
        rig.variant = variant;
        let mut counts = counts(&mut stream, cells);
        counts.chunks_mut(CHUNK).skip(1).step_by(3).for_each(|chunk| chunk.fill(0));
        let all = with_end(&counts);
        let mut of_chunks = sums(&all, CHUNK);
        of_chunks.resize(64 * (cells / STRETCH + 1), 7);
        rig.put("chunk_sums", &of_chunks);
        rig.put("stretch_sums", &prefix(&sums(&all, STRETCH))[..cells / STRETCH + 1]);
        rig.put("cell_start", &all);
        rig.run("scan_cells", cells / CHUNK + 1);
        assert_eq!(rig.get::<u32>("cell_start", cells + 1), prefix(&counts), "{variant:?}");
    }
}

/// `clear_cells` clears what the scan has written, with as many threads as it is given, and nothing behind it.
#[test]
fn all_cells_of_the_step_are_cleared() {
    for (cells, groups) in CELLS.into_iter().flat_map(|cells| [[1, 1, 1], [3, 2, 1]].map(|groups| (cells, groups))) {
        let mut rig = rig(cells);
        let all = CHUNK * (cells / CHUNK + 1);
        rig.put("cell_start", &vec![9u32; all + 8]);
        rig.run_groups("clear_cells", groups);
        assert_eq!(rig.get::<u32>("cell_start", all + 8), [vec![0; all], vec![9; 8]].concat(), "{cells}");
    }
}
