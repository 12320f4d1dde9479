//! uses: step.wgsl workgroup_sums.wgsl stretches.wgsl
//! phase: scan
// Scan, part 2, where there are more than a few stretches: their sums become exclusive prefix sums.
//
// Reads and writes `stretch_sums`. One workgroup; each thread takes one contiguous share.

var<uniform> step: Step;
var<storage, read_write> stretch_sums: array<u32>;

// Four sums from `k` on, zero from `end` on, where others' are: read together, since each read would wait for what was written before it.
fn four_from(k: u32, end: u32) -> vec4<u32> {
    let wanted = k + vec4<u32>(0u, 1u, 2u, 3u);
    let at = min(wanted, vec4<u32>(end - 1u));
    let four = vec4<u32>(stretch_sums[at.x], stretch_sums[at.y], stretch_sums[at.z], stretch_sums[at.w]);
    return select(vec4<u32>(0u), four, wanted < vec4<u32>(end));
}

@compute @workgroup_size(SCAN_THREADS)
fn scan_stretches(@builtin(local_invocation_index) thread: u32) {
    let count = step.bins / (CHUNK * WORKGROUP) + 1u;
    let share = (count + SCAN_THREADS - 1u) / SCAN_THREADS;
    let begin = min(thread * share, count);
    let end = min(begin + share, count);
    var sum = 0u;
    // bench: stretches
    for (var k = begin; k < end; k += 4u) {
        let four = four_from(k, end);
        sum += four.x + four.y + four.z + four.w;
    }
    workgroup_sums[thread] = sum;
    workgroupBarrier();
    var before = sums_before(thread);
    // bench: stretches
    for (var k = begin; k < end; k += 4u) {
        let four = four_from(k, end);
        for (var j = 0u; j < min(4u, end - k); j++) {
            stretch_sums[k + j] = before;
            before += four[j];
        }
    }
}
