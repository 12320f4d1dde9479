//! uses: thread.wgsl
// How many reads of single words the device makes that its caches have, for `corpuscle bench`: what a kernel that gathers can
// do at most.
//
// Reads `copy_from`, its first TABLE words; writes `copy_to`. One thread per four words of that; LOOPS times 4 reads each.

override LOOPS: u32 = 64;

// Words, a power of two: 16 KiB, which every device has in its nearest cache.
const TABLE: u32 = 4096;

var<storage, read> copy_from: array<u32>;
var<storage, read_write> copy_to: array<vec4<u32>>;

@compute @workgroup_size(WORKGROUP)
fn ceiling_loads(thread: Thread) {
    let k = linear(thread);
    if (k >= arrayLength(&copy_to)) {
        return;
    }
    var sum = vec4<u32>(0u);
    var at = k * 7u;
    // Four reads that do not wait for each other.
    for (var i = 0u; i < LOOPS; i++) {
        sum.x += copy_from[at & (TABLE - 1u)];
        sum.y += copy_from[(at + 1021u) & (TABLE - 1u)];
        sum.z += copy_from[(at + 2039u) & (TABLE - 1u)];
        sum.w += copy_from[(at + 3067u) & (TABLE - 1u)];
        at += 13u;
    }
    copy_to[k] = sum;
}
