//! uses: step.wgsl prefix.wgsl
// Scan, part 2: the sums of the chunks become their exclusive prefix sums, and the sum of all stands behind them.
//
// Reads and writes `chunk_sums` (one more than there are chunks). One workgroup. (Of many chunks sum_stretches.wgsl and the two behind it
// do the same.)

override CHUNK: u32;

@group(0) @binding(0) var<uniform> step: Step;

@compute @workgroup_size(SCAN_THREADS)
fn scan_chunks(@builtin(local_invocation_index) thread: u32) {
    // With the cell behind the last.
    scan_shares(thread, step.bins / CHUNK + 1u);
}
