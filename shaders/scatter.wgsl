//! uses: step.wgsl particle.wgsl
// Sort, part 1: each particle's id to a slot of its cell.
//
// Reads `particles`, `bins`, `cell_start`; writes `slots`. One thread per particle. The order within a
// cell is still that of `bin`; `order` mends it.

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(2) var<storage, read> particles: array<Particle>;
@group(0) @binding(5) var<storage, read> bins: array<vec2<u32>>;
@group(0) @binding(8) var<storage, read> cell_start: array<u32>;
@group(0) @binding(9) var<storage, read_write> slots: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn scatter(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear(id, groups);
    if (i >= step.count + step.newborns + step.arrivals) {
        return;
    }
    let bin = bins[i];
    if (bin.x == NOBODY) {
        return;
    }
    slots[cell_start[bin.x] + bin.y] = id_of(particles[i].tag);
}
