// Adds to each value of a span what stands before the span, and puts the sum of all behind the last.

override WORKGROUP: u32 = 64;
override SPAN: u32;
override COUNT: u32;

@group(0) @binding(0) var<storage, read> before: array<u32>;
@group(0) @binding(1) var<storage, read_write> sums: array<u32>;
@group(0) @binding(2) var<storage, read> values: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn scan_add(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let item = id.x + id.y * groups.x * WORKGROUP;
    if (item >= COUNT) {
        return;
    }
    let sum = sums[item] + before[item / SPAN];
    sums[item] = sum;
    if (item + 1u == COUNT) {
        sums[COUNT] = sum + values[item];
    }
}
