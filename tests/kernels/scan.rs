//! `scan_sums`, `scan_chunks` and `scan_cells`: the parts of an exclusive prefix sum, exactly.

use crate::oracle::random::Stream;
use crate::rig::*;

const CHUNK: usize = 64;

/// For so many bins.
fn rig(cells: usize) -> Rig {
    let mut rig = Rig::new(&World::plain());
    rig.constant("CHUNK", CHUNK as f64);
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
const CELLS: [usize; 8] = [4, 61, 62, 63, 64, 64 * 64 - 1, 64 * 64 + 4, 30_001];

/// The counts, and zeros to the end of the four that has the cell behind the last.
fn with_end(counts: &[u32]) -> Vec<u32> {
    let mut all = counts.to_vec();
    all.resize(4 * (counts.len() / 4 + 1), 0);
    all
}

#[test]
fn scan_sums_adds_each_chunk() {
    let mut stream = Stream::new(4);
    for cells in CELLS {
        let mut rig = rig(cells);
        let counts = counts(&mut stream, cells);
        let chunks = cells / CHUNK + 1;
        rig.put("cell_start", &with_end(&counts));
        rig.put("chunk_sums", &vec![7u32; chunks]);
        rig.run("scan_sums", chunks);
        let sums: Vec<u32> = with_end(&counts).chunks(CHUNK).map(|chunk| chunk.iter().sum()).collect();
        let found: Vec<u32> = rig.get("chunk_sums", chunks);
        assert_eq!(found, sums);
        // The check can fail: the last count matters.
        assert_ne!(found[chunks - 1], sums[chunks - 1] + 1);
    }
}

#[test]
fn scan_chunks_is_an_exclusive_prefix_sum() {
    let mut stream = Stream::new(5);
    for chunks in [4, 128, 132, 5000] {
        // The cell behind the last is in the last chunk.
        let mut rig = rig(chunks * CHUNK - 1);
        let sums = counts(&mut stream, chunks);
        rig.put("chunk_sums", &[&sums[..], &[7]].concat());
        rig.run_groups("scan_chunks", [1, 1, 1]);
        let found: Vec<u32> = rig.get("chunk_sums", chunks + 1);
        assert_eq!(found, prefix(&sums));
        // The check can fail: it is not the inclusive sum.
        assert_ne!(found[..chunks], prefix(&sums)[1..]);
    }
}

/// By stretches of chunks the same comes out, whatever is left of the last.
#[test]
fn chunks_are_scanned_by_stretches() {
    let mut stream = Stream::new(7);
    for chunks in [4, CHUNK, CHUNK + 1, 5000, 3 * 128 * CHUNK - 1] {
        let mut rig = rig(chunks * CHUNK - 1);
        let sums = counts(&mut stream, chunks);
        let stretches = chunks.div_ceil(CHUNK);
        let of_stretches: Vec<u32> = sums.chunks(CHUNK).map(|stretch| stretch.iter().sum()).collect();
        rig.put("chunk_sums", &[&sums[..], &[7]].concat());
        rig.put("stretch_sums", &vec![7u32; stretches + 1]);
        rig.run("sum_stretches", stretches);
        assert_eq!(rig.get::<u32>("stretch_sums", stretches), of_stretches);
        // It scans what it calls the sums of chunks.
        rig.put("chunk_sums", &[&of_stretches[..], &[7]].concat());
        rig.run_groups("scan_stretches", [1, 1, 1]);
        let before: Vec<u32> = rig.get("chunk_sums", stretches + 1);
        assert_eq!(before, prefix(&of_stretches));
        rig.put("chunk_sums", &[&sums[..], &[7]].concat());
        rig.put("stretch_sums", &before);
        rig.run("start_chunks", stretches);
        assert_eq!(rig.get::<u32>("chunk_sums", chunks + 1), prefix(&sums));
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
        let chunks = cells / CHUNK + 1;
        let chunk_starts: Vec<u32> = (0..=chunks).map(|chunk| starts[(chunk * CHUNK).min(cells)]).collect();
        rig.put("chunk_sums", &chunk_starts);
        rig.put("cell_start", &with_end(&counts));
        rig.run("scan_cells", chunks);
        assert_eq!(rig.get::<u32>("cell_start", cells + 1), starts);
        assert_ne!(starts[cells], 0, "the check can fail: there were particles");
    }
}
