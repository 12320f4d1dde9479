//! uses: step.wgsl shares.wgsl
// Scan, part 2: the sums of the stretches become their exclusive prefix sums.
//
// Reads and writes `stretch_sums`. One workgroup; each thread takes one contiguous share.

override CHUNK: u32;
override SHARES: u32 = 256;

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(29) var<storage, read_write> stretch_sums: array<u32>;

// Four sums, zero from `end` on: read together, since each read would wait for what was written before it.
fn four_from(k: u32, end: u32) -> vec4<u32> {
    let four = vec4<u32>(stretch_sums[k], stretch_sums[k + 1u], stretch_sums[k + 2u], stretch_sums[k + 3u]);
    return select(vec4<u32>(0u), four, vec4<u32>(k, k + 1u, k + 2u, k + 3u) < vec4<u32>(end));
}

@compute @workgroup_size(SHARES)
fn scan_stretches(@builtin(local_invocation_index) thread: u32) {
    let count = step.bins / (CHUNK * WORKGROUP) + 1u;
    let share = (count + SHARES - 1u) / SHARES;
    let begin = min(thread * share, count);
    let end = min(begin + share, count);
    var sum = 0u;
    for (var k = begin; k < end; k += 4u) {
        let four = four_from(k, end);
        sum += four.x + four.y + four.z + four.w;
    }
    shares[thread] = sum;
    workgroupBarrier();
    var before = shares_before(thread);
    for (var k = begin; k < end; k += 4u) {
        let four = four_from(k, end);
        for (var j = 0u; j < min(4u, end - k); j++) {
            stretch_sums[k + j] = before;
            before += four[j];
        }
    }
}
