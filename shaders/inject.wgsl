//! uses: step.wgsl particle.wgsl newborn.wgsl counters.wgsl
// Appends this step's newborns to the particles.
//
// Reads `newborns`; writes `particles[count ..]`. One thread per newborn. Each writes its own slot, so
// order does not matter. A newborn without room is counted, and the host stops the run.

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(2) var<storage, read_write> particles: array<Particle>;
@group(0) @binding(4) var<storage, read_write> counters: array<atomic<u32>>;

@compute @workgroup_size(WORKGROUP)
fn inject(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let k = linear(id, groups);
    if (k >= step.newborns) {
        return;
    }
    let slot = step.count + k;
    if (slot >= step.capacity) {
        atomicAdd(&counters[CAPACITY_FAILED], 1u);
        return;
    }
    particles[slot] = newborns[step.newborn_offset + k].particle;
}
