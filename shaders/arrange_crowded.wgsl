//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl lists.wgsl slots.wgsl lay.wgsl
// Sort of the method `cell`, in cells that `collide` does not put in order: their particles by id.
//
// Reads `crowded`, `bins`, `cell_start`, `slots` and `particles`; writes `sorted` (lay.wgsl). One thread per entry of `crowded`.

@group(0) @binding(5) var<storage, read> bins: array<vec2<u32>>;
@group(0) @binding(25) var<storage, read> crowded: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn arrange_crowded(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let place_in_list = linear(id, groups);
    if (place_in_list >= atomicLoad(&counters[LIST_CROWDED])) {
        return;
    }
    let i = crowded[place_in_list];
    let cell = bins[i].x;
    lay(i, place_by_id(cell, id_of(particles[i].place.w)), cell);
}
