//! uses: thread.wgsl
// What the device's memory gives: a copy, for `corpuscle bench`.
//
// Reads `copy_from`, writes `copy_to`. One thread per four words.

@group(0) @binding(0) var<storage, read> copy_from: array<vec4<u32>>;
@group(0) @binding(1) var<storage, read_write> copy_to: array<vec4<u32>>;

@compute @workgroup_size(WORKGROUP)
fn ceiling_copy(thread: Thread) {
    let k = linear(thread);
    if (k < arrayLength(&copy_to)) {
        copy_to[k] = copy_from[k];
    }
}
