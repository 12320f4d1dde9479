// A particle as one record of eight words: `fly` moves it where it is, `gather` puts it into another order.

override WORKGROUP: u32 = 64;
override COUNT: u32;

struct Particle {
    position: vec3<u32>,
    tag: u32,
    velocity: vec3<f32>,
    spin: f32,
}

@group(0) @binding(0) var<storage, read> order: array<u32>;
@group(0) @binding(1) var<storage, read_write> particles: array<Particle>;
@group(0) @binding(2) var<storage, read_write> ordered: array<Particle>;

@compute @workgroup_size(WORKGROUP)
fn fly(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let item = id.x + id.y * groups.x * WORKGROUP;
    if (item < COUNT) {
        let moved = bitcast<vec3<u32>>(vec3<i32>(particles[item].velocity));
        particles[item].position += moved;
    }
}

@compute @workgroup_size(WORKGROUP)
fn gather(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let item = id.x + id.y * groups.x * WORKGROUP;
    if (item < COUNT) {
        ordered[item] = particles[order[item]];
    }
}
