//! `scan_sums`, `scan_stretches` and `scan_cells`: the parts of an exclusive prefix sum, exactly.

use corpuscle::gpu::KernelVariant;

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

/// On a device alone the lists of the step before are emptied, but for those that `bin` and `advect` have to do with; among others none is.
#[test]
fn scan_sums_empties_the_lists_of_the_step_before() {
    let mut stream = Stream::new(3);
    let noise: Vec<u32> = (0..COUNTER_WORDS).map(|_| stream.word() | 1).collect();
    let kept = [LIST_BOUNCE, LIST_BOUNCE_ODD, COUNT_DROPPED];
    // Fewer chunks than there are lists, and more.
    let cases = [(4, 0, 0), (90_001, 0, 0), (90_001, 0, 64), (90_001, 1, 64)];
    for (variant, (cells, peers, few)) in variants().into_iter().flat_map(|variant| cases.map(|case| (variant, case))) {
        let mut rig = rig(cells);
        rig.variant = variant;
        rig.constant("FEW_STRETCHES", f64::from(few));
        rig.put("cell_counts", &with_end(&vec![0; cells]));
        rig.put("chunk_sums", &vec![7u32; cells / CHUNK + 1]);
        rig.put("stretch_sums", &vec![0u32; cells / STRETCH + 1]);
        for buffer in ["counters", "dispatches", "rechoose_dispatches"] {
            rig.put(buffer, &noise);
        }
        rig.step(corpuscle::subdomain::GpuStep { bins: cells as u32, peers, ..Default::default() });
        rig.run("scan_sums", cells / CHUNK + 1);
        let counters: Vec<u32> = rig.get("counters", COUNTER_WORDS);
        for (word, (&found, &before)) in counters.iter().zip(&noise).enumerate() {
            let emptied = is_of_shard(variant, word) || word < LISTS && !kept.contains(&word);
            assert_eq!(found, if emptied && peers == 0 { 0 } else { before }, "{variant:?} {word}");
        }
        for buffer in ["dispatches", "rechoose_dispatches"] {
            let sizes: Vec<[u32; 3]> = rig.get(buffer, LISTS);
            for (list, (size, before)) in sizes.iter().zip(noise.as_chunks().0).enumerate() {
                // On a GPU, and where cells are few, the first of `choose` has them to empty.
                let emptying = buffer == "rechoose_dispatches"
                    && list == LIST_RECHOOSE
                    && (variant == KernelVariant::Gpu || few > 0);
                let emptied = [if emptying { (cells / STRETCH + 1) as u32 } else { 0 }, 1, 1];
                assert_eq!(size, if peers == 0 && !kept.contains(&list) { &emptied } else { before }, "{list}");
            }
        }
    }
}

/// All in one, with counts in the place of the starts and apart from them: starts, PRESENT, and on a device alone the lists of the step before.
#[test]
fn scan_merged_does_all_of_the_scan() {
    let mut stream = Stream::new(8);
    let noise: Vec<u32> = (0..COUNTER_WORDS).map(|_| stream.word() | 1).collect();
    let kept = [LIST_BOUNCE, LIST_BOUNCE_ODD, COUNT_DROPPED];
    let cases: Vec<(usize, bool)> = CELLS.into_iter().flat_map(|cells| [(cells, false), (cells, true)]).collect();
    for (variant, (cells, apart)) in
        variants().into_iter().flat_map(|variant| cases.iter().map(move |&case| (variant, case)))
    {
        let peers = u32::from(cells == 63);
        let mut rig = rig(cells);
        rig.variant = variant;
        rig.constant("COUNTS_APART", f64::from(u8::from(apart)));
        let mut counts = counts(&mut stream, cells);
        counts[cells - 1] = 3;
        let all = with_end(&counts);
        let (name, noise_of_cells) = (if apart { "counts_apart" } else { "cell_start" }, vec![9u32; all.len() + 4]);
        rig.put("cell_start", &noise_of_cells);
        rig.put(name, &[&all[..], &[9; 4]].concat());
        rig.put("counters", &noise);
        for buffer in ["dispatches", "rechoose_dispatches"] {
            rig.put(buffer, &[7u32; 3 * LISTS]);
        }
        rig.step(corpuscle::subdomain::GpuStep { bins: cells as u32, peers, ..Default::default() });
        rig.run_groups("scan_merged", [1, 1, 1]);
        let starts = prefix(&counts);
        let found: Vec<u32> = rig.get("cell_start", all.len() + 4);
        assert_eq!(found[..=cells], starts, "{variant:?} {cells} {apart}");
        assert!(found[cells..all.len()].iter().all(|&start| start == starts[cells]));
        assert_eq!(found[all.len()..], [9; 4], "nothing behind them");
        assert_eq!(rig.step_state(PRESENT), starts[cells]);
        if apart {
            assert_eq!(rig.get::<u32>("counts_apart", all.len()), vec![0; all.len()]);
        }
        let counters: Vec<u32> = rig.get("counters", COUNTER_WORDS);
        for (word, (&found, &before)) in counters.iter().zip(&noise).enumerate() {
            let emptied = is_of_shard(variant, word) || word < LISTS && !kept.contains(&word);
            assert_eq!(found, if emptied && peers == 0 { 0 } else { before }, "{variant:?} {word}");
        }
        for (list, size) in rig.get::<[u32; 3]>("dispatches", LISTS).iter().enumerate() {
            assert_eq!(*size, if peers == 0 && !kept.contains(&list) { [0, 1, 1] } else { [7; 3] }, "{list}");
        }
        // The check can fail: the last count matters.
        assert_ne!(starts[cells], starts[cells - 1]);
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

/// Counts that lie apart from the starts are emptied as they are read, for the step that follows.
#[test]
fn scan_cells_empties_counts_that_lie_apart() {
    let mut stream = Stream::new(7);
    for (variant, cells) in variants().into_iter().flat_map(|variant| CELLS.map(|cells| (variant, cells))) {
        let mut rig = rig(cells);
        rig.variant = variant;
        let mut counts = counts(&mut stream, cells);
        counts.chunks_mut(CHUNK).skip(1).step_by(3).for_each(|chunk| chunk.fill(0));
        let all = with_end(&counts);
        let mut of_chunks = sums(&all, CHUNK);
        of_chunks.resize(64 * (cells / STRETCH + 1), 7);
        rig.constant("COUNTS_APART", 1.0);
        rig.put("chunk_sums", &of_chunks);
        rig.put("stretch_sums", &prefix(&sums(&all, STRETCH))[..cells / STRETCH + 1]);
        rig.put("counts_apart", &all);
        rig.put("cell_start", &vec![9u32; all.len()]);
        rig.run("scan_cells", cells / CHUNK + 1);
        assert_eq!(rig.get::<u32>("cell_start", cells + 1), prefix(&counts), "{variant:?}");
        assert_eq!(rig.get::<u32>("counts_apart", all.len()), vec![0; all.len()]);
    }
}
