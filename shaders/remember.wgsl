//! uses: step.wgsl particle.wgsl counters.wgsl
// Keeps the particles as they are between two intervals, on a device alone: the next interval may have to run again. Once one
// has to, what is kept is its start, and stays until the host has gone back to it.
//
// Reads `particles` and whether an interval had too little room; writes `remembered`, and notes that in `counters`. One thread
// per particle, which writes its own slot.

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(2) var<storage, read> particles: array<Particle>;
@group(0) @binding(4) var<storage, read_write> counters: array<atomic<u32>>;
@group(0) @binding(59) var<storage, read_write> remembered: array<Particle>;

@compute @workgroup_size(WORKGROUP)
fn remember(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let k = linear(id, groups);
    if (k >= step.total) {
        return;
    }
    if (atomicLoad(&counters[TAILS_WANTED]) > 0u) {
        if (k == 0u) {
            atomicStore(&counters[GOES_BACK], 1u);
        }
    } else if (atomicLoad(&counters[GOES_BACK]) == 0u) {
        remembered[k] = particles[k];
    }
}
