// Sums become their exclusive prefix sums, and the sum of all stands behind them, by one workgroup; each thread takes one contiguous
// share.

override SCAN_THREADS: u32 = 128;

@group(0) @binding(7) var<storage, read_write> chunk_sums: array<u32>;

var<workgroup> shares: array<u32, SCAN_THREADS>;

fn scan_shares(thread: u32, count: u32) {
    let share = (count + SCAN_THREADS - 1u) / SCAN_THREADS;
    let begin = min(thread * share, count);
    let end = min(begin + share, count);
    var sum = 0u;
    for (var k = begin; k < end; k++) {
        sum += chunk_sums[k];
    }
    shares[thread] = sum;
    workgroupBarrier();
    if (thread == 0u) {
        var before = 0u;
        for (var k = 0u; k < SCAN_THREADS; k++) {
            let own = shares[k];
            shares[k] = before;
            before += own;
        }
    }
    workgroupBarrier();
    var before = shares[thread];
    for (var k = begin; k < end; k++) {
        let own = chunk_sums[k];
        chunk_sums[k] = before;
        before += own;
    }
    if (begin < end && end == count) {
        chunk_sums[count] = before;
    }
}
