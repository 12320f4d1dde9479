//! uses: step.wgsl
// What the device's memory gives: a copy, for `corpuscle bench`.
//
// Reads `copy_from`, writes `copy_to`. One thread per four words.

@group(0) @binding(0) var<storage, read> copy_from: array<vec4<u32>>;
@group(0) @binding(1) var<storage, read_write> copy_to: array<vec4<u32>>;

@compute @workgroup_size(WORKGROUP)
fn ceiling_copy(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let k = linear(id, groups);
    if (k < arrayLength(&copy_to)) {
        copy_to[k] = copy_from[k];
    }
}
