// A particle as eight words in as many stretches of one buffer, one for each word of all particles: `fly` moves it where
// it is, `gather` puts it into another order.

override WORKGROUP: u32 = 64;
override COUNT: u32;

const WORDS: u32 = 8;
const VELOCITY: u32 = 4;

@group(0) @binding(0) var<storage, read> order: array<u32>;
@group(0) @binding(1) var<storage, read_write> particles: array<u32>;
@group(0) @binding(2) var<storage, read_write> ordered: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn fly(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let item = id.x + id.y * groups.x * WORKGROUP;
    if (item < COUNT) {
        for (var axis = 0u; axis < 3u; axis++) {
            let moved = bitcast<u32>(i32(bitcast<f32>(particles[(VELOCITY + axis) * COUNT + item])));
            particles[axis * COUNT + item] += moved;
        }
    }
}

@compute @workgroup_size(WORKGROUP)
fn gather(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let item = id.x + id.y * groups.x * WORKGROUP;
    if (item < COUNT) {
        let source = order[item];
        for (var word = 0u; word < WORDS; word++) {
            ordered[word * COUNT + item] = particles[word * COUNT + source];
        }
    }
}
