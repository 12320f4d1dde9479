use super::stretch::Item;
use super::*;

const PROBE: KernelSource = KernelSource::probe(
    "override FAST: bool = true;
override FACTOR: f32 = 2.0;
@group(0) @binding(0) var<storage, read_write> values: array<vec3<f32>>;
fn twice(x: f32) -> f32 {
return x + x;
}
fn fast() -> bool {
return FAST;
}
@compute @workgroup_size(1)
fn probe(@builtin(global_invocation_id) id: vec3<u32>) {
let k = id.x + 1u;
// bench: behind the last
if (k > 7u) {
    return;
}
let v = values[k] * (FACTOR * 3.0);
var sum = 0.0;
for (var i = 0u; i < 4u; i++) {
    sum += v.x;
}
// bench: turn
for (var i = 0u; i < k; i++) {
    // bench: far
    if (v.y > sum) {
        continue;
    }
    sum -= dot(v, v);
}
if (fast()) {
    values[k] = v / twice(sum);
} else {
    values[k] = normalize(v) * f32(k);
}
}",
);

#[test]
fn operations_are_those_of_the_source() {
    let fast = Stretch::of_kernel(&PROBE, &[]).unwrap();
    // k and its test; four turns of comparison and count.
    let integer = 2.0 + 4.0 * 2.0;
    // v, four sums, twice the sum, three quotients.
    assert_eq!(fast.straight(), Operations { floating: 3.0 + 4.0 + 1.0 + 3.0, integer });
    // Three components, their length and quotients, a conversion and three products.
    let slow = Stretch::of_kernel(&PROBE, &[("FAST", 0.0)]).unwrap();
    assert_eq!(slow.straight(), Operations { floating: 3.0 + 4.0 + 9.0 + 1.0 + 3.0, integer });
    let turn = fast.inner("turn").unwrap();
    assert_eq!(turn.straight(), Operations { floating: 1.0 + 5.0 + 1.0, integer: 2.0 });
    let [before, after] = turn.around("far").unwrap();
    assert_eq!(before, Operations { floating: 1.0, integer: 1.0 });
    assert_eq!(before + after, turn.straight());
    assert_eq!(fast.around("behind the last").unwrap()[0], Operations { floating: 0.0, integer: 2.0 });
    assert!(fast.inner("side").is_none() && fast.around("side").is_none());
}

#[test]
fn both_sides_of_a_logical_operator_count() {
    let source = "@group(0) @binding(0) var<storage, read_write> values: array<u32>;
@compute @workgroup_size(1)
fn probe(@builtin(global_invocation_id) id: vec3<u32>) {
values[id.x] = select(0u, 1u, id.x > 1u && (id.y > 2u || id.z > 3u));
}";
    let counted = Stretch::of_kernel(&KernelSource::probe(source), &[]).unwrap();
    assert_eq!(counted, Stretch(vec![Item::Counted(counted.straight())]), "no branch");
    assert!(counted.straight().integer >= 4.0 && counted.straight().integer <= 6.0, "{counted:?}");
}
