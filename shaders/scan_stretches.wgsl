//! uses: step.wgsl prefix.wgsl
// Scan of many cells: the sums of the stretches become their exclusive prefix sums.
//
// Reads and writes the sums of stretches (here called `chunk_sums`). One workgroup.

override CHUNK: u32;

@group(0) @binding(0) var<uniform> step: Step;

@compute @workgroup_size(SCAN_THREADS)
fn scan_stretches(@builtin(local_invocation_index) thread: u32) {
    scan_shares(thread, step.bins / (CHUNK * CHUNK) + 1u);
}
