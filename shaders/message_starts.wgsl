//! uses: step.wgsl workgroup_sums.wgsl
//! phase: exchange update
// Exchange and update, part 2: where each peer's message begins among all that is sent.
//
// Reads `peer_counts` and leaves zeros there; writes their exclusive prefix sums and, behind them, the sum of all to
// `peer_starts`. One workgroup; each thread takes one contiguous share of the peers.

var<uniform> step: Step;
var<storage, read_write> peer_counts: array<u32>;
var<storage, read_write> peer_starts: array<u32>;

@compute @workgroup_size(SCAN_THREADS)
fn message_starts(@builtin(local_invocation_index) thread: u32) {
    let share = (step.peers + SCAN_THREADS - 1u) / SCAN_THREADS;
    let begin = min(thread * share, step.peers);
    let end = min(begin + share, step.peers);
    var sum = 0u;
    for (var p = begin; p < end; p++) {
        sum += peer_counts[p];
    }
    workgroup_sums[thread] = sum;
    workgroupBarrier();
    if (begin >= end) {
        // Not to look at all that is before a share of nothing.
        return;
    }
    var before = sums_before(thread);
    for (var p = begin; p < end; p++) {
        peer_starts[p] = before;
        before += peer_counts[p];
        peer_counts[p] = 0u;
    }
    if (end == step.peers) {
        peer_starts[step.peers] = before;
    }
}
