// What the threads of one workgroup have, and the sum of what those before one have.

// Threads of the workgroup, a multiple of eight.
override SCAN_THREADS: u32 = 256;

var<workgroup> workgroup_sums: array<u32, SCAN_THREADS>;

fn sums_before(thread: u32) -> u32 {
    var sum = vec4<u32>(0u);
    // Eight reads a turn: a GPU waits for each turn's.
    for (var k = 0u; k < thread; k += 8u) {
        let low = vec4<u32>(workgroup_sums[k], workgroup_sums[k + 1u], workgroup_sums[k + 2u], workgroup_sums[k + 3u]);
        let high = vec4<u32>(workgroup_sums[k + 4u], workgroup_sums[k + 5u], workgroup_sums[k + 6u], workgroup_sums[k + 7u]);
        let from_low = k + vec4<u32>(0u, 1u, 2u, 3u);
        sum += select(vec4<u32>(0u), low, from_low < vec4<u32>(thread));
        sum += select(vec4<u32>(0u), high, from_low + 4u < vec4<u32>(thread));
    }
    return sum.x + sum.y + sum.z + sum.w;
}
