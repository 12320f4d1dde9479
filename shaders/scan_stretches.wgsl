//! uses: step.wgsl
// Scan, part 2: the sums of the stretches become their exclusive prefix sums.
//
// Reads and writes `stretch_sums`. One workgroup; each thread takes one contiguous share.

override CHUNK: u32;
// A multiple of eight.
override SCAN_THREADS: u32 = 256;

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(29) var<storage, read_write> stretch_sums: array<u32>;

var<workgroup> shares: array<u32, SCAN_THREADS>;

// The sum of what the threads before one have.
fn shares_before(thread: u32) -> u32 {
    var sum = vec4<u32>(0u);
    // Eight reads a turn: a GPU waits for each turn's.
    for (var k = 0u; k < thread; k += 8u) {
        let low = vec4<u32>(shares[k], shares[k + 1u], shares[k + 2u], shares[k + 3u]);
        let high = vec4<u32>(shares[k + 4u], shares[k + 5u], shares[k + 6u], shares[k + 7u]);
        let from_low = k + vec4<u32>(0u, 1u, 2u, 3u);
        sum += select(vec4<u32>(0u), low, from_low < vec4<u32>(thread));
        sum += select(vec4<u32>(0u), high, from_low + 4u < vec4<u32>(thread));
    }
    return sum.x + sum.y + sum.z + sum.w;
}

// Four sums, zero from `end` on: read together, since each read would wait for what was written before it.
fn four_from(k: u32, end: u32) -> vec4<u32> {
    let four = vec4<u32>(stretch_sums[k], stretch_sums[k + 1u], stretch_sums[k + 2u], stretch_sums[k + 3u]);
    return select(vec4<u32>(0u), four, vec4<u32>(k, k + 1u, k + 2u, k + 3u) < vec4<u32>(end));
}

@compute @workgroup_size(SCAN_THREADS)
fn scan_stretches(@builtin(local_invocation_index) thread: u32) {
    let count = step.bins / (CHUNK * WORKGROUP) + 1u;
    let share = (count + SCAN_THREADS - 1u) / SCAN_THREADS;
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
