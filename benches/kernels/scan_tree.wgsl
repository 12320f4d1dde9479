// Exclusive prefix sums in the memory of a workgroup: each takes 2 WORKGROUP values, in a pass of doubling distances.
// With TOTALS the sum of each is written too, for the pass above; with BEFORE the sums of those before are added.
//
// Reads `values` and, with BEFORE, `before`; writes `sums` and, with TOTALS, `totals`.

override WORKGROUP: u32 = 64;
override SPAN: u32 = 2 * WORKGROUP;
override COUNT: u32;
override TOTALS: bool;

@group(0) @binding(0) var<storage, read> values: array<u32>;
@group(0) @binding(1) var<storage, read_write> sums: array<u32>;
@group(0) @binding(2) var<storage, read_write> totals: array<u32>;

var<workgroup> shared_sums: array<u32, SPAN>;

@compute @workgroup_size(WORKGROUP)
fn scan_tree(
    @builtin(local_invocation_index) thread: u32,
    @builtin(workgroup_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let group = id.x + id.y * groups.x;
    let first = group * SPAN;
    for (var k = thread; k < SPAN; k += WORKGROUP) {
        var value = 0u;
        if (first + k < COUNT) {
            value = values[first + k];
        }
        shared_sums[k] = value;
    }
    for (var distance = 1u; distance < SPAN; distance *= 2u) {
        workgroupBarrier();
        var low = 0u;
        var high = 0u;
        if (thread >= distance) {
            low = shared_sums[thread - distance];
        }
        if (thread + WORKGROUP >= distance) {
            high = shared_sums[thread + WORKGROUP - distance];
        }
        workgroupBarrier();
        shared_sums[thread] += low;
        shared_sums[thread + WORKGROUP] += high;
    }
    workgroupBarrier();
    for (var k = thread; k < SPAN; k += WORKGROUP) {
        if (first + k < COUNT) {
            sums[first + k] = select(shared_sums[max(k, 1u) - 1u], 0u, k == 0u);
        }
    }
    if (TOTALS && thread == 0u) {
        totals[group] = shared_sums[SPAN - 1u];
    }
}
