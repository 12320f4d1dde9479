//! uses: step.wgsl grid.wgsl particle.wgsl counters.wgsl
// Counts the particles of each cell, by their mid-step position.
//
// Reads `particles`; writes `bins` (cell, slot within the cell) and `cell_count`. One thread per
// particle. The slot depends on the order of the threads; `order` replaces it by the rank of the id.

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(2) var<storage, read> particles: array<Particle>;
@group(0) @binding(5) var<storage, read_write> bins: array<vec2<u32>>;
@group(0) @binding(6) var<storage, read_write> cell_count: array<atomic<u32>>;

@compute @workgroup_size(WORKGROUP)
fn bin(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear(id, groups);
    if (i >= step.count + step.newborns) {
        return;
    }
    let middle = shifted(particles[i].position, particles[i].velocity * (0.5 * step.dt));
    let cell = cell_index(nearest_cell(middle));
    bins[i] = vec2<u32>(cell, atomicAdd(&cell_count[cell], 1u));
}
