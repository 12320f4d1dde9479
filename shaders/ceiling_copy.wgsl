//! uses: thread.wgsl
// What the device's memory gives: a copy, for `corpuscle bench`.
//
// Reads `copy_from`, writes `copy_to`. One thread per four words.

var<storage, read> copy_from: array<vec4<u32>>;
var<storage, read_write> copy_to: array<vec4<u32>>;

@compute @workgroup_size(WORKGROUP)
fn ceiling_copy(thread: Thread) {
    let k = linear(thread);
    if (k < arrayLength(&copy_to)) {
        copy_to[k] = copy_from[k];
    }
}
